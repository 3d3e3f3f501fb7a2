#pragma once

#include <weave/sim/energy.hpp>
#include <weave/sim/relax.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace weave::sim {

/// Relaxes to a residual while friction is held as it is: `relax`, or the solver `paper`.
using RelaxOnce = std::function<RelaxResult(Energy<double>&, std::vector<double>&, const RelaxOptions&)>;

struct FrictionResult {
    RelaxResult last;  ///< of all rounds together; its residual is that with friction as it is in the end
    std::size_t rounds = 0;  ///< how often what is held was renewed; 0: there is no friction
    bool agreed = true;  ///< whether the forces of friction came to agree with the state that they belong to
    SlipSummary slip;
};

/// Relaxes with the scene's friction: in rounds, each with the normal forces and directions of the state that
/// the last round came to, until with those renewed the residual is at the goal, or for 40 rounds (then
/// Ending::iterations). Slip counts from the start (SimScene::slip_from). Without friction it is one call of
/// `once`.
FrictionResult relax_with_friction(Energy<double>& energy, std::vector<double>& state,
                                   const RelaxOptions& options, const RelaxOnce& once = relax<double>);

}  // namespace weave::sim
