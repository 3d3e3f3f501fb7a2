#pragma once

#include <weave/sim/bodies.hpp>

#include <cstdint>

namespace weave::sim {

/// Adds one to a number that other threads count with too; what it was before. In which order they come nobody knows.
WEAVE_HD inline std::uint32_t count_up(std::uint32_t& counter) {
#if defined(__CUDA_ARCH__)
    return atomicAdd(&counter, 1U);
#else
    return __atomic_fetch_add(&counter, 1U, __ATOMIC_RELAXED);
#endif
}

}  // namespace weave::sim
