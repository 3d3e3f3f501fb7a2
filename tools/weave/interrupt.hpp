#pragma once

namespace weave::program {

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
