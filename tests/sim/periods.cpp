#include "scenes.hpp"

#include <weave/sim/periods.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// Energy of a scene with other periods at the same control points: only what is beyond the seam moves.
double energy_in(const SimScene& scene, std::size_t axis, double more) {
    SimScene other = scene;
    other.period_mm[axis] += more;
    for (SimYarn& yarn : other.yarns) yarn.shift[static_cast<Eigen::Index>(axis)] += yarn.turns[axis] * more;
    Bench bench(other);
    return bench.evaluate();
}

SimScene shaken_weave(Random& random) {
    SimScene scene = plain_weave({.count = 2, .points_a_crossing = 3, .swing = 0.7});
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.02);
    return scene;
}

struct Rest {
    double energy = 0;
    std::array<double, 2> force{};
};

Rest at_rest(const SimScene& scene, const std::array<double, 2>& period) {
    SimScene other = with_periods(scene, period);
    Bench bench(other);
    const RelaxResult result = relax(bench.energy, bench.state, {.residual = 1e-10, .watch = {}});
    REQUIRE(result.ending == Ending::converged);
    return {result.energy, bench.energy.period_gradient(bench.state)};
}

}  // namespace

TEST_CASE("the pull on the rim is the derivative of the energy by the period, at any state") {
    weave::testing::for_all(
        [](Random& random) {
            const SimScene scene = shaken_weave(random);
            Bench bench(scene);
            const std::array<double, 2> pull = bench.energy.period_gradient(bench.state);
            for (const std::size_t axis : {0, 1}) {
                const double slope = (energy_in(scene, axis, 1e-6) - energy_in(scene, axis, -1e-6)) / 2e-6;
                CHECK(pull[axis] == Approx(slope).epsilon(1e-5).margin(1e-6));
            }
        },
        10);
}

TEST_CASE("the pull on the rim of cloth at rest is the derivative of its relaxed energy") {
    Random random(7);
    const SimScene scene = plain_weave({.count = 2, .swing = 1});
    const std::array<double, 2> period = scene.period_mm;
    const Rest here = at_rest(scene, period);
    for (const std::size_t axis : {0, 1}) {
        std::array<double, 2> more = period, less = period;
        const double step = 1e-4 * period[axis];
        more[axis] += step;
        less[axis] -= step;
        const double slope = (at_rest(scene, more).energy - at_rest(scene, less).energy) / (2 * step);
        CHECK(here.force[axis] == Approx(slope).epsilon(1e-3));
    }
}

TEST_CASE("a straight yarn in a free period is as long as the force on it says") {
    SimScene scene;
    scene.is_periodic = {true, true};
    scene.period_mm = {1.1, 5};
    SimYarn yarn = usual_yarn();
    yarn.is_fed = false;
    yarn.rest_mm = 1;
    yarn = laid(yarn, {0, 0, 0}, {1.1, 0, 0}, 6, true);
    yarn.turns = {1, 0};
    scene.yarns = {yarn};
    const Executor executor(1);
    for (const double force : {0.0, 2.0}) {  // F = EA (P / L - 1)
        SimScene free = scene;
        const PeriodsResult result = relax_periods(free, {force, std::nullopt}, {.residual = 1e-6, .watch = {}}, 1e-6, executor);
        CHECK(result.balanced);
        CHECK(free.period_mm[0] == Approx(1 + force / 40).epsilon(1e-4));
        CHECK(free.period_mm[1] == 5);
        CHECK(free.yarns[0].shift.x() == Approx(free.period_mm[0]));
    }
}

TEST_CASE("a free period of a weave ends where its rim bears the force that was asked for") {
    for (const double force : {0.0, 0.3}) {
        SimScene scene = plain_weave({.count = 2, .swing = 1});
        const Executor executor(1);
        const PeriodsResult result = relax_periods(scene, {std::nullopt, force}, {.residual = 1e-6, .watch = {}}, 1e-4, executor);
        CHECK(result.balanced);
        CHECK(result.last.ending == Ending::converged);
        CHECK(result.force_N[1] == Approx(force).margin(1e-3 * result.last.reference_N));
        CHECK(scene.period_mm[0] == 1.0);
        CHECK(scene.period_mm[1] > 0.8);
        CHECK(scene.period_mm[1] < 1.2);
    }
}
