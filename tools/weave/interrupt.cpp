#include "interrupt.hpp"

#include <weave/core/file.hpp>

#include <atomic>
#include <csignal>
#include <thread>

namespace weave::program {

namespace {

std::atomic<bool> held{false}, came{false};

}  // namespace

/// Whoever ends the program by a signal finds no half-written file. A signal that was to be ignored (nohup) still is.
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
        do {
            if (sigwait(&ending, &signal) != 0) return;
        } while (held && !came.exchange(true));
        drop_unfinished_writes();
        std::signal(signal, SIG_DFL);
        pthread_sigmask(SIG_UNBLOCK, &ending, nullptr);
        std::raise(signal);  // so that the caller learns what ended us
    }).detach();
}

HeldInterrupt::HeldInterrupt() {
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
