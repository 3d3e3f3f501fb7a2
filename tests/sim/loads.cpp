// Weight, and yarns that wrap round something, without friction.

#include "scenes.hpp"

#include <weave/sim/relax.hpp>

#include <catch2/catch.hpp>

#include <cmath>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// Tension of a yarn of fixed length in the middle of a segment, N.
double tension_at(const Bench<double>& bench, std::size_t yarn, std::size_t segment) {
    const YarnPlace& place = bench.fabric.yarns()[yarn];
    const Speeds<double> speeds(bench.fabric.gauss(), &bench.state[3 * (place.first_slot + segment)]);
    const YarnConstants<double>& constants = bench.fabric.constants()[yarn];
    return constants.stretch_N * (speeds.length / constants.rest_mm - 1);
}

/// A yarn hung over a thick rod that lies along y, held at both ends; more of it lies on the left at the
/// start.
SimScene wrap() {
    SimScene scene;
    SimYarn rod = usual_yarn(0.5);
    rod.is_fed = false;
    rod = laid(rod, {0, -1, 0}, {0, 1, 0}, 9);
    rod.frozen.assign(9, 1);
    SimYarn yarn = usual_yarn(0.1);
    yarn.is_fed = false;
    yarn.bending_N_mm2 = 1e-4;
    constexpr std::size_t segments = 60;
    const double turn = 0.6, radius = 0.6, straight = 1.5;  // half of the angle it lies on the rod with
    const double whole = 2 * (radius * turn + straight);
    for (std::size_t i = 0; i <= segments; ++i) {
        double share = static_cast<double>(i) / segments;
        share += 0.02 * std::sin(std::numbers::pi * share);  // uneven: the left is stretched, the right slack
        const double along = (share - 0.5) * whole, bent = std::clamp(along / radius, -turn, turn),
                     rest = along - bent * radius;
        yarn.control.emplace_back(radius * std::sin(bent) + rest * std::cos(bent), 0,
                                  radius * std::cos(bent) - rest * std::sin(bent));
    }
    yarn.rest_mm = whole / 1.02;
    yarn.frozen.assign(segments + 1, 0);
    yarn.frozen.front() = yarn.frozen.back() = 1;
    scene.yarns = {yarn, rod};
    scene.sample_spacing = 0.1;
    return scene;
}

}  // namespace

TEST_CASE("a yarn slides round a rod without friction: its tension is the same on both sides") {
    Bench bench(wrap());
    const double left = tension_at(bench, 0, 5), right = tension_at(bench, 0, 54);
    REQUIRE(std::abs(left - right) > 0.5);
    const RelaxResult result =
        relax(bench.energy, bench.state, {.residual = 1e-6, .most_iterations = 2000, .watch = {}});
    CHECK(result.ending == Ending::converged);
    const double now_left = tension_at(bench, 0, 5), now_right = tension_at(bench, 0, 54);
    std::printf("wrap: tension %.4f and %.4f N\n", now_left, now_right);
    CHECK(now_left > 0.1);
    CHECK(now_left == Approx(now_right).epsilon(1e-3));
    // What it presses the rod with is what both straight ends pull down with, each under the angle at which it comes.
    const std::vector<Vec3> yarn = bench.fabric.control(bench.state)[0];
    const Vec3 left_way = (yarn[0] - yarn[5]).normalized(), right_way = (yarn[60] - yarn[55]).normalized();
    const double down = -now_left * left_way.z() - now_right * right_way.z();
    bench.evaluate({.elastic = false, .contact = true});
    CHECK(bench.pull_on(0).norm() == Approx(down).epsilon(0.01));
}

TEST_CASE(
    "weight does not curve: the matrix and the differences of forces are the same with it and without") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene light = heap(random, 3), heavy = light;
            heavy.gravity_mm_ms2 = 9.80665e-3;
            for (SimYarn& yarn : heavy.yarns) yarn.gram_per_mm = 10;
            Bench without(light), with(heavy);
            without.evaluate();
            with.evaluate();
            REQUIRE(with.gradient != without.gradient);
            const std::vector<double> weight = [&] {
                std::vector<double> difference = with.gradient;
                for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= without.gradient[i];
                return difference;
            }();
            BlockMatrix first, second;
            for (const Curvature curvature : {Curvature::convex, Curvature::exact}) {
                Hessian<double>(without.fabric).assemble(without.energy, without.state, curvature, first);
                Hessian<double>(with.fabric).assemble(with.energy, with.state, curvature, second);
                REQUIRE(first.blocks() == second.blocks());
                CHECK(std::equal(first.value(0), first.value(first.blocks()), second.value(0)));
            }
            for (std::size_t slot = 0; slot < with.fabric.slots(); ++slot) {
                if (with.fabric.moves()[slot] == 0) continue;
                const Vec3 by = jitter(random, 0.05);
                for (std::size_t k = 0; k < 3; ++k) {
                    without.state[3 * slot + k] += by[static_cast<Eigen::Index>(k)];
                    with.state[3 * slot + k] += by[static_cast<Eigen::Index>(k)];
                }
            }
            without.fabric.follow(without.state);
            with.fabric.follow(with.state);
            without.evaluate();
            with.evaluate();
            for (std::size_t i = 0; i < weight.size(); ++i)
                CHECK(with.gradient[i] - without.gradient[i] == Approx(weight[i]).margin(1e-9));
        },
        10);
}
