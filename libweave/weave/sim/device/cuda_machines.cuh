#pragma once

// Machines (relax_on.hpp) whose crews are of a CUDA device.

#include <weave/sim/device/launches.cuh>

#include <cstddef>

namespace weave::sim {

/// A kernel with numbers for its threads: each has its own, which begin alike; one of them writes its back.
template <class Kernel, class Numbers>
struct WithNumbers {
    Kernel kernel;
    View<Numbers> kept;  ///< one

    struct Keep {
        View<Numbers> kept;
        Numbers own;
        WEAVE_HD void operator()() const { kept[0] = own; }
    };

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        Numbers own = kept[0];
        kernel(crew, own);
        crew.alone(Keep{kept, own});
    }
};

/// All that fits on the device as one gang, that stays there for a whole leg: for cells too small to keep a device busy between two
/// launches.
class CudaGangMachine {
  public:
    using Crew = CudaGang;

    explicit CudaGangMachine(DeviceQueue& queue) : m_memory(queue), m_runner(queue) {}

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers) {
        Array<Numbers> kept(m_memory, std::vector<Numbers>{numbers});
        m_runner.run(WithNumbers<Kernel, Numbers>{kernel, kept.view()});
        numbers = kept.get().front();
    }

  private:
    CudaMemory m_memory;
    GangRunner m_runner;
};

/// Kernels launched one after the other, by the processor, which decides the way on.
class CudaLaunchesMachine {
  public:
    using Crew = Launches;

    explicit CudaLaunchesMachine(DeviceQueue& queue) : m_memory(queue), m_crew(queue) {}

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers) {
        kernel(m_crew, numbers);
    }

  private:
    CudaMemory m_memory;
    Launches m_crew;
};

}  // namespace weave::sim
