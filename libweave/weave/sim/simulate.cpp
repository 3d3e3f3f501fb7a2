#include <weave/sim/simulate.hpp>

#include <weave/sim/result.hpp>

#include <utility>

namespace weave::sim {

namespace {

RunGoal goal_of(const SimulationOptions& options) {
    return {options.solver, options.residual, options.most_iterations, options.most_seconds, options.backend};
}

/// The coarser yarns as the end of a run: whether or not they are at rest, what was asked for is not.
Yarns cut_off(Yarns yarns, const Json& coarser, Ending ending, const PlanRun& finer, const std::vector<Flip>& flips) {
    yarns.report.update({{"converged", false},
                         {"ending", std::string(sim::name_of(ending))},
                         {"goal", finer.goal()},
                         {"coarser", coarser}});
    if (!flips.empty()) yarns.report["flips"] = flips_not_begun(flips, sim::name_of(ending));
    return yarns;
}

/// Relaxes the coarser plan and lets the finer run begin with its yarns; gives them where the run ends with them.
std::optional<Yarns> begin_coarser(const Design& design, const SimulationOptions& options, PlanRun& run, Json& told) {
    RunGoal goal = goal_of(options);
    goal.residual.reset();
    PlanRun coarser(design, *options.coarser, goal, options.threads);
    coarser.relax(options.watch);
    Yarns yarns = coarser.yarns();
    yarns.report["goes_on"] = std::string(sim::name_of(run.plan().fidelity));
    run.add_cost(coarser.cost());
    told = told_of_coarser(yarns.report);
    if (const std::optional<Ending> over = coarser.cut_short()) return cut_off(std::move(yarns), told, *over, run, options.flips);
    if (options.after_coarser && !options.after_coarser(yarns))
        return cut_off(std::move(yarns), told, Ending::stopped, run, options.flips);
    std::vector<std::vector<Vec3>> control = coarser.control();
    const std::optional<StartState> start =
        refined_start(run.plan(), *options.coarser, {std::move(control), coarser.scene().period_mm});
    told["taken"] = start.has_value();
    if (start) run.start_at(*start, true);  // both levels are one way from the plan to the rest
    return {};
}

}  // namespace

Yarns simulate(const Design& design, const Plan& plan, const SimulationOptions& options) {
    PlanRun run(design, plan, goal_of(options), options.threads);
    if (options.start) run.start_at(*options.start);
    Json coarser;
    if (options.coarser != nullptr) {
        if (std::optional<Yarns> ended = begin_coarser(design, options, run, coarser)) return std::move(*ended);
    }
    run.relax(options.watch);
    for (const Flip& flip : options.flips) {
        run.begin_flip(flip, options.watch);
        run.relax(options.watch);
        if (run.is_flipping()) run.end_flip();
        run.relax(options.watch);
    }
    Yarns yarns = run.yarns();
    if (!coarser.is_null()) yarns.report["coarser"] = std::move(coarser);
    return yarns;
}

}  // namespace weave::sim
