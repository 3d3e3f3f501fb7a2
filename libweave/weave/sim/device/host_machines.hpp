#pragma once

// Machines whose crews run on the processor (relax_on.hpp).

#include <weave/sim/device/cores.hpp>
#include <weave/sim/device/emulated.hpp>
#include <weave/sim/device/memory.hpp>

#include <cstddef>

namespace weave::sim {

/// The calling thread alone.
class OneThreadMachine {
  public:
    using Crew = Gang<OneThread>;

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers) {
        run_alone([&](Crew& crew) { kernel(crew, numbers); });
    }

  private:
    HostMemory m_memory;
};

/// Real threads and barriers in the place of a device's.
class EmulatedMachine {
  public:
    using Crew = Gang<EmulatedThread>;

    EmulatedMachine(std::size_t blocks, std::size_t threads_a_block) : m_blocks(blocks), m_threads(threads_a_block) {}

    Memory& memory() { return m_memory; }
    template <class Kernel, class Numbers>
    void run(const Kernel& kernel, Numbers& numbers) {
        const Numbers before = numbers;
        emulate(m_blocks, m_threads, [&](Crew& crew) {
            Numbers own = before;
            kernel(crew, own);
            crew.alone([&] { numbers = own; });
        });
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
    void run(const Kernel& kernel, Numbers& numbers) {
        kernel(m_crew, numbers);
    }

  private:
    HostMemory m_memory;
    Cores m_crew;
};

}  // namespace weave::sim
