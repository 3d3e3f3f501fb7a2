#pragma once

#include <string>

namespace weave::program {

/// A line for whoever ends the program by a signal, told just before it ends; empty: none.
void tell_when_ended(std::string line);

/// From now on SIGUSR1 is a wish to stop at the next occasion: mpirun hands it on, while it ends all at once by other signals.
void stop_on_user_signal();
/// Whether it came.
bool asked_to_stop();

/// Lets the program end tidily by a signal (SIGINT, SIGTERM, SIGHUP): no half-written file stays behind. Call once,
/// before any other thread is started.
void tidy_up_when_ended();

/// While one lives, the first signal does not end the program but makes interrupted() true, so that what was computed
/// can be kept; another one, half a second later or more, ends it at once.
class HeldInterrupt {
  public:
    /// `follows` tells people what a first signal leads to, and what a second; it must last as long as the program.
    explicit HeldInterrupt(const char* follows);
    ~HeldInterrupt();
    HeldInterrupt(const HeldInterrupt&) = delete;
    HeldInterrupt& operator=(const HeldInterrupt&) = delete;
};

/// Whether a signal has come while it was held.
bool interrupted();

}  // namespace weave::program
