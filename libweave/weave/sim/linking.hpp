#pragma once

#include <weave/sim/scene.hpp>

#include <vector>

namespace weave::sim {

/// For every two yarns how often one passes over the other, seen from above, signed by the sense in which
/// they cross: entry [i][j] for j ≤ i, j = i being a yarn with its images beside it. It changes when a yarn
/// passes through another, and when a free end slips off; however yarns move otherwise, it stays. For scenes
/// without a card image (order.hpp asks the card); every two pieces are tried, so scenes should be small.
std::vector<std::vector<int>> linking_of(const SimScene& scene,
                                         const std::vector<std::vector<Vec3>>& control);

}  // namespace weave::sim
