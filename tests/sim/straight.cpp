// Straight yarns and rods, whose forces have formulas.

#include "scenes.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

double energy_of(const SimScene& scene, Terms terms = {}) {
    return Bench(scene).evaluate(terms);
}

/// A straight periodic yarn of this period.
SimScene straight(SimYarn yarn, double period) {
    SimScene scene;
    scene.is_periodic = {true, false};
    scene.period_mm = {period, 0};
    yarn = laid(yarn, {0, 0, 0}, {period, 0, 0}, 5, true);
    yarn.turns = {1, 0};
    scene.yarns = {yarn};
    return scene;
}

/// How hard a period is pulled, by central differences.
template <class Scene>
double pull_of(const Scene& scene, double period) {
    const double step = 1e-5;
    return (energy_of(scene(period + step)) - energy_of(scene(period - step))) / (2 * step);
}

/// Two long straight rods of radii `a` and `b` that cross at an angle; `phase` moves their samples by shares
/// of the spacing.
struct Crossing {
    double share_of_reach, angle, spacing, a, b;

    [[nodiscard]] double reach() const { return a + b; }
    [[nodiscard]] SimScene scene(double phase_a, double phase_b) const {
        SimScene scene;
        scene.sample_spacing = spacing;
        const double half =
            4 * reach() / std::sin(angle);  // one segment: its samples lie as far apart as asked
        for (const bool first : {true, false}) {
            SimYarn yarn = usual_yarn(first ? a : b);
            yarn.contact_N_mm2 = first ? 2 : 4.5;
            const double turn = first ? 0 : angle;
            const Vec3 along(std::cos(turn), std::sin(turn), 0);
            const Vec3 middle = Vec3(0, 0, first ? 0 : share_of_reach * reach()) +
                                along * (first ? phase_a : phase_b) * spacing * std::min(a, b) * 2;
            scene.yarns.push_back(laid(yarn, middle - half * along, middle + half * along, 3));
        }
        return scene;
    }
    /// F = 2 π k D (1 - η²)² / (η sin θ), with k the geometric mean of both yarns'.
    [[nodiscard]] double force() const {
        const double eta = share_of_reach, open = 1 - eta * eta;
        return 2 * std::numbers::pi * 3 * reach() * open * open / (eta * std::sin(angle));
    }
    /// Greatest relative error over phases, both as found.
    [[nodiscard]] double worst_error() const {
        double worst = 0;
        for (const double phase_a : {0.0, 0.25, 0.5, 0.75}) {
            for (const double phase_b : {0.0, 0.25, 0.5, 0.75}) {
                Bench bench(scene(phase_a, phase_b));
                bench.evaluate({.elastic = false});
                CHECK(bench.pull_on(0).z() == Approx(-bench.pull_on(1).z()));
                worst = std::max(worst, error_of(bench.pull_on(0).z(), force()));
            }
        }
        return worst;
    }
};

/// The widest spacing, in D, that the accuracy notes allow: min(1/4, 0.3 √(1 - η²)).
double allowed_spacing(double eta) {
    return std::min(0.25, 0.3 * std::sqrt(1 - eta * eta));
}

/// Energy per length of two parallel yarns at a distance h, in units of k: ∫ f over the other yarn.
double parallel_energy(double h, double reach) {
    if (h >= reach) return 0;
    const double c = std::sqrt(reach * reach - h * h);
    return 2 * reach * reach / h * std::atan(c / h) + 2 / (reach * reach) * (h * h * c + c * c * c / 3) -
           4 * c;
}

}  // namespace

TEST_CASE("a straight yarn of fixed length pulls with EA (P/L - 1)") {
    for (const double period : {0.9, 1.0, 1.001, 1.3}) {
        SimYarn yarn = usual_yarn(0.05);
        yarn.is_fed = false;
        yarn.rest_mm = 1;
        const double pull = pull_of([&](double p) { return straight(yarn, p); }, period);
        CHECK(pull == Approx(40 * (period - 1)).margin(1e-7));
    }
}

TEST_CASE("a fed yarn pulls with EA (S - 1), whatever its period") {
    for (const double strain : {1.0, 1.000001, 1.01, 1.5}) {
        for (const double period : {0.5, 1.0, 3.0}) {
            SimYarn yarn = usual_yarn(0.05);
            yarn.strain = strain;
            const double pull = pull_of([&](double p) { return straight(yarn, p); }, period);
            CHECK(pull == Approx(40 * (strain - 1)).margin(1e-7));
        }
    }
}

TEST_CASE("a straight yarn is at rest") {
    for (const bool fed : {true, false}) {
        SimYarn yarn = usual_yarn(0.05);
        yarn.is_fed = fed;
        yarn.rest_mm = 0.9;
        Bench bench(straight(yarn, 1));
        bench.evaluate();
        for (const double force : bench.gradient) CHECK(std::abs(force) < 1e-12);
    }
}

TEST_CASE("two crossing rods press with 2 π k D (1 - η²)² / (η sin θ)") {
    std::printf("  η    θ    error at the spacing allowed, at half of it\n");
    for (const double eta : {0.3, 0.5, 0.8, 0.95, 0.99}) {
        for (const double degrees : {90.0, 45.0, 20.0}) {
            const double angle = degrees * std::numbers::pi / 180;
            const double spacing = allowed_spacing(eta);
            const double error = Crossing{eta, angle, spacing, 0.12, 0.12}.worst_error(),
                         half = Crossing{eta, angle, spacing / 2, 0.12, 0.12}.worst_error();
            std::printf("%.2f %4.0f  %9.2e  %9.2e\n", eta, degrees, error, half);
            CHECK(error < 0.025);
            CHECK(half < 0.005);
        }
    }
}

TEST_CASE("light contact needs finer samples: what the usual spacing costs") {
    std::printf("  η   error at 0.25 D, at 0.45 D\n");
    for (const double eta : {0.5, 0.8, 0.9, 0.95, 0.99}) {
        const double right_angle = std::numbers::pi / 2;
        const double usual = Crossing{eta, right_angle, 0.25, 0.12, 0.12}.worst_error(),
                     coarse = Crossing{eta, right_angle, 0.45, 0.12, 0.12}.worst_error();
        std::printf("%.2f  %9.2e  %9.2e\n", eta, usual, coarse);
        CHECK(usual < (eta <= 0.8 ? 0.025 : eta <= 0.95 ? 0.1 : 1.05));
    }
}

TEST_CASE("rods of different radii press by the same formula, each with its own spacing") {
    for (const double thin : {0.06, 0.012}) {
        const Crossing crossing{0.8, std::numbers::pi / 2, 0.25, thin, 0.12};
        CHECK(crossing.worst_error() < 0.025);
    }
}

TEST_CASE("rods that only just meet do not press, and deeply sunk ones press on evenly") {
    Bench apart(Crossing{1.0, 1, 0.25, 0.12, 0.12}.scene(0, 0));
    CHECK(apart.evaluate({.elastic = false}) == 0);
    // Below the floor, a tenth of the reach, the pull falls to nothing at no distance, but pushes the same
    // way.
    double before = 0;
    for (const double eta : {1e-6, 0.01, 0.05}) {
        Bench sunk(Crossing{eta, std::numbers::pi / 2, 0.25, 0.12, 0.12}.scene(0, 0));
        sunk.evaluate({.elastic = false});
        const double force = sunk.pull_on(0).z();
        CHECK(std::isfinite(force));
        CHECK(force > before);
        before = force;
    }
}

TEST_CASE("parallel rods have the energy per length of the formula") {
    for (const double eta : {0.3, 0.5, 0.8, 0.95}) {
        const double reach = 0.24, h = eta * reach;
        SimScene scene;
        scene.is_periodic = {true, false};
        scene.period_mm = {1, 0};
        scene.sample_spacing = allowed_spacing(eta);
        for (const double z : {0.0, h}) {
            SimYarn yarn = laid(usual_yarn(), {0, 0, z}, {1, 0, z}, 4, true);
            yarn.turns = {1, 0};
            scene.yarns.push_back(yarn);
        }
        CHECK(energy_of(scene, {.elastic = false}) == Approx(3 * parallel_energy(h, reach)).epsilon(0.01));
    }
}

TEST_CASE("a yarn meets its own image beside it as it would meet another yarn") {
    const double reach = 0.24, h = 0.55 * reach;
    SimScene scene = straight(usual_yarn(), 1);
    scene.is_periodic[1] = true;
    scene.period_mm[1] = h;
    CHECK(energy_of(scene, {.elastic = false}) == Approx(3 * parallel_energy(h, reach)).epsilon(0.01));
    scene.period_mm[1] = h * 0.6;  // and the image of its image
    const double both =
        parallel_energy(0.6 * h, reach) + parallel_energy(1.2 * h, reach) + parallel_energy(1.8 * h, reach);
    CHECK(energy_of(scene, {.elastic = false}) == Approx(3 * both).epsilon(0.01));
}
