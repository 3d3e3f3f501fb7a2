#pragma once

// Machines (relax_on.hpp) whose crews are of a CUDA device.

#include <weave/sim/device/launches.cuh>
#include <weave/sim/device/with_numbers.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// A gang that stays on the device for a whole leg: for cells too small to keep a device busy between two launches. It has as many
/// blocks as its work asks for, up to all that fit there: the fewer, the sooner they have waited for one another.
class CudaGangMachine {
  public:
    using Crew = CudaGang;
    using BlockCrew = CudaBlockGang;

    explicit CudaGangMachine(DeviceQueue& queue) : m_memory(queue), m_runner(queue) {}

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers, std::size_t items = 0) {
        Array<Numbers> kept(m_memory, std::vector<Numbers>{numbers});
        m_runner.run(WithNumbers<Kernel, Numbers>{kernel, kept.view()}, (items + gang_threads - 1) / gang_threads);
        numbers = kept.get().front();
    }
    template <class Kernel, class Numbers>
    void run_each(const std::vector<Kernel>& kernels, std::vector<Numbers>& numbers) {
        const Array<Kernel> all(m_memory, kernels);
        Array<Numbers> kept(m_memory, numbers);
        m_runner.run_each(EachWithNumbers<Kernel, Numbers>{all.view(), kept.view()}, kernels.size());
        numbers = kept.get();
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
    void run(const Kernel& kernel, Numbers& numbers, std::size_t = 0) {
        kernel(m_crew, numbers);
    }

  private:
    CudaMemory m_memory;
    Launches m_crew;
};

}  // namespace weave::sim
