// How time and memory grow with the cloth.

#include "bench_scale.hpp"

#include "interrupt.hpp"

#include <weave/block/operations.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>

#include <algorithm>
#include <cmath>

namespace weave::program {

namespace {

/// Moves every free control point by up to `size` in each direction, always the same way.
void add_noise(sim::SimScene& scene, double size) {
    std::uint64_t number = 1;
    for (sim::SimYarn& yarn : scene.yarns) {
        for (std::size_t i = 0; i < yarn.control.size(); ++i) {
            for (Eigen::Index k = 0; k < 3; ++k) {
                number = number * 6364136223846793005U + 1442695040888963407U;
                const double share =
                    static_cast<double>(number >> 11) / static_cast<double>(std::uint64_t{1} << 52) - 1;
                if (yarn.frozen.empty() || yarn.frozen[i] == 0) yarn.control[i][k] += size * share;
            }
        }
    }
}

/// So many cells side by side, unreduced.
Result<sim::Plan> plan_of(const Design& design, const Block& cell, std::size_t x, std::size_t y) {
    WEAVE_TRY(const Block cloth, tile(cell, x, y, 1));
    sim::SimulationRequest request;
    request.reduce = false;
    return sim::make_plan(design, cloth, request);
}

/// Slope of log y over log x by least squares; null with fewer than three sizes.
Json exponent(const Json& sizes, const char* of) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Json& size : sizes) {
        const double x = std::log(size.at("points").get<double>()), y = std::log(size.at(of).get<double>());
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    const double spread = n * sxx - sx * sx;
    return n >= 3 && spread > 0 ? Json((n * sxy - sx * sy) / spread) : Json();
}

Json size_json(const Measured& run, double residual, double plan_seconds) {
    Json json = run.json();
    const auto points = static_cast<double>(run.points);
    json["plan_seconds"] = plan_seconds;
    json["us_a_point"] = 1e6 * run.result.seconds / points;
    json["bytes_a_point"] = static_cast<double>(run.peak_bytes) / points;
    json["converged"] = run.result.ending == sim::Ending::converged;
    json["goal"] = residual;
    return json;
}

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A cloth of so many cells, as near to the points wanted as whole cells come.
struct Cells {
    std::size_t wanted_points, x, y;
};

/// From the least to the most, each √10 times the one before; none twice.
std::vector<Cells> cells_of(const ScaleOptions& scale, std::size_t cell_points) {
    std::vector<Cells> all;
    for (double wanted = static_cast<double>(scale.least); wanted <= 1.01 * static_cast<double>(scale.most);
         wanted *= std::sqrt(10.0)) {
        const auto cells =
            static_cast<std::size_t>(std::max(1.0, std::round(wanted / static_cast<double>(cell_points))));
        const auto x =
            static_cast<std::size_t>(std::max(1.0, std::round(std::sqrt(static_cast<double>(cells)))));
        const std::size_t y = std::max<std::size_t>(1, cells / x);
        if (all.empty() || x * y != all.back().x * all.back().y)
            all.push_back({static_cast<std::size_t>(std::round(wanted)), x, y});
    }
    return all;
}

Result<Json> measure_size(const Design& design, const Block& cell, const Cells& cells,
                          const BenchOptions& options, double residual) {
    tell("scale: some " + std::to_string(cells.wanted_points) + " points");
    const double began = now();
    WEAVE_TRY(sim::Plan plan, plan_of(design, cell, cells.x, cells.y));
    add_noise(plan.scene, 0.05 * plan.scene.yarns.front().radius_mm);
    const double planned = now() - began;
    const Measured run = measure(plan, sim::Solver::relax, {}, {residual, options.seconds, options.threads});
    Json size = size_json(run, residual, planned);
    size["wanted_points"] = cells.wanted_points;
    size["lost_crossings"] = shape_of(plan, run.control).lost;
    tell("scale: " + in_words("%.0f points: ", static_cast<double>(run.points)) +
         in_words("%.2f s, ", run.result.seconds) + in_words("residual %.1e", run.result.residual));
    return size;
}

}  // namespace

Result<Json> measure_scale(const BenchOptions& options, const ScaleOptions& scale) {
    const Design design = find_sample("satin-e")->make();
    WEAVE_TRY(const Evaluation evaluation, evaluate(design));
    WEAVE_TRY(const sim::Plan cell, plan_of(design, *evaluation.block, 1, 1));
    const std::size_t cell_points = points_of(cell.scene);
    if (scale.most < cell_points)
        return Error{ErrorCode::usage,
                     "the smallest cloth, one repeat, has " + std::to_string(cell_points) + " points",
                     "--most " + std::to_string(scale.most)};
    const std::vector<Cells> all = cells_of(scale, cell_points);
    Json sizes = Json::array(), asked = Json::array();
    for (const Cells& cells : all) asked.push_back(cells.wanted_points);
    for (const Cells& cells : all) {
        WEAVE_TRY(Json size, measure_size(design, *evaluation.block, cells, options, scale.residual));
        if (interrupted()) break;
        const bool converged = size.at("converged").get<bool>();
        sizes.push_back(std::move(size));
        if (!converged) break;
    }
    Json rested = Json::array();
    for (const Json& size : sizes) {
        if (size.at("converged").get<bool>()) rested.push_back(size);
    }
    return Json{{"machine", machine_json(options.threads)},
                {"structure", "satin-e, two layers, tiled, unreduced, noise 0.05 radius"},
                {"goal", scale.residual},
                {"cell_points", cell_points},
                {"asked_points", asked},
                {"sizes", sizes},
                {"exponent_time", exponent(rested, "seconds")},
                {"exponent_memory", exponent(rested, "peak_bytes")},
                {"exponent_steps", exponent(rested, "steps")}};
}

std::string scale_table(const Json& result) {
    std::string text = "# How time and memory grow\n\nWritten by `weave bench scale`. " +
                       machine_line(result.at("machine")) + ". " + result.at("structure").get<std::string>() +
                       ", `relax` to " + in_words("%.0e", result.at("goal")) + ".\n\n" +
                       "| Points | At rest | s | µs a point | Steps | CG steps | Evaluations | Memory, MB | "
                       "Bytes a point | Lost |\n"
                       "|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Json& size : result.at("sizes"))
        text += "| " + in_words("%.0f", size.at("points")) + " | " +
                (size.at("converged").get<bool>() ? "yes" : "no") + " | " +
                in_words("%.2f", size.at("seconds")) + " | " + in_words("%.0f", size.at("us_a_point")) +
                " | " + in_words("%.0f", size.at("steps")) + " | " + in_words("%.0f", size.at("cg_steps")) +
                " | " + in_words("%.0f", size.at("evaluations")) + " | " +
                in_words("%.0f", size.at("peak_bytes").get<double>() / 1e6) + " | " +
                in_words("%.0f", size.at("bytes_a_point")) + " | " +
                in_words("%.0f", size.at("lost_crossings")) + " |\n";
    const Json &asked = result.at("asked_points"), &sizes = result.at("sizes");
    if (asked.front() < result.at("cell_points"))
        text += "\nThe smallest cloth, one repeat, has " + in_words("%.0f", result.at("cell_points")) +
                " points: it stands for the " + in_words("%.0f", asked.front()) + " asked for.\n";
    if (!sizes.empty() && !sizes.back().at("converged").get<bool>())
        text +=
            "\nThe last did not come to rest in its time, so larger ones were not tried and it is left out "
            "of what follows.\n";
    if (result.at("exponent_time").is_number())
        text += "\nTime grows as n^" + in_words("%.2f", result.at("exponent_time")) + ", memory as n^" +
                in_words("%.2f", result.at("exponent_memory")) + ", steps as n^" +
                in_words("%.2f", result.at("exponent_steps")) + ".\n";
    return text;
}

}  // namespace weave::program
