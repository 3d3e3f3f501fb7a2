#include <weave/sim/extremes.hpp>

#include <weave/block/operations.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/sim/friction_rounds.hpp>
#include <weave/sim/linking.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/paper.hpp>
#include <weave/sim/plan.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace weave::sim {

namespace {

// ---- scenes

SimYarn usual_yarn(double radius_mm = 0.12) {
    SimYarn yarn;
    yarn.radius_mm = radius_mm;
    yarn.stretch_N = 40;
    yarn.bending_N_mm2 = 0.02;
    yarn.contact_N_mm2 = 3;
    yarn.gram_per_mm = 5e-5;
    yarn.is_fed = true;
    yarn.strain = 1.02;
    return yarn;
}

SimYarn laid(SimYarn yarn, const Vec3& from, const Vec3& to, std::size_t points, bool is_periodic) {
    yarn.is_periodic = is_periodic;
    yarn.shift = is_periodic ? Vec3(to - from) : Vec3(0, 0, 0);
    yarn.control.clear();
    const auto segments = static_cast<double>(is_periodic ? points : points - 1);
    for (std::size_t i = 0; i < points; ++i)
        yarn.control.push_back(from + (to - from) * (static_cast<double>(i) / segments));
    yarn.rest_mm = (to - from).norm();
    return yarn;
}

/// Two warps and two wefts of plain weave, periodic, a little crooked, so that no symmetry helps.
struct Plain {
    SimYarn warp = usual_yarn(), weft = usual_yarn();
    double pitch_mm = 0.5, origin_mm = 0;
    std::size_t points_a_crossing = 4;

    [[nodiscard]] SimScene scene() const {
        constexpr std::size_t count = 2;
        const double size = static_cast<double>(count) * pitch_mm;
        SimScene scene;
        scene.is_periodic = {true, true};
        scene.period_mm = {size, size};
        const double swing = (warp.radius_mm + weft.radius_mm) / 2;
        for (const bool is_warp : {true, false}) {
            for (std::size_t y = 0; y < count; ++y) {
                const double across = (static_cast<double>(y) + 0.5) * pitch_mm;
                const Vec3 from = is_warp ? Vec3(0, across, 0) : Vec3(across, 0, 0);
                SimYarn yarn = is_warp ? warp : weft;
                yarn.is_fed = is_warp;
                yarn = laid(yarn, from, from + (is_warp ? Vec3(size, 0, 0) : Vec3(0, size, 0)),
                            count * points_a_crossing, true);
                yarn.turns = {is_warp ? 1 : 0, is_warp ? 0 : 1};
                yarn.rest_mm = 1.05 * size;
                const double side = (y % 2 == 0 ? 1 : -1) * (is_warp ? 1 : -1);
                for (std::size_t i = 0; i < yarn.control.size(); ++i) {
                    Vec3& point = yarn.control[i];
                    point.z() = side * swing *
                                std::sin(std::numbers::pi * (is_warp ? point.x() : point.y()) / pitch_mm);
                    const auto phase = static_cast<double>(7 * i + 13 * y + (is_warp ? 0 : 5));
                    point +=
                        0.05 * swing * Vec3(std::sin(phase), std::sin(2.3 * phase), std::cos(1.7 * phase));
                    point += Vec3(origin_mm, origin_mm, 0);
                }
                scene.yarns.push_back(yarn);
            }
        }
        return scene;
    }
};

/// Two open yarns of fixed length along x, the second turned and moved.
SimScene two_yarns(double turn, const Vec3& moved) {
    SimScene scene;
    for (const bool first : {true, false}) {
        SimYarn yarn = usual_yarn();
        yarn.is_fed = false;
        const Vec3 along = first ? Vec3(1, 0, 0) : Vec3(std::cos(turn), std::sin(turn), 0),
                   middle = first ? Vec3(0, 0, 0) : moved;
        scene.yarns.push_back(laid(yarn, middle - along, middle + along, 9, false));
    }
    return scene;
}

Design plain_design() {
    Design design;
    design.root = "plain";
    design.blocks["plain"] = std::make_shared<const Node>(Node{PresetLeaf{{"plain", {}}}, {}});
    return design;
}

// ---- running them

std::string words(const char* format, double a, double b = 0, double c = 0) {
    char text[200];
    std::snprintf(text, sizeof text, format, a, b, c);
    return text;
}

/// The slot that is pulled most, as a yarn and a point of it, from 1; empty where there is no slot.
template <class Real>
std::string worst_place(const Fabric<Real>& fabric, const std::vector<Real>& gradient) {
    std::size_t worst = 0;
    double most = -1;
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        const double force = static_cast<double>(load(&gradient[3 * slot]).norm());
        if (std::isfinite(force) && force <= most) continue;
        worst = slot;
        most = force;
        if (!std::isfinite(force)) break;
    }
    if (fabric.slots() == 0) return "";
    const std::size_t yarn = fabric.yarn_of_slot()[worst];
    return words("yarn %.0f, point %.0f", static_cast<double>(yarn + 1),
                 static_cast<double>(worst - fabric.yarns()[yarn].first_slot));
}

/// Greatest 1 - d/D of samples that touch.
template <class Real>
double overlap_of(Energy<Real>& energy, const std::vector<Real>& state) {
    const FabricView<Real> fabric = energy.view(state);
    return energy.executor().greatest(energy.fabric().samples(), [&](std::size_t a) {
        double overlap = 0;
        for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
            const std::uint32_t b = fabric.neighbours[e];
            const double dx = double(fabric.samples.x[a] - fabric.samples.x[b]),
                         dy = double(fabric.samples.y[a] - fabric.samples.y[b]),
                         dz = double(fabric.samples.z[a] - fabric.samples.z[b]);
            overlap = std::max(overlap, 1 - std::sqrt(dx * dx + dy * dy + dz * dz) /
                                                double(fabric.samples.radius[a] + fabric.samples.radius[b]));
        }
        return overlap;
    });
}

template <class Real>
bool all_finite(const std::vector<Real>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](Real number) { return std::isfinite(number); });
}

/// Yarns of fixed length that lie far shorter than they are, in words.
template <class Real>
std::string crushed_words(const Fabric<Real>& fabric, const std::vector<Real>& state) {
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        const SimYarn& yarn = fabric.scene().yarns[y];
        if (yarn.is_fed || yarn.rest_mm <= 0) continue;
        const double length = fabric.length_mm(state, y);
        if (length < 0.5 * yarn.rest_mm)
            return words(", yarn %.0f lies in %.0f %% of its length", static_cast<double>(y + 1),
                         100 * length / yarn.rest_mm);
    }
    return "";
}

/// `paper` takes small steps: so many times as many are allowed.
constexpr std::size_t steps_in_time = 3;

/// How one relaxation is run.
struct Way {
    double goal = 1e-3;
    bool in_time = false;
    PaperOptions paper{};
};

std::string report_of(const ExtremeEnd& end, Ending ending, const std::string& passed) {
    constexpr const char* endings[]{"", "stopped", "given up after its steps", "given up after its time",
                                    "stuck"};
    std::string report = end.converged ? "at rest" : endings[static_cast<std::size_t>(ending)];
    report += words(": residual %.1e", end.residual);
    if (!end.converged && !end.where.empty()) report += ", greatest force at " + end.where;
    if (end.overlap > 0.5) report += words(", yarns overlap by %.0f %%", 100 * end.overlap);
    if (end.converged && end.curves_down) report += ", though the energy curves down in some direction there";
    if (!end.finite) report += ", NOT ALL NUMBERS ARE FINITE";
    return report + passed;
}

/// Yarns whose linking changed, in words.
std::string passed_words(const Linking& before, const Linking& after) {
    for (const auto& [now, past] : {std::pair(&after, &before), std::pair(&before, &after)}) {
        for (const auto& [yarns, sum] : *now) {
            const auto found = past->find(yarns);
            if (passed_through(sum - (found == past->end() ? 0 : found->second)))
                return words(", yarns %.0f and %.0f passed through one another", static_cast<double>(yarns.second + 1),
                             static_cast<double>(yarns.first + 1));
        }
    }
    return "";
}

/// In rounds where there is friction; that is not computed in float.
RelaxResult rested(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) {
    return relax_with_friction(energy, state, options).last;
}
RelaxResult rested(Energy<float>& energy, std::vector<float>& state, const RelaxOptions& options) {
    return relax(energy, state, options);
}

/// Relaxes a scene and says what became of it. `control` receives the last state.
template <class Real>
ExtremeEnd relaxed(const SimScene& scene, const ExtremeLimits& limits, const Way& way = {},
                   std::vector<std::vector<Vec3>>* control = nullptr) {
    const Executor executor(limits.threads);
    const Fabric<Real> fabric(scene);
    Energy<Real> energy(fabric, executor);
    std::vector<Real> state = fabric.state(), gradient;
    const auto before = linking_of(scene, fabric.control(state));
    RelaxOptions options;
    options.residual = way.goal;
    options.most_iterations = limits.most_iterations * (way.in_time ? steps_in_time : 1);
    options.most_seconds = limits.most_seconds;
    const RelaxResult result =
        way.in_time ? relax_in_time(energy, state, options, way.paper) : rested(energy, state, options);
    const double value = energy.evaluate(state, gradient);
    ExtremeEnd end;
    end.converged = result.ending == Ending::converged;
    end.finite =
        all_finite(state) && all_finite(gradient) && std::isfinite(value) && std::isfinite(result.residual);
    end.residual = result.residual;
    end.overlap = overlap_of(energy, state);
    end.curves_down = result.curves_down.value_or(false);
    end.points = fabric.points();
    end.iterations = result.iterations;
    end.seconds = result.seconds;
    const std::string passed =
        end.finite ? passed_words(before, linking_of(scene, fabric.control(state))) : "";
    end.passed_through = !passed.empty();
    end.where = worst_place(fabric, gradient);
    end.report = report_of(end, result.ending, crushed_words(fabric, state) + passed);
    if (control != nullptr) *control = fabric.control(state);
    return end;
}

std::function<ExtremeEnd(const ExtremeLimits&)> scene_case(SimScene scene, Way way = {}) {
    return [scene = std::move(scene), way](const ExtremeLimits& limits) {
        return relaxed<double>(scene, limits, way);
    };
}

/// Comes to rest, then every yarn changes at once, and it relaxes again from there.
std::function<ExtremeEnd(const ExtremeLimits&)> jump_case(const Plain& plain,
                                                          std::function<void(SimYarn&)> jump) {
    return [plain, jump = std::move(jump)](const ExtremeLimits& limits) {
        SimScene scene = plain.scene();
        std::vector<std::vector<Vec3>> control;
        const ExtremeEnd first = relaxed<double>(scene, limits, {}, &control);
        if (!first.converged) return first;
        for (std::size_t y = 0; y < control.size(); ++y) {
            scene.yarns[y].control = control[y];
            jump(scene.yarns[y]);
        }
        return relaxed<double>(scene, limits);
    };
}

// ---- the catalogue

using List = std::vector<Extreme>;

void add(List& list, std::string name, std::string about, std::function<ExtremeEnd(const ExtremeLimits&)> run,
         Expected expected = Expected::rest) {
    list.push_back({std::move(name), std::move(about), expected, false, std::move(run)});
}

void add_ratios(List& list) {
    Plain thin;
    thin.weft = usual_yarn(0.0012);
    thin.weft.stretch_N *= 1e-4;      // as the radius squared
    thin.weft.bending_N_mm2 *= 1e-8;  // and to the fourth power
    SimScene thin_scene = thin.scene();
    thin_scene.sample_spacing = 0.45;  // thin yarns have many samples
    add(list, "radius ratio 1:100", "ends of 0.12 mm, picks of 0.0012 mm, as stiff as such yarns are", scene_case(std::move(thin_scene)));
    Plain stretch, bending, contact;
    stretch.warp.stretch_N *= 1e3, stretch.weft.stretch_N *= 1e-3;
    bending.warp.bending_N_mm2 *= 1e3, bending.weft.bending_N_mm2 *= 1e-3;
    contact.warp.contact_N_mm2 *= 1e3, contact.weft.contact_N_mm2 *= 1e-3;
    add(list, "EA ratio 1e6", "ends a million times as hard to stretch as picks", scene_case(stretch.scene()));
    add(list, "EI ratio 1e6", "ends a million times as hard to bend", scene_case(bending.scene()));
    add(list, "k ratio 1e6", "ends a million times as hard to press", scene_case(contact.scene()));
}

void add_strains(List& list) {
    for (const double strain : {1.0, 1 + 1e-6, 1.5}) {
        Plain plain;
        plain.warp.strain = strain;
        add(list, words("S = %.7g", strain),
            strain == 1 ? "ends without tension" : words("ends pulled to %.7g of their length", strain), scene_case(plain.scene()));
    }
    add(
        list, "S = 0.999999", "ends that would be pushed",
        [](const ExtremeLimits&) {
            Design design = plain_design();
            design.scene.warp.strain = 1 - 1e-6;
            ExtremeEnd end;
            const Status checked = check(design);
            end.refused = !checked;
            end.report = checked ? "not refused" : "refused: " + checked.error().text();
            return end;
        },
        Expected::refused);
}

void add_jumps(List& list) {
    for (const double factor : {0.5, 1.5})
        add(list, words("live jump: radius × %g", factor), "at rest, then every radius changes at once",
            jump_case({}, [=](SimYarn& yarn) { yarn.radius_mm *= factor; }));
    for (const double factor : {1e-3, 1e3}) {
        add(list, words("live jump: EA and EI × %g", factor), "at rest, then every yarn's stiffness changes at once",
            jump_case({}, [=](SimYarn& yarn) {
                yarn.stretch_N *= factor;
                yarn.bending_N_mm2 *= factor;
            }));
        add(list, words("live jump: k × %g", factor), "at rest, then contact changes at once",
            jump_case({}, [=](SimYarn& yarn) { yarn.contact_N_mm2 *= factor; }));
    }
    for (const double strain : {1.0, 1.5, 2.0})
        add(list, words("live jump: S to %g", strain), "at rest under S = 1.02, then ends are fed otherwise at once",
            jump_case({}, [=](SimYarn& yarn) { yarn.strain = strain; }));
}

void add_degenerate_places(List& list) {
    add(list, "near-parallel, 1e-7 rad", "two yarns all but along one another, sunk into one another",
        scene_case(two_yarns(1e-7, Vec3(0, 0, 0.1))));
    add(list, "parallel, side by side", "two yarns sunk into one another all along", scene_case(two_yarns(0, Vec3(0, 0.1, 0))));
    add(list, "collinear, one after the other", "the end of one yarn in the beginning of the next, on one line",
        scene_case(two_yarns(0, Vec3(1.9, 0, 0))), Expected::told);
    add(list, "coincident centrelines", "two yarns in one place", scene_case(two_yarns(0, Vec3(0, 0, 0))), Expected::told);
    add(list, "centrelines that meet", "two yarns through one another at a point", scene_case(two_yarns(1, Vec3(0, 0, 0))),
        Expected::told);
    const auto spoilt = [&](const std::string& name, const std::string& about,
                            const std::function<void(std::vector<Vec3>&)>& spoil) {
        SimScene scene = Plain().scene();
        for (SimYarn& yarn : scene.yarns) spoil(yarn.control);
        add(list, name, about, scene_case(scene));
    };
    spoilt("duplicate points", "a control point of each yarn on the one before it",
           [](std::vector<Vec3>& control) { control[3] = control[2]; });
    spoilt("a segment of no length", "four control points of each yarn in one place",
           [](std::vector<Vec3>& control) { control[5] = control[4] = control[3] = control[2]; });
    spoilt("a reversed segment", "two control points of each yarn in the wrong order",
           [](std::vector<Vec3>& control) { std::swap(control[2], control[3]); });
    SimScene point;
    point.yarns = {laid(usual_yarn(), {0, 0, 0}, {0, 0, 0}, 4, false)};
    point.yarns[0].is_fed = false;
    point.yarns[0].rest_mm = 1;
    add(list, "a whole yarn in one place", "a yarn of 1 mm whose points all lie on one another", scene_case(point), Expected::told);
}

void add_periods(List& list) {
    SimScene narrow;
    narrow.is_periodic = {true, true};
    narrow.period_mm = {1.2, 0.1};
    narrow.yarns = {laid(usual_yarn(), {0, 0, 0}, {1.2, 0, 0}, 8, true)};
    narrow.yarns[0].turns = {1, 0};
    for (std::size_t i = 0; i < 8; ++i)
        narrow.yarns[0].control[i].z() = 0.02 * std::sin(2.0 * static_cast<double>(i));
    add(list, "period below 2D: a yarn in its own images", "a yarn of 0.24 mm that repeats every 0.1 mm beside itself",
        scene_case(narrow), Expected::told);
    SimScene beside = narrow;
    beside.period_mm = {1.2, 0.22};
    add(list, "a yarn meeting its own image", "the same every 0.22 mm", scene_case(beside));
    Plain tight;
    tight.pitch_mm = 0.2;
    add(list, "plain weave with a pitch below its diameter", "yarns of 0.24 mm every 0.2 mm", scene_case(tight.scene()),
        Expected::told);
}

void add_resolutions(List& list) {
    Plain fine;
    fine.points_a_crossing = 64;
    add(list, "radius 15 times the segments", "64 control points a crossing", scene_case(fine.scene()));
    Plain coarse;
    coarse.points_a_crossing = 1;
    add(list, "one point a crossing", "as few control points as a weave can have", scene_case(coarse.scene()), Expected::told);
    for (const double step : {0.9, 1.0, 1.1})
        add(list, words("paper: step %.1f of the stability limit", step), "the solver paper, in time",
            scene_case(Plain().scene(),
                       {.goal = 1e-3, .in_time = true, .paper = {.step = step, .damping = 0.01}}),
            step < 1   ? Expected::rest
            : step > 1 ? Expected::no_rest
                       : Expected::told);
    for (const bool in_float : {true, false}) {
        Plain far;
        far.origin_mm = 1e6;  // a repeat is a millimetre
        const SimScene scene = far.scene();
        const auto run = [=](const ExtremeLimits& limits) {
            return in_float ? relaxed<float>(scene, limits) : relaxed<double>(scene, limits);
        };
        add(list, in_float ? "origin at 1e6 repeats, float32" : "origin at 1e6 repeats, double",
            in_float ? "a kilometre away a float is 0.06 mm from the next" : "the same place in double", run,
            in_float ? Expected::told : Expected::rest);
    }
}

void add_loads(List& list) {
    for (const double friction : {1e-6, 1.0, 100.0}) {
        SimScene scene = Plain().scene();
        scene.friction = friction;
        add(list, words("friction %g", friction),
            friction < 1   ? "hardly any"
            : friction > 1 ? "the most that a scene may ask for: nothing slips"
                           : "rougher than any yarn",
            scene_case(std::move(scene)), friction > 1 ? Expected::told : Expected::rest);
    }
    for (const double strength : {1e4, -1e4}) {
        SimScene scene = Plain().scene();
        scene.fields = {{{0.3, 0.3, 0}, 0.4, strength}};
        add(list, words("field of %g N/mm", strength), strength > 0 ? "a sphere in the cloth bursts" : "a sphere draws all yarns into a point",
            scene_case(std::move(scene)), Expected::told);
    }
    SimScene heavy = Plain().scene();
    heavy.gravity_mm_ms2 = 1e3;
    add(list, "gravity of 1e5 g", "nothing holds a periodic cloth up", scene_case(std::move(heavy)), Expected::told);
}

/// A tiled plain weave of about so many points.
ExtremeEnd large_cloth(const ExtremeLimits& limits, double points) {
    const Design design = plain_design();
    const auto side = static_cast<std::size_t>(std::sqrt(points / 32));
    const Result<Block> cloth = tile(*evaluate(design)->block, side, side, 1);
    SimulationRequest request;
    request.reduce = false;
    const Plan plan = make_plan(design, *cloth, request).value();
    const Executor executor(limits.threads);
    const Fabric<double> fabric(plan.scene);
    Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state(), gradient;
    RelaxOptions options;
    options.residual = 1e-2;
    options.most_iterations = limits.most_iterations;
    options.most_seconds = limits.most_seconds;
    const RelaxResult result = relax(energy, state, options);
    energy.evaluate(state, gradient);
    std::vector<Spline> splines(plan.curves.yarns.size());
    const std::vector<std::vector<Vec3>> control = fabric.control(state);
    for (std::size_t y = 0; y < control.size(); ++y)
        splines[plan.curve_of[y]] = {control[y], plan.scene.yarns[y].is_periodic, plan.scene.yarns[y].shift};
    ExtremeEnd end;
    end.converged = result.ending == Ending::converged;
    end.finite = all_finite(state) && all_finite(gradient);
    end.residual = result.residual;
    end.overlap = overlap_of(energy, state);
    end.points = fabric.points();
    end.iterations = result.iterations;
    end.seconds = result.seconds;
    const std::size_t lost = lost_crossings(plan.curves, splines).size();
    end.passed_through = lost > 0;
    end.where = worst_place(fabric, gradient);
    end.report = report_of(end, result.ending,
                           lost > 0 ? words(", %.0f crossings lost", static_cast<double>(lost)) : "");
    return end;
}

void add_sizes(List& list) {
    add(list, "empty scene", "no yarn at all", scene_case({}));
    SimScene one;
    one.yarns = {laid(usual_yarn(), {0, 0, 0}, {2, 0, 0}, 9, false)};
    one.yarns[0].is_fed = false;
    for (std::size_t i = 0; i < 9; ++i) one.yarns[0].control[i].z() = 0.1 * std::sin(static_cast<double>(i));
    add(list, "one yarn", "a crooked yarn alone", scene_case(one));
    list.push_back({"one million points", "an easy cloth, as much as a machine holds: plain weave side by side, not reduced, to 1e-2", Expected::told, true,
                    [](const ExtremeLimits& limits) { return large_cloth(limits, 1e6); }});
}

}  // namespace

std::vector<Extreme> extremes() {
    List list;
    add_ratios(list);
    add_strains(list);
    add_jumps(list);
    add_degenerate_places(list);
    add_periods(list);
    add_resolutions(list);
    add_loads(list);
    add_sizes(list);
    return list;
}

bool is_good(const Extreme& extreme, const ExtremeEnd& end, const ExtremeLimits& limits, std::string& why) {
    why.clear();
    const auto fault = [&](bool wrong, const char* what) {
        if (wrong && why.empty()) why = what;
    };
    fault(end.report.empty(), "it says nothing");
    fault(!end.refused && !end.converged && (end.where.empty() || end.report.find(end.where) == std::string::npos),
          "it does not say where it is not at rest");
    // Time is looked at after each step.
    const double step = end.seconds / static_cast<double>(std::max<std::size_t>(1, end.iterations));
    fault(end.iterations > steps_in_time * limits.most_iterations || end.seconds > limits.most_seconds + 2 * step,
          "it went on beyond its steps or its time");
    fault(!end.finite, "not all numbers are finite");
    fault(end.passed_through, "a yarn passed through another");
    fault((extreme.expected == Expected::refused) != end.refused,
          end.refused ? "it was refused" : "it was not refused");
    fault(extreme.expected == Expected::rest && !end.converged, "it did not come to rest");
    fault(extreme.expected == Expected::no_rest && end.converged, "it claims to be at rest");
    return why.empty();
}

}  // namespace weave::sim
