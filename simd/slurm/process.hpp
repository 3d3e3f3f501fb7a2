#pragma once

#include <weave/core/result.hpp>

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

namespace weave::simd {

/// What a program answered.
struct Answered {
    int status = 0;      ///< its exit status; -1: a signal ended it
    std::string answer;  ///< standard output
    std::string told;    ///< standard error
};

/// Runs a program, found by PATH, with these words and no shell between, in an environment of PATH, HOME, LANG and SLURM_CONF alone, and waits
/// for its end. Errors (system): it is not there; it took longer than `patience`, or `gives_up` became true, and so was killed.
Result<Answered> run_command(const std::vector<std::string>& words, std::chrono::milliseconds patience, const std::atomic<bool>& gives_up);

}  // namespace weave::simd
