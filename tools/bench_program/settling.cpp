#include "settling.hpp"

#include <weave/block/flip.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/energy.hpp>
#include <weave/sim/flips.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/starts.hpp>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace weave::bench {

namespace {

constexpr std::size_t most_steps = 600;
constexpr const char* structures[]{
    "satin-e",         "twill-g", "layer-to-layer", "angle-interlock-a", "angle-interlock-b", "hexagon-tubes",
    "tl013-corrected", "pocket",  "i-beam"};

/// What one step found of each point that may move.
struct Step {
    std::vector<std::uint8_t> is_pulled;  ///< by more than the goal
    std::vector<float> place_mm;          ///< three a point
};

/// A relaxation, step by step.
struct Run {
    std::vector<Step> steps;
    std::vector<double> radius_mm;  ///< of each point that may move
    sim::RelaxResult result;
};

Run relaxed(sim::SimScene& scene, double goal) {
    const sim::Executor executor(1);
    const sim::Fabric<double> fabric(scene);
    sim::Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state(), gradient;
    Run run;
    std::vector<std::size_t> moving;
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        if (fabric.moves()[slot] == 0) continue;
        moving.push_back(slot);
        run.radius_mm.push_back(fabric.constants()[fabric.yarn_of_slot()[slot]].radius_mm);
    }
    sim::RelaxOptions options;
    options.residual = goal;
    options.most_iterations = most_steps;
    options.watch = [&](const sim::Progress&) {
        const double reference = sim::reference_force(energy, state);
        energy.evaluate(state, gradient);
        Step& step = run.steps.emplace_back();
        for (const std::size_t slot : moving) {
            step.is_pulled.push_back(sim::load(&gradient[3 * slot]).norm() > goal * reference ? 1 : 0);
            for (std::size_t k = 0; k < 3; ++k)
                step.place_mm.push_back(static_cast<float>(state[3 * slot + k]));
        }
        return true;
    };
    run.result = sim::relax(energy, state, options);
    const std::vector<std::vector<Vec3>> control = fabric.control(state);
    for (std::size_t y = 0; y < control.size(); ++y) scene.yarns[y].control = control[y];
    return run;
}

/// Whether a point is further from where it ends than what passes for the same rest.
bool is_away(const Run& run, std::size_t step, std::size_t point) {
    double square = 0;
    for (std::size_t k = 3 * point; k < 3 * point + 3; ++k) {
        const double way = run.steps[step].place_mm[k] - run.steps.back().place_mm[k];
        square += way * way;
    }
    const double allowed = sim::same_rest_radii * run.radius_mm[point];
    return square > allowed * allowed;
}

/// For each point the steps up to the last in which it is not yet `done`.
std::vector<std::size_t> busy_steps(const Run& run,
                                    const std::function<bool(std::size_t, std::size_t)>& is_busy) {
    std::vector<std::size_t> busy(run.radius_mm.size(), 0);
    for (std::size_t point = 0; point < busy.size(); ++point) {
        for (std::size_t step = run.steps.size(); step > 0 && busy[point] == 0; --step)
            busy[point] = is_busy(step - 1, point) ? step : 0;
    }
    return busy;
}

/// Share of points that are never busy again, at the beginning of each tenth of the steps, and over all
/// steps.
Json shares_of(const std::vector<std::size_t>& busy, std::size_t steps) {
    const auto points = static_cast<double>(std::max<std::size_t>(1, busy.size()));
    Json tenths = Json::array();
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
        const std::size_t step = tenth * steps / 10;
        tenths.push_back(
            static_cast<double>(std::ranges::count_if(busy, [&](std::size_t last) { return last <= step; })) /
            points);
    }
    double saved = 0;
    for (const std::size_t last : busy) saved += static_cast<double>(steps - last);
    return {{"by_tenths", tenths},
            {"saved_at_most", saved / points / static_cast<double>(std::max<std::size_t>(1, steps))}};
}

Json told(const Run& run) {
    const std::size_t steps = run.steps.size();
    const auto is_pulled = [&](std::size_t step, std::size_t point) {
        return run.steps[step].is_pulled[point] != 0;
    };
    Json now = Json::array();
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
        const std::vector<std::uint8_t>& pulled = run.steps[tenth * steps / 10].is_pulled;
        now.push_back(static_cast<double>(std::ranges::count(pulled, 0)) /
                      static_cast<double>(std::max<std::size_t>(1, pulled.size())));
    }
    return {{"points", run.radius_mm.size()},
            {"steps", run.result.iterations},
            {"ending", std::string(sim::name_of(run.result.ending))},
            {"residual", run.result.residual},
            {"below_goal_by_tenths", now},
            {"below_goal_for_good", shares_of(busy_steps(run, is_pulled), steps)},
            {"in_place_for_good",
             shares_of(busy_steps(run, [&](std::size_t step,
                                           std::size_t point) { return is_away(run, step, point); }),
                       steps)}};
}

/// A crossing that may flip, from the middle of a cloth on; nothing where there is none.
std::optional<Flip> some_flip(const Block& cloth, const ClothCurves& curves) {
    const std::size_t count = curves.crossings.size();
    for (std::size_t k = 0; k < count; ++k) {
        const Crossing& crossing = curves.crossings[(count / 2 + k) % count];
        if (flip(stack_at(cloth, crossing.pick, crossing.end), crossing.pick, crossing.end))
            return Flip{crossing.pick, crossing.end, !crossing.weft_over};
    }
    return {};
}

Json settling_of(const std::string& name) {
    const Design design = find_sample(name)->make();
    const Block cloth = *evaluate(design)->block;
    sim::SimulationRequest request;
    request.reduce = false;
    if (name == "i-beam") request.weft_mode = WeftMode::wraparound;
    sim::Plan plan = sim::make_plan(design, cloth, request).value();
    Run run = relaxed(plan.scene, plan.goal);
    Json answer{{"from_plan", told(run)}};
    const bool rests = run.result.ending == sim::Ending::converged;
    run = {};
    const std::optional<Flip> wish = some_flip(cloth, plan.curves);
    if (!rests || !wish) return answer;
    const sim::FlipResult flipped = sim::flip_relaxed(plan.scene, plan.curves, plan.curve_of, *wish,
                                                      plan.goal, sim::Executor(1), [] { return true; });
    if (flipped.done) answer["after_flip"] = told(relaxed(plan.scene, plan.goal));
    return answer;
}

}  // namespace

Json settling() {
    Json answer;
    for (const char* name : structures) answer[name] = settling_of(name);
    return answer;
}

}  // namespace weave::bench
