#pragma once

#include <weave/curve/spline.hpp>
#include <weave/sim/scene.hpp>

#include <array>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace weave::sim {

/// How often one yarn passes over another, seen from nearly above, signed by the sense in which they cross:
/// for every two yarns (the greater index first) for which that is not 0; a yarn with itself being one with
/// its images beside it. It changes by 2 when a yarn passes through another, by 1 when a free end slips off;
/// however yarns move otherwise, it stays.
using Linking = std::map<std::pair<std::size_t, std::size_t>, int>;

/// Whether an entry that changed by so much tells that yarns passed through one another.
inline bool passed_through(int change) {
    return change > 1 || change < -1;
}

/// An empty spline takes no part. `period_mm` is 0 in directions that do not repeat. Time is that of sorting
/// the pieces.
Linking linking_of(const std::vector<Spline>& yarns, const std::array<double, 2>& period_mm);

/// The same for a scene whose yarns have these control points.
Linking linking_of(const SimScene& scene, const std::vector<std::vector<Vec3>>& control);

}  // namespace weave::sim
