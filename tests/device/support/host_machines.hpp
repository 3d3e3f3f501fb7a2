#pragma once

#include <weave/sim/device/cores.hpp>
#include <weave/sim/device/emulated.hpp>
#include <weave/sim/device/memory.hpp>

namespace device_tests {

namespace sim = weave::sim;

/// One thread of the processor.
struct OneThread {
    sim::HostMemory memory;
    template <class Kernel>
    void run(const Kernel& kernel) {
        sim::run_alone(kernel);
    }
};

/// The processor's cores.
struct TwoCores {
    sim::HostMemory memory;
    sim::Executor executor{2};
    template <class Kernel>
    void run(const Kernel& kernel) {
        sim::Cores cores(executor);
        kernel(cores);
    }
};

/// A gang of two blocks, every thread of them one of the operating system.
struct Emulated {
    sim::HostMemory memory;
    template <class Kernel>
    void run(const Kernel& kernel) {
        sim::emulate(2, 3, kernel);
    }
};

}  // namespace device_tests

#if defined(__CUDACC__) // there they only tell what is right; see device_machines.cuh
#elif defined(WEAVE_WATCHES_THREADS) // asks about barriers; the library's own threads are not compiled to be watched there
#define WEAVE_MACHINES device_tests::Emulated
#else
#define WEAVE_MACHINES device_tests::OneThread, device_tests::TwoCores, device_tests::Emulated
#endif
