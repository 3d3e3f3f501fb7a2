#pragma once

#include <functional>
#include <string_view>

namespace weave {

enum class LogLevel { debug, info, warning };

using LogSink = std::function<void(LogLevel, std::string_view message)>;

/// Where the library's messages go from now on. The library never prints by itself: without a sink they are
/// dropped. Safe to call from any thread.
void set_log_sink(LogSink sink);

/// Hands one message to the sink. Never a secret, never more than a line.
void log(LogLevel level, std::string_view message);

}  // namespace weave
