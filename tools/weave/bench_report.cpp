// The results of `weave bench tradeoff` as tables.

#include "bench_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace weave::program {

namespace {

constexpr const char* dash = "–";
/// A reference that is nearer to its rest than this errs by nothing that counts.
constexpr double reference_rests = 1e-6;

std::string number(const Json& value, const char* format) {
    return value.is_number() ? in_words(format, value.get<double>()) : dash;
}

std::string seconds_text(double seconds) {
    return in_words(seconds < 0.1 ? "%.3f" : "%.2f", seconds);
}

std::string seconds_cell(const Json& seconds) {
    return seconds.is_number() ? seconds_text(seconds.get<double>()) : dash;
}

std::string given_up_after(const Json& run) {
    return "> " + in_words("%.0f", run.at("seconds").get<double>());
}

/// `12 s`, or `> 300 s` where it was given up then.
std::string seconds_to(const Json& run, double residual) {
    const Json& seconds = run.at("seconds_to").at(in_words("%.0e", residual));
    if (seconds.is_number()) return seconds_text(seconds.get<double>());
    return run.at("ending") == "converged" ? dash : given_up_after(run);
}

/// The errors of a run at the last residual up to its goal that it reached.
const Json* error_near_goal(const Json& run) {
    const Json* found = nullptr;
    for (const Json& error : run.at("errors")) {
        if (error.at("residual").get<double>() >= 0.99 * run.at("goal").get<double>()) found = &error;
    }
    return found;
}

std::string error_cell(const Json& run) {
    const Json* error = run.at("start") == "plan" ? error_at_goal(run) : error_near_goal(run);
    if (error == nullptr) return dash;
    return number(error->at("crimp_warp_pp"), "%+.3f") + " / " + number(error->at("crimp_weft_pp"), "%+.3f") +
           " / " + number(error->at("thickness_pc"), "%+.2f") + " / " +
           number(error->at("place_rms_radii"), "%.3f");
}

std::string paper_words(const Json& structure) {
    if (structure.at("sweep").empty())
        return "`standard` did not come as far as a draft, so no more than this was tried.";
    return "`paper` with a step of " + number(structure.at("paper_step"), "%g") + " and damping " +
           number(structure.at("paper_damping"), "%g") + ", the best of " +
           std::to_string(structure.at("sweep").size()) + " tried.";
}

std::string runs_table(const Json& structure) {
    std::string text =
        "\n### " + structure.at("name").get<std::string>() + "\n\n" + machine_line(structure.at("machine")) +
        ". `standard` has " + std::to_string(structure.at("standard_points").get<std::size_t>()) + " points" +
        (structure.at("paper_points").is_number() ? number(structure.at("paper_points"), " (the paper %.0f)")
                                                  : "") +
        ": " + number(structure.at("points_per_key"), "%.3g") + " a crossing. " + paper_words(structure) +
        "\n\n"
        "| Fidelity | Solver | Start | Points | s to 1e-1 | 1e-2 | 1e-3 | 1e-5 | 1e-8 | Steps "
        "| Memory, MB | Lost | "
        "Error at its goal: crimp warp / weft, pp; thickness, %; place, radii |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Json& run : structure.at("runs")) {
        text += "| " + run.at("fidelity").get<std::string>() + " | " + run.at("solver").get<std::string>() +
                " | " + run.at("start").get<std::string>() + " | " + number(run.at("points"), "%.0f");
        for (const double residual : told_residuals) text += " | " + seconds_to(run, residual);
        text += " | " + number(run.at("steps"), "%.0f") + " | " +
                in_words("%.0f", run.at("peak_bytes").get<double>() / 1e6) + " | " +
                number(run.at("lost_crossings"), "%.0f") + " | " + error_cell(run) + " |\n";
    }
    const Json &truth = structure.at("reference"), &basins = structure.at("basins");
    text += "\nReference: " + number(truth.at("points"), "%.0f") + " points, residual " +
            number(truth.at("residual"), "%.1e") + ", warp crimp " +
            number(truth.at("crimp_warp_pc"), "%.2f") + " %, weft crimp " +
            number(truth.at("crimp_weft_pc"), "%.2f") + " %, thickness " +
            number(truth.at("thickness_mm"), "%.3f") + " mm. ";
    if (!basins.at("comparable").get<bool>())
        return text + "The two solvers did not both come to rest, so their rests are not compared.\n";
    return text +
           (basins.at("same").get<bool>() ? "Both solvers end at the same rest"
                                          : "The solvers end at different rests") +
           ": `paper` against `relax`, crimp " + number(basins.at("crimp_warp_pp"), "%+.3f") + " / " +
           number(basins.at("crimp_weft_pp"), "%+.3f") + " pp, thickness " +
           number(basins.at("thickness_pc"), "%+.2f") + " %, places at most " +
           number(basins.at("place_max_radii"), "%.2g") + " radii apart.\n";
}

std::string ratio_row(const Json& structure) {
    std::string text = "| " + structure.at("name").get<std::string>() + " | " +
                       number(structure.at("standard_points"), "%.0f") + " | " +
                       number(structure.at("paper_gpu_s"), "%.2f");
    for (const char* residual : {"1e-02", "1e-03"}) {
        const Json& ratio = structure.at("ratios").at(residual);
        const bool bound = ratio.value("is_lower_bound", false);
        text += " | " + seconds_cell(ratio.at("relax_s")) + " | " + seconds_cell(ratio.at("paper_s")) +
                " | " + (bound ? "> " : "") + number(ratio.at("ratio"), "%.1f");
    }
    return text + " |\n";
}

// ---- all structures together

/// A number of some cloth.
struct Figure {
    double value = 0;
    std::string cloth;
};

/// Middle and greatest of some figures, and whose the greatest is.
std::string band(std::vector<Figure> figures, const char* format) {
    if (figures.empty()) return std::string(dash) + " | " + dash;
    std::ranges::sort(figures, {}, &Figure::value);
    const Figure& most = figures.back();
    return in_words(format, figures[figures.size() / 2].value) + " | " + in_words(format, most.value) + " (" +
           most.cloth + ")";
}

const Json* run_of(const Json& structure, const std::string& fidelity, const char* solver,
                   const char* start) {
    for (const Json& run : structure.at("runs")) {
        if (run.at("fidelity") == fidelity && run.at("solver") == solver && run.at("start") == start)
            return &run;
    }
    return nullptr;
}

/// What is told of one way of erring: the row's first words, and which errors of which run.
struct Way {
    const char* words;
    const char* start;
    bool to_its_end;
};
constexpr Way ways[]{{"points alone", "reference", false},
                     {"from the plan", "plan", false},
                     {"stopped at its goal", "plan", true}};

std::string way_row(const Json& structures, const std::string& fidelity, const Way& way) {
    std::vector<Figure> crimp, thickness, place;
    for (const Json& structure : structures) {
        const Json* run = run_of(structure, fidelity, "relax", way.start);
        const Json* error = run != nullptr && is_measured(structure) ? error_at_goal(*run) : nullptr;
        if (error == nullptr ||
            (way.to_its_end && run_of(structure, fidelity, "relax", "raw")->at("ending") != "converged"))
            continue;
        const Json& told = way.to_its_end ? error->at("to_its_end") : *error;
        const std::string name = structure.at("name");
        crimp.push_back({crimp_error(told), name});
        thickness.push_back({std::abs(told.at("thickness_pc").get<double>()), name});
        place.push_back({told.at("place_rms_radii"), name});
    }
    return "| " + fidelity + " | " + way.words + " | " + std::to_string(crimp.size()) + " | " +
           band(crimp, "%.3f") + " | " + band(thickness, "%.2f") + " | " + band(place, "%.3f") + " |\n";
}

double middle(std::vector<double> numbers) {
    std::ranges::sort(numbers);
    return numbers.empty() ? 0 : numbers[numbers.size() / 2];
}

/// What the finer of two fidelities costs and gains on the middle cloth.
std::string step_words(const Json& structures, const char* coarse, const char* fine) {
    std::vector<double> seconds, errors;
    for (const Json& structure : structures) {
        if (!is_measured(structure)) continue;
        const auto error = [&](const char* fidelity, const char* start) {
            const Json* run = run_of(structure, fidelity, "relax", start);
            return run != nullptr ? error_at_goal(*run) : nullptr;
        };
        const Json *from = error(coarse, "plan"), *to = error(fine, "plan");
        const Json *more = error(coarse, "reference"), *less = error(fine, "reference");
        if (from == nullptr || to == nullptr || more == nullptr || less == nullptr) continue;
        seconds.push_back(to->at("seconds").get<double>() / from->at("seconds").get<double>());
        errors.push_back(crimp_error(*more) / crimp_error(*less));
    }
    return std::string("`") + fine + "` takes " + in_words("%.1f", middle(std::move(seconds))) +
           " times as long as `" + coarse + "`, and its points err " +
           in_words("%.1f", middle(std::move(errors))) + " times less";
}

std::string errors_summary(const Json& structures) {
    std::string text =
        "\n## How far each fidelity errs, all cloths together\n\n"
        "Middle and greatest of the cloths whose reference came to rest, at the fidelity's own goal, "
        "`relax`. *Points alone*: "
        "gone on from the reference's rest. *From the\nplan*: what the same points come to from the plan, another rest included. "
        "*Stopped at its goal*: "
        "against where its yarns end at 1e-8. Crimp: the greater error of warp and weft; place: root "
        "mean square.\n\n"
        "| Fidelity | Error of | Cloths | Crimp, pp: middle | most | Thickness, %: middle | most | Place, "
        "radii: middle | most |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const char* fidelity : fidelities) {
        for (const Way& way : ways) text += way_row(structures, fidelity, way);
    }
    return text + "\nOn the middle cloth " + step_words(structures, "draft", "standard") + "; " +
           step_words(structures, "standard", "reference") + ".\n";
}

/// Seconds from the plan to the goal, and the error of its points alone.
std::string cost_cell(const Json& structure, const char* fidelity) {
    const Json *raw = run_of(structure, fidelity, "relax", "plan"),
               *same = run_of(structure, fidelity, "relax", "reference");
    const Json* error = is_measured(structure) && same != nullptr ? error_at_goal(*same) : nullptr;
    const Json* reached = error_at_goal(*raw);
    return (reached != nullptr ? seconds_cell(reached->at("seconds")) : given_up_after(*raw)) + " | " +
           (error == nullptr ? dash : in_words("%.3f", crimp_error(*error)));
}

std::string costs_summary(const Json& structures) {
    std::string text =
        "\n## What each cloth costs\n\n"
        "`relax` from the plan to the fidelity's own goal, and the crimp error of the points alone, in "
        "percentage points.\n\n"
        "| Cloth | Points of standard | draft, s | pp | standard, s | pp | reference, s | pp | Residual of "
        "its reference |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const Json& structure : structures) {
        text += "| " + structure.at("name").get<std::string>() + " | " +
                number(structure.at("standard_points"), "%.0f");
        for (const char* fidelity : fidelities) text += " | " + cost_cell(structure, fidelity);
        text += " | " + number(structure.at("reference").at("residual"), "%.0e") +
                (is_measured(structure) ? "" : ": not at rest") + " |\n";
    }
    return text;
}

}  // namespace

bool is_measured(const Json& structure) {
    return structure.at("reference").at("residual").get<double>() <= reference_rests;
}

const Json* error_at_goal(const Json& run) {
    if (run.at("start") == "plan") return run.at("ending") == "converged" ? &run.at("end") : nullptr;
    for (const Json& error : run.at("errors")) {
        if (error.at("residual") == run.at("goal")) return &error;
    }
    return nullptr;
}

double crimp_error(const Json& error) {
    return std::max(std::abs(error.at("crimp_warp_pp").get<double>()),
                    std::abs(error.at("crimp_weft_pp").get<double>()));
}

std::string tradeoff_table(const Json& structures) {
    std::string text =
        "# Speed against accuracy of the simulator\n\n"
        "Written by `weave bench tradeoff -o FOLDER`, with the plots `tradeoff.svg` and "
        "`tradeoff-thickness.svg` and all numbers in "
        "`tradeoff-NAME.json`. Times are\n"
        "seconds until a residual was first reached, looking not counted, of the processor where one thread "
        "computed; `>` marks the cap at which a run was ended. Errors are against\n"
        "a reference with four times the points and samples of `standard`, gone on from `standard` at rest. "
        "Structures of the paper's Table 1\n"
        "have about its numbers of points, not those that `weave simulate` lays by itself. "
        "A start `plan` is from the plan, another basin included: to its own goal, where `relax` leaves a saddle; `raw` the same on to "
        "1e-8, where it looks "
        "only at the end; a start `reference` goes on from the reference's rest, so that only "
        "the discretisation errs.\n" +
        errors_summary(structures) + costs_summary(structures) +
        "\n"
        "## `relax` against `paper`, `standard`, in the same run\n\n"
        "| Structure | Points | Paper's GPU, s | relax to 1e-2, s | paper, s | ratio | relax to 1e-3, s | "
        "paper, s | ratio |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const Json& structure : structures) text += ratio_row(structure);
    text += "\n## Every run\n";
    for (const Json& structure : structures) text += runs_table(structure);
    return text;
}

}  // namespace weave::program
