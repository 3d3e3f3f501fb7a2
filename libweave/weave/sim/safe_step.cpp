#include <weave/sim/safe_step.hpp>

#include <algorithm>

namespace weave::sim {

namespace {

/// A cut change that keeps less of its slope than this share is worth little.
constexpr double least_kept = 0.2;

}  // namespace

template <class Real>
SafeStep make_safe(Energy<Real>& energy, const std::vector<Real>& state, const std::vector<Real>& gradient,
                   std::vector<Real>& change, double most) {
    const Executor& executor = energy.executor();
    const double slope = dot(executor, gradient, change), safe = energy.safe_share(state, change, most);
    if (safe >= 1) return {slope, 1, safe};
    std::vector<Real> cut = change;
    energy.shorten(state, cut);
    double kept = dot(executor, gradient, cut);
    if (kept > least_kept * slope) {
        // What is left leads hardly down: points that it moves uphill stay where they are.
        for (std::size_t i = 0; i + 2 < cut.size(); i += 3) {
            if (gradient[i] * cut[i] + gradient[i + 1] * cut[i + 1] + gradient[i + 2] * cut[i + 2] > 0)
                cut[i] = cut[i + 1] = cut[i + 2] = 0;
        }
        energy.fabric().follow_change(cut);
        energy.shorten(state, cut);
    }
    const double still = energy.safe_share(state, cut, 1);  // rounds of shortening come close, not always all the way
    for (Real& part : cut) part *= static_cast<Real>(still);
    kept = dot(executor, gradient, cut);
    if (kept < safe * slope) {
        change.swap(cut);
        return {kept, kept / slope, 1};
    }
    for (Real& part : change) part *= static_cast<Real>(safe);
    return {safe * slope, safe, 1};
}

template SafeStep make_safe(Energy<float>&, const std::vector<float>&, const std::vector<float>&,
                            std::vector<float>&, double);
template SafeStep make_safe(Energy<double>&, const std::vector<double>&, const std::vector<double>&,
                            std::vector<double>&, double);

}  // namespace weave::sim
