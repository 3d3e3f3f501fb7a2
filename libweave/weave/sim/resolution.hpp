#pragma once

#include <weave/sim/plan.hpp>

namespace weave::sim {

/// How finely a fidelity lays yarns, and when they are still: control points per key point, see SimScene, and the greatest force
/// over the reference force.
struct Resolution {
    double points_per_key, sample_spacing, goal;
};
Resolution resolution_of(Fidelity fidelity);

/// A goal that may be asked for instead. The least is far below the rounding of forces, some 1e-12: who asks for it asks for a run
/// without an end.
inline constexpr double least_residual = 1e-15, most_residual = 1;

}  // namespace weave::sim
