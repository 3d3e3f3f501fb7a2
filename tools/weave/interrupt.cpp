#include "interrupt.hpp"

#include <weave/core/file.hpp>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <unistd.h>
#include <utility>

namespace weave::program {

namespace {

std::atomic<bool> held{false}, came{false};
std::atomic<const char*> what_follows{""};
std::atomic<bool> wished{false};

/// The line for the end, and the lock that its readers take.
struct LastLine {
    std::mutex mutex;
    std::string text;
};

LastLine& last_line() {
    static auto* const one = new LastLine;  // outlives every thread
    return *one;
}

/// Decides signal by signal whether the program ends at once. A key that bounces, or a caller that signals
/// twice, is not a second wish.
class Judge {
  public:
    bool ends_at_once() {
        if (!held) return true;
        const auto now = std::chrono::steady_clock::now();
        if (came.exchange(true)) return now - m_first > std::chrono::milliseconds(500);
        m_first = now;
        const char* after_progress = ::isatty(STDERR_FILENO) == 1 ? "\n" : "";
        std::fprintf(stderr, "%sweave: interrupted: %s\n", after_progress, what_follows.load());
        return false;
    }

  private:
    std::chrono::steady_clock::time_point m_first;
};

}  // namespace

/// Whoever ends the program by a signal finds no half-written file. A signal that was to be ignored (nohup)
/// still is.
void tidy_up_when_ended() {
    sigset_t ending;
    sigemptyset(&ending);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction now {};
        if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) sigaddset(&ending, signal);
    }
    pthread_sigmask(SIG_BLOCK, &ending, nullptr);  // here, and in every thread from now on
    std::thread([ending] {
        int signal = 0;
        Judge judge;
        do {
            if (sigwait(&ending, &signal) != 0) return;
        } while (!judge.ends_at_once());
        drop_unfinished_writes();
        {
            const std::lock_guard lock(last_line().mutex);
            if (!last_line().text.empty()) std::fprintf(stderr, "weave: %s\n", last_line().text.c_str());
        }
        std::signal(signal, SIG_DFL);
        pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
        std::raise(signal);  // so that the caller learns what ended us
    }).detach();
}

void tell_when_ended(std::string line) {
    const std::lock_guard lock(last_line().mutex);
    last_line().text = std::move(line);
}

void stop_on_user_signal() {
    struct sigaction action {};
    action.sa_handler = [](int) { wished = true; };
    sigaction(SIGUSR1, &action, nullptr);
}

bool asked_to_stop() {
    return wished;
}

HeldInterrupt::HeldInterrupt(const char* follows) {
    what_follows = follows;
    came = false;
    held = true;
}

HeldInterrupt::~HeldInterrupt() {
    held = false;
}

bool interrupted() {
    return came;
}

}  // namespace weave::program
