#pragma once

#include <weave/block/block.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/sim/plan_run.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace weave::sim {

/// What is asked of a run: what of a design is simulated, how still it is to become, and on which way.
struct RunRequest {
    SimulationRequest plan;
    RunGoal goal;
    /// A rougher fidelity that is relaxed first, to its own goal; its yarns, refined, are the start of the others.
    std::optional<Fidelity> start_from;
    std::vector<Flip> flips;  ///< made one after the other once the cloth is at rest
};

/// The request for the points of a rougher fidelity, in which the run of `request` begins.
SimulationRequest coarser_request(SimulationRequest request, Fidelity rough);

/// Steps of a leg, after which a run may be taken up again: they depend on the cloth alone, so that a run that was taken up
/// ends as one that was never broken off. Some seconds of work on two cores; shorter ones cost more steps in all (README).
std::size_t leg_steps(const Plan& plan, Solver solver);

/// A run through the plans that it takes: fewer points first where that is asked for, then those of the fidelity, and for
/// what happens at one place of a cloth that was simulated as its smallest repeat, the whole cloth. It goes on leg by leg,
/// and what state() tells between two of them is all there is to know.
class Run {
  public:
    using Watch = PlanRun::Watch;

    /// Plans. Errors: a design that does not evaluate, what make_plan() refuses, a start with no fewer points.
    static Result<std::unique_ptr<Run>> begin(const Design& design, const RunRequest& request, std::size_t threads);
    /// The run that state() told of, of the same design and request.
    static Result<std::unique_ptr<Run>> resume(const Design& design, const RunRequest& request, const Json& state, std::size_t threads);

    /// What comes next: a leg of so many steps at most, or what lies between two relaxations (other points, the whole cloth, a
    /// flip). Errors: the whole cloth cannot be planned.
    Status advance(std::size_t most_steps, const Watch& watch);
    /// Does what lies between two relaxations and takes no step of its own, where that comes next, and says whether it did: after
    /// it there is one place for changes at every step.
    bool settle_between();
    /// Nothing is left to do, or time or steps are used up. A watch that ended a leg does not make it so.
    [[nodiscard]] bool is_over() const;

    /// The plan that is being relaxed now.
    [[nodiscard]] PlanRun& now() { return *m_now; }
    [[nodiscard]] const PlanRun& now() const { return *m_now; }
    /// Counts the plans that were gone through: with another number yarns have other points.
    [[nodiscard]] std::size_t level() const { return m_level; }
    /// In the points of `start_from`.
    [[nodiscard]] bool is_coarse() const { return m_finer.has_value(); }
    /// Steps made so far, but those of the leg under way.
    [[nodiscard]] std::size_t steps() const { return m_now->cost().iterations; }

    // ---- Changes between two legs. A smallest repeat becomes the whole cloth for what happens at one place ----

    /// Leads to other parameters; what is absent stays.
    Status change(const SystemScene& warp, const SystemScene& weft);
    /// The yarns that are held from now on, where they lie. Errors: a yarn that there is not; nothing could move.
    Status hold(const std::vector<Pin>& pins);
    Status push(const std::vector<ForceField>& fields);
    /// Leads a crossing to its other side; now().flips() tells how that ended, once now().is_flipping() no more.
    Status flip(const Flip& flip, const Watch& watch);

    /// The yarns as they lie, with a report: that of simulate(). Flips of the request that were not begun are in it.
    [[nodiscard]] Yarns yarns();
    [[nodiscard]] Json state() const;
    void use_threads(std::size_t threads);

  private:
    Run(Design design, BlockPtr block, RunRequest request, std::size_t threads)
        : m_design(std::move(design)), m_block(std::move(block)), m_request(std::move(request)), m_threads(threads) {}

    Result<Plan> plan() const { return make_plan(m_design, *m_block, m_request.plan); }
    Result<Plan> coarser_plan() const { return make_plan(m_design, *m_block, coarser_request(m_request.plan, *m_request.start_from)); }
    void relax(Plan plan);
    void refine();
    void settle();
    [[nodiscard]] bool is_reduced() const;
    Status unfold();
    Status restore(const Json& state);

    Design m_design;  ///< whose scene the plan is of
    BlockPtr m_block;
    RunRequest m_request;
    std::size_t m_threads;
    std::unique_ptr<PlanRun> m_now;
    std::optional<Plan> m_finer;  ///< that follows
    std::size_t m_level = 1, m_next_flip = 0;
    Json m_coarser;
};

}  // namespace weave::sim
