#pragma once

// A gang on the processor: every thread of every block is a thread of the operating system, and barriers are real. It shows what a
// device would do with the same code, missing barriers (under ThreadSanitizer) and accesses beyond the end (with WEAVE_BOUNDS) among it.

#include <weave/sim/device/crew.hpp>

#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace weave::sim {

/// Lets threads wait for one another. They sleep meanwhile: there are more of them than cores, and std::barrier's spin would keep
/// from their core just those that are waited for.
class SleepingBarrier {
  public:
    explicit SleepingBarrier(std::size_t threads) : m_threads(threads) {}

    void arrive_and_wait() {
        std::unique_lock lock(m_lock);
        const std::size_t round = m_round;
        if (++m_arrived == m_threads) {
            m_arrived = 0;
            ++m_round;
            m_next.notify_all();
            return;
        }
        m_next.wait(lock, [&] { return m_round != round; });
    }

  private:
    std::size_t m_threads, m_arrived = 0, m_round = 0;
    std::mutex m_lock;
    std::condition_variable m_next;
};

/// What the threads of an emulated device share.
struct EmulatedDevice {
    EmulatedDevice(std::size_t blocks, std::size_t threads_a_block)
        : threads(threads_a_block), all(blocks * threads), parts(parts_of_gang(blocks)),
          shared(blocks, std::vector<double>(threads)) {
        for (std::size_t b = 0; b < blocks; ++b)
            of_block.push_back(std::make_unique<SleepingBarrier>(threads));
    }

    std::size_t threads;
    SleepingBarrier all;
    std::vector<std::unique_ptr<SleepingBarrier>> of_block;
    std::vector<double> parts;
    std::vector<std::vector<double>> shared;
};

/// One of its threads, as Gang wants it.
struct EmulatedThread {
    EmulatedDevice* device;
    std::size_t m_block, m_thread;

    [[nodiscard]] std::size_t thread() const { return m_thread; }
    [[nodiscard]] std::size_t threads() const { return device->threads; }
    [[nodiscard]] std::size_t block() const { return m_block; }
    [[nodiscard]] std::size_t blocks() const { return device->of_block.size(); }
    void sync_block() const { device->of_block[m_block]->arrive_and_wait(); }
    void sync_all() const { device->all.arrive_and_wait(); }
    [[nodiscard]] double* shared() const { return device->shared[m_block].data(); }
};

/// work(thread) by every thread of so many blocks.
template <class Work>
void by_emulated_threads(std::size_t blocks, std::size_t threads_a_block, const Work& work) {
    EmulatedDevice device(blocks, threads_a_block);
    std::vector<std::thread> all;
    for (std::size_t b = 0; b < blocks; ++b) {
        for (std::size_t t = 0; t < threads_a_block; ++t) all.emplace_back([&device, &work, b, t] { work(EmulatedThread{&device, b, t}); });
    }
    for (std::thread& thread : all) thread.join();
}

/// kernel(gang) by all blocks together.
template <class Kernel>
void emulate(std::size_t blocks, std::size_t threads_a_block, const Kernel& kernel) {
    by_emulated_threads(blocks, threads_a_block, [&](const EmulatedThread& thread) {
        Gang<EmulatedThread> gang(thread, {thread.device->parts.data(), thread.device->parts.size()});
        kernel(gang);
    });
}

/// kernel(gang, k) for every k below `gangs`, each by a block for itself.
template <class Kernel>
void emulate_each(std::size_t gangs, std::size_t threads_a_block, const Kernel& kernel) {
    std::vector<double> parts(gangs * parts_of_gang(1));
    by_emulated_threads(gangs, threads_a_block, [&](const EmulatedThread& thread) {
        Gang<BlockOf<EmulatedThread>> gang({thread}, {parts.data() + thread.block() * parts_of_gang(1), parts_of_gang(1)});
        kernel(gang, thread.block());
    });
}

/// kernel(gang) by the calling thread alone.
template <class Kernel>
void run_alone(const Kernel& kernel) {
    double shared = 0;
    std::vector<double> parts(parts_of_gang(1));
    Gang<OneThread> gang({&shared}, {parts.data(), parts.size()});
    kernel(gang);
}

}  // namespace weave::sim
