#include <weave/core/log.hpp>

#include <mutex>

namespace weave {

namespace {

std::mutex sink_mutex;

LogSink& sink() {
    static LogSink current;
    return current;
}

}  // namespace

void set_log_sink(LogSink new_sink) {
    const std::lock_guard lock(sink_mutex);
    sink() = std::move(new_sink);
}

void log(LogLevel level, std::string_view message) {
    const std::lock_guard lock(sink_mutex);
    if (sink()) sink()(level, message);
}

}  // namespace weave
