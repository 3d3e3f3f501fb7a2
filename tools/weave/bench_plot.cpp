// The results of `weave bench tradeoff` as a plot: small panels, one a structure, all with the same axes.

#include "bench_tradeoff.hpp"

#include <weave/picture/canvas.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace weave::program {

namespace {

constexpr std::size_t panels_a_row = 4;
constexpr double panel_width = 250, panel_height = 200, left = 40, right = 10, top = 38, below = 26;
constexpr double least_seconds = 1e-3, most_seconds = 1e2, least_error = 1e-3, most_error = 1e2;
constexpr Colour grid{0xdd, 0xdd, 0xdd}, faint{0x77, 0x77, 0x77};

Colour colour_of(const std::string& solver) {
    return solver == "paper" ? Colour{0xd5, 0x5e, 0x00} : Colour{0x00, 0x5a, 0xb5};
}

struct Panel {
    double x = 0, y = 0;

    [[nodiscard]] Point at(double seconds, double error) const {
        const double across = share(seconds, least_seconds, most_seconds),
                     up = share(error, least_error, most_error);
        return {x + left + across * (panel_width - left - right),
                y + panel_height - below - up * (panel_height - top - below)};
    }

  private:
    static double share(double value, double least, double most) {
        return std::log(std::clamp(value, least, most) / least) / std::log(most / least);
    }
};

double plotted_error(const Json& error, PlottedError plotted) {
    return plotted == PlottedError::crimp ? crimp_error(error)
                                          : std::abs(error.at("thickness_pc").get<double>());
}

void draw_axes(Canvas& canvas, const Panel& panel) {
    for (double seconds = least_seconds; seconds <= 1.01 * most_seconds; seconds *= 10) {
        const Point ends[]{panel.at(seconds, least_error), panel.at(seconds, most_error)};
        canvas.lines(ends, {.colour = grid, .width = 0.7});
        canvas.text({ends[0].x, ends[0].y + 14}, in_words("%g", seconds),
                    {.size = 10, .anchor = Anchor::middle});
    }
    for (double error = least_error; error <= 1.01 * most_error; error *= 10) {
        const Point ends[]{panel.at(least_seconds, error), panel.at(most_seconds, error)};
        canvas.lines(ends, {.colour = grid, .width = 0.7});
        canvas.text({ends[0].x - 5, ends[0].y}, in_words("%g", error),
                    {.size = 10, .anchor = Anchor::end, .centred = true});
    }
}

/// A circle, a square or a triangle, full or hollow.
void draw_mark(Canvas& canvas, const Point& at, const std::string& fidelity, Colour colour, bool full) {
    const double size = 4.2;
    const Colour inside = full ? colour : Colour{0xff, 0xff, 0xff};
    if (fidelity == "draft") {
        canvas.circle(at, size, inside);
        canvas.ring(at, size, {.colour = colour, .width = 1.4});
        return;
    }
    std::vector<Point> corners{{at.x - size, at.y - size},
                               {at.x + size, at.y - size},
                               {at.x + size, at.y + size},
                               {at.x - size, at.y + size}};
    if (fidelity == "reference")
        corners = {{at.x, at.y - 1.3 * size},
                   {at.x + 1.2 * size, at.y + 0.9 * size},
                   {at.x - 1.2 * size, at.y + 0.9 * size}};
    canvas.polygon(corners, inside);
    corners.push_back(corners.front());
    canvas.polyline(corners, {.colour = colour, .width = 1.4});
}

const Json* run_of(const Json& structure, const char* fidelity, const std::string& solver,
                   const char* start) {
    for (const Json& run : structure.at("runs")) {
        if (run.at("fidelity") == fidelity && run.at("solver") == solver && run.at("start") == start)
            return &run;
    }
    return nullptr;
}

/// The run to a fidelity's own goal: `paper` looks for no saddle, so it is the one on to 1e-8 as far as that
/// goal.
const char* start_of(const std::string& solver, const char* fidelity) {
    return solver == "relax" ? asked_start(fidelity) : "raw";
}

/// Where one solver comes to from the plan, fidelity after fidelity; and, hollow below or above, what the
/// points alone cost.
void draw_solver(Canvas& canvas, const Panel& panel, const Json& structure, const std::string& solver,
                 PlottedError plotted) {
    const Colour colour = colour_of(solver);
    std::vector<std::pair<std::string, Point>> reached;
    std::vector<Point> way;
    for (const char* fidelity : fidelities) {
        const Json* run = run_of(structure, fidelity, solver, start_of(solver, fidelity));
        const Json* error = run != nullptr ? error_at_goal(*run) : nullptr;
        if (error == nullptr) continue;
        const double seconds = error->at("seconds");
        way.push_back(panel.at(seconds, plotted_error(*error, plotted)));
        reached.emplace_back(fidelity, way.back());
        const Json* same = run_of(structure, fidelity, solver, "reference");
        const Json* alone = same != nullptr ? error_at_goal(*same) : nullptr;
        if (alone == nullptr) continue;
        const Point hollow = panel.at(seconds, plotted_error(*alone, plotted));
        const Point line[]{way.back(), hollow};
        canvas.lines(line, {.colour = colour, .width = 1, .alpha = 0.6, .dash = {2, 2}});
        draw_mark(canvas, hollow, fidelity, colour, false);
    }
    if (way.size() > 1) canvas.polyline(way, {.colour = colour, .width = 1, .alpha = 0.45});
    for (const auto& [fidelity, place] : reached) draw_mark(canvas, place, fidelity, colour, true);
}

/// What did not come to rest in its time, in words.
std::string not_reached(const Json& structure) {
    std::string words;
    for (const char* solver : {"relax", "paper"}) {
        std::string missing;
        for (const char* fidelity : fidelities) {
            const Json* run = run_of(structure, fidelity, solver, start_of(solver, fidelity));
            if (run != nullptr && error_at_goal(*run) == nullptr)
                missing += (missing.empty() ? "" : ", ") + std::string(fidelity);
        }
        if (!missing.empty()) words += (words.empty() ? "" : "; ") + std::string(solver) + " " + missing;
    }
    return words.empty() ? words : "no rest: " + words;
}

void draw_structure(Canvas& canvas, const Panel& panel, const Json& structure, PlottedError plotted) {
    canvas.text({panel.x + left, panel.y + 16}, structure.at("name").get<std::string>(),
                {.size = 12, .bold = true});
    canvas.text({panel.x + left, panel.y + 30}, not_reached(structure), {.size = 9.5, .colour = faint});
    draw_axes(canvas, panel);
    for (const char* solver : {"paper", "relax"}) draw_solver(canvas, panel, structure, solver, plotted);
}

void draw_key(Canvas& canvas, const Panel& panel, PlottedError plotted) {
    const double x = panel.x + left;
    double y = panel.y + 18;
    for (const char* line : {"across: seconds to the fidelity's goal",
                             plotted == PlottedError::crimp ? "up: error of crimp, percentage points"
                                                            : "up: error of thickness, %",
                             "full: what one gets", "hollow: from the reference's rest,",
                             "what its points alone cost"}) {
        canvas.text({x, y}, line, {.size = 11});
        y += 15;
    }
    y += 6;
    for (const char* solver : {"relax", "paper"}) {
        double across = x;
        for (const char* fidelity : fidelities) {
            draw_mark(canvas, {across + 5, y}, fidelity, colour_of(solver), true);
            canvas.text({across + 13, y}, fidelity, {.size = 10.5, .centred = true});
            across += fidelity == std::string("draft") ? 50 : 72;
        }
        canvas.text({x, y + 16}, solver,
                    {.size = 11, .colour = colour_of(solver), .bold = true, .centred = true});
        y += 36;
    }
}

}  // namespace

Result<std::string> tradeoff_plot(const Json& structures, PlottedError plotted) {
    std::vector<const Json*> drawn;  // of the others there is no error to draw
    for (const Json& structure : structures) {
        if (is_measured(structure)) drawn.push_back(&structure);
    }
    const std::size_t panels = drawn.size() + 1, rows = (panels + panels_a_row - 1) / panels_a_row;
    WEAVE_TRY(Canvas canvas, Canvas::make(PictureFormat::svg, panels_a_row * panel_width,
                                          static_cast<double>(rows) * panel_height));
    const auto place = [](std::size_t k) {
        return Panel{static_cast<double>(k % panels_a_row) * panel_width,
                     static_cast<double>(k / panels_a_row) * panel_height};
    };
    for (std::size_t k = 0; k < drawn.size(); ++k) draw_structure(canvas, place(k), *drawn[k], plotted);
    draw_key(canvas, place(drawn.size()), plotted);
    return std::move(canvas).finish();
}

}  // namespace weave::program
