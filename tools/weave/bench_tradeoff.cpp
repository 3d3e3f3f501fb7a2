// Speed against accuracy: every solver and fidelity on one structure, against a reference on the same branch.

#include "bench_tradeoff.hpp"

#include "interrupt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weave::program {

namespace {

constexpr std::size_t draft = 0, standard = 1, reference = 2;
/// The truth has so many times the points and samples of `standard`.
constexpr std::size_t truth_times = 4;
constexpr double deepest = 1e-8;

std::string name_of(std::size_t grade) {
    return fidelities[grade];
}

double goal_of(std::size_t grade) {
    return sim::goal_of(static_cast<sim::Fidelity>(grade));
}

/// A structure in the points of a fidelity, as `weave simulate` lays them.
Result<sim::Plan> plan_of(const Structure& structure, sim::SimulationRequest request) {
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
        for (const sim::Fidelity fidelity : {sim::Fidelity::draft, sim::Fidelity::standard, sim::Fidelity::reference}) {
            sim::SimulationRequest request;
            request.fidelity = fidelity;
            WEAVE_TRY(sim::Plan plan, plan_of(m_structure, request));
            m_plans.push_back(std::move(plan));
        }
        sim::SimulationRequest finer;
        finer.points_per_key = truth_times * m_plans[standard].points_per_key;
        finer.sample_spacing = m_plans[standard].scene.sample_spacing / truth_times;
        WEAVE_TRY(m_truth, plan_of(m_structure, finer));
        for (std::size_t g = 0; g < m_plans.size(); ++g) {
            m_raw.push_back(measured(g, sim::Solver::relax, {}, deepest, m_options.seconds, nullptr));
            say(name_of(g) + ", relax: " + told(m_raw.back()));
            ask(g);
        }
        find_truth();
        if (m_raw[standard].seconds_to(goal_of(draft))) go_on();
        if (interrupted())
            return Error{ErrorCode::system, "interrupted; what was measured of it is not kept",
                         m_structure.name};
        return result();
    }

  private:
    /// What a user gets: whoever stops at a loose goal is first led off a saddle there, on the way to a tighter
    /// one nobody looks; and a reference begins where `standard` came to, whose seconds count with its own.
    void ask(std::size_t g) {
        if (g != reference) {
            m_asked.push_back(measured(g, sim::Solver::relax, {}, goal_of(g), m_options.seconds, nullptr));
        } else {
            const Control start = resampled_to(m_plans[g].scene, m_plans[standard].scene, m_asked[standard].control);
            m_asked.push_back(measured(g, sim::Solver::relax, {}, goal_of(g), m_options.seconds, &start));
            add_seconds(m_asked[g], m_asked[standard].result.seconds);
        }
        say(name_of(g) + ", relax to its goal: " + told(m_asked.back()));
    }

    static void add_seconds(Measured& run, double before) {
        run.result.seconds += before;
        run.cap_seconds += before;
        for (Snapshot& snapshot : run.snapshots) snapshot.seconds += before;
    }

    /// What is of use only where `standard` comes as far as a draft at least.
    void go_on() {
        for (std::size_t g = 0; g < m_plans.size(); ++g) continue_from_truth(g);
        sweep();
        for (std::size_t g = 0; g < m_plans.size(); ++g) {
            m_paper.push_back(measured(g, sim::Solver::paper, m_best, deepest, m_options.seconds, nullptr));
            say(name_of(g) + ", paper: " + told(m_paper.back()));
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
        const Control start = refined(m_plans[standard].scene, m_raw[standard].control, truth_times);
        for (std::size_t y = 0; y < start.size(); ++y) {
            sim::SimYarn& yarn = m_truth.scene.yarns[y];
            yarn.control = start[y];
            if (!yarn.frozen.empty()) yarn.frozen = frozen_as(m_plans[standard].scene.yarns[y], start[y].size());
        }
        m_true_run = measure(m_truth, sim::Solver::relax, {},
                             {deepest, interrupted() ? 0 : 3 * m_options.seconds, m_options.threads});
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
        m_continued.push_back(measured(g, sim::Solver::relax, {}, deepest, m_options.seconds, &start));
        say(name_of(g) + ", on the reference's branch: " + told(m_continued.back()));
    }

    /// Step and damping with which `paper` needs the fewest evaluations to 1e-3 on `standard`, each tried for
    /// a tenth of the cap; among those that do not arrive, the one that came nearest.
    void sweep() {
        double best = std::numeric_limits<double>::infinity();
        const auto attempt = [&](double step, double damping) {
            const sim::PaperOptions paper{.step = step, .damping = damping};
            const Measured run =
                measured(standard, sim::Solver::paper, paper, 1e-3, m_options.seconds / 10, nullptr);
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
        json["fidelity"] = fidelities[g];
        json["solver"] = solver;
        json["start"] = start;
        json["goal"] = goal_of(g);
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
            const std::optional<double> fast = m_raw[standard].seconds_to(residual);
            if (m_paper.empty()) {
                ratios[in_words("%.0e", residual)] = {
                    {"relax_s", fast ? Json(*fast) : Json()}, {"paper_s", nullptr}, {"ratio", nullptr}};
                continue;
            }
            const std::optional<double> slow = m_paper[standard].seconds_to(residual);
            Json ratio = {{"relax_s", fast ? Json(*fast) : Json()},
                          {"paper_s", slow ? Json(*slow) : Json()},
                          {"ratio", nullptr}};
            if (fast && *fast > 0) {
                ratio["ratio"] = slow.value_or(m_paper[standard].result.seconds) / *fast;
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
        const Shape fast = shape_of(m_plans[standard], m_raw[standard].control),
                    slow = shape_of(m_plans[standard], m_paper[standard].control);
        Json basins = error_json(m_plans[standard], slow, fast);
        const bool both = m_raw[standard].result.residual <= 1e-3 && m_paper[standard].result.residual <= 1e-3;
        basins["comparable"] = both;
        basins["same"] = both && std::abs(basins.at("crimp_warp_pp").get<double>()) < 0.1 &&
                         std::abs(basins.at("crimp_weft_pp").get<double>()) < 0.1 &&
                         basins.at("place_max_radii").get<double>() < 0.5;
        basins["energy_relax_N_mm"] = m_raw[standard].result.energy;
        basins["energy_paper_N_mm"] = m_paper[standard].result.energy;
        return basins;
    }

    [[nodiscard]] Json result() const {
        Json json = {{"name", m_structure.name},
                     {"machine", machine_json(m_options.threads)},
                     {"tiles", m_structure.tiles},
                     {"standard_points", m_raw[standard].points},
                     {"sweep", m_sweep},
                     {"paper_step", m_best.step},
                     {"paper_damping", m_best.damping},
                     {"runs", Json::array()}};
        for (std::size_t g = 0; g < m_plans.size(); ++g) {
            json["runs"].push_back(run_json(g, "relax", asked_start(fidelities[g]), m_asked[g]));
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

const char* asked_start(std::string_view fidelity) {
    return fidelity == fidelities[reference] ? fidelities[standard] : "plan";
}

Result<Json> measure_tradeoff(const Structure& structure, const BenchOptions& options) {
    return Tradeoff(structure, options).run();
}

}  // namespace weave::program
