#pragma once

#include <weave/sim/plan.hpp>
#include <weave/sim/yarns.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace weave::sim {

/// Where a relaxation takes up an earlier one.
struct StartState {
    std::vector<std::vector<Vec3>> control;  ///< of each simulated yarn of the plan
    std::array<double, 2> size_mm{};         ///< of the repeat, which may have relaxed
};

/// The scene of a plan with its yarns at a start. Yarns of another period are drawn to the plan's, unless it is what is
/// looked for.
SimScene scene_at(const Plan& plan, const StartState& start);

/// The state of relaxed yarns for a plan of the same design: each yarn is found again by its system and number, and its
/// spline taken over, through other points where the plan has another number of them. Where the plan holds one repeat of
/// the cloth, the first repeat of the yarns is taken.
/// `scenes` are the hashes of scenes that the yarns may come from. Errors: yarns of another design, scene or part of it.
Result<StartState> start_from(const Plan& plan, const Yarns& yarns, const std::string& design_sha256,
                              const std::vector<std::string>& scenes);

/// The state of a coarser plan's yarns, at `state` (its periods included), as the start of a plan of the same part of the
/// cloth: the same curves through more points, what is held being where this plan holds it. Nothing where yarns have passed
/// through one another on the way from the planned curves, or a crossing no longer lies as the card says: coarse curves may
/// err in that, and what follows would not mend it.
std::optional<StartState> refined_start(const Plan& plan, const Plan& coarser, const StartState& state);

}  // namespace weave::sim
