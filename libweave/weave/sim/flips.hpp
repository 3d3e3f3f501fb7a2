#pragma once

#include <weave/block/flip.hpp>
#include <weave/sim/execute.hpp>
#include <weave/sim/plan.hpp>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace weave::sim {

/// What a flip in relaxed cloth came to.
struct FlipResult {
    Flip flip;
    bool done = false;
    std::string reason;       ///< where it is not: why
    double height_mm = 0;     ///< of the weft above the warp in the end
    std::size_t iterations = 0;
    double seconds = 0;
};

/// Leads the pick and the end of one crossing past one another while the cloth lies as it is (paper, 5.2 and A.4): the
/// contact of the two is off along stretches of at least four times the thickest radius, a spring leads them to their
/// new heights, yarns near by give way, and all else is frozen; then their contact comes back by and by, and the cloth around
/// comes to rest to `residual`, its surroundings still frozen. `scene` holds
/// the state and afterwards that with the flip, not yet at rest as a whole; `curves` and `curve_of` are those of its plan, and the
/// crossing there is turned. Where the crossing does not end as asked for, both are as they were, and the result says why.
FlipResult flip_relaxed(SimScene& scene, ClothCurves& curves, const std::vector<std::size_t>& curve_of, const Flip& flip,
                        double residual, const Executor& executor, const std::function<bool()>& go_on);

}  // namespace weave::sim
