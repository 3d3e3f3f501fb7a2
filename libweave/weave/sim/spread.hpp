#pragma once

#include <weave/sim/energy.hpp>

#include <vector>

namespace weave::sim {

/// Spreads control points that lie on one another, or nearly, along their yarn: a segment without length has
/// no direction and bends without bound, so that no solver finds its way from there. Yarns of which no
/// segment is shorter than a tenth of their mean stay as they are; points that are held stay, and no yarn
/// passes through another. True where something moved; the energy was then evaluated elsewhere.
template <class Real>
bool spread_points(Energy<Real>& energy, std::vector<Real>& state);

}  // namespace weave::sim
