#pragma once

#include <weave/sim/plan.hpp>

namespace weave::sim {

/// How finely a fidelity lays yarns, and when they are still: control points per key point, see SimScene, and the greatest force
/// over the reference force.
struct Resolution {
    double points_per_key, sample_spacing, goal;
};
Resolution resolution_of(Fidelity fidelity);

}  // namespace weave::sim
