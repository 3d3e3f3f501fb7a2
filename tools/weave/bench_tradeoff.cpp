// Speed against accuracy: every solver and fidelity on one structure, against a reference on the same branch.

#include "bench_tradeoff.hpp"

#include "interrupt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave::program {

namespace {

/// A discretisation: points and samples as shares of those of `standard`.
struct Grade {
    const char* name;
    double points, spacing, goal;
};
constexpr Grade grades[]{
    {"draft", 0.5, 0.25, 1e-2}, {"standard", 1, 0.25, 1e-3}, {"reference", 2, 0.125, 1e-8}};
/// Four times the points of `standard`, and four times its samples.
constexpr Grade truth{"truth", 4, 0.0625, 1e-8};
constexpr std::size_t truth_times = 4;

Result<sim::Plan> plan_of(const Structure& structure, const Grade& grade) {
    sim::SimulationRequest request;
    request.points_per_key = std::clamp(structure.points_per_key * grade.points, 1.0, 64.0);
    request.sample_spacing = grade.spacing;
    request.reduce = structure.tiles[0] * structure.tiles[1] == 1;
    return sim::make_plan(structure.design, *structure.block, request);
}

std::string told(const Measured& run) {
    std::string text = in_words("%.0f points, ", static_cast<double>(run.points));
    for (const Snapshot& snapshot : run.snapshots)
        text += in_words("%.0e ", snapshot.wanted) + in_words("%.2f s, ", snapshot.seconds);
    return text + in_words("ended at %.1e", run.result.residual) +
           in_words(" after %.1f s", run.result.seconds) +
           in_words(", %.0f steps", static_cast<double>(run.result.iterations));
}

/// One structure under measurement.
class Tradeoff {
  public:
    Tradeoff(const Structure& structure, const BenchOptions& options)
        : m_structure(structure), m_options(options) {}

    Result<Json> run() {
        for (const Grade& grade : grades) {
            WEAVE_TRY(sim::Plan plan, plan_of(m_structure, grade));
            m_plans.push_back(std::move(plan));
        }
        WEAVE_TRY(m_truth, plan_of(m_structure, truth));
        for (std::size_t g = 0; g < m_plans.size(); ++g) {
            m_raw.push_back(measured(g, sim::Solver::relax, {}, 1e-8, m_options.seconds, nullptr));
            say(std::string(grades[g].name) + ", relax: " + told(m_raw.back()));
            ask(g);
        }
        find_truth();
        if (m_raw[1].seconds_to(grades[0].goal)) go_on();
        if (interrupted())
            return Error{ErrorCode::system, "interrupted; what was measured of it is not kept",
                         m_structure.name};
        return result();
    }

  private:
    /// What a user gets: whoever stops at a loose goal is first led off a saddle there, on the way to a
    /// tighter one nobody looks.
    void ask(std::size_t g) {
        const double goal = grades[g].goal;
        m_asked.push_back(
            goal == 1e-8 ? m_raw[g] : measured(g, sim::Solver::relax, {}, goal, m_options.seconds, nullptr));
        say(std::string(grades[g].name) + ", relax to its goal: " + told(m_asked.back()));
    }

    /// What is of use only where `standard` comes as far as a draft at least.
    void go_on() {
        for (std::size_t g = 0; g < m_plans.size(); ++g) continue_from_truth(g);
        sweep();
        for (std::size_t g = 0; g < m_plans.size(); ++g) {
            m_paper.push_back(measured(g, sim::Solver::paper, m_best, 1e-8, m_options.seconds, nullptr));
            say(std::string(grades[g].name) + ", paper: " + told(m_paper.back()));
        }
    }

    void say(const std::string& line) const { tell(m_structure.name + ": " + line); }

    [[nodiscard]] Measured measured(std::size_t grade, sim::Solver solver, const sim::PaperOptions& paper,
                                    double residual, double seconds, const Control* start) const {
        return measure(m_plans[grade], solver, paper,
                       {residual, interrupted() ? 0 : seconds, m_options.threads}, start);
    }

    /// The reference goes on from `standard` at rest: the same curves with four times the segments, so the
    /// same basin.
    void find_truth() {
        const Control start = refined(m_plans[1].scene, m_raw[1].control, truth_times);
        for (std::size_t y = 0; y < start.size(); ++y) {
            sim::SimYarn& yarn = m_truth.scene.yarns[y];
            yarn.control = start[y];
            if (!yarn.frozen.empty()) yarn.frozen = frozen_as(m_plans[1].scene.yarns[y], start[y].size());
        }
        m_true_run = measure(m_truth, sim::Solver::relax, {},
                             {1e-8, interrupted() ? 0 : 3 * m_options.seconds, m_options.threads});
        m_true_shape = shape_of(m_truth, m_true_run.control);
        say("four times the points: " + told(m_true_run));
    }

    /// As much of the yarn as before is held.
    static std::vector<std::uint8_t> frozen_as(const sim::SimYarn& coarse, std::size_t points) {
        std::vector<std::uint8_t> frozen(points, 0);
        for (std::size_t i = 0; i < points; ++i) {
            const double at = static_cast<double>(i) / static_cast<double>(truth_times);
            const auto below = std::min(coarse.frozen.size() - 1, static_cast<std::size_t>(std::floor(at))),
                       above = std::min(coarse.frozen.size() - 1, static_cast<std::size_t>(std::ceil(at)));
            frozen[i] = coarse.frozen[below] != 0 && coarse.frozen[above] != 0 ? 1 : 0;
        }
        return frozen;
    }

    /// What the discretisation alone costs: on the reference's branch, to the same residual.
    void continue_from_truth(std::size_t g) {
        const Control start = resampled_to(m_plans[g].scene, m_truth.scene, m_true_run.control);
        m_continued.push_back(measured(g, sim::Solver::relax, {}, 1e-8, m_options.seconds, &start));
        say(std::string(grades[g].name) + ", on the reference's branch: " + told(m_continued.back()));
    }

    /// Step and damping with which `paper` needs the fewest evaluations to 1e-3 on `standard`, each tried for
    /// a tenth of the cap; among those that do not arrive, the one that came nearest.
    void sweep() {
        double best = std::numeric_limits<double>::infinity();
        const auto attempt = [&](double step, double damping) {
            const sim::PaperOptions paper{.step = step, .damping = damping};
            const Measured run =
                measured(1, sim::Solver::paper, paper, 1e-3, m_options.seconds / 10, nullptr);
            const bool arrived = run.result.ending == sim::Ending::converged;
            const double cost =
                arrived ? static_cast<double>(run.result.evaluations) : 1e12 * (1 + run.result.residual);
            m_sweep.push_back({{"step", step},
                               {"damping", damping},
                               {"converged", arrived},
                               {"residual", run.result.residual},
                               {"evaluations", run.result.evaluations},
                               {"seconds", run.result.seconds}});
            if (!(cost < best)) return;
            best = cost;
            m_best = paper;
        };
        for (const double damping : {0.3, 0.1, 0.05, 0.03, 0.02, 0.01, 0.003}) attempt(0.9, damping);
        const double damping = m_best.damping;
        for (const double step : {0.7, 0.97}) attempt(step, damping);
        say("paper runs best with a step of " + in_words("%g", m_best.step) + " and damping " +
            in_words("%g", m_best.damping));
    }

    [[nodiscard]] Json run_json(std::size_t g, const char* solver, const char* start,
                                const Measured& run) const {
        Json json = run.json();
        json["fidelity"] = grades[g].name;
        json["solver"] = solver;
        json["start"] = start;
        json["goal"] = grades[g].goal;
        json["errors"] = Json::array();
        for (const Snapshot& snapshot : run.snapshots) {
            const Shape shape = shape_of(m_plans[g], snapshot.control);
            Json error = error_json(m_plans[g], shape, m_true_shape);
            error["residual"] = snapshot.wanted;
            error["seconds"] = snapshot.seconds;
            error["lost_crossings"] = shape.lost;
            json["errors"].push_back(error);
        }
        const Shape last = shape_of(m_plans[g], run.control);
        json["end"] = error_json(m_plans[g], last, m_true_shape);
        json["end"]["seconds"] = run.result.seconds;
        // What it costs to stop there, whatever the points cost.
        json["end"]["to_its_end"] = error_json(m_plans[g], last, shape_of(m_plans[g], m_raw[g].control));
        json["lost_crossings"] = last.lost;
        json["crimp_warp_pc"] = last.crimp_pc[0];
        json["crimp_weft_pc"] = last.crimp_pc[1];
        json["thickness_mm"] = last.thickness_mm;
        return json;
    }

    /// Seconds of `paper` over those of `relax`; where it did not arrive, its cap: a lower bound.
    [[nodiscard]] Json ratios() const {
        Json ratios = Json::object();
        for (const double residual : told_residuals) {
            const std::optional<double> fast = m_raw[1].seconds_to(residual);
            if (m_paper.empty()) {
                ratios[in_words("%.0e", residual)] = {
                    {"relax_s", fast ? Json(*fast) : Json()}, {"paper_s", nullptr}, {"ratio", nullptr}};
                continue;
            }
            const std::optional<double> slow = m_paper[1].seconds_to(residual);
            Json ratio = {{"relax_s", fast ? Json(*fast) : Json()},
                          {"paper_s", slow ? Json(*slow) : Json()},
                          {"ratio", nullptr}};
            if (fast && *fast > 0) {
                ratio["ratio"] = slow.value_or(m_paper[1].result.seconds) / *fast;
                ratio["is_lower_bound"] = !slow;
            }
            ratios[in_words("%.0e", residual)] = ratio;
        }
        return ratios;
    }

    /// Whether both solvers came from the same raw start to the same rest, as far as residuals of 1e-3 tell;
    /// if not, how they differ.
    [[nodiscard]] Json basins() const {
        if (m_paper.empty()) return {{"comparable", false}};
        const Shape fast = shape_of(m_plans[1], m_raw[1].control),
                    slow = shape_of(m_plans[1], m_paper[1].control);
        Json basins = error_json(m_plans[1], slow, fast);
        const bool both = m_raw[1].result.residual <= 1e-3 && m_paper[1].result.residual <= 1e-3;
        basins["comparable"] = both;
        basins["same"] = both && std::abs(basins.at("crimp_warp_pp").get<double>()) < 0.1 &&
                         std::abs(basins.at("crimp_weft_pp").get<double>()) < 0.1 &&
                         basins.at("place_max_radii").get<double>() < 0.5;
        basins["energy_relax_N_mm"] = m_raw[1].result.energy;
        basins["energy_paper_N_mm"] = m_paper[1].result.energy;
        return basins;
    }

    [[nodiscard]] Json result() const {
        Json json = {{"name", m_structure.name},
                     {"machine", machine_json(m_options.threads)},
                     {"tiles", m_structure.tiles},
                     {"points_per_key", m_structure.points_per_key},
                     {"paper_points", m_structure.paper_points ? Json(*m_structure.paper_points) : Json()},
                     {"paper_gpu_s", m_structure.paper_seconds ? Json(*m_structure.paper_seconds) : Json()},
                     {"standard_points", m_raw[1].points},
                     {"sweep", m_sweep},
                     {"paper_step", m_best.step},
                     {"paper_damping", m_best.damping},
                     {"runs", Json::array()}};
        for (std::size_t g = 0; g < m_plans.size(); ++g) {
            json["runs"].push_back(run_json(g, "relax", "plan", m_asked[g]));
            json["runs"].push_back(run_json(g, "relax", "raw", m_raw[g]));
            if (m_paper.empty()) continue;
            json["runs"].push_back(run_json(g, "paper", "raw", m_paper[g]));
            json["runs"].push_back(run_json(g, "relax", "reference", m_continued[g]));
        }
        json["reference"] = m_true_run.json();
        json["reference"]["crimp_warp_pc"] = m_true_shape.crimp_pc[0];
        json["reference"]["crimp_weft_pc"] = m_true_shape.crimp_pc[1];
        json["reference"]["thickness_mm"] = m_true_shape.thickness_mm;
        json["reference"]["lost_crossings"] = m_true_shape.lost;
        json["ratios"] = ratios();
        json["basins"] = basins();
        return json;
    }

    const Structure& m_structure;
    const BenchOptions& m_options;
    std::vector<sim::Plan> m_plans;
    sim::Plan m_truth;
    std::vector<Measured> m_raw, m_asked, m_paper, m_continued;
    Measured m_true_run;
    Shape m_true_shape;
    sim::PaperOptions m_best;
    Json m_sweep = Json::array();
};

}  // namespace

Result<Json> measure_tradeoff(const Structure& structure, const BenchOptions& options) {
    return Tradeoff(structure, options).run();
}

}  // namespace weave::program
