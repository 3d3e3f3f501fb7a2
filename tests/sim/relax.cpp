#include "scenes.hpp"

#include <weave/curve/spline.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/spread.hpp>

#include <catch2/catch.hpp>

#include <array>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// Height of the yarn at the place of its spline that lies nearest to (x, y), images included.
double height_at(const SimScene& scene, const std::vector<Vec3>& control, const SimYarn& yarn, double x,
                 double y) {
    const Spline spline{control, yarn.is_periodic, yarn.shift};
    double best = 1e300, height = 0;
    for (std::size_t k = 0; k < 40 * spline.segments(); ++k) {
        const Vec3 place = spline.place(static_cast<double>(k) / 40);
        const double dx = std::remainder(place.x() - x, scene.period_mm[0]),
                     dy = std::remainder(place.y() - y, scene.period_mm[1]);
        if (dx * dx + dy * dy >= best) continue;
        best = dx * dx + dy * dy;
        height = place.z();
    }
    return height;
}

/// For each warp and weft of a plain weave, whether the warp lies above.
std::vector<bool> order_of(const SimScene& scene, const std::vector<std::vector<Vec3>>& control) {
    std::vector<bool> above;
    const std::size_t count = scene.yarns.size() / 2;
    for (std::size_t warp = 0; warp < count; ++warp) {
        for (std::size_t weft = count; weft < 2 * count; ++weft) {
            // Where they cross, as seen from above: the middle of the warp's y and the weft's x.
            double x = 0, y = 0;
            for (const Vec3& point : control[weft])
                x += point.x() / static_cast<double>(control[weft].size());
            for (const Vec3& point : control[warp])
                y += point.y() / static_cast<double>(control[warp].size());
            above.push_back(height_at(scene, control[warp], scene.yarns[warp], x, y) >
                            height_at(scene, control[weft], scene.yarns[weft], x, y));
        }
    }
    return above;
}

/// A plain weave whose yarns still lie in one another, and crooked.
SimScene rough_weave(Random& random, std::size_t count = 2) {
    SimScene scene = plain_weave({.count = count, .swing = 0.5});
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.015);
    return scene;
}

/// What the residual is when everything is computed anew from the control points alone.
double residual_anew(SimScene scene, const std::vector<std::vector<Vec3>>& control) {
    for (std::size_t y = 0; y < control.size(); ++y) scene.yarns[y].control = control[y];
    Bench bench(scene);
    // As many samples as the relaxation had: they follow from the lengths at the start.
    bench.evaluate();
    const double force = greatest_force(bench.executor, bench.gradient);
    return force / reference_force(bench.energy, bench.state);
}

}  // namespace

TEST_CASE("sums and greatest values are the same for any number of threads") {
    weave::testing::for_all(
        [](Random& random) {
            std::vector<double> numbers(random.between(0, 80000));
            for (double& number : numbers)
                number = uniform(random, -1, 1) * std::pow(10, uniform(random, -8, 8));
            const auto term = [&](std::size_t i) { return numbers[i]; };
            const Executor one(1);
            double greatest = 0, least = 0;
            for (const double number : numbers)
                greatest = std::max(greatest, number), least = std::min(least, number);
            for (const std::size_t threads : {1, 2, 3, 7}) {
                const Executor some(threads);
                CHECK(some.threads() == threads);
                CHECK(some.sum(numbers.size(), term) == one.sum(numbers.size(), term));
                CHECK(some.greatest(numbers.size(), term) == greatest);
                CHECK(some.least(numbers.size(), term, 0) == least);
                std::vector<int> visits(numbers.size(), 0);
                some.each(numbers.size(), [&](std::size_t i) { ++visits[i]; });
                CHECK(std::all_of(visits.begin(), visits.end(), [](int times) { return times == 1; }));
            }
        },
        30);
    CHECK(Executor().threads() >= 1);
}

TEST_CASE("energy, gradient and matrix are the same bit for bit on one thread and on several") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    const SimScene scene = rough_weave(random, 10);
    Bench one(scene, 1), three(scene, 3);
    CHECK(one.evaluate() == three.evaluate());
    CHECK(one.gradient == three.gradient);
    BlockMatrix first, second;
    for (const Curvature curvature : {Curvature::convex, Curvature::exact}) {
        Hessian<double>(one.fabric).assemble(one.energy, one.state, curvature, first);
        Hessian<double>(three.fabric).assemble(three.energy, three.state, curvature, second);
        REQUIRE(first.blocks() == second.blocks());
        CHECK(std::equal(first.value(0), first.value(first.blocks()), second.value(0)));
    }
}

TEST_CASE("relaxing on two threads ends in the same places as on one, bit for bit") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    const SimScene scene = rough_weave(random, 4);
    Bench one(scene, 1), two(scene, 2);
    const RelaxResult a = relax(one.energy, one.state, {.residual = 1e-3, .watch = {}}),
                      b = relax(two.energy, two.state, {.residual = 1e-3, .watch = {}});
    CHECK(one.state == two.state);
    CHECK(a.residual == b.residual);
    CHECK(a.iterations == b.iterations);
    CHECK(a.cg_iterations == b.cg_iterations);
}

TEST_CASE("a plain weave relaxes to 1e-8 from rough starts, and no yarn passes another") {
    weave::testing::for_all(
        [](Random& random) {
            const SimScene scene = rough_weave(random);
            Bench bench(scene);
            const std::vector<bool> before = order_of(scene, bench.fabric.control(bench.state));
            CHECK(before == std::vector<bool>{true, false, false, true});
            const double start = bench.evaluate();
            const RelaxResult result = relax(bench.energy, bench.state, {.residual = 1e-8, .watch = {}});
            CHECK(result.ending == Ending::converged);
            CHECK(result.residual <= 1e-8);
            CHECK(result.energy < start);
            CHECK(order_of(scene, bench.fabric.control(bench.state)) == before);

            // What it says of itself is so.
            CHECK(bench.evaluate() == Approx(result.energy).epsilon(1e-12));
            const double force = greatest_force(bench.executor, bench.gradient);
            CHECK(force / result.reference_N == Approx(result.residual).epsilon(1e-6));
            CHECK(reference_force(bench.energy, bench.state) == Approx(result.reference_N).epsilon(1e-6));
            REQUIRE_FALSE(result.history.empty());
            CHECK(result.history.back().residual == result.residual);
        },
        8);
}

TEST_CASE("a relaxed weave is at rest for whoever computes it anew") {
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    SimScene scene = rough_weave(random);
    Bench bench(scene);
    // Twice, so that samples follow from the lengths of a cloth at rest.
    relax(bench.energy, bench.state, {.residual = 1e-4, .watch = {}});
    const std::vector<std::vector<Vec3>> control = bench.fabric.control(bench.state);
    for (std::size_t y = 0; y < control.size(); ++y) scene.yarns[y].control = control[y];
    Bench again(scene);
    const RelaxResult result = relax(again.energy, again.state, {.residual = 1e-8, .watch = {}});
    CHECK(result.ending == Ending::converged);
    CHECK(residual_anew(scene, again.fabric.control(again.state)) < 2e-8);
}

TEST_CASE("a start in the middle of a crush is measured by the forces at its end") {
    // Few steps lead to rest here, so the reference must be that of the last state, not of the first.
    Random random(weave::testing::run_seed());
    INFO("WEAVE_SEED=" << weave::testing::run_seed());
    SimScene scene = plain_weave({.count = 2, .swing = 0.1});
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.002);
    for (const double goal : {1e-1, 1e-2, 1e-3}) {
        Bench bench(scene);
        const RelaxResult result = relax(bench.energy, bench.state, {.residual = goal, .watch = {}});
        CHECK(result.ending == Ending::converged);
        bench.evaluate();
        const double force = greatest_force(bench.executor, bench.gradient);
        CHECK(force / reference_force(bench.energy, bench.state) <= goal * (1 + 1e-6));
    }
}

TEST_CASE("an empty scene is at rest, and a stopped run keeps its last state") {
    const SimScene empty;
    Bench nothing(empty);
    const RelaxResult none = relax(nothing.energy, nothing.state, {.residual = 1e-8, .watch = {}});
    CHECK(none.ending == Ending::converged);
    CHECK(none.residual == 0);
    CHECK(none.energy == 0);

    Random random(1);
    Bench bench(rough_weave(random));
    const RelaxResult stopped =
        relax(bench.energy, bench.state,
              {.residual = 1e-8, .watch = [](const Progress& progress) { return progress.iteration < 3; }});
    CHECK(stopped.ending == Ending::stopped);
    CHECK(stopped.iterations == 3);
    CHECK(bench.evaluate() == Approx(stopped.energy).epsilon(1e-12));
    const RelaxResult few =
        relax(bench.energy, bench.state, {.residual = 1e-12, .most_iterations = 2, .watch = {}});
    CHECK(few.ending == Ending::iterations);
    CHECK(few.iterations == 2);
}

TEST_CASE("frozen points stay where they are, and what is wholly frozen is at rest") {
    Random random(1);
    SimScene scene = rough_weave(random);
    scene.yarns[0].frozen.assign(scene.yarns[0].control.size(), 1);
    Bench bench(scene);
    const RelaxResult result = relax(bench.energy, bench.state, {.residual = 1e-8, .watch = {}});
    CHECK(result.ending == Ending::converged);
    CHECK(bench.fabric.control(bench.state)[0] == scene.yarns[0].control);
    CHECK(bench.fabric.control(bench.state)[1] != scene.yarns[1].control);

    for (SimYarn& yarn : scene.yarns) yarn.frozen.assign(yarn.control.size(), 1);
    Bench still(scene);
    CHECK(relax(still.energy, still.state, {.residual = 1e-8, .watch = {}}).residual == 0);
    CHECK(still.fabric.control(still.state)[1] == scene.yarns[1].control);
}

TEST_CASE("a rest that is none but a saddle is left: a straight rod that is pressed buckles") {
    Bench straight(pressed_rod()), buckled(pressed_rod());
    const RelaxResult saddle =
        relax(straight.energy, straight.state, {.residual = 1e-6, .leaves_saddles = false, .watch = {}});
    const RelaxResult rest = relax(buckled.energy, buckled.state, {.residual = 1e-6, .watch = {}});
    CHECK(saddle.ending == Ending::converged);
    CHECK(saddle.iterations == 0);
    const Bend bend = bend_at(straight.energy, straight.state, 1e-6 * saddle.reference_N);
    CHECK(bend == Bend::down);
    // A force that counts as none and explains the fall leaves it open.
    CHECK(bend_at(straight.energy, straight.state, 1e9) == Bend::open);
    CHECK(bend_at(buckled.energy, buckled.state, 1e-6 * rest.reference_N) == Bend::up);
    CHECK(rest.ending == Ending::converged);
    CHECK(rest.curves_down == false);
    CHECK(rest.energy < 0.5 * saddle.energy);
}

TEST_CASE("what is at rest is so under its own law of stretch, however loose the goal and long the start") {
    // Wefts laid twice as long as they are give way at first.
    for (const double goal : {40.0, 20.0, 10.0, 5.0, 2.5, 1.2, 0.6, 0.3, 0.15, 1e-4}) {
        INFO("goal " << goal);
        SimScene scene = plain_weave({.count = 2, .swing = 0.7});
        for (SimYarn& yarn : scene.yarns) {
            yarn.is_fed = false;
            yarn.rest_mm = 0.5 * control_length(yarn);
        }
        Bench bench(scene);
        const RelaxResult result = relax(bench.energy, bench.state, {.residual = goal, .watch = {}});
        REQUIRE(result.ending == Ending::converged);
        CHECK(result.residual <= goal);
        CHECK(bench.evaluate() == Approx(result.energy).epsilon(1e-12));
        CHECK(greatest_force(bench.executor, bench.gradient) / reference_force(bench.energy, bench.state) <= goal * (1 + 1e-9));
    }
}

TEST_CASE("points that lie on one another are spread along their yarn before it relaxes; held ones stay") {
    SimScene scene = plain_weave({.count = 2});
    for (const std::size_t i : {3, 4, 5}) scene.yarns[0].control[i] = scene.yarns[0].control[2];
    Bench bench(scene), even(plain_weave({.count = 2}));
    bench.evaluate();
    even.evaluate();
    const std::vector<double> before = bench.state, untouched = even.state;
    CHECK(spread_points(bench.energy, bench.state));
    CHECK_FALSE(spread_points(even.energy, even.state));
    CHECK(even.state == untouched);
    const std::size_t first = 3 * (bench.fabric.yarns()[0].first_slot + 1);
    for (std::size_t i = 2; i < 5; ++i)
        CHECK((load(&bench.state[first + 3 * i + 3]) - load(&bench.state[first + 3 * i])).norm() > 0);
    for (std::size_t slot = bench.fabric.yarns()[1].first_slot; slot < bench.fabric.slots(); ++slot)
        CHECK(load(&bench.state[3 * slot]) == load(&before[3 * slot]));
}
