#pragma once

#include <weave/sim/execute.hpp>
#include <weave/sim/friction_rounds.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/scene.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace weave::sim {

/// The forces that pull a piece apart along x and y while its period there is free, N on the whole rim; where absent the
/// period is fixed.
using RimForces = std::array<std::optional<double>, 2>;

struct PeriodsResult {
    RelaxResult last;                   ///< relaxation at the last periods; its iterations and seconds are those of all
    FrictionResult friction;            ///< of that relaxation
    std::array<double, 2> force_N{};    ///< what pulls the rims together in the end: ∂E/∂P
    std::size_t rounds = 0;
    bool balanced = false;              ///< whether that is as asked for, within the tolerance
};

/// The scene with other periods: its yarns drawn along, their lengths as before.
SimScene with_periods(SimScene scene, const std::array<double, 2>& period_mm);

/// Relaxes yarns and free periods together: yarns at rest in one period after another, each by the secant of the force
/// on the rim. `scene` holds the start, from which slip counts in every period unless it says from
/// where else, and then the result. Balanced: the force differs by at most `tolerance` times the
/// reference force of each yarn that crosses the rim. `once` relaxes at one period.
PeriodsResult relax_periods(SimScene& scene, const RimForces& forces, const RelaxOptions& options, double tolerance,
                            const Executor& executor, const RelaxOnce& once = relax<double>);

}  // namespace weave::sim
