#pragma once

#include <weave/core/json.hpp>

#include <cstddef>
#include <string>

namespace weave::simd {

/// The status of a daemon (Daemon::status()) as lines of a terminal, none wider than `columns`; at most `lines` of them, the
/// busiest first, and how many were left out.
std::string status_table(const Json& status, std::size_t columns, std::size_t lines);

}  // namespace weave::simd
