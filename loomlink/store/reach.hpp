#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <optional>

namespace weave::loomlink {

/// Why a store did not answer that is well in itself, as while its server is down. The cause stands in the message, for the log.
enum class Lost : std::uint8_t {
    before,     ///< it is out of reach: nothing was recorded
    in_commit,  ///< it went while it recorded: what was to be recorded may be there, or not
};

/// An error of the system that says so.
Error lost_store(Lost when, const Error& cause);

/// When the store was lost, of an error that lost_store() made.
std::optional<Lost> lost_of(const Error& error);

}  // namespace weave::loomlink
