#pragma once

#include <weave/sim/plan_run.hpp>
#include <weave/sim/resume.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace weave::sim {

struct SimulationOptions {
    Solver solver = Solver::relax;
    Backend backend = Backend::automatic;  ///< what computes
    std::size_t threads = 0;            ///< 0: one a core
    std::optional<double> residual;     ///< instead of the fidelity's
    std::size_t most_iterations = 20000;  ///< of both levels and all flips together
    double most_seconds = 1e30;           ///< the same
    /// See RelaxOptions; is told of lost crossings as well, unless a period relaxes.
    std::function<bool(const Progress&)> watch;
    std::optional<StartState> start;             ///< instead of the planned curves
    /// A plan of the same part of the cloth in fewer points. It is relaxed first, to its own goal, and its yarns, refined, are
    /// the start of the others (refined_start()); without `start`. Null: none.
    const Plan* coarser = nullptr;
    /// Is shown the coarser yarns, at rest or not, before the finer ones begin; false ends the run with them.
    std::function<bool(const Yarns&)> after_coarser;
    /// Made one after the other once the cloth is at rest, each followed by a relaxation. They must be legal (block/flip.hpp),
    /// and the plan one of the whole cloth where it has several repeats.
    std::vector<Flip> flips;
};

/// Relaxes a plan. The yarns hold the whole cloth: a smallest repeat is copied back. Their report has the keys of
/// `weave simulate --json`; whether it converged, and whether every crossing kept its order, is in it. What the report
/// says is measured on the last state, whatever the ending. Of flips the report lists which are done, and the yarns are those
/// of the design with these; one that does not end with the crossing asked for, or that costs another crossing its order,
/// is undone, and one that time, steps or whoever watches left no room for is listed as not `tried`. Where the run ended
/// with the coarser plan, for whatever reason, the yarns are those in its points: their report says which fidelity was to come
/// (`goes_on`), has the goal that was asked for, and is not `converged`.
Yarns simulate(const Design& design, const Plan& plan, const SimulationOptions& options);

}  // namespace weave::sim
