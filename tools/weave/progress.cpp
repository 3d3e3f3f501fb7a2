#include "progress.hpp"

#include <weave/core/text.hpp>

#include <chrono>
#include <cstdio>
#include <unistd.h>

namespace weave::program {

Progress::Progress(const std::string& doing) : m_doing(on_one_line(doing)), m_thread([this] { tell(); }) {}

Progress::~Progress() {
    {
        const std::lock_guard lock(m_mutex);
        m_over = true;
    }
    m_ended.notify_one();
    m_thread.join();
}

void Progress::tell() {
    const bool terminal = ::isatty(STDERR_FILENO) == 1;
    std::unique_lock lock(m_mutex);
    int seconds = 0;
    while (!m_ended.wait_for(lock, std::chrono::seconds(1), [this] { return m_over; })) {
        ++seconds;
        if (terminal) {
            std::fprintf(stderr, "\r%s … %d s ", m_doing.c_str(), seconds);
        } else if (seconds == 1 || seconds % 10 == 0) {
            std::fprintf(stderr, "%s ... %d s\n", m_doing.c_str(), seconds);
        }
    }
    if (terminal && seconds > 0) std::fprintf(stderr, "\r\033[K");
}

}  // namespace weave::program
