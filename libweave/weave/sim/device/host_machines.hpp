#pragma once

// Machines whose crews run on the processor (relax_on.hpp).

#include <weave/sim/device/cores.hpp>
#include <weave/sim/device/emulated.hpp>
#include <weave/sim/device/memory.hpp>
#include <weave/sim/device/with_numbers.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// The calling thread alone.
class OneThreadMachine {
  public:
    using Crew = Gang<OneThread>;
    using BlockCrew = Crew;

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers, std::size_t = 0) {
        run_alone([&](Crew& crew) { kernel(crew, numbers); });
    }
    template <class Kernel, class Numbers>
    void run_each(const std::vector<Kernel>& kernels, std::vector<Numbers>& numbers) {
        for (std::size_t k = 0; k < kernels.size(); ++k) run(kernels[k], numbers[k]);
    }

  private:
    HostMemory m_memory;
};

/// Real threads and barriers in the place of a device's.
class EmulatedMachine {
  public:
    using Crew = Gang<EmulatedThread>;
    using BlockCrew = Gang<BlockOf<EmulatedThread>>;

    EmulatedMachine(std::size_t blocks, std::size_t threads_a_block) : m_blocks(blocks), m_threads(threads_a_block) {}

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers, std::size_t = 0) {
        emulate(m_blocks, m_threads, WithNumbers<Kernel, Numbers>{kernel, {&numbers, 1}});
    }
    template <class Kernel, class Numbers>
    void run_each(const std::vector<Kernel>& kernels, std::vector<Numbers>& numbers) {
        const EachWithNumbers<Kernel, Numbers> each{{kernels.data(), kernels.size()}, {numbers.data(), numbers.size()}};
        emulate_each(kernels.size(), m_threads, each);
    }

  private:
    std::size_t m_blocks, m_threads;
    HostMemory m_memory;
};

/// The processor's cores.
class CoresMachine {
  public:
    using Crew = Cores;

    explicit CoresMachine(const Executor& executor) : m_crew(executor) {}

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers, std::size_t = 0) {
        kernel(m_crew, numbers);
    }

  private:
    HostMemory m_memory;
    Cores m_crew;
};

}  // namespace weave::sim
