#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/yarns.hpp>

namespace weave::sim {

/// The yarn of a curve as the design says: system, number, beam, radius and colour. It has no spline yet.
SimulatedYarn labelled_yarn(const Design& design, const YarnCurve& curve);

/// The planned curves as yarns that nobody has relaxed: one control point a key point, no strain and no contact. For
/// pictures; their report has nothing but `points_per_key`, with which crossing_places() finds their crossings.
Yarns planned_yarns(const Design& design, const ClothCurves& curves);

}  // namespace weave::sim
