#pragma once

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

#if defined(_OPENMP)
#include <omp.h>
#endif

namespace weave::sim {

/// Runs bodies on the processor's cores. What it computes does not depend on the number of threads: bodies write to
/// places of their own, and sums are formed in blocks of fixed size.
class Executor {
  public:
    /// 0: as many threads as there are cores.
    explicit Executor(std::size_t threads = 0)
        : m_threads(threads > 0 ? threads : std::max(1U, std::thread::hardware_concurrency())) {}

    [[nodiscard]] std::size_t threads() const { return m_threads; }

    /// body(i) for every i below `count`, in any order.
    template <class Body>
    void each(std::size_t count, const Body& body) const {
        const auto last = static_cast<std::ptrdiff_t>(count);
#if defined(_OPENMP)
        if (m_threads > 1 && count >= smallest_share * 2) {
#pragma omp parallel for schedule(static) num_threads(static_cast<int>(m_threads))
            for (std::ptrdiff_t i = 0; i < last; ++i) body(static_cast<std::size_t>(i));
            return;
        }
#endif
        for (std::ptrdiff_t i = 0; i < last; ++i) body(static_cast<std::size_t>(i));
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
    static constexpr std::size_t smallest_share = 32, block = 512;

    template <class Term, class Join>
    double reduce(std::size_t count, const Term& term, double start, Join join) const {
        const std::size_t blocks = (count + block - 1) / block;
        std::vector<double> parts(blocks, start);
        const auto of_block = [&](std::size_t b) {
            double part = start;
            for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) part = join(part, term(i));
            parts[b] = part;
        };
        if (blocks < smallest_share * 2) {
            for (std::size_t b = 0; b < blocks; ++b) of_block(b);
        } else {
            each(blocks, of_block);
        }
        for (const double part : parts) start = join(start, part);
        return start;
    }

    std::size_t m_threads;
};

}  // namespace weave::sim
