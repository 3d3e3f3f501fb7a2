#include <weave/sim/plan_run.hpp>

#include <weave/design/edit.hpp>
#include <weave/design/outline.hpp>
#include <weave/sim/flips.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/paper.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace weave::sim {

namespace {

/// How far yarns give way between two moves of their parameters.
constexpr double passing_residual = 0.1;
constexpr std::size_t passing_iterations = 60;

/// How near the force on a rim must come to what was asked for, as a share of the reference force of each yarn.
constexpr double rim_tolerance = 1e-2;

constexpr std::string_view solver_names[]{"relax", "paper"};

/// Why a run ended before it was done, by the name of its ending.
std::string why_over(std::string_view ending) {
    return ending == "time" ? "the time was up" : ending == "iterations" ? "the steps were used up" : "it was stopped";
}

/// Tells how many seconds have passed since it was made.
auto clock_from_now() {
    return [began = std::chrono::steady_clock::now()] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    };
}

std::vector<std::vector<Vec3>> controls_of(const SimScene& scene) {
    std::vector<std::vector<Vec3>> control;
    for (const SimYarn& yarn : scene.yarns) control.push_back(yarn.control);
    return control;
}

}  // namespace

PlanRun::PlanRun(Design design, Plan plan, const RunGoal& goal, std::size_t threads)
    : m_design(std::move(design)), m_plan(std::move(plan)), m_goal(goal), m_executor(std::make_unique<Executor>(threads)),
      m_relaxer(goal.backend), m_parameters(m_plan), m_scene(m_plan.scene) {
    m_last.ending = Ending::stopped;
}

void PlanRun::start_at(const StartState& start, bool since_plan) {
    m_scene = scene_at(m_plan, start);
    if (since_plan && m_scene.friction > 0) m_scene.slip_from = SlipStart{controls_of(m_plan.scene), m_plan.scene.period_mm};
}

void PlanRun::add_cost(const RunCost& cost) {
    m_cost.iterations += cost.iterations;
    m_cost.evaluations += cost.evaluations;
    m_cost.seconds += cost.seconds;
}

void PlanRun::use_threads(std::size_t threads) {
    if (m_executor->threads() == threads) return;
    m_energy.reset();  // which stands on the old one
    m_executor = std::make_unique<Executor>(threads);
}

// ---- Relaxing ----

void PlanRun::begin_relaxation() {
    m_scene.slip_from.reset();
    m_end.reset();
    m_looks.reset();
    m_relaxed = {};
    m_begun = false;
}

void PlanRun::relax(const Watch& watch) {
    while (!at_end()) {
        leg(m_goal.most_iterations, watch);
        if (m_last.ending == Ending::stopped) return;
    }
}

void PlanRun::leg(std::size_t most_steps, const Watch& watch) {
    if (at_end()) return;
    const bool passing = m_parameters.approach();
    if (passing) {
        m_parameters.apply(m_scene);
        m_scene.slip_from.reset();
    }
    if ((passing || !m_begun) && m_scene.friction > 0 && !m_scene.slip_from)
        m_scene.slip_from = SlipStart{controls_of(m_scene), m_scene.period_mm};
    m_begun = true;
    const bool periods = m_plan.rim_force_N[0].has_value() || m_plan.rim_force_N[1].has_value();
    if (periods && !passing) relax_with_periods(watch);
    else relax_points(passing ? passing_iterations : most_steps, passing, watch);
}

void PlanRun::make_solver() {
    m_energy.reset();
    m_fabric = std::make_unique<Fabric<double>>(m_scene);
    m_energy = std::make_unique<Energy<double>>(*m_fabric, *m_executor);
    m_state = m_fabric->state();
}

void PlanRun::relax_points(std::size_t most_steps, bool passing, const Watch& watch) {
    make_solver();
    if (!m_looks) m_looks.emplace(m_plan.curves.crossings.size());
    const double looked_before = m_looks->spent_s();
    RelaxOptions options = looking_on(watch);
    options.most_iterations = std::min(options.most_iterations, most_steps);
    if (passing) options.residual = std::max(options.residual, passing_residual);
    options.leaves_saddles = !passing;
    const std::size_t rounds = m_relaxed.iterations > 0 ? m_friction.rounds : 0;
    m_in_leg = true;
    m_friction = relax_with_friction(*m_energy, m_state, options, once());
    m_in_leg = false;
    m_friction.rounds += rounds;
    RelaxResult leg = m_friction.last;
    leg.seconds -= m_looks->spent_s() - looked_before;  // which relaxed nothing
    std::vector<std::vector<Vec3>> control = m_fabric->control(m_state);
    for (std::size_t y = 0; y < control.size(); ++y) m_scene.yarns[y].control = std::move(control[y]);
    count(leg);
    const bool used_up = m_cost.iterations >= m_goal.most_iterations;
    const bool rounds_used_up = m_scene.friction > 0 && leg.iterations < options.most_iterations;
    switch (m_last.ending) {
        case Ending::stopped: return;
        case Ending::time: m_end = Ending::time; return;
        case Ending::iterations:
            if (used_up || rounds_used_up) m_end = Ending::iterations;
            return;
        case Ending::converged:
        case Ending::stuck:
            if (!passing) m_end = m_last.ending;
    }
}

/// One relaxation by whatever solver and machine was asked for; periods that relax know only `relax`.
RelaxOnce PlanRun::once() {
    return [this](Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) {
        const bool periods = m_plan.rim_force_N[0].has_value() || m_plan.rim_force_N[1].has_value();
        if (m_goal.solver == Solver::paper && !periods) return relax_in_time(energy, state, options);
        RelaxResult result = m_relaxer.relax(energy, state, options);
        const BackendChoice& choice = m_relaxer.choice();
        say("backend", choice.device.empty() ? "cpu" : "cuda: " + choice.device, choice.reason);
        return result;
    };
}

void PlanRun::relax_with_periods(const Watch& watch) {
    m_fabric.reset();
    m_periods = relax_periods(m_scene, m_plan.rim_force_N, relax_options(watch), rim_tolerance, *m_executor, once());
    m_friction = m_periods->friction;
    count(m_periods->last);
    make_solver();
    if (m_last.ending != Ending::stopped) m_end = m_last.ending;
}

void PlanRun::count(const RelaxResult& leg) {
    m_last = leg;
    m_last.history.clear();
    for (RunCost* cost : {&m_cost, &m_relaxed}) {
        cost->iterations += leg.iterations;
        cost->evaluations += leg.evaluations;
        cost->seconds += leg.seconds;
    }
}

RelaxOptions PlanRun::relax_options(const Watch& watch) const {
    RelaxOptions options;
    options.residual = goal();
    options.most_iterations = m_goal.most_iterations - std::min(m_goal.most_iterations, m_cost.iterations);
    options.most_seconds = m_goal.most_seconds - m_cost.seconds;
    if (!watch) return options;
    options.watch = [&watch, before = m_relaxed](Progress progress) {
        progress.iteration += before.iterations;
        progress.seconds += before.seconds;
        return watch(progress);
    };
    return options;
}

/// The same, while `m_state` is what relaxes: whoever watches is told now and then whether crossings lie in order.
RelaxOptions PlanRun::looking_on(const Watch& watch) {
    RelaxOptions options = relax_options(watch);
    if (!watch) return options;
    const auto now = [since = clock_from_now(), before = m_relaxed.seconds] { return before + since(); };
    options.watch = [this, now, told = std::move(options.watch)](Progress progress) {
        if (const double began = now(); m_looks->is_due(began)) {
            m_lost = lost_crossings(m_plan.curves, splines_of(m_fabric->control(m_state))).size();
            m_looks->looked(began, now());
        }
        progress.lost_crossings = m_lost;
        return told(progress);
    };
    return options;
}

std::optional<Ending> PlanRun::cut_short() const {
    if (m_cut) return m_cut;
    if (m_last.ending == Ending::stopped || m_last.ending == Ending::time) return m_last.ending;
    if (m_cost.seconds >= m_goal.most_seconds) return Ending::time;
    if (m_cost.iterations >= m_goal.most_iterations) return Ending::iterations;
    return {};
}

void PlanRun::forget_stop() {
    if (m_last.ending == Ending::stopped) m_last.ending = Ending::iterations;
}

std::vector<std::vector<Vec3>> PlanRun::control() const {
    return m_in_leg ? m_fabric->control(m_state) : controls_of(m_scene);
}

std::size_t PlanRun::lost() const {
    return lost_crossings(m_plan.curves, splines_of(controls_of(m_scene))).size();
}

/// Of control points of every yarn of the scene: one for each planned curve.
std::vector<Spline> PlanRun::splines_of(std::vector<std::vector<Vec3>> control) const {
    std::vector<Spline> splines(m_plan.curves.yarns.size());
    for (std::size_t y = 0; y < m_scene.yarns.size(); ++y)
        splines[m_plan.curve_of[y]] = {std::move(control[y]), m_scene.yarns[y].is_periodic, m_scene.yarns[y].shift};
    return splines;
}

// ---- Flips ----

void PlanRun::begin_flip(const Flip& flip, const Watch& watch) {
    if (const std::optional<Ending> over = cut_short()) {
        m_flips.push_back(flips_not_begun({flip}, sim::name_of(*over)).at(0));
        return;
    }
    if (std::string reason = why_not(flip); !reason.empty()) return tell_of(flip, false, std::move(reason), 0, 0);
    Flipping flipping{flip, {controls_of(m_scene), m_scene.period_mm}, m_plan.curves.crossings, lost(), 0};
    const std::function<bool()> go_on = [&, since = clock_from_now()] {
        if (watch && !watch({})) m_cut = Ending::stopped;
        else if (m_cost.seconds + since() > m_goal.most_seconds) m_cut = Ending::time;
        return !m_cut;
    };
    FlipResult result = flip_relaxed(m_scene, m_plan.curves, m_plan.curve_of, flip, goal(), *m_executor, go_on);
    if (m_cut && !result.done) result.reason = "broken off, as " + why_over(sim::name_of(*m_cut));
    add_cost({result.iterations, 0, result.seconds});
    if (!result.done) return tell_of(flip, false, result.reason, result.seconds, 0);
    flipping.seconds = result.seconds;
    m_flipping = std::move(flipping);
    begin_relaxation();
}

void PlanRun::end_flip() {
    const Flipping flipping = std::move(*m_flipping);
    m_flipping.reset();
    const RunCost settled = m_relaxed;
    std::string reason;
    if (lost() > flipping.lost_before) {
        reason = "other crossings would change with it";
        m_scene = with_periods(std::move(m_scene), flipping.before.size_mm);
        for (std::size_t y = 0; y < m_scene.yarns.size(); ++y) m_scene.yarns[y].control = flipping.before.control[y];
        m_plan.curves.crossings = flipping.crossings;
        begin_relaxation();
    } else if (!apply_edit(m_design, PutFlip{m_design.root, flipping.flip})) {
        reason = "the design does not take it";
    } else {
        m_flipped.push_back(flipping.flip);
    }
    const bool done = reason.empty();
    tell_of(flipping.flip, done, std::move(reason), flipping.seconds, settled.seconds);
    m_flips.back()["settle_iterations"] = done ? settled.iterations : 0;
}

/// Why the card of the design, with the flips made so far, does not take this one; empty where it does.
std::string PlanRun::why_not(const Flip& flip) const {
    const Result<Outline> cloth = outline(m_design, CardPlace{flip.pick, flip.end});
    if (!cloth) return cloth.error().text();
    if (!cloth->at) return no_crossing(cloth->grid, flip.pick, flip.end).message;
    const PlacedStack& at = *cloth->at;
    if (at.stack.weft_over(flip.pick - at.first_pick, flip.end - at.first_end) == flip.weft_over) return "they lie so already";
    const Result<Stack> flipped = weave::flip(at, flip.pick, flip.end);
    return flipped ? "" : flipped.error().message;
}

void PlanRun::tell_of(const Flip& flip, bool done, std::string reason, double flip_seconds, double settle_seconds) {
    m_flips.push_back({{"pick", flip.pick + 1}, {"end", flip.end + 1}, {"weft_over", flip.weft_over},
                       {"done", done}, {"tried", done || !m_cut}, {"reason", std::move(reason)}, {"flip_seconds", flip_seconds},
                       {"settle_seconds", settle_seconds}, {"settle_iterations", 0}});
}

// ---- Changes ----

Status PlanRun::ask(System system, const LiveParameters& wanted) {
    WEAVE_CHECK_OK(m_parameters.ask(system, wanted));
    begin_relaxation();
    return {};
}

/// Puts right what the plan says of a term, or adds it.
void PlanRun::say(const std::string& term, std::string choice, std::string reason) {
    const auto line = std::ranges::find(m_plan.lines, term, &PlanLine::term);
    if (line != m_plan.lines.end()) *line = {term, std::move(choice), std::move(reason)};
    else m_plan.lines.push_back({term, std::move(choice), std::move(reason)});
}

void PlanRun::hold(const Plan& held) {
    std::size_t yarns = 0;
    for (std::size_t y = 0; y < m_scene.yarns.size(); ++y) {
        m_scene.yarns[y].frozen = held.scene.yarns[y].frozen;
        yarns += std::ranges::find(m_scene.yarns[y].frozen, std::uint8_t{1}) != m_scene.yarns[y].frozen.end() ? 1 : 0;
    }
    say("pins", yarns == 0 ? "off" : std::to_string(yarns) + " yarns with places that are held", "changed while it relaxed; where they lay then");
    begin_relaxation();
}

void PlanRun::push(std::vector<ForceField> fields) {
    m_scene.fields = std::move(fields);
    say("fields", m_scene.fields.empty() ? "off" : std::to_string(m_scene.fields.size()), "changed while it relaxed");
    begin_relaxation();
}

// ---- Names ----

Result<Solver> parse_solver(std::string_view text) {
    for (const Solver solver : {Solver::relax, Solver::paper}) {
        if (text == name_of(solver)) return solver;
    }
    return Error{ErrorCode::usage, "solver is relax or paper, not '" + std::string(text) + "'", {}};
}

std::string_view name_of(Solver solver) {
    return solver_names[static_cast<std::size_t>(solver)];
}

Json flips_not_begun(const std::vector<Flip>& flips, std::string_view ending) {
    Json list = Json::array();
    for (const Flip& flip : flips) {
        list.push_back({{"pick", flip.pick + 1}, {"end", flip.end + 1}, {"weft_over", flip.weft_over}, {"done", false},
                        {"tried", false}, {"reason", "not begun, as " + why_over(ending)}, {"flip_seconds", 0.0},
                        {"settle_seconds", 0.0}, {"settle_iterations", 0}});
    }
    return list;
}

}  // namespace weave::sim
