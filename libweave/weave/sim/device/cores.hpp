#pragma once

#include <weave/sim/device/emulated.hpp>
#include <weave/sim/execute.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// The processor's cores as a crew (crew.hpp): one thread decides, all cores work.
class Cores {
  public:
    explicit Cores(const Executor& executor) : m_executor(executor) {}

    template <class Body>
    void each(std::size_t count, const Body& body) {
        m_executor.each(count, body);
    }
    template <class Term>
    double sum(std::size_t count, const Term& term) {
        return m_executor.sum(count, term);
    }
    template <class Term>
    double greatest(std::size_t count, const Term& term) {
        return m_executor.greatest(count, term);
    }
    template <class Term>
    double least(std::size_t count, const Term& term, double start) {
        return m_executor.least(count, term, start);
    }
    template <class Term>
    void sums(View<double> out, std::size_t sums, std::size_t count, const Term& term) {
        for (std::size_t k = 0; k < sums; ++k) out[k] = m_executor.sum(count, [&](std::size_t i) { return term(k, i); });
    }
    std::size_t scan(View<std::uint32_t> counts, std::size_t count) {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t own = counts[i];
            counts[i] = static_cast<std::uint32_t>(sum);
            sum += own;
        }
        return sum;
    }
    template <class T>
    std::remove_const_t<T> read(const View<T>& view, std::size_t at) {
        return view[at];
    }
    template <class Body>
    void alone(const Body& body) {
        body();
    }
    template <class Task>
    void in_one_block(const Task& task) {
        run_alone(task);
    }

  private:
    const Executor& m_executor;
};

}  // namespace weave::sim
