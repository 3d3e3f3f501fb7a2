#pragma once

#include <weave/sim/execute.hpp>

#include <cmath>
#include <cstddef>
#include <deque>
#include <vector>

namespace weave::sim {

/// What steps have told of the energy: changes of places with what the gradient changed by, for directions by limited-memory
/// BFGS (Nocedal 1980). Vectors have three numbers for each row of the matrix; `dot` multiplies two of them.
class LearnedPairs {
  public:
    using Rows = std::vector<double>;
    struct Pair {
        Rows change, bend;   ///< of places and of the gradient
        double product = 0;  ///< of both
    };

    void forget() { m_pairs.clear(); }

    /// Remembers a pair, whose product is found here; unless the energy hardly curves upwards along it, against `gradient`
    /// where the change began.
    template <class Dot>
    void remember(Pair pair, const Rows& gradient, const Dot& dot) {
        constexpr double least_bend = 1e-3;
        constexpr std::size_t most_pairs = 16;
        pair.product = dot(pair.change, pair.bend);
        if (!(pair.product > least_bend * std::abs(dot(pair.change, gradient)))) return;
        m_pairs.push_back(std::move(pair));
        if (m_pairs.size() > most_pairs) m_pairs.pop_front();
    }

    /// direction := downhill by the gradient, which is lost: the two loops over the pairs, with precondition(residual, step)
    /// between them, scaled by the latest pair.
    template <class Dot, class Precondition>
    void find_direction(const Executor& executor, Rows& gradient, Rows& direction, const Dot& dot,
                        const Precondition& precondition) const {
        std::vector<double> share(m_pairs.size());
        const auto add = [&](double factor, const Rows& to_add, Rows& rows) {
            executor.each(rows.size(), [&](std::size_t i) { rows[i] += factor * to_add[i]; });
        };
        for (std::size_t p = m_pairs.size(); p-- > 0;) {
            share[p] = dot(m_pairs[p].change, gradient) / m_pairs[p].product;
            add(-share[p], m_pairs[p].bend, gradient);
        }
        precondition(gradient, direction);
        double scale = 1;
        if (!m_pairs.empty()) {
            const Pair& latest = m_pairs.back();
            precondition(latest.bend, gradient);
            scale = latest.product / dot(latest.bend, gradient);
        }
        executor.each(direction.size(), [&](std::size_t i) { direction[i] *= scale; });
        for (std::size_t p = 0; p < m_pairs.size(); ++p)
            add(share[p] - dot(m_pairs[p].bend, direction) / m_pairs[p].product, m_pairs[p].change, direction);
        executor.each(direction.size(), [&](std::size_t i) { direction[i] = -direction[i]; });
    }

  private:
    std::deque<Pair> m_pairs;
};

}  // namespace weave::sim
