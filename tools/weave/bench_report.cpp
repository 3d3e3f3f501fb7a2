// The results of `weave bench tradeoff` as a table and as a plot.

#include "bench_tradeoff.hpp"

#include <weave/picture/canvas.hpp>

#include <algorithm>
#include <cmath>

namespace weave::program {

namespace {

constexpr const char* dash = "–";

std::string number(const Json& value, const char* format) {
    return value.is_number() ? in_words(format, value.get<double>()) : dash;
}

/// `12 s`, or `> 300 s` where it was given up then.
std::string seconds_to(const Json& run, double residual) {
    const Json& seconds = run.at("seconds_to").at(in_words("%.0e", residual));
    if (seconds.is_number()) return in_words("%.2f", seconds.get<double>());
    return "> " + in_words("%.0f", run.at("seconds").get<double>());
}

/// The errors of a run at the last residual up to its goal that it reached.
const Json* error_at_goal(const Json& run) {
    const Json* found = nullptr;
    for (const Json& error : run.at("errors")) {
        if (error.at("residual").get<double>() >= 0.99 * run.at("goal").get<double>()) found = &error;
    }
    return found;
}

std::string error_cell(const Json& run) {
    const Json* error = error_at_goal(run);
    if (error == nullptr) return dash;
    return number(error->at("crimp_warp_pp"), "%+.3f") + " / " + number(error->at("crimp_weft_pp"), "%+.3f") +
           " / " + number(error->at("thickness_pc"), "%+.2f") + " / " +
           number(error->at("place_rms_radii"), "%.3f");
}

std::string runs_table(const Json& structure) {
    std::string text = "\n## " + structure.at("name").get<std::string>() +
                       "\n\n" + machine_line(structure.at("machine")) + ". `standard` has " +
                       std::to_string(structure.at("standard_points").get<std::size_t>()) +
                       " points (the paper " + number(structure.at("paper_points"), "%.0f") +
                       "): " + number(structure.at("points_per_key"), "%.3g") +
                       " a crossing. `paper` with a step of " + number(structure.at("paper_step"), "%g") +
                       " and damping " + number(structure.at("paper_damping"), "%g") + ", the best of " +
                       std::to_string(structure.at("sweep").size()) +
                       " tried.\n\n"
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
        text += " | " + number(ratio.at("relax_s"), "%.2f") + " | " + number(ratio.at("paper_s"), "%.2f") +
                " | " + (bound ? "> " : "") + number(ratio.at("ratio"), "%.1f");
    }
    return text + " |\n";
}

// ---- the plot

constexpr double panel_width = 330, panel_height = 240, margin = 46;
constexpr std::size_t panels_a_row = 3;
constexpr double least_time = 1e-2, most_time = 1e3, least_error = 1e-3, most_error = 1e2;

struct Panel {
    double x, y;

    [[nodiscard]] Point at(double seconds, double error) const {
        const double time = std::log(std::clamp(seconds, least_time, most_time) / least_time) /
                            std::log(most_time / least_time);
        const double size = std::log(std::clamp(error, least_error, most_error) / least_error) /
                            std::log(most_error / least_error);
        return {x + margin + time * (panel_width - margin - 14),
                y + panel_height - 34 - size * (panel_height - 64)};
    }
};

struct Look {
    Colour colour;
    std::vector<double> dash;
    double width;
};

Look look_of(const Json& run) {
    const bool paper = run.at("solver") == "paper";
    const std::string fidelity = run.at("fidelity");
    return {paper ? Colour{0xd9, 0x6c, 0x1a} : Colour{0x1f, 0x5f, 0xa8},
            fidelity == "draft"      ? std::vector<double>{2, 3}
            : fidelity == "standard" ? std::vector<double>{}
                                     : std::vector<double>{7, 3},
            fidelity == "standard" ? 2.0 : 1.3};
}

void draw_axes(Canvas& canvas, const Panel& panel, const std::string& title) {
    const Colour grey{0xd8, 0xd8, 0xd8};
    for (double seconds = least_time; seconds <= 1.01 * most_time; seconds *= 10) {
        const Point ends[]{panel.at(seconds, least_error), panel.at(seconds, most_error)};
        canvas.lines(ends, {.colour = grey, .width = 0.7});
        canvas.text({ends[0].x, ends[0].y + 13}, in_words("%g", seconds),
                    {.size = 9, .anchor = Anchor::middle});
    }
    for (double error = least_error; error <= 1.01 * most_error; error *= 10) {
        const Point ends[]{panel.at(least_time, error), panel.at(most_time, error)};
        canvas.lines(ends, {.colour = grey, .width = 0.7});
        canvas.text({ends[0].x - 5, ends[0].y}, in_words("%g", error),
                    {.size = 9, .anchor = Anchor::end, .centred = true});
    }
    canvas.text({panel.x + margin, panel.y + 18}, title, {.size = 12, .bold = true});
}

/// The greater of both crimp errors, at each residual that was reached.
void draw_run(Canvas& canvas, const Panel& panel, const Json& run) {
    const Look look = look_of(run);
    std::vector<Point> points;
    for (const Json& error : run.at("errors"))
        points.push_back(
            panel.at(error.at("seconds"), std::max(std::abs(error.at("crimp_warp_pp").get<double>()),
                                                   std::abs(error.at("crimp_weft_pp").get<double>()))));
    if (points.size() > 1)
        canvas.polyline(points, {.colour = look.colour, .width = look.width, .dash = look.dash});
    for (const Point& point : points) canvas.circle(point, 2.2, look.colour);
}

void draw_key(Canvas& canvas, const Panel& panel) {
    double y = panel.y + 56;
    for (const char* line : {"up: error of the crimp, percentage points", "across: seconds",
                             "dots: residual 1e-1, 1e-2, 1e-3, 1e-5, 1e-8"}) {
        canvas.text({panel.x + margin, y - 32}, line, {.size = 10});
        y += 14;
    }
    y -= 28;
    for (const char* solver : {"relax", "paper"}) {
        for (const char* fidelity : {"draft", "standard", "reference"}) {
            y += 18;
            const Look look = look_of({{"solver", solver}, {"fidelity", fidelity}});
            const Point line[]{{panel.x + margin, y}, {panel.x + margin + 40, y}};
            canvas.polyline(line, {.colour = look.colour, .width = look.width, .dash = look.dash});
            canvas.text({panel.x + margin + 50, y}, std::string(solver) + ", " + fidelity,
                        {.size = 10, .centred = true});
        }
    }
}

}  // namespace

std::string tradeoff_table(const Json& structures) {
    std::string text =
        "# Speed against accuracy of the simulator\n\n"
        "Written by `weave bench tradeoff -o FOLDER`, with the plot `tradeoff.svg` and all numbers in "
        "`tradeoff-NAME.json`. Times are\n"
        "seconds until a residual was first reached, looking not counted; `>` marks the cap at which a run "
        "was ended. Errors are against\n"
        "a reference with four times the points and samples of `standard`, gone on from `standard` at rest. "
        "A start `raw` is what a user\n"
        "gets, another basin included; a start `reference` goes on from the reference's rest, so that only "
        "the discretisation errs.\n\n"
        "## `relax` against `paper`, `standard`, in the same run\n\n"
        "| Structure | Points | Paper's GPU, s | relax to 1e-2, s | paper, s | ratio | relax to 1e-3, s | "
        "paper, s | ratio |\n"
        "|---|---|---|---|---|---|---|---|---|\n";
    for (const Json& structure : structures) text += ratio_row(structure);
    for (const Json& structure : structures) text += runs_table(structure);
    return text;
}

Result<std::string> tradeoff_plot(const Json& structures) {
    const std::size_t panels = structures.size() + 1, rows = (panels + panels_a_row - 1) / panels_a_row;
    WEAVE_TRY(Canvas canvas, Canvas::make(PictureFormat::svg, panels_a_row * panel_width,
                                          static_cast<double>(rows) * panel_height));
    const auto place = [](std::size_t k) {
        return Panel{static_cast<double>(k % panels_a_row) * panel_width,
                     static_cast<double>(k / panels_a_row) * panel_height};
    };
    for (std::size_t k = 0; k < structures.size(); ++k) {
        const Json& structure = structures.at(k);
        draw_axes(canvas, place(k),
                  structure.at("name").get<std::string>() + ", " +
                      number(structure.at("standard_points"), "%.0f") + " points");
        for (const Json& run : structure.at("runs")) {
            if (run.at("start") == "raw") draw_run(canvas, place(k), run);
        }
    }
    draw_key(canvas, place(structures.size()));
    return std::move(canvas).finish();
}

}  // namespace weave::program
