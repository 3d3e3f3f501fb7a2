#include <weave/sim/spread.hpp>

#include <algorithm>
#include <cstddef>

namespace weave::sim {

namespace {

constexpr double shortest = 0.1;  ///< of the mean segment
constexpr int rounds = 100;

/// Distance of each control point of a yarn from the next slot.
template <class Real>
std::vector<double> steps_of(const YarnPlace& yarn, const std::vector<Real>& state) {
    std::vector<double> steps;
    for (std::size_t slot = yarn.first_slot + 1; slot < yarn.first_slot + 1 + yarn.points; ++slot)
        steps.push_back(static_cast<double>((load(&state[3 * (slot + 1)]) - load(&state[3 * slot])).norm()));
    if (yarn.points > yarn.segments) steps.pop_back();  // an open yarn ends there
    return steps;
}

/// Moves the points beside the short steps halfway to between their neighbours. False if there is none.
template <class Real>
bool smoothed(const Fabric<Real>& fabric, const YarnPlace& yarn, std::vector<Real>& state) {
    const std::vector<double> steps = steps_of(yarn, state);
    if (steps.size() < 3) return false;
    double mean = 0;
    for (const double step : steps) mean += step / static_cast<double>(steps.size());
    if (!(mean > 0) || *std::ranges::min_element(steps) >= shortest * mean) return false;
    const std::vector<Real> before = state;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i] >= 2 * shortest * mean) continue;
        for (const std::size_t slot : {yarn.first_slot + 1 + i, yarn.first_slot + 2 + i}) {
            if (fabric.moves()[slot] == 0) continue;
            for (std::size_t k = 3 * slot; k < 3 * slot + 3; ++k)
                state[k] = before[k] / 2 + (before[k - 3] + before[k + 3]) / 4;
        }
    }
    fabric.follow(state);
    return true;
}

}  // namespace

template <class Real>
bool spread_points(Energy<Real>& energy, std::vector<Real>& state) {
    const Fabric<Real>& fabric = energy.fabric();
    std::vector<Real> even = state;
    bool moved = false;
    for (const YarnPlace& yarn : fabric.yarns()) {
        for (int round = 0; round < rounds && smoothed(fabric, yarn, even); ++round) moved = true;
    }
    if (!moved) return false;
    std::vector<Real> change(state.size(), 0);
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        if (fabric.moves()[slot] == 0) continue;
        for (std::size_t k = 3 * slot; k < 3 * slot + 3; ++k) change[k] = even[k] - state[k];
    }
    fabric.follow_change(change);
    std::vector<Real> unused;
    energy.evaluate(state, unused);  // for its samples and lists
    energy.shorten(state, change);
    const auto share = static_cast<Real>(energy.safe_share(state, change, 1));
    for (std::size_t i = 0; i < state.size(); ++i) state[i] += share * change[i];
    fabric.follow(state);
    return true;
}

template bool spread_points(Energy<float>&, std::vector<float>&);
template bool spread_points(Energy<double>&, std::vector<double>&);

}  // namespace weave::sim
