#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

/// Marks a function that is compiled twice, plainly and for processors with wide vectors (AVX2, fused multiply-add), of
/// which the program takes what the machine has; what it calls inline is compiled with it. Sums may differ by rounding
/// between machines. Only g++ knows it for templates, and sanitizers do not take it.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__CUDACC__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define WEAVE_WIDE __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define WEAVE_WIDE
#endif

namespace weave::sim {

/// body(i) from `first` on, before `last`, compiled for wide vectors together with what it calls inline.
template <class Body>
static WEAVE_WIDE void run_wide(const Body& body, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) body(i);
}

/// Threads that help with a task of many pieces. The thread that has it does not wait for them to come: it takes piece
/// after piece itself, and whoever is awake in time takes some as well. So a machine that is busy with other work costs a
/// helper, never a stop. They sleep between tasks.
class ThreadTeam {
  public:
    /// As many helpers as the machine gives, `helpers` at most.
    explicit ThreadTeam(std::size_t helpers) {
        m_threads.reserve(helpers);
        try {
            for (std::size_t t = 0; t < helpers; ++t) m_threads.emplace_back([this] { serve(); });
        } catch (const std::exception&) {  // no more threads or no memory for them: the work is done all the same
        }
    }
    ThreadTeam(const ThreadTeam&) = delete;
    ThreadTeam& operator=(const ThreadTeam&) = delete;
    ~ThreadTeam() {
        m_ends = true;
        m_round.fetch_add(1);
        m_round.notify_all();
        for (std::thread& thread : m_threads) thread.join();
    }

    [[nodiscard]] std::size_t helpers() const { return m_threads.size(); }

    /// task(piece) for every piece below `pieces`, each once; returns when all are done.
    void run(std::size_t pieces, const std::function<void(std::size_t)>& task) {
        m_task = &task;
        m_pieces = pieces;
        m_next.store(0);
        m_open.store(true);
        m_round.fetch_add(1);
        m_round.notify_all();
        work();
        // A helper counts itself in before it looks whether the task is still open, so none slips in after this.
        m_open.store(false);
        for (std::size_t inside = m_inside.load(), spin = 0; inside != 0; inside = m_inside.load(), ++spin) {
            if (spin >= spins) m_inside.wait(inside);
        }
    }

  private:
    static constexpr std::size_t spins = 2000;  ///< some microseconds: as long as a short task lasts

    void work() {
        for (std::size_t piece = m_next.fetch_add(1); piece < m_pieces; piece = m_next.fetch_add(1)) (*m_task)(piece);
    }

    void serve() {
        for (std::size_t seen = 0; !m_ends;) {
            for (std::size_t spin = 0; m_round.load() == seen && spin < spins; ++spin) {}
            m_round.wait(seen);
            seen = m_round.load();
            m_inside.fetch_add(1);
            if (m_open.load()) work();
            if (m_inside.fetch_sub(1) == 1) m_inside.notify_one();
        }
    }

    const std::function<void(std::size_t)>* m_task = nullptr;
    std::size_t m_pieces = 0;
    std::atomic<bool> m_open{false}, m_ends{false};
    std::atomic<std::size_t> m_round{0}, m_next{0}, m_inside{0};
    std::vector<std::thread> m_threads;
};

/// More threads than this help nobody.
inline constexpr std::size_t most_threads = 1024;

/// Runs bodies on the processor's cores. What it computes does not depend on the number of threads: bodies write to
/// places of their own, and sums are formed in blocks of fixed size.
class Executor {
  public:
    /// 0: as many threads as there are cores. `most_threads` at most, and no more than the machine gives.
    explicit Executor(std::size_t threads = 0)
        : m_threads(std::min(most_threads, threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency()))),
          m_team(m_threads > 1 ? std::make_unique<ThreadTeam>(m_threads - 1) : nullptr) {
        if (m_team) m_threads = m_team->helpers() + 1;
    }

    /// Those there are, the caller's among them.
    [[nodiscard]] std::size_t threads() const { return m_threads; }

    /// body(i) for every i below `count`, in any order. Bodies must not call the executor themselves.
    template <class Body>
    void each(std::size_t count, const Body& body) const {
        ranges(count, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) body(i);
        });
    }

    /// The same by run_wide().
    template <class Body>
    void each_wide(std::size_t count, const Body& body) const {
        ranges(count, [&](std::size_t first, std::size_t last) { run_wide(body, first, last); });
    }

    /// body(first, last) for ranges that together are 0 to `count`, in any order.
    template <class Body>
    void ranges(std::size_t count, const Body& body) const {
        if (!m_team || count < smallest_share * m_threads) {
            if (count > 0) body(std::size_t{0}, count);
            return;
        }
        const std::size_t pieces = std::min(count, pieces_a_thread * m_threads);
        m_team->run(pieces, [&](std::size_t piece) { body(count * piece / pieces, count * (piece + 1) / pieces); });
    }

    /// Sum of part(first, last) over ranges of fixed length: the same for any number of threads.
    template <class Part>
    double sum_of_ranges(std::size_t count, const Part& part) const {
        return reduce_ranges(count, part, 0.0, [](double a, double b) { return a + b; });
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
    static constexpr std::size_t smallest_share = 16, pieces_a_thread = 4, block = 512;

    template <class Term, class Join>
    double reduce(std::size_t count, const Term& term, double start, Join join) const {
        const auto part = [&](std::size_t first, std::size_t last) {
            double joined = start;
            for (std::size_t i = first; i < last; ++i) joined = join(joined, term(i));
            return joined;
        };
        return reduce_ranges(count, part, start, join);
    }

    template <class Part, class Join>
    double reduce_ranges(std::size_t count, const Part& part, double start, Join join) const {
        const std::size_t blocks = (count + block - 1) / block;
        std::vector<double> parts(blocks, start);
        each(blocks, [&](std::size_t b) { parts[b] = part(b * block, std::min(count, (b + 1) * block)); });
        for (const double value : parts) start = join(start, value);
        return start;
    }

    std::size_t m_threads;
    std::unique_ptr<ThreadTeam> m_team;
};

}  // namespace weave::sim
