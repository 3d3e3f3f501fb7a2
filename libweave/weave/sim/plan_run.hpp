#pragma once

#include <weave/block/flip.hpp>
#include <weave/core/json.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/backend.hpp>
#include <weave/sim/friction_rounds.hpp>
#include <weave/sim/live_parameters.hpp>
#include <weave/sim/order_watch.hpp>
#include <weave/sim/periods.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/resume.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave::sim {

/// Which solver relaxes.
enum class Solver : std::uint8_t {
    relax,  ///< steps that learn, Newton's near rest (relax.hpp)
    paper,  ///< motion in time, as the paper did it (paper.hpp): slow, the baseline
};

Result<Solver> parse_solver(std::string_view text);
std::string_view name_of(Solver solver);

/// Steps after which a run that is not told otherwise gives up.
inline std::size_t usual_iterations(Solver solver) {
    return solver == Solver::paper ? 1'000'000 : 20'000;
}

/// How still cloth is to become, and what may be used up on the way.
struct RunGoal {
    Solver solver = Solver::relax;
    std::optional<double> residual;       ///< instead of the plan's
    std::size_t most_iterations = 20000;  ///< of the whole run
    double most_seconds = 1e30;           ///< the same
    Backend backend = Backend::automatic;  ///< what computes with the solver `relax`; flips and `paper` are computed on the processor
};

/// What a run has used up.
struct RunCost {
    std::size_t iterations = 0, evaluations = 0;
    double seconds = 0;
};

/// A plan that is being relaxed, leg by leg. Between two legs the solver remembers nothing: what state() tells then is all
/// there is, and another process that restore()s it comes to the same bits, however many threads either has. A leg renews
/// what the solver has learned, so legs that are short cost steps (README).
class PlanRun {
  public:
    /// Is told of progress after each step, `iteration` counting from the beginning of this relaxation; while two yarns are
    /// led past one another it is asked with an empty Progress. False ends the leg with the state as it is.
    using Watch = std::function<bool(const Progress&)>;

    /// `threads`: 0 for one a core.
    PlanRun(Design design, Plan plan, const RunGoal& goal, std::size_t threads);
    PlanRun(const PlanRun&) = delete;
    PlanRun& operator=(const PlanRun&) = delete;

    /// Begins there instead of at the planned curves. With friction, slip counts from there, or with `since_plan` from
    /// the planned places.
    void start_at(const StartState& start, bool since_plan = false);
    /// Counts what was used up before.
    void add_cost(const RunCost& cost);

    // ---- Relaxing ----

    /// The next leg: so many steps at most, fewer where it comes to its end. Nothing once it is at_end().
    void leg(std::size_t most_steps, const Watch& watch);
    /// Legs to the end, or until a watch ends one.
    void relax(const Watch& watch);
    /// Whether no leg is left of this relaxation: it converged or got stuck, or time or steps are used up.
    [[nodiscard]] bool at_end() const { return m_end.has_value(); }
    /// How the latest leg ended, `iterations` also where only its own steps were used up.
    [[nodiscard]] const RelaxResult& last() const { return m_last; }
    [[nodiscard]] bool is_at_rest() const { return m_end == Ending::converged && (!m_periods || m_periods->balanced); }
    /// What leaves no more to be done, if anything does: the last watch, or the time or the steps that are used up.
    [[nodiscard]] std::optional<Ending> cut_short() const;

    /// The watch that ended the last leg did so to let something in, not to end the run.
    void forget_stop();

    // ---- Flips ----

    /// Leads two yarns past one another; what follows relaxes the cloth again. Where that cannot be, it is listed with its
    /// reason, and nothing follows. The plan must be one of the whole cloth where it has several repeats.
    void begin_flip(const Flip& flip, const Watch& watch);
    [[nodiscard]] bool is_flipping() const { return m_flipping.has_value(); }
    /// Looks whether the flip cost another crossing its order, and undoes it then: the cloth relaxes again. To be called
    /// at_end(), or when something else comes between.
    void end_flip();
    /// What the report lists of flips: the last is the latest.
    [[nodiscard]] const Json& flips() const { return m_flips; }

    // ---- Changes between two legs: the relaxation begins anew with each ----

    /// Leads there part by part.
    Status ask(System system, const LiveParameters& wanted);
    [[nodiscard]] const LedParameters& parameters() const { return m_parameters; }
    /// Yarns held from now on where they lie: the frozen points of a plan of the same yarns.
    void hold(const Plan& held);
    void push(std::vector<ForceField> fields);
    /// The scene that the yarns' own report names from now on.
    void set_scene(const Scene& scene) { m_design.scene = scene; }

    // ---- What there is ----

    [[nodiscard]] const Plan& plan() const { return m_plan; }
    /// With the flips that were made.
    [[nodiscard]] const Design& design() const { return m_design; }
    /// As it lies between two legs.
    [[nodiscard]] const SimScene& scene() const { return m_scene; }
    /// The control points of all yarns, as they lie now; also from within a watch.
    [[nodiscard]] std::vector<std::vector<Vec3>> control() const;
    [[nodiscard]] double goal() const { return m_goal.residual.value_or(m_plan.goal); }
    /// Up to the latest leg.
    [[nodiscard]] const RunCost& cost() const { return m_cost; }
    /// Steps before those that Progress counts from.
    [[nodiscard]] std::size_t steps_before() const { return m_cost.iterations - m_relaxed.iterations; }
    /// The yarns with their report, measured on the latest state; from within a watch too.
    [[nodiscard]] Yarns yarns();
    void use_threads(std::size_t threads);

    /// Everything between two legs, with control points as bytes; for restore() of a run of the same design, plan and goal.
    /// Errors of restore: what such a run cannot have written.
    [[nodiscard]] Json state() const;
    Status restore(const Json& state);

  private:
    struct Flipping {
        Flip flip;
        StartState before;
        std::vector<Crossing> crossings;
        std::size_t lost_before = 0;
        double seconds = 0;
    };

    void begin_relaxation();
    void relax_points(std::size_t most_steps, bool passing, const Watch& watch);
    [[nodiscard]] RelaxOnce once();
    void relax_with_periods(const Watch& watch);
    [[nodiscard]] RelaxOptions relax_options(const Watch& watch) const;
    [[nodiscard]] RelaxOptions looking_on(const Watch& watch);
    void count(const RelaxResult& leg);
    void make_solver();
    [[nodiscard]] std::size_t lost() const;
    [[nodiscard]] std::vector<Spline> splines_of(std::vector<std::vector<Vec3>> control) const;
    [[nodiscard]] std::string why_not(const Flip& flip) const;
    void tell_of(const Flip& flip, bool done, std::string reason, double flip_seconds, double settle_seconds);
    void say(const std::string& term, std::string choice, std::string reason);
    [[nodiscard]] Yarns measured(Energy<double>& energy, std::vector<double>& state) const;
    [[nodiscard]] Plan in_periods_reached() const;
    [[nodiscard]] Json report(const Plan& plan, const Fabric<double>& fabric) const;
    [[nodiscard]] std::string smallest_curvature(Energy<double>& energy, std::vector<double>& state) const;

    Design m_design;
    Plan m_plan;
    RunGoal m_goal;
    std::unique_ptr<Executor> m_executor;
    Relaxer m_relaxer;
    LedParameters m_parameters;
    SimScene m_scene;  ///< as it lay between the last two legs
    std::unique_ptr<Fabric<double>> m_fabric;
    std::unique_ptr<Energy<double>> m_energy;
    std::vector<double> m_state;
    bool m_in_leg = false;  ///< then m_state is what relaxes
    RunCost m_cost, m_relaxed;  ///< of the run, and of this relaxation
    bool m_begun = false;       ///< this relaxation has had a leg
    RelaxResult m_last;
    std::optional<Ending> m_end;
    std::optional<Ending> m_cut;  ///< what broke a flip off
    FrictionResult m_friction;
    std::optional<PeriodsResult> m_periods;
    std::optional<OrderWatch> m_looks;
    std::optional<std::size_t> m_lost;  ///< as seen last
    std::optional<Flipping> m_flipping;
    std::vector<Flip> m_flipped;  ///< those done, in their order
    Json m_flips = Json::array();
};

/// Flips as a report lists those that a run did not begin, being over by then; `ending` is its ending by name.
Json flips_not_begun(const std::vector<Flip>& flips, std::string_view ending);

}  // namespace weave::sim
