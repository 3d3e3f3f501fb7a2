#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace weave::sim {

/// Threads that wait for a task and all run it at once. They sleep between tasks, so that a busy machine is not made
/// busier by waiting.
class ThreadTeam {
  public:
    explicit ThreadTeam(std::size_t threads) {
        for (std::size_t t = 1; t < threads; ++t) m_threads.emplace_back([this, t] { serve(t); });
    }
    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;
    ~ThreadTeam() {
        m_task = nullptr;
        m_round.fetch_add(1, std::memory_order_release);
        m_round.notify_all();
        for (std::thread& thread : m_threads) thread.join();
    }

    /// task(t) for every thread t, this one being 0; returns when all are done.
    void run(const std::function<void(std::size_t)>& task) {
        m_task = &task;
        m_running.store(m_threads.size(), std::memory_order_relaxed);
        m_round.fetch_add(1, std::memory_order_release);
        m_round.notify_all();
        task(0);
        std::size_t running = m_running.load(std::memory_order_acquire);
        for (int spin = 0; running != 0 && spin < spins; ++spin) running = m_running.load(std::memory_order_acquire);
        while (running != 0) {
            m_running.wait(running, std::memory_order_acquire);
            running = m_running.load(std::memory_order_acquire);
        }
    }

  private:
    static constexpr int spins = 2000;  ///< some microseconds: as long as a short task lasts

    void serve(std::size_t number) {
        std::size_t seen = 0;
        while (true) {
            for (int spin = 0; m_round.load(std::memory_order_acquire) == seen && spin < spins; ++spin) {}
            m_round.wait(seen, std::memory_order_acquire);
            ++seen;
            if (m_task == nullptr) return;
            (*m_task)(number);
            if (m_running.fetch_sub(1, std::memory_order_acq_rel) == 1) m_running.notify_one();
        }
    }

    const std::function<void(std::size_t)>* m_task = nullptr;
    std::atomic<std::size_t> m_round{0}, m_running{0};
    std::vector<std::thread> m_threads;
};

/// Runs bodies on the processor's cores. What it computes does not depend on the number of threads: bodies write to
/// places of their own, and sums are formed in blocks of fixed size.
class Executor {
  public:
    /// 0: as many threads as there are cores.
    explicit Executor(std::size_t threads = 0)
        : m_threads(threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency())),
          m_team(m_threads > 1 ? std::make_unique<ThreadTeam>(m_threads) : nullptr) {}

    [[nodiscard]] std::size_t threads() const { return m_threads; }

    /// body(i) for every i below `count`, in any order. Bodies must not call the executor themselves.
    template <class Body>
    void each(std::size_t count, const Body& body) const {
        if (!m_team || count < smallest_share * m_threads) {
            for (std::size_t i = 0; i < count; ++i) body(i);
            return;
        }
        m_team->run([&](std::size_t thread) {
            for (std::size_t i = count * thread / m_threads; i < count * (thread + 1) / m_threads; ++i) body(i);
        });
    }

    /// Sum of term(i), in blocks: the same for any number of threads.
    template <class Term>
    double sum(std::size_t count, const Term& term) const {
        return reduce(count, term, 0.0, [](double a, double b) { return a + b; });
    }

    /// Greatest of term(i), at least 0.
    template <class Term>
    double greatest(std::size_t count, const Term& term) const {
        return reduce(count, term, 0.0, [](double a, double b) { return std::max(a, b); });
    }

    /// Least of term(i), at most `start`.
    template <class Term>
    double least(std::size_t count, const Term& term, double start) const {
        return reduce(count, term, start, [](double a, double b) { return std::min(a, b); });
    }

  private:
    static constexpr std::size_t smallest_share = 16, block = 512;

    template <class Term, class Join>
    double reduce(std::size_t count, const Term& term, double start, Join join) const {
        const std::size_t blocks = (count + block - 1) / block;
        std::vector<double> parts(blocks, start);
        const auto of_block = [&](std::size_t b) {
            double part = start;
            for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) part = join(part, term(i));
            parts[b] = part;
        };
        each(blocks, of_block);
        for (const double part : parts) start = join(start, part);
        return start;
    }

    std::size_t m_threads;
    std::unique_ptr<ThreadTeam> m_team;
};

}  // namespace weave::sim
