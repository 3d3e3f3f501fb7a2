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
    const Json* error = is_as_asked(run) ? error_at_goal(run) : error_near_goal(run);
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
        ". `standard` has " + std::to_string(structure.at("standard_points").get<std::size_t>()) + " points. " + paper_words(structure) +
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
                       number(structure.at("standard_points"), "%.0f");
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

/// The middle one; of an even number the mean of both that are.
double median(std::vector<double> numbers) {
    if (numbers.empty()) return 0;
    std::ranges::sort(numbers);
    const std::size_t half = numbers.size() / 2;
    return numbers.size() % 2 != 0 ? numbers[half] : (numbers[half - 1] + numbers[half]) / 2;
}

/// Median and greatest of some figures, and whose the greatest is.
std::string band(const std::vector<Figure>& figures, const char* format) {
    if (figures.empty()) return std::string(dash) + " | " + dash;
    std::vector<double> values;
    for (const Figure& figure : figures) values.push_back(figure.value);
    const Figure& most = *std::ranges::max_element(figures, {}, &Figure::value);
    return in_words(format, median(std::move(values))) + " | " + in_words(format, most.value) + " (" + most.cloth + ")";
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
    bool to_its_end = false;
};

/// A reference goes on from `standard` as one gets it, so what it comes to from the plan is told besides; what its goal
/// leaves is nothing.
std::vector<Way> ways_of(const std::string& fidelity) {
    std::vector<Way> ways{{"points alone", "reference"}, {"as one gets it", asked_start(fidelity)}};
    ways.push_back(fidelity == "reference" ? Way{"from the plan", "raw"} : Way{"stopped at its goal", "plan", true});
    return ways;
}

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

/// What the finer of two fidelities costs and gains.
std::string step_words(const Json& structures, const char* coarse, const char* fine) {
    std::vector<double> seconds, errors;
    for (const Json& structure : structures) {
        if (!is_measured(structure)) continue;
        const auto error = [&](const char* fidelity, const char* start) {
            const Json* run = run_of(structure, fidelity, "relax", start);
            return run != nullptr ? error_at_goal(*run) : nullptr;
        };
        const Json *from = error(coarse, asked_start(coarse)), *to = error(fine, asked_start(fine));
        const Json *more = error(coarse, "reference"), *less = error(fine, "reference");
        if (from == nullptr || to == nullptr || more == nullptr || less == nullptr) continue;
        seconds.push_back(to->at("seconds").get<double>() / from->at("seconds").get<double>());
        errors.push_back(crimp_error(*more) / crimp_error(*less));
    }
    return std::string("`") + fine + "` takes " + in_words("%.1f", median(std::move(seconds))) +
           " times as long as `" + coarse + "`, and its points err " +
           in_words("%.1f", median(std::move(errors))) + " times less";
}

std::string errors_summary(const Json& structures) {
    std::string text =
        "\n## How far each fidelity errs, all cloths together\n\n"
        "Median and greatest of the cloths whose reference came to rest, at the fidelity's own goal, `relax`. "
        "*As one gets it*: what `weave simulate` gives, another rest included: from the plan, a reference from `standard`. "
        "*Points alone*: gone on from the rest that errors are measured against.\n"
        "*Stopped at its goal*: against where its yarns end at 1e-8. *From the plan*: a reference that does not begin at "
        "`standard`. Crimp: the greater error of warp and weft; place: root mean square.\n"
        "What errors are measured against went on from `standard` itself, so another rest is told of the other two alone.\n\n"
        "| Fidelity | Error of | Cloths | Crimp, pp: median | most | Thickness, %: median | most | Place, "
        "radii: median | most |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const char* fidelity : fidelities) {
        for (const Way& way : ways_of(fidelity)) text += way_row(structures, fidelity, way);
    }
    return text + "\nIn the median over these cloths " + step_words(structures, "draft", "standard") + "; " +
           step_words(structures, "standard", "reference") + ".\n";
}

/// Seconds until one has it, and the error of its points alone.
std::string cost_cell(const Json& structure, const char* fidelity) {
    const Json *asked = run_of(structure, fidelity, "relax", asked_start(fidelity)),
               *same = run_of(structure, fidelity, "relax", "reference");
    const Json* error = is_measured(structure) && same != nullptr ? error_at_goal(*same) : nullptr;
    const Json* reached = error_at_goal(*asked);
    return (reached != nullptr ? seconds_cell(reached->at("seconds")) : given_up_after(*asked)) + " | " +
           (error == nullptr ? dash : in_words("%.3f", crimp_error(*error)));
}

std::string costs_summary(const Json& structures) {
    std::string text =
        "\n## What each cloth costs\n\n"
        "`relax` until the fidelity's own goal, of a reference with the seconds of the `standard` that it begins at, and the "
        "crimp error of the points alone, in percentage points.\n\n"
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

bool is_as_asked(const Json& run) {
    return run.at("start") == asked_start(run.at("fidelity").get<std::string>());
}

const Json* error_at_goal(const Json& run) {
    if (is_as_asked(run)) return run.at("ending") == "converged" ? &run.at("end") : nullptr;
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
        "Cloths are laid as `weave simulate` lays them, as their smallest repeat.\n"
        "A start `plan` is from the plan to the fidelity's own goal, where `relax` leaves a saddle; `standard` from where "
        "that came to, as a reference begins; `raw` from the plan on to 1e-8, where it looks only at the end; a start "
        "`reference` goes on from the reference's rest, so that only the discretisation errs.\n" +
        errors_summary(structures) + costs_summary(structures) +
        "\n"
        "## `relax` against `paper`, `standard`, in the same run\n\n"
        "| Structure | Points | relax to 1e-2, s | paper, s | ratio | relax to 1e-3, s | paper, s | ratio |\n"
        "|---|---|---|---|---|---|---|---|\n";
    for (const Json& structure : structures) text += ratio_row(structure);
    text += "\n## Every run\n";
    for (const Json& structure : structures) text += runs_table(structure);
    return text;
}

}  // namespace weave::program
