// What it saves to model only what a scene requires: the same cloth without a term and with it.

#include "bench_savings.hpp"

#include "interrupt.hpp"

#include <weave/block/operations.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/deviation.hpp>
#include <weave/sim/friction_rounds.hpp>
#include <weave/sim/inspect.hpp>
#include <weave/sim/periods.hpp>
#include <weave/sim/starts.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace weave::program {

namespace {

/// One relaxation of a cloth, with a term or without it.
struct Side {
    std::size_t points = 0, steps = 0;
    double seconds = 0;
    bool at_rest = false;
    std::vector<Spline> yarns;
    std::vector<double> crimp_pc;  ///< of each yarn, or the mean of each system: what is compared
};

using Run = std::function<Side(const RunLimits&)>;

/// What of both results must be the same: the places of all yarns; the mean crimp of each system, nearly; or nothing,
/// where they do not come to rest.
enum class Compared : std::uint8_t { places, crimp, nothing };
/// What a part of a cloth may be off beyond the rows and columns that its frozen rims disturb.
constexpr double nearly_the_same_pp = 0.5;

struct Saving {
    const char* term;
    std::string cloth, kept;  ///< what is relaxed, and what is kept in it that else is left out
    double residual = 1e-8;
    std::size_t most_steps = std::numeric_limits<std::size_t>::max();
    Compared compared = Compared::places;
    double radius_mm = 0;  ///< the thinnest yarn's
    bool drifts = true;    ///< the cloth rests anywhere
    Run lean = {}, full = {};
};

// ---- runs

sim::RelaxOptions options_of(const Saving& saving, const RunLimits& limits) {
    sim::RelaxOptions options;
    options.residual = saving.residual;
    options.most_iterations = saving.most_steps;
    options.most_seconds = limits.seconds;
    options.watch = [](const sim::Progress&) { return !interrupted(); };
    return options;
}

/// The yarns of a scene as they lie in it.
void tell_yarns(Side& side, const sim::SimScene& scene) {
    for (const sim::SimYarn& yarn : scene.yarns) {
        side.yarns.push_back({yarn.control, yarn.is_periodic, yarn.shift});
        side.crimp_pc.push_back(100 * length_of(side.yarns.back()) /
                                (yarn.is_periodic ? yarn.shift.norm() : yarn.rest_mm));
    }
}

using Once =
    std::function<sim::RelaxResult(sim::Energy<double>&, std::vector<double>&, const sim::RelaxOptions&)>;

Side relaxed(const sim::SimScene& scene, const sim::RelaxOptions& options, std::size_t threads,
             const Once& once) {
    Side side;
    const double began = seconds_now(threads);
    const sim::Executor executor(threads);
    const sim::Fabric<double> fabric(scene);
    sim::Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state();
    const sim::RelaxResult result = once(energy, state, options);
    side.seconds = seconds_now(threads) - began;
    side.points = fabric.points();
    side.steps = result.iterations;
    side.at_rest = result.ending == sim::Ending::converged;
    sim::SimScene rested = scene;
    const Control control = fabric.control(state);
    for (std::size_t y = 0; y < control.size(); ++y) rested.yarns[y].control = control[y];
    tell_yarns(side, rested);
    return side;
}

/// As `simulate` relaxes it: in rounds where there is friction.
sim::RelaxResult with_its_friction(sim::Energy<double>& energy, std::vector<double>& state,
                                   const sim::RelaxOptions& options) {
    return sim::relax_with_friction(energy, state, options).last;
}

Run run_of(const Saving& saving, sim::SimScene scene, Once once = with_its_friction) {
    return [saving, scene = std::move(scene), once = std::move(once)](const RunLimits& limits) {
        return relaxed(scene, options_of(saving, limits), limits.threads, once);
    };
}

/// Two scenes that differ in one term.
Saving both_ways(Saving saving, const sim::SimScene& without, sim::SimScene with) {
    saving.radius_mm = std::numeric_limits<double>::infinity();
    for (const sim::SimYarn& yarn : without.yarns)
        saving.radius_mm = std::min(saving.radius_mm, yarn.radius_mm);
    saving.drifts = without.is_periodic[0] && without.is_periodic[1];
    saving.lean = run_of(saving, without);
    saving.full = run_of(saving, std::move(with));
    return saving;
}

// ---- cloths

/// A sample, tiled.
struct Cloth {
    Design design;
    BlockPtr block;
};

Result<Cloth> cloth_of(const std::string& sample, std::size_t times = 1) {
    Cloth cloth{find_sample(sample)->make(), nullptr};
    WEAVE_TRY(const Evaluation evaluation, evaluate(cloth.design));
    WEAVE_TRY(Block tiled, tile(*evaluation.block, times, times, 1));
    cloth.block = std::make_shared<const Block>(std::move(tiled));
    return cloth;
}

Result<sim::Plan> plan_of(const std::string& sample) {
    WEAVE_TRY(const Cloth cloth, cloth_of(sample));
    return sim::make_plan(cloth.design, *cloth.block, {});
}

/// The whole of a cloth as `simulate` gives it, its yarns in one order.
Run simulation_of(const Saving& saving, const Cloth& cloth, const sim::SimulationRequest& request) {
    return [=](const RunLimits& limits) {
        Side side;
        const double began = seconds_now(limits.threads);
        const sim::Plan plan = sim::make_plan(cloth.design, *cloth.block, request).value();
        sim::SimulationOptions options;
        options.threads = limits.threads;
        options.backend = sim::Backend::cpu;
        options.residual = saving.residual;
        options.most_seconds = limits.seconds;
        options.watch = [](const sim::Progress&) { return !interrupted(); };
        Yarns yarns = sim::simulate(cloth.design, plan, options);
        side.seconds = seconds_now(limits.threads) - began;
        side.points = points_of(plan.scene);
        side.steps = yarns.report.at("iterations").get<std::size_t>();
        side.at_rest = yarns.report.at("converged").get<bool>();
        if (const Result<Inspection> seen = inspect(yarns); seen && seen->warp_crimp && seen->weft_crimp)
            side.crimp_pc = {100 * seen->warp_crimp->mean, 100 * seen->weft_crimp->mean};
        std::ranges::sort(yarns.yarns, {},
                          [](const SimulatedYarn& yarn) { return std::pair(yarn.system, yarn.number); });
        for (const SimulatedYarn& yarn : yarns.yarns) side.yarns.push_back(yarn.spline);
        return side;
    };
}

// ---- the savings

Result<Saving> repeat_of(const std::string& sample) {
    WEAVE_TRY(const Cloth cloth, cloth_of(sample, 4));
    Saving saving{.term = "repeat", .cloth = sample + ", 4 × 4 side by side", .kept = "all 16 repeats relaxed"};
    sim::SimulationRequest request;
    WEAVE_TRY(const sim::Plan plan, sim::make_plan(cloth.design, *cloth.block, request));
    saving.radius_mm = plan.scene.yarns.front().radius_mm;
    saving.lean = simulation_of(saving, cloth, request);
    request.reduce = false;
    saving.full = simulation_of(saving, cloth, request);
    return saving;
}

Result<Saving> repeat() {
    return repeat_of("plain");
}

Result<Saving> repeat_of_satin() {
    return repeat_of("satin-5");
}

/// The yarns that the plan left out, as it would have laid them.
sim::SimScene with_loose_yarns(const sim::Plan& plan) {
    sim::SimScene scene = plan.scene;
    for (std::size_t c = 0; c < plan.curves.yarns.size(); ++c) {
        if (std::ranges::find(plan.curve_of, c) != plan.curve_of.end()) continue;
        const YarnCurve& curve = plan.curves.yarns[c];
        // Parameters of another yarn of its system; the beams of these samples have one kind of yarn.
        const auto like = std::ranges::find_if(plan.curve_of, [&](std::size_t other) {
            return plan.curves.yarns[other].system == curve.system;
        });
        sim::SimYarn yarn = plan.scene.yarns[static_cast<std::size_t>(like - plan.curve_of.begin())];
        std::vector<Vec3> places;
        for (const KeyPoint& key : curve.keys) places.push_back(key.place);
        yarn.control = resample(interpolate(places, curve.is_periodic, curve.shift),
                                static_cast<std::size_t>(plan.points_per_key) * places.size())
                           .control;
        yarn.is_periodic = curve.is_periodic;
        yarn.shift = curve.shift;
        yarn.frozen.clear();
        yarn.planned_mm = 0;
        scene.yarns.push_back(std::move(yarn));
    }
    return scene;
}

/// A loose end over each end of a twill, as a cloth has them where another part needs more ends.
Result<Saving> loose_yarns() {
    WEAVE_TRY(const Cloth cloth, cloth_of("twill-2-2"));
    const Block& twill = *cloth.block;
    const auto with_loose_end = [&](std::size_t row, std::size_t column) {
        return parse_stack(to_text(twill.stack(row, column)) + " - P1~").value();
    };
    WEAVE_TRY(const Block block, make_block({twill.t().begin(), twill.t().end()},
                                            std::vector<std::uint32_t>(twill.columns(), 2), with_loose_end));
    WEAVE_TRY(const sim::Plan plan, sim::make_plan(cloth.design, block, {}));
    return both_ways(
        {.term = "yarns", .cloth = "twill-2-2 with a loose end over each", .kept = "the loose ends"},
        plan.scene, with_loose_yarns(plan));
}

/// Not at rest in any time that a benchmark has, so that only what a step costs can be told.
Result<Saving> loose_yarns_of_i_beam() {
    WEAVE_TRY(const sim::Plan plan, plan_of("i-beam"));
    return both_ways({.term = "yarns",
                      .cloth = "i-beam, its first 100 steps",
                      .kept = "80 ends that are loose all along",
                      .most_steps = 100,
                      .compared = Compared::nothing},
                     plan.scene, with_loose_yarns(plan));
}

/// A sample as it is, and with what `keep` puts into its scene.
template <class Keep>
Result<Saving> kept_in_scene(Saving what, Keep keep) {
    WEAVE_TRY(const sim::Plan plan, plan_of(what.cloth));
    sim::SimScene scene = plan.scene;
    keep(scene);
    return both_ways(std::move(what), plan.scene, scene);
}

Result<Saving> radii() {
    return kept_in_scene({.term = "radii",
                          .cloth = "herringbone",
                          .kept = "an end three times as thick, far above it: a second grid"},
                         [](sim::SimScene& scene) {
                             sim::SimYarn thick = scene.yarns.back();
                             thick.radius_mm *= 3;
                             for (Vec3& point : thick.control) point.z() = 50;
                             scene.yarns.push_back(thick);
                         });
}

Result<Saving> pins() {
    return kept_in_scene(
        {.term = "pins", .cloth = "sateen-8", .kept = "a mark at every point that it may move"},
        [](sim::SimScene& scene) {
            for (sim::SimYarn& yarn : scene.yarns) yarn.frozen.assign(yarn.control.size(), 0);
        });
}

Result<Saving> fields() {
    return kept_in_scene(
        {.term = "fields", .cloth = "sateen-8", .kept = "a sphere round all of it that pushes with 0 N/mm"},
        [](sim::SimScene& scene) {
            scene.fields = {{{0, 0, 0}, 100, 0}};
        });
}

Result<Saving> gravity() {
    return kept_in_scene({.term = "gravity", .cloth = "sateen-8", .kept = "a weight of 1e-28 of the usual"},
                         [](sim::SimScene& scene) { scene.gravity_mm_ms2 = 1e-30; });
}

Result<Saving> friction() {
    return kept_in_scene({.term = "friction", .cloth = "herringbone", .kept = "a coefficient of 1e-12"},
                         [](sim::SimScene& scene) { scene.friction = 1e-12; });
}

Result<Saving> transition() {
    WEAVE_TRY(const sim::Plan plan, plan_of("sateen-8"));
    sim::SimScene scene = plan.scene;
    const Crossing& crossing = plan.curves.crossings.front();
    const auto yarn_of = [&](std::size_t curve) {
        return static_cast<std::size_t>(std::ranges::find(plan.curve_of, curve) - plan.curve_of.begin());
    };
    const auto point_of = [&](std::size_t key) { return plan.points_per_key * static_cast<double>(key); };
    scene.transition = {.yarn = {yarn_of(crossing.weft), yarn_of(crossing.warp)},
                        .at = {point_of(crossing.weft_key), point_of(crossing.warp_key)},
                        .reach = {2, 2},
                        .contact = 1};
    return both_ways({.term = "transition",
                      .cloth = "sateen-8",
                      .kept = "a crossing as in a flip, its spring 0 and its contact whole"},
                     plan.scene, scene);
}

/// A start whose period is a hundredth too long, and the forces that the fixed one bears at rest.
Result<Saving> periods() {
    WEAVE_TRY(const sim::Plan plan, plan_of("plain"));
    Saving saving = both_ways(
        {.term = "periods", .cloth = "plain", .kept = "periods that relax, from ones a hundredth too long"},
        plan.scene, plan.scene);
    saving.full = [saving, scene = plan.scene](const RunLimits& limits) {
        const sim::Executor executor(limits.threads);
        const sim::RelaxOptions options = options_of(saving, limits);
        const sim::Fabric<double> fabric(scene);
        sim::Energy<double> energy(fabric, executor);
        std::vector<double> state = fabric.state();
        sim::relax(energy, state, options);
        const std::array<double, 2> pull = energy.period_gradient(state);
        Side side;
        const double began = seconds_now(limits.threads);
        sim::SimScene relaxing =
            sim::with_periods(scene, {1.01 * scene.period_mm[0], 1.01 * scene.period_mm[1]});
        const sim::PeriodsResult result =
            sim::relax_periods(relaxing, {pull[0], pull[1]}, options, 1e-6, executor);
        side.seconds = seconds_now(limits.threads) - began;
        side.points = fabric.points();
        side.steps = result.last.iterations;
        side.at_rest = result.balanced && result.last.ending == sim::Ending::converged;
        tell_yarns(side, relaxing);
        return side;
    };
    return saving;
}

Result<Saving> balance() {
    WEAVE_TRY(const sim::Plan plan, plan_of("twill-2-2"));
    Saving saving = both_ways({.term = "balance",
                               .cloth = "twill-2-2, solver paper",
                               .kept = "rest lengths renewed at every step, as in the paper",
                               .residual = 1e-6},
                              plan.scene, plan.scene);
    const auto in_time = [](sim::Balance law) {
        return
            [law](sim::Energy<double>& energy, std::vector<double>& state, const sim::RelaxOptions& options) {
                return sim::relax_in_time(energy, state, options, {.balance = law});
            };
    };
    saving.lean = run_of(saving, plan.scene, in_time(sim::Balance::tension));
    saving.full = run_of(saving, plan.scene, in_time(sim::Balance::rest_length));
    return saving;
}

Result<Saving> region() {
    WEAVE_TRY(const Cloth cloth, cloth_of("satin-e", 4));
    Saving saving{.term = "region",
                  .cloth = "satin-e, 4 × 4 side by side",
                  .kept = "all of it, where the middle half of its rows and columns was asked for",
                  .residual = 1e-3,
                  .compared = Compared::crimp};
    sim::SimulationRequest request;
    request.reduce = false;
    saving.full = simulation_of(saving, cloth, request);
    const std::size_t rows = cloth.block->rows(), columns = cloth.block->columns();
    request.region = Region{rows / 4, 3 * rows / 4 - 1, columns / 4, 3 * columns / 4 - 1};
    saving.lean = simulation_of(saving, cloth, request);
    return saving;
}

struct Named {
    const char* name;
    Result<Saving> (*make)();
};
constexpr Named all_savings[]{{"repeat", repeat},     {"repeat-satin", repeat_of_satin},
                              {"yarns", loose_yarns}, {"yarns-i-beam", loose_yarns_of_i_beam},
                              {"radii", radii},       {"pins", pins},
                              {"fields", fields},     {"gravity", gravity},
                              {"friction", friction}, {"transition", transition},
                              {"periods", periods},   {"balance", balance},
                              {"region", region}};

// ---- measuring

/// The quickest of some turns, both in each: what runs beside them slows both.
std::pair<Side, Side> in_turns(const Saving& saving, const RunLimits& limits) {
    constexpr std::size_t most_turns = 5;
    constexpr double enough_seconds = 10;
    std::pair<Side, Side> best;
    const double began = seconds_now(limits.threads);
    for (std::size_t turn = 0; turn < most_turns && !interrupted(); ++turn) {
        Side lean = saving.lean(limits), full = saving.full(limits);
        if (turn == 0 || lean.seconds < best.first.seconds) best.first = std::move(lean);
        if (turn == 0 || full.seconds < best.second.seconds) best.second = std::move(full);
        if (seconds_now(limits.threads) - began > enough_seconds) break;
    }
    return best;
}

Json side_json(const Side& side) {
    return {
        {"points", side.points}, {"steps", side.steps}, {"seconds", side.seconds}, {"at_rest", side.at_rest}};
}

/// How far the yarns of both lie apart, in radii; of the cloth alone, where the other has more than it.
Json places_apart(const Saving& saving, const Side& lean, const Side& full) {
    if (saving.compared != Compared::places || lean.yarns.size() > full.yarns.size()) return nullptr;
    const std::vector<Spline> same(full.yarns.begin(),
                                   full.yarns.begin() + static_cast<std::ptrdiff_t>(lean.yarns.size()));
    return sim::deviation_of(same, lean.yarns, saving.drifts).max_mm / saving.radius_mm;
}

Json crimp_apart(const Saving& saving, const Side& lean, const Side& full) {
    if (saving.compared == Compared::nothing || lean.crimp_pc.empty() || full.crimp_pc.empty())
        return nullptr;
    double most = 0;
    for (std::size_t y = 0; y < std::min(lean.crimp_pc.size(), full.crimp_pc.size()); ++y)
        most = std::max(most, std::abs(full.crimp_pc[y] - lean.crimp_pc[y]));
    return most;
}

std::string fault_of(const Saving& saving, const Side& lean, const Side& full, const Json& apart, const Json& crimp) {
    const bool same_steps = lean.steps == full.steps && lean.steps == saving.most_steps;
    if (!same_steps && !(lean.at_rest && full.at_rest)) return "not both at rest";
    if (saving.compared == Compared::nothing) return "";
    if (saving.compared == Compared::crimp)
        return crimp.is_number() && crimp.get<double>() <= nearly_the_same_pp ? "" : "the crimp is another";
    if (!apart.is_number()) return "the yarns are not the same ones";
    return apart.get<double>() <= sim::same_rest_radii ? "" : "the result is another";
}

}  // namespace

std::vector<std::string> saving_names() {
    std::vector<std::string> names;
    for (const Named& named : all_savings) names.emplace_back(named.name);
    return names;
}

Status check_saving(const std::string& name) {
    const std::vector<std::string> known = saving_names();
    if (std::ranges::find(known, name) != known.end()) return {};
    std::string names;
    for (const std::string& one : known) names += (names.empty() ? "" : ", ") + one;
    return Error{ErrorCode::usage, "there is no term '" + name + "'; there are " + names, "--only"};
}

Result<Json> measure_saving(const std::string& name, const BenchOptions& options) {
    WEAVE_CHECK_OK(check_saving(name));
    const auto* named = std::ranges::find_if(all_savings, [&](const Named& one) { return one.name == name; });
    WEAVE_TRY(const Saving saving, named->make());
    const auto [lean, full] = in_turns(saving, {saving.residual, options.seconds, options.threads});
    if (interrupted())
        return Error{ErrorCode::system, "interrupted; what was measured of it is not kept", name};
    const Json apart = places_apart(saving, lean, full), crimp = crimp_apart(saving, lean, full);
    return Json{{"term", saving.term},
                {"cloth", saving.cloth},
                {"kept", saving.kept},
                {"residual", saving.residual},
                {"left_out", side_json(lean)},
                {"with_it", side_json(full)},
                {"ratio", full.seconds / lean.seconds},
                {"apart_radii", apart},
                {"crimp_apart_pp", crimp},
                {"fault", fault_of(saving, lean, full, apart, crimp)}};
}

std::string savings_table(const Json& savings, const Json& machine) {
    std::string text = "# What a scene does not need\n\nWritten by `weave bench savings`. " +
                       machine_line(machine) +
                       ". Each cloth is relaxed without a term and with it, in turns; seconds are those of "
                       "the quickest turn. "
                       "Apart: the greatest distance\nacross a yarn between both results, in radii, and the "
                       "greatest difference of a "
                       "yarn's crimp, in percentage points.\n\n"
                       "| Term | Cloth | Kept in the second run | Points | Steps | Left out, s | Kept, s | "
                       "Ratio | Apart, radii | Crimp, pp |\n"
                       "|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Json& saving : savings) {
        const Json &lean = saving.at("left_out"), &full = saving.at("with_it");
        const auto both = [&](const char* of) {
            const std::string a = in_words("%.0f", lean.at(of)), b = in_words("%.0f", full.at(of));
            return a == b ? a : a + ", " + b;
        };
        const auto apart = [&](const char* of) {
            return saving.at(of).is_number() ? in_words("%.1e", saving.at(of)) : std::string("–");
        };
        const std::string fault = saving.at("fault");
        text += "| " + saving.at("term").get<std::string>() + " | " + saving.at("cloth").get<std::string>() +
                " | " + saving.at("kept").get<std::string>() + " | " + both("points") + " | " +
                both("steps") + " | " + in_words("%.3f", lean.at("seconds")) + " | " +
                in_words("%.3f", full.at("seconds")) + " | " + in_words("%.2f", saving.at("ratio")) + " | " +
                apart("apart_radii") + " | " + apart("crimp_apart_pp") +
                (fault.empty() ? "" : " **BAD: " + fault + "**") + " |\n";
    }
    return text;
}

}  // namespace weave::program
