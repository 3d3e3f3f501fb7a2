#pragma once

#include <weave/core/json.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace weave::simd {

/// As much of a text of one line as fits these columns, no character cut in two.
std::string clipped(std::string_view text, std::size_t columns);

/// The status of a daemon (Daemon::status()) as lines of a terminal, none wider than `columns`; at most `lines` of them, the
/// busiest first, and how many were left out.
std::string status_table(const Json& status, std::size_t columns, std::size_t lines);

}  // namespace weave::simd
