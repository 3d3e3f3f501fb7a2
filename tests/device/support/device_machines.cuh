#pragma once

#include <weave/sim/device/launches.cuh>

namespace device_tests {

namespace sim = weave::sim;

/// All that fits on the device as one gang.
struct DeviceGang {
    sim::DeviceQueue queue;
    sim::CudaMemory memory{queue};
    template <class Kernel>
    void run(const Kernel& kernel) {
        sim::GangRunner(queue).run(kernel);
    }
};

/// A kernel for run_each() from one for run().
template <class Kernel>
struct WithoutNumber {
    Kernel kernel;
    template <class Crew>
    WEAVE_HD void operator()(Crew& crew, std::size_t) const {
        kernel(crew);
    }
};

/// A block of the device as a gang.
struct DeviceBlock {
    sim::DeviceQueue queue;
    sim::CudaMemory memory{queue};
    template <class Kernel>
    void run(const Kernel& kernel) {
        sim::GangRunner(queue).run_each(WithoutNumber<Kernel>{kernel}, 1);
    }
};

/// Kernels of the device, launched one after the other.
struct DeviceLaunches {
    sim::DeviceQueue queue;
    sim::CudaMemory memory{queue};
    template <class Kernel>
    void run(const Kernel& kernel) {
        sim::Launches launches(queue);
        kernel(launches);
        queue.wait();
    }
};

}  // namespace device_tests

#define WEAVE_MACHINES device_tests::DeviceGang, device_tests::DeviceBlock, device_tests::DeviceLaunches
