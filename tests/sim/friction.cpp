// Friction between yarns: the held potential, the rounds that make it agree, and what Euler's capstan says.

#include "differences.hpp"
#include "scenes.hpp"

#include <weave/sim/friction_rounds.hpp>

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

constexpr double degree = std::numbers::pi / 180;

/// The gradient and both matrices of a scene whose friction is held as it lies and whose yarns have then
/// moved: by much less than the transition length, by about as much, or by far more. Whether any pair is
/// held.
bool held_friction_curves_as_it_pulls(Random& random, const SimScene& scene) {
    Bench bench(scene);
    bench.energy.renew_friction(bench.state, stick_share);
    if (!bench.energy.friction().is_on()) return false;
    const double moves[]{1e-4, 1e-3, 1e-2}, by = moves[random.between(0, 2)];
    for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot) {
        for (std::size_t k = 0; k < 3 && bench.fabric.moves()[slot] != 0; ++k)
            bench.state[3 * slot + k] += uniform(random, -by, by);
    }
    bench.fabric.follow(bench.state);
    INFO("moved by up to " << by << " mm, mu " << scene.friction);
    CHECK(gradient_error(bench) < 1e-6);
    check_matrices(bench);
    return true;
}

/// Tension of a yarn of fixed length in the middle of a segment, N.
double tension_at(const Bench<double>& bench, std::size_t yarn, std::size_t segment) {
    const YarnPlace& place = bench.fabric.yarns()[yarn];
    const Speeds<double> speeds(bench.fabric.gauss(), &bench.state[3 * (place.first_slot + segment)]);
    const YarnConstants<double>& constants = bench.fabric.constants()[yarn];
    return constants.stretch_N * (speeds.length / constants.rest_mm - 1);
}

/// A thin yarn laid round a frozen rod by `turn`, held at both ends; the left end has been pulled on by
/// `pull` of its whole length, which has not run through to the right yet.
struct Capstan {
    double turn = 0, friction = 0, pull = 0.03;
};
constexpr std::size_t capstan_segments = 120;

SimScene scene_of(const Capstan& capstan) {
    SimScene scene;
    scene.friction = capstan.friction;
    scene.sample_spacing = 0.1;
    SimYarn rod = usual_yarn(0.5);
    rod.is_fed = false;
    rod.contact_N_mm2 = 60;
    rod = laid(rod, {0, -1, 0}, {0, 1, 0}, 9);
    rod.frozen.assign(9, 1);
    SimYarn yarn = usual_yarn(0.05);
    yarn.is_fed = false;
    yarn.bending_N_mm2 = 1e-5;
    yarn.contact_N_mm2 = 60;
    const double radius = 0.55, straight = 1.2, half = capstan.turn / 2,
                 whole = 2 * (radius * half + straight);
    for (std::size_t i = 0; i <= capstan_segments; ++i) {
        const double share = static_cast<double>(i) / capstan_segments;
        // Left of the rod the yarn lies stretched evenly over its leg.
        const double leg = straight / whole, pulled = share < leg ? capstan.pull * (1 - share / leg) : 0;
        const double along = (share - 0.5 - pulled) * whole, bent = std::clamp(along / radius, -half, half),
                     rest = along - bent * radius;
        yarn.control.emplace_back(radius * std::sin(bent) + rest * std::cos(bent), 0,
                                  radius * std::cos(bent) - rest * std::sin(bent));
    }
    yarn.rest_mm = whole / 1.01;
    yarn.frozen.assign(capstan_segments + 1, 0);
    yarn.frozen.front() = yarn.frozen.back() = 1;
    scene.yarns = {yarn, rod};
    return scene;
}

struct Pulled {
    FrictionResult result;
    double left = 0, right = 0, turn = 0;  ///< tensions in N; the angle between the legs
};

Pulled pull(const Capstan& capstan) {
    Bench bench(scene_of(capstan));
    RelaxOptions options;
    options.residual = 1e-6;
    options.most_iterations = 5000;
    Pulled pulled;
    pulled.result = relax_with_friction(bench.energy, bench.state, options);
    const std::size_t near = 10, far = capstan_segments - 11;
    pulled.left = tension_at(bench, 0, near);
    pulled.right = tension_at(bench, 0, far);
    const auto tangent = [&](std::size_t segment) {
        const double* slots = &bench.state[3 * (bench.fabric.yarns()[0].first_slot + segment)];
        return Vec3(combine(basis_at(0.5).slope, slots).normalized());
    };
    pulled.turn = std::acos(tangent(near).dot(tangent(far)));
    return pulled;
}

}  // namespace

TEST_CASE("the potential of slip is smooth, and its slope rises to 1 within the transition length") {
    const double epsilon = 0.02, step = 1e-7;
    for (double y = 0.001; y < 0.05; y += 0.00037) {
        const auto law = SlipLaw<double>::at(y, epsilon);
        const double slope =
            (SlipLaw<double>::at(y + step, epsilon).value - SlipLaw<double>::at(y - step, epsilon).value) /
            (2 * step);
        CHECK(law.stiffness * y == Approx(slope).epsilon(1e-6));
        CHECK(law.stiffness * y <= 1 + 1e-12);
        CHECK(law.bend <= 0);
        if (y >= epsilon) CHECK(law.stiffness * y == Approx(1));
    }
    CHECK(SlipLaw<double>::at(0, epsilon).value == 0);
}

TEST_CASE("held friction pulls as its energy says, and curves as its pull says, images included") {
    std::size_t held = 0;
    weave::testing::for_all(
        [&](Random& random) {
            SimScene scene = heap(random, random.between(2, 3), random.coin() ? 0.12 : 0.06);
            scene.friction = uniform(random, 0.05, 1);
            if (random.coin()) scene.yarns[0].frozen.assign(scene.yarns[0].control.size(), 1);
            held += held_friction_curves_as_it_pulls(random, scene) ? 1 : 0;
        },
        20);
    CHECK(held > 10);
    weave::testing::for_all(
        [&](Random& random) {
            WeaveShape shape;
            shape.points_a_crossing = random.between(1, 3);
            shape.pitch_mm = uniform(random, 0.3, 0.5);
            shape.swing = 0.7;
            SimScene scene = plain_weave(shape);
            scene.friction = uniform(random, 0.05, 1);
            if (random.coin()) scene.yarns.erase(scene.yarns.begin() + 1);
            for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.02);
            CHECK(held_friction_curves_as_it_pulls(random, scene));
        },
        6);
}

TEST_CASE("friction of a yarn dragged across another is the coefficient times what it presses with") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene;
            scene.friction = uniform(random, 0.1, 1);
            const double turn = uniform(random, 0.3, 1.5), mu = scene.friction;
            const Vec3 along(std::cos(turn), std::sin(turn), 0);
            scene.yarns = {laid(usual_yarn(), {-1, 0, 0}, {1, 0, 0}, 9),
                           laid(usual_yarn(0.08), Vec3(0, 0, 0.17) - along, Vec3(0, 0, 0.17) + along, 9)};
            Bench bench(scene);
            bench.energy.renew_friction(bench.state, stick_share);
            REQUIRE(bench.energy.friction().is_on());
            const double way = uniform(random, 0, 6.28);
            const Vec3 drag(0.01 * std::cos(way), 0.01 * std::sin(way), 0);
            bench.evaluate({.elastic = false, .contact = true});
            const double press = bench.pull_on(1).norm();
            bench.evaluate();
            CHECK(bench.pull_on(1).head<2>().norm() < 1e-9 * press);  // nothing has slipped
            for (std::size_t i = 0; i < 9; ++i) {
                for (std::size_t k = 0; k < 2; ++k) bench.state[bench.at(1, i) + k] += drag[Eigen::Index(k)];
            }
            bench.fabric.follow(bench.state);
            bench.evaluate();
            const Vec3 with = bench.pull_on(1);
            SimScene smooth = scene;
            smooth.friction = 0;
            Bench without(smooth);
            without.state = bench.state;
            without.evaluate();
            const Vec3 friction = with - without.pull_on(1);
            INFO("angle " << turn << ", mu " << mu << ", press " << press);
            CHECK(friction.dot(drag.normalized()) == Approx(mu * press).epsilon(2e-3));
            CHECK((friction - drag.normalized() * friction.dot(drag.normalized())).norm() <
                  2e-3 * mu * press);
            CHECK(bench.energy.friction().summary(bench.energy.view(bench.state)).press_N ==
                  Approx(press).epsilon(2e-3));
        },
        20);
}

TEST_CASE("a yarn pulled round a rod slips where Euler's capstan says: T1 = T0 exp(mu phi)") {
    for (const double turn : {90.0, 180.0}) {
        const Pulled smooth = pull({turn * degree, 0});
        CHECK(smooth.result.last.ending == Ending::converged);
        CHECK(smooth.left == Approx(smooth.right).epsilon(1e-3));
        for (const double mu : {0.1, 0.3}) {
            const Pulled rough = pull({turn * degree, mu});
            const double ratio = rough.left / rough.right, right = std::exp(mu * rough.turn);
            std::printf(
                "capstan: %.0f degrees, mu %.1f: T1/T0 %.4f, exp(mu phi) %.4f, %.2f %% off; %zu rounds, %zu "
                "steps, %.0f %% stuck\n",
                turn, mu, ratio, right, 100 * (ratio / right - 1), rough.result.rounds,
                rough.result.last.iterations, 100 * rough.result.slip.stuck_share);
            CHECK(rough.result.agreed);
            CHECK(rough.result.last.ending == Ending::converged);
            CHECK(rough.result.slip.stuck_share < 0.02);
            CHECK(rough.turn == Approx(turn * degree).epsilon(0.03));
            CHECK(ratio == Approx(right).epsilon(0.03));
        }
    }
}

TEST_CASE("a yarn that is hardly pulled sticks: the ratio stays below the capstan's") {
    const Pulled rough = pull({180 * degree, 0.3, 0.0005});
    CHECK(rough.result.agreed);
    CHECK(rough.left > 1.02 * rough.right);
    CHECK(rough.left < 0.9 * std::exp(0.3 * rough.turn) * rough.right);
    CHECK(rough.result.slip.stuck_share > 0.2);
}

TEST_CASE("friction of 0 is none: the same numbers") {
    const SimScene scene = plain_weave({});
    Bench with(scene), without(scene);
    const FrictionResult result = relax_with_friction(with.energy, with.state, {});
    relax(without.energy, without.state, {});
    CHECK(result.rounds == 0);
    CHECK(with.state == without.state);
    with.energy.renew_friction(with.state, stick_share);
    CHECK_FALSE(with.energy.friction().is_on());
}

TEST_CASE("a plain weave with friction keeps more of its start, and the more the rougher it is") {
    // Its picks lie unevenly at the start: without friction they spread.
    SimScene scene = plain_weave({.count = 4});
    for (SimYarn& yarn : scene.yarns) {
        if (yarn.is_fed) continue;
        const double uneven =
            0.06 * std::sin(2 * std::numbers::pi * yarn.control[0].x() / scene.period_mm[0]);
        for (Vec3& point : yarn.control) point.x() += uneven;
    }
    double before = 1e9;
    for (const double mu : {0.0, 0.1, 0.3}) {
        scene.friction = mu;
        Bench bench(scene);
        const FrictionResult result = relax_with_friction(bench.energy, bench.state, {});
        double moved = 0;
        for (std::size_t y = 0; y < scene.yarns.size(); ++y) {
            for (std::size_t i = 0; i < scene.yarns[y].control.size(); ++i) {
                const Vec3 by = load(&bench.state[bench.at(y, i)]) - scene.yarns[y].control[i];
                moved += by.head<2>().squaredNorm();
            }
        }
        std::printf(
            "plain weave, mu %.1f: moved in its plane %.4f mm, %zu rounds, %zu steps, residual %.1e, %.0f %% "
            "stuck, farthest slip %.3f mm\n",
            mu, std::sqrt(moved), result.rounds, result.last.iterations, result.last.residual,
            100 * result.slip.stuck_share, result.slip.farthest_mm);
        CHECK(result.agreed);
        CHECK(result.last.residual <= 1e-3);
        CHECK(moved < 0.9 * before);
        before = moved;
    }
}

TEST_CASE(
    "friction through images counts to the force on the rim: it does not matter in which repeat a yarn is "
    "written down") {
    SimScene scene = plain_weave({.count = 2, .points_a_crossing = 2});
    scene.friction = 0.4;
    for (SimYarn& yarn : scene.yarns) {
        if (!yarn.is_fed && yarn.control[0].x() > 0.5) {
            for (Vec3& point : yarn.control) point.x() += 0.03;
        }
    }
    SimScene start = scene;
    Bench bench(scene);
    RelaxOptions options;
    options.residual = 1e-9;
    REQUIRE(relax_with_friction(bench.energy, bench.state, options).agreed);
    const std::array<double, 2> here = bench.energy.period_gradient(bench.state);
    const std::vector<std::vector<Vec3>> control = bench.fabric.control(bench.state);
    scene.slip_from = SlipStart{{}, scene.period_mm};
    for (std::size_t y = 0; y < control.size(); ++y) {
        const Vec3 by = y == 2 ? Vec3(scene.period_mm[0], 0, 0) : Vec3(0, 0, 0);  // a weft
        scene.yarns[y].control = control[y];
        scene.slip_from->control.push_back(start.yarns[y].control);
        for (Vec3& point : scene.yarns[y].control) point += by;
        for (Vec3& point : scene.slip_from->control.back()) point += by;
        scene.yarns[y].planned_mm = control_length(start.yarns[y]);
    }
    Bench moved(scene);
    moved.energy.renew_friction(moved.state, stick_share);
    moved.evaluate();
    CHECK(greatest(moved.gradient) < 1e-6);
    const std::array<double, 2> there = moved.energy.period_gradient(moved.state);
    CHECK(there[0] == Approx(here[0]).epsilon(1e-6));
    CHECK(there[1] == Approx(here[1]).epsilon(1e-6));
    // Without that part it would matter.
    const std::array<double, 2> rubbing = moved.energy.friction().image_pull(moved.energy.view(moved.state));
    CHECK(std::abs(rubbing[0]) > 1e-3);
}
