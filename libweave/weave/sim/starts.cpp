#include <weave/sim/starts.hpp>

#include <weave/core/text.hpp>
#include <weave/sim/backend.hpp>
#include <weave/sim/deviation.hpp>
#include <weave/sim/energy.hpp>
#include <weave/sim/inspect.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/report_words.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

namespace weave::sim {

namespace {

/// Evenly from -1 to 1, the same on every machine.
double noise(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-52 - 1;
}

/// Noise of every control point that may move, at most `start_noise_radii` long.
std::vector<double> noise_of(const Fabric<double>& fabric, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::vector<double> change(3 * fabric.slots(), 0);
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        if (fabric.moves()[slot] == 0) continue;
        const double radius = fabric.constants()[fabric.yarn_of_slot()[slot]].radius_mm;
        for (std::size_t k = 0; k < 3; ++k)
            change[3 * slot + k] = start_noise_radii / std::sqrt(3.0) * radius * noise(random);
    }
    fabric.follow_change(change);
    return change;
}

std::vector<Spline> splines_of(const Yarns& yarns) {
    std::vector<Spline> splines;
    for (const SimulatedYarn& yarn : yarns.yarns) splines.push_back(yarn.spline);
    return splines;
}

std::size_t lost_in(const Plan& plan, const std::vector<std::vector<Vec3>>& control) {
    std::vector<Spline> splines(plan.curves.yarns.size());
    for (std::size_t y = 0; y < control.size(); ++y) {
        const SimYarn& yarn = plan.scene.yarns[y];
        splines[plan.curve_of[y]] = {control[y], yarn.is_periodic, yarn.shift};
    }
    return lost_crossings(plan.curves, splines).size();
}

bool holds_a_place(const SimScene& scene) {
    return !scene.fields.empty() || std::ranges::any_of(scene.yarns, [](const SimYarn& yarn) {
        return std::ranges::count(yarn.frozen, 1) > 0;
    });
}

/// One run in figures.
Json figures_of(const Yarns& yarns) {
    Json figures{{"converged", yarns.report.at("converged")},
                 {"order_kept", yarns.report.at("order_kept")},
                 {"energy_N_mm", yarns.report.at("energy_N_mm")}};
    const Result<Inspection> inspection = inspect(yarns);
    if (!inspection) return figures;
    if (inspection->thickness_mm) figures["thickness_mm"] = *inspection->thickness_mm;
    if (inspection->warp_crimp) figures["warp_crimp"] = inspection->warp_crimp->mean;
    if (inspection->weft_crimp) figures["weft_crimp"] = inspection->weft_crimp->mean;
    return figures;
}

/// Least and greatest of a figure over all runs that have it.
Json spread_of(const std::vector<Json>& runs, const char* name) {
    Json spread;
    for (const Json& run : runs) {
        if (!run.contains(name)) continue;
        const double value = run.at(name);
        if (spread.is_null()) spread = {{"least", value}, {"most", value}};
        spread["least"] = std::min(spread["least"].get<double>(), value);
        spread["most"] = std::max(spread["most"].get<double>(), value);
    }
    return spread;
}

/// Starts of one plan, each with a fabric of its own.
struct StartedCloth {
    SimScene scene;
    std::unique_ptr<Fabric<double>> fabric;
    std::unique_ptr<Energy<double>> energy;
    std::vector<double> state;

    StartedCloth(const Plan& plan, const StartState& start, const Executor& executor)
        : scene(scene_at(plan, start)), fabric(std::make_unique<Fabric<double>>(scene)),
          energy(std::make_unique<Energy<double>>(*fabric, executor)), state(fabric->state()) {}
};

/// Lets all starts come to rest at once where a device can do so: whoever goes on from them finds them there. What that took of each;
/// nothing where the starts are as they were.
std::vector<RelaxResult> come_to_rest_at_once(const Plan& plan, const SimulationOptions& options, std::vector<StartState>& starts) {
    const bool periods = plan.rim_force_N[0].has_value() || plan.rim_force_N[1].has_value();
    if (options.solver != Solver::relax || periods || !may_use_device(options.backend)) return {};
    const Executor executor(options.threads);
    std::vector<StartedCloth> all;
    std::vector<ClothToRelax> cloths;
    all.reserve(starts.size());
    for (const StartState& start : starts) {
        StartedCloth& cloth = all.emplace_back(plan, start, executor);
        RelaxOptions wanted;
        wanted.residual = options.residual.value_or(plan.goal);
        wanted.most_iterations = options.most_iterations;
        wanted.most_seconds = options.most_seconds;
        wanted.watch = options.watch;
        cloths.push_back({cloth.energy.get(), &cloth.state, std::move(wanted)});
    }
    std::vector<RelaxResult> results = relax_at_once(options.backend, cloths);
    for (std::size_t k = 0; k < results.size(); ++k) starts[k].control = all[k].fabric->control(all[k].state);
    return results;
}

std::size_t how_many_are_not(const std::vector<Json>& runs, const char* name) {
    return static_cast<std::size_t>(
        std::ranges::count_if(runs, [&](const Json& run) { return !run.at(name).get<bool>(); }));
}

}  // namespace

StartState perturbed_start(const Plan& plan, const std::optional<StartState>& start, std::uint64_t seed,
                           std::size_t threads) {
    SimScene scene = start ? scene_at(plan, *start) : plan.scene;
    const Executor executor(threads);
    const Fabric<double> fabric(scene);
    Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state(), change = noise_of(fabric, seed), gradient;
    energy.evaluate(state, gradient);
    energy.shorten(state, change);
    const std::size_t lost = lost_in(plan, fabric.control(state));
    // Samples do not see yarns that all but meet between them: the crossings themselves have the last word.
    for (double share = energy.safe_share(state, change, 1); share > 1e-3; share /= 2) {
        std::vector<double> moved = state;
        for (std::size_t i = 0; i < state.size(); ++i) moved[i] += share * change[i];
        StartState noisy{fabric.control(moved), scene.period_mm};
        if (lost_in(plan, noisy.control) <= lost) return noisy;
    }
    return {fabric.control(state), scene.period_mm};
}

Json relaxed_again(const Design& design, const Plan& plan, const SimulationOptions& options,
                   const Yarns& first, std::size_t runs, std::uint64_t seed) {
    const std::vector<Spline> own = splines_of(first);
    const bool may_drift = !holds_a_place(plan.scene);
    std::vector<Json> all{figures_of(first)};
    Json furthest{{"max_mm", 0.0}, {"max_radii", 0.0}, {"rms_mm", 0.0}};
    std::size_t elsewhere = 0;
    std::vector<StartState> starts;
    for (std::size_t k = 0; k < runs; ++k) starts.push_back(perturbed_start(plan, options.start, seed + k, options.threads));
    const std::vector<RelaxResult> at_once = come_to_rest_at_once(plan, options, starts);
    SimulationOptions again = options;
    again.flips.clear();
    again.coarser = nullptr;  // whose yarns would take the place of the start
    for (std::size_t k = 0; k < starts.size(); ++k) {
        again.start = std::move(starts[k]);
        if (!at_once.empty()) {
            again.most_iterations = options.most_iterations - std::min(options.most_iterations, at_once[k].iterations);
            again.most_seconds = options.most_seconds - at_once[k].seconds;
        }
        const Yarns yarns = simulate(design, plan, again);
        if (yarns.report.at("ending") == "stopped") break;
        const Deviation deviation = deviation_of(splines_of(yarns), own, may_drift);
        const double radii =
            first.yarns.empty() ? 0 : deviation.max_mm / first.yarns[deviation.yarn].radius_mm;
        all.push_back(figures_of(yarns));
        all.back()["max_radii"] = radii;
        elsewhere += radii > same_rest_radii ? 1 : 0;
        if (radii <= furthest["max_radii"].get<double>()) continue;
        furthest = {{"max_mm", deviation.max_mm}, {"max_radii", radii}, {"rms_mm", deviation.rms_mm}};
        furthest.update(yarn_json(first.yarns[deviation.yarn]));
    }
    Json json{{"runs", all.size() - 1},
              {"asked", runs},
              {"noise_radii", start_noise_radii},
              {"seed", seed},
              {"at_once", !at_once.empty()},
              {"elsewhere", elsewhere},
              {"not_at_rest", how_many_are_not(all, "converged")},
              {"order_lost", how_many_are_not(all, "order_kept")},
              {"furthest", furthest}};
    for (const char* name : {"warp_crimp", "weft_crimp", "thickness_mm", "energy_N_mm"})
        json[name] = spread_of(all, name);
    json["each"] = all;
    return json;
}

std::string starts_text(const Json& report) {
    const Json starts = part_of(report, "starts");
    const double runs = number_in(starts, "runs"), asked = number_in(starts, "asked");
    if (!(runs >= 1)) return "";
    const Json furthest = part_of(starts, "furthest");
    const double elsewhere = number_in(starts, "elsewhere"), radii = number_in(furthest, "max_radii");
    std::string text = counted(static_cast<std::size_t>(std::min(runs, 1e6)), "more relaxation") +
                       (asked > runs ? short_format(" (of %.0f asked for)", asked) : "") +
                       short_format(" from starts up to %g radii off", number_in(starts, "noise_radii"));
    if (elsewhere == 0) {
        text = "Not sensitive to its start: " + text +
               short_format(" came to the same place, to %.2g radii", radii);
    } else {
        text = "SENSITIVE to its start: of " + text + short_format(" %.0f ended elsewhere", elsewhere) +
               short_format(", by up to %.1f radii", radii) + yarn_words(furthest);
    }
    const auto spread = [&](const char* name, const char* words, double unit, const char* pattern) {
        const Json part = part_of(starts, name);
        if (!part.is_object()) return;
        text += words + short_format(pattern, unit * number_in(part, "least")) + " to " +
                short_format(pattern, unit * number_in(part, "most"));
    };
    spread("warp_crimp", "; crimp warp ", 100, "%.2f %%");
    spread("weft_crimp", ", weft ", 100, "%.2f %%");
    spread("thickness_mm", ", thickness ", 1, "%.3f mm");
    if (number_in(starts, "not_at_rest") > 0)
        text += short_format("; not at rest: %.0f of them", number_in(starts, "not_at_rest"));
    if (number_in(starts, "order_lost") > 0)
        text += short_format("; with lost crossings: %.0f", number_in(starts, "order_lost"));
    return text + "\n";
}

}  // namespace weave::sim
