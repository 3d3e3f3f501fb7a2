#pragma once

#include <weave/core/result.hpp>

#include <chrono>
#include <string>
#include <string_view>

namespace weave {

/// A moment in UTC, to the millisecond.
using Instant = std::chrono::sys_time<std::chrono::milliseconds>;

/// `2026-11-26T09:30:00.000Z`, always with milliseconds, so that a moment has one text only. Years 1970 to
/// 9999.
std::string utc_text(Instant instant);

/// Reads exactly what utc_text() writes; an error for anything else, days that do not exist included.
Result<Instant> parse_utc(std::string_view text);

}  // namespace weave
