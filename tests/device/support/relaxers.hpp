#pragma once

// The machines that relaxations are tested on: by one body, in SUBJECT.hpp, as with machines.hpp. `weave`: yarns each way of the cloth that
// they are tried with (WEAVE_BATCH_RELAXERS: those that take many cloths at once); the gang's threads wait for one another some hundred times in a step, so its cloth is small.

#include <catch2/catch.hpp>

#if defined(__CUDACC__)
#include <weave/sim/device/relax_cuda.cuh>

namespace device_tests {

struct RelaxesInOneKernel {
    static constexpr std::size_t weave = 4;
    weave::sim::DeviceQueue queue;
    weave::sim::CudaGangMachine machine{queue};
};
struct RelaxesByLaunches {
    static constexpr std::size_t weave = 4;
    weave::sim::DeviceQueue queue;
    weave::sim::CudaLaunchesMachine machine{queue};
};

}  // namespace device_tests

#define WEAVE_RELAXERS device_tests::RelaxesInOneKernel, device_tests::RelaxesByLaunches
#define WEAVE_BATCH_RELAXERS device_tests::RelaxesInOneKernel
#else
#include <weave/sim/device/host_machines.hpp>

namespace device_tests {

struct RelaxesByOneThread {
    static constexpr std::size_t weave = 4;
    weave::sim::OneThreadMachine machine;
};
struct RelaxesByTwoCores {
    static constexpr std::size_t weave = 4;
    weave::sim::Executor executor{2};
    weave::sim::CoresMachine machine{executor};
};
struct RelaxesByGang {
    static constexpr std::size_t weave = 2;
    weave::sim::EmulatedMachine machine{2, 3};
};

}  // namespace device_tests

#if defined(WEAVE_WATCHES_THREADS)
#define WEAVE_RELAXERS device_tests::RelaxesByGang
#define WEAVE_BATCH_RELAXERS device_tests::RelaxesByGang
#else
#define WEAVE_BATCH_RELAXERS device_tests::RelaxesByOneThread, device_tests::RelaxesByGang
#define WEAVE_RELAXERS device_tests::RelaxesByOneThread, device_tests::RelaxesByTwoCores, device_tests::RelaxesByGang
#endif
#endif
