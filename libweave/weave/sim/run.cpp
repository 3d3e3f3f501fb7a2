#include <weave/sim/run.hpp>

#include <weave/design/edit.hpp>
#include <weave/sim/result.hpp>

#include <algorithm>
#include <utility>

namespace weave::sim {

namespace {

/// Half as many points alone save little: work follows the contact samples. At up to 0.45 no yarn was seen to pass another.
constexpr double draft_sample_spacing = 0.4;

/// Points times steps of a leg, and how many these may be: with 2,000 points 500 steps, which take 1.5 s on two cores, and
/// where 16 such runs share these, some 20 s.
constexpr double points_of_a_leg = 1e6;
constexpr std::size_t fewest_steps = 50, most_steps_of_a_leg = 2000;
/// A step of `paper` is that much cheaper, and it makes that many more.
constexpr std::size_t paper_steps = 20;

/// The parameters of a system as its scene would have them; `base` is the scene that the factors count from.
void set_system(SystemScene& scene, const SystemScene& base, const LiveParameters& parameters, const LiveParameters& planned) {
    if (parameters.strain != planned.strain) scene.strain = parameters.strain;
    if (parameters.stiffness != 1) scene.stiffness_scale = base.stiffness_scale.value_or(1) * parameters.stiffness;
    if (parameters.radius != 1) scene.radius_scale = base.radius_scale.value_or(1) * parameters.radius;
}

LiveParameters asked(const SystemScene& system, const SystemScene& base, LiveParameters wanted) {
    if (system.strain) wanted.strain = *system.strain;
    if (system.stiffness_scale) wanted.stiffness = *system.stiffness_scale / base.stiffness_scale.value_or(1);
    if (system.radius_scale) wanted.radius = *system.radius_scale / base.radius_scale.value_or(1);
    return wanted;
}

/// The scene of a plan with the parameters of now, or with those asked for, in place of its own.
Scene with_parameters(const Scene& base, const LedParameters& led, const LedParameters& planned, bool wanted) {
    Scene scene = base;
    const auto of = [&](const LedParameters& from, System system) { return wanted ? from.wanted(system) : from.now(system); };
    set_system(scene.warp, base.warp, of(led, System::warp), planned.now(System::warp));
    set_system(scene.weft, base.weft, of(led, System::weft), planned.now(System::weft));
    return scene;
}

}  // namespace

SimulationRequest coarser_request(SimulationRequest request, Fidelity rough) {
    request.points_per_key.reset();
    request.fidelity = rough;
    if (rough == Fidelity::draft) request.sample_spacing = draft_sample_spacing;
    return request;
}

std::size_t leg_steps(const Plan& plan, Solver solver) {
    double points = 0;
    for (const SimYarn& yarn : plan.scene.yarns) points += static_cast<double>(yarn.control.size());
    const auto steps = static_cast<std::size_t>(points_of_a_leg / std::max(1.0, points));
    return std::clamp(steps, fewest_steps, most_steps_of_a_leg) * (solver == Solver::paper ? paper_steps : 1);
}

Result<std::unique_ptr<Run>> Run::begin(const Design& design, const RunRequest& request, std::size_t threads) {
    WEAVE_TRY(const Evaluation evaluation, evaluate(design));
    std::unique_ptr<Run> run(new Run(design, evaluation.block, request, threads));
    WEAVE_TRY(Plan plan, run->plan());
    if (!request.start_from) {
        run->relax(std::move(plan));
        return run;
    }
    WEAVE_TRY(Plan coarser, run->coarser_plan());
    if (coarser.points_per_key >= plan.points_per_key)
        return Error{ErrorCode::usage, "has no fewer points than what is asked for", "start_from"};
    run->m_finer = std::move(plan);
    run->relax(std::move(coarser));
    return run;
}

void Run::use_threads(std::size_t threads) {
    m_threads = threads;
    m_now->use_threads(threads);
}

void Run::relax(Plan plan) {
    RunGoal goal = m_request.goal;
    if (m_finer) goal.residual.reset();
    m_now = std::make_unique<PlanRun>(m_design, std::move(plan), goal, m_threads);
}

Status Run::advance(std::size_t most_steps, const Watch& watch) {
    if (!m_now->at_end()) m_now->leg(most_steps, watch);
    else if (m_now->is_flipping()) m_now->end_flip();
    else if (is_coarse()) refine();
    else if (m_next_flip == m_request.flips.size()) return {};
    else if (is_reduced()) return unfold();  // the whole comes to rest before
    else return flip(m_request.flips[m_next_flip++], watch);
    return {};
}

bool Run::settle_between() {
    if (!m_now->at_end() || m_now->cut_short()) return false;
    if (!m_now->is_flipping() && !is_coarse()) return false;
    static_cast<void>(advance(0, {}));  // neither can fail
    return true;
}

bool Run::is_over() const {
    if (!m_now->at_end() || m_now->is_flipping()) return false;
    return m_now->cut_short() || (!is_coarse() && m_next_flip == m_request.flips.size());
}

/// The yarns go on in the points asked for; with crossings that lie wrong in so few, these begin anew as planned.
void Run::refine() {
    m_coarser = told_of_coarser(m_now->yarns().report);
    const std::unique_ptr<PlanRun> coarser = std::move(m_now);
    const std::optional<StartState> start =
        refined_start(*m_finer, coarser->plan(), {coarser->control(), coarser->scene().period_mm});
    m_coarser["taken"] = start.has_value();
    Plan finer = std::move(*m_finer);
    m_finer.reset();
    const LedParameters planned(coarser->plan());
    relax(std::move(finer));
    m_now->add_cost(coarser->cost());
    if (start) m_now->start_at(*start, true);
    for (const System system : {System::warp, System::weft}) {
        if (coarser->parameters().wanted(system) != planned.now(system))
            static_cast<void>(m_now->ask(system, coarser->parameters().wanted(system)));  // was taken once
    }
    m_now->set_scene(coarser->design().scene);
    ++m_level;
}

bool Run::is_reduced() const {
    const std::array<std::size_t, 2>& repeats = m_now->plan().repeats;
    return repeats[0] * repeats[1] > 1;
}

/// The whole cloth in place of its smallest repeat, from where that lies.
Status Run::unfold() {
    if (!is_reduced()) return {};
    const LedParameters planned(m_now->plan()), led = m_now->parameters();
    const Scene base = m_design.scene, shown = m_now->design().scene;
    const Scene now = with_parameters(base, led, planned, false), wanted = with_parameters(base, led, planned, true);
    Design design = m_design;
    design.scene = now;
    SimulationRequest request = m_request.plan;
    request.reduce = false;
    WEAVE_TRY(Plan whole, make_plan(design, *m_block, request));
    const Yarns repeat = m_now->yarns();
    WEAVE_TRY(const StartState start, start_from(whole, repeat, repeat.design_sha256, {repeat.scene_sha256}));
    const RunCost cost = m_now->cost();
    m_design = std::move(design);
    m_request.plan.reduce = false;
    relax(std::move(whole));
    m_now->add_cost(cost);
    m_now->start_at(start);
    ++m_level;
    if (!led.have_arrived()) WEAVE_CHECK_OK(change(wanted.warp, wanted.weft));
    m_now->set_scene(shown);
    return {};
}

Status Run::change(const SystemScene& warp, const SystemScene& weft) {
    if (m_now->is_flipping()) m_now->end_flip();
    m_now->forget_stop();
    const LedParameters& led = m_now->parameters();
    const LiveParameters warps = asked(warp, m_design.scene.warp, led.wanted(System::warp)),
                         wefts = asked(weft, m_design.scene.weft, led.wanted(System::weft));
    LedParameters tried = led;
    WEAVE_CHECK_OK(tried.ask(System::warp, warps));
    WEAVE_CHECK_OK(tried.ask(System::weft, wefts));
    WEAVE_CHECK_OK(m_now->ask(System::warp, warps));
    WEAVE_CHECK_OK(m_now->ask(System::weft, wefts));
    Scene scene = m_now->design().scene;
    for (const auto& [from, to] : {std::pair(&warp, &scene.warp), std::pair(&weft, &scene.weft)}) {
        if (from->strain) to->strain = from->strain;
        if (from->stiffness_scale) to->stiffness_scale = from->stiffness_scale;
        if (from->radius_scale) to->radius_scale = from->radius_scale;
    }
    m_now->set_scene(scene);
    return {};
}

/// What is under way comes to its end as it lies.
void Run::settle() {
    m_now->forget_stop();
    if (m_now->is_flipping()) m_now->end_flip();
    if (is_coarse()) refine();
}

Status Run::hold(const std::vector<Pin>& pins) {
    for (const Pin& pin : pins) {
        const std::size_t most = pin.is_pick ? m_block->picks() : m_block->ends();
        if (pin.number >= most)
            return invalid((pin.is_pick ? "pick " : "end ") + std::to_string(pin.number + 1) + " is not in the cloth, which has " + std::to_string(most),
                           "pins");
    }
    Design held = m_design;
    held.scene.pins = pins;
    SimulationRequest whole = m_request.plan;
    whole.reduce = false;
    WEAVE_TRY(const Plan planned, make_plan(held, *m_block, whole));  // refused before anything changes
    settle();
    WEAVE_CHECK_OK(unfold());
    m_design.scene.pins = pins;
    m_now->hold(planned);
    Scene scene = m_now->design().scene;
    scene.pins = pins;
    m_now->set_scene(scene);
    return {};
}

Status Run::push(const std::vector<ForceField>& fields) {
    settle();
    WEAVE_CHECK_OK(unfold());
    m_design.scene.fields = fields;
    m_now->push(fields);
    Scene scene = m_now->design().scene;
    scene.fields = fields;
    m_now->set_scene(scene);
    return {};
}

Status Run::flip(const Flip& flip, const Watch& watch) {
    settle();
    if (!m_now->cut_short()) WEAVE_CHECK_OK(unfold());
    m_now->forget_stop();
    m_now->begin_flip(flip, watch);
    return {};
}

Yarns Run::yarns() {
    Yarns yarns = m_now->yarns();
    const std::vector<Flip> left(m_request.flips.begin() + static_cast<std::ptrdiff_t>(m_next_flip), m_request.flips.end());
    const std::string_view ending = name_of(m_now->cut_short().value_or(m_now->last().ending));
    if (is_coarse()) {
        yarns.report["goes_on"] = std::string(name_of(m_finer->fidelity));
        Json coarser = told_of_coarser(yarns.report);
        yarns.report.update({{"converged", false},
                             {"ending", std::string(ending)},
                             {"goal", m_request.goal.residual.value_or(m_finer->goal)},
                             {"coarser", std::move(coarser)}});
    } else if (!m_coarser.is_null()) {
        yarns.report["coarser"] = m_coarser;
    }
    if (left.empty()) return yarns;
    if (!yarns.report.contains("flips")) yarns.report["flips"] = Json::array();
    for (const Json& flip : flips_not_begun(left, ending)) yarns.report["flips"].push_back(flip);
    return yarns;
}

Json Run::state() const {
    return {{"version", 1},
            {"level", m_level},
            {"coarse", is_coarse()},
            {"reduce", m_request.plan.reduce},
            {"next_flip", m_next_flip},
            {"coarser", m_coarser},
            {"base", to_json(Edit(SetScene{m_design.scene}))},
            {"scene", to_json(Edit(SetScene{m_now->design().scene}))},
            {"now", m_now->state()}};
}

Result<std::unique_ptr<Run>> Run::resume(const Design& design, const RunRequest& request, const Json& state, std::size_t threads) {
    WEAVE_TRY(const Evaluation evaluation, evaluate(design));
    std::unique_ptr<Run> run(new Run(design, evaluation.block, request, threads));
    try {
        WEAVE_CHECK_OK(run->restore(state));
    } catch (const std::exception& broken) {
        return bad_input("this is no state of such a run: " + std::string(broken.what()));
    }
    return run;
}

Status Run::restore(const Json& state) {
    if (state.at("version") != 1) return bad_input("this is the state of another version of the program");
    WEAVE_TRY(const Edit base, edit_from_json(state.at("base")));
    WEAVE_TRY(const Edit scene, edit_from_json(state.at("scene")));
    m_design.scene = std::get<SetScene>(base).scene;
    m_request.plan.reduce = state.at("reduce");
    m_level = state.at("level");
    m_next_flip = std::min(state.at("next_flip").get<std::size_t>(), m_request.flips.size());
    m_coarser = state.at("coarser");
    WEAVE_TRY(Plan finer, plan());
    if (state.at("coarse") == true) {
        if (!m_request.start_from) return bad_input("this is the state of another run");
        WEAVE_TRY(Plan coarser, coarser_plan());
        m_finer = std::move(finer);
        relax(std::move(coarser));
    } else {
        relax(std::move(finer));
    }
    WEAVE_CHECK_OK(m_now->restore(state.at("now")));
    m_now->set_scene(std::get<SetScene>(scene).scene);
    return {};
}

}  // namespace weave::sim
