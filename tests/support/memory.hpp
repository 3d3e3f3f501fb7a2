#pragma once

#include <sys/resource.h>

namespace weave::testing {

/// The most memory that this process has held so far, in MB. It never falls, so the growth over a piece of work is
/// 0 where earlier work held more; CTest runs every test case in a process of its own.
inline double peak_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace weave::testing
