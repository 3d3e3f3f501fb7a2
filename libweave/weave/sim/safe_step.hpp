#pragma once

#include <weave/sim/energy.hpp>

#include <vector>

namespace weave::sim {

/// A change of state that may be made at once.
struct SafeStep {
    double slope = 0;  ///< ∂E along it, N·mm; below 0 where it leads down
    double kept = 1;   ///< share of the slope that was asked for
    double farthest =
        1;  ///< how many times the change could be made and yarns still not pass through one another
};

/// Shortens a change so that no yarns can pass through one another: as a whole, or only where it must be,
/// whichever keeps more of its slope. `farthest` is at most `most`.
template <class Real>
SafeStep make_safe(Energy<Real>& energy, const std::vector<Real>& state, const std::vector<Real>& gradient,
                   std::vector<Real>& change, double most);

/// Σ a·b, the same for any number of threads.
template <class A, class B>
double dot(const Executor& executor, const std::vector<A>& a, const std::vector<B>& b) {
    return executor.sum(a.size(),
                        [&](std::size_t i) { return static_cast<double>(a[i]) * static_cast<double>(b[i]); });
}

}  // namespace weave::sim
