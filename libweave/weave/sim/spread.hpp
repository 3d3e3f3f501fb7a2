#pragma once

#include <weave/sim/energy.hpp>

#include <vector>

namespace weave::sim {

/// Spreads control points that lie on one another, or nearly, along their yarn: a segment without length has
/// no direction and bends without bound, so that no solver finds its way from there. Yarns of which no
/// segment is shorter than a tenth of their mean stay as they are; points that are held stay, and no yarn
/// passes through another. The energy is to have been evaluated at `state`, and is to be evaluated anew where
/// this tells true: something moved.
template <class Real>
bool spread_points(Energy<Real>& energy, std::vector<Real>& state);

}  // namespace weave::sim
