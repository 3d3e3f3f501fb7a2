// Single yarns held at their ends, whose shapes and forces have formulas.

#include "scenes.hpp"

#include <weave/curve/spline.hpp>
#include <weave/sim/relax.hpp>

#include <catch2/catch.hpp>

#include <cmath>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

constexpr double length = 10, bending = 0.02, gravity = 9.80665e-3;

/// A yarn along x that hardly stretches, with `held` points frozen at its first and last end: one is a hinge,
/// for the spline has no curvature at its end; two hold its direction too.
SimScene held_yarn(std::size_t segments, double span, std::size_t first, std::size_t last,
                   double stretch = 1000) {
    SimYarn yarn = usual_yarn(0.2);
    yarn.is_fed = false;
    yarn.stretch_N = stretch;
    yarn.bending_N_mm2 = bending;
    yarn.rest_mm = length;
    yarn = laid(yarn, {0, 0, 0}, {span, 0, 0}, segments + 1);
    yarn.frozen.assign(segments + 1, 0);
    for (std::size_t i = 0; i < first; ++i) yarn.frozen[i] = 1;
    for (std::size_t i = 0; i < last; ++i) yarn.frozen[segments - i] = 1;
    SimScene scene;
    scene.yarns = {yarn};
    return scene;
}

/// Stiffness against displacement along z of the points that move, at the scene's straight state.
Eigen::MatrixXd across(const SimScene& scene) {
    Bench bench(scene);
    std::vector<std::size_t> moving;
    for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot) {
        if (bench.fabric.moves()[slot] != 0) moving.push_back(3 * slot + 2);
    }
    const auto size = static_cast<Eigen::Index>(moving.size());
    Eigen::MatrixXd stiffness(size, size);
    const double step = 1e-5;
    for (Eigen::Index i = 0; i < size; ++i) {
        std::vector<double> state = bench.state, gradient;
        state[moving[static_cast<std::size_t>(i)]] += step;
        bench.fabric.follow(state);
        bench.energy.evaluate(state, gradient);
        for (Eigen::Index j = 0; j < size; ++j)
            stiffness(j, i) = gradient[moving[static_cast<std::size_t>(j)]] / step;
    }
    return (stiffness + stiffness.transpose()) / 2;
}

/// The least compression at which a straight yarn gives way: K - F·B loses its stiffness there.
double buckling_force(std::size_t segments, std::size_t held) {
    const double shorter = 1e-6, force = 1000 * shorter;
    const Eigen::MatrixXd slack = across(held_yarn(segments, length, held, held)),
                          pressed = across(held_yarn(segments, length * (1 - shorter), held, held));
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen((slack - pressed) / force, slack);
    return 1 / eigen.eigenvalues()[slack.rows() - 1];
}

/// The inflexional elastica of one half wave between hinges: modulus k from span / length = 2 E(k)/K(k) - 1.
struct Elastica {
    double modulus;

    explicit Elastica(double span_share) {
        double low = 0, high = 0.99;
        for (int halving = 0; halving < 60; ++halving) {
            modulus = (low + high) / 2;
            const double span = 2 * std::comp_ellint_2(modulus) / std::comp_ellint_1(modulus) - 1;
            (span > span_share ? low : high) = modulus;
        }
    }
    [[nodiscard]] double rise() const { return length * modulus / std::comp_ellint_1(modulus); }
    [[nodiscard]] double force() const {
        const double wave = 2 * std::comp_ellint_1(modulus) / length;
        return wave * wave * bending;
    }
    [[nodiscard]] double energy() const {  // ½ EI ∫ κ² with κ = 2 k λ cn(λ s)
        const double whole = std::comp_ellint_1(modulus), wave = 2 * whole / length;
        const double squares =
            (std::comp_ellint_2(modulus) - (1 - modulus * modulus) * whole) / (modulus * modulus);
        return bending / 2 * 4 * modulus * modulus * wave * 2 * squares;
    }
};

struct Bent {
    double rise = 0, energy = 0;
};

Spline relaxed(SimScene scene, double swing, double& energy) {
    SimYarn& yarn = scene.yarns[0];
    for (Vec3& point : yarn.control)
        point.z() += swing * std::sin(std::numbers::pi * (point.x() / yarn.control.back().x()));
    Bench bench(scene);
    const RelaxResult result =
        relax(bench.energy, bench.state, {.residual = 1e-10, .most_iterations = 400, .watch = {}});
    CHECK(result.residual < 1e-8);
    energy = result.energy;
    return {bench.fabric.control(bench.state)[0], false, {0, 0, 0}};
}

/// Rise of a hinged yarn relaxed between ends so far apart.
Bent bent(std::size_t segments, double span) {
    Bent result;
    const double swing = std::sqrt(1 - span / length) * length * 0.6;
    const Spline spline = relaxed(held_yarn(segments, span, 1, 1), swing, result.energy);
    result.rise = spline.place(static_cast<double>(segments) / 2).z();
    return result;
}

/// Log of how errors fall, by halving.
double order(double coarse, double fine) {
    return std::log2(coarse / fine);
}

}  // namespace

TEST_CASE("a straight yarn between hinges buckles at π² EI / L²") {
    const double wanted = std::numbers::pi * std::numbers::pi * bending / (length * length);
    double errors[3];
    for (const int k : {0, 1, 2}) errors[k] = error_of(buckling_force(std::size_t{4} << k, 1), wanted);
    std::printf("hinged, 4, 8, 16 segments: errors %.2e %.2e %.2e, orders %.1f %.1f\n", errors[0], errors[1],
                errors[2], order(errors[0], errors[1]), order(errors[1], errors[2]));
    CHECK(errors[1] < 1e-3);
    CHECK(errors[2] < 1e-4);
}

TEST_CASE("a straight yarn whose ends are held buckles at 4 π² EI / L²") {
    const double wanted = 4 * std::numbers::pi * std::numbers::pi * bending / (length * length);
    double errors[3];
    for (const int k : {0, 1, 2}) errors[k] = error_of(buckling_force(std::size_t{8} << k, 2), wanted);
    std::printf("held, 8, 16, 32 segments: errors %.2e %.2e %.2e, orders %.1f %.1f\n", errors[0], errors[1],
                errors[2], order(errors[0], errors[1]), order(errors[1], errors[2]));
    // The held direction takes hold a third of a segment inside, so errors fall as segments do, and what is left of them
    // when that is taken off is small.
    CHECK(errors[2] < 0.04);
    CHECK(std::abs(2 * errors[2] - errors[1]) < 0.005);
}

TEST_CASE("a periodic yarn buckles at 4 π² EI / P², with the period as its wave") {
    const double wanted = 4 * std::numbers::pi * std::numbers::pi * bending / (length * length);
    const auto scene = [](double force) {
        SimYarn yarn = held_yarn(4, length, 0, 0).yarns[0];
        yarn.frozen.clear();
        yarn.rest_mm = length / (1 - force / 1000);
        yarn = laid(yarn, {0, 0, 0}, {length, 0, 0}, 16, true);
        yarn.turns = {1, 0};
        SimScene periodic;
        periodic.is_periodic = {true, false};
        periodic.period_mm = {length, 0};
        periodic.yarns = {yarn};
        return periodic;
    };
    const auto soft_modes = [&](double force) {
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(across(scene(force)));
        return (eigen.eigenvalues().array() < -1e-9).count();
    };
    CHECK(soft_modes(0.998 * wanted) == 0);
    CHECK(soft_modes(1.002 * wanted) == 2);  // sine and cosine
}

TEST_CASE("a held yarn that is pressed less than that stays straight, and more rises") {
    for (const double share : {0.9, 1.1}) {
        const double force = share * std::numbers::pi * std::numbers::pi * bending / (length * length);
        double energy = 0;
        // Soft enough that the force changes its length visibly.
        const Spline spline = relaxed(held_yarn(16, length * (1 - force / 1), 1, 1, 1), 0.05, energy);
        const double rise = spline.place(8).z();
        if (share < 1) CHECK(std::abs(rise) < 1e-4);
        if (share > 1) CHECK(rise > 0.05);
    }
}

TEST_CASE("a yarn bent between hinges is the elastica") {
    for (const double span_share : {0.95, 0.8, 0.5}) {
        const Elastica wanted(span_share);
        const double span = span_share * length, step = 1e-3;
        double errors[3];
        for (const int k : {0, 1, 2})
            errors[k] = error_of(bent(std::size_t{8} << k, span).rise, wanted.rise());
        std::printf("span %.2f, 8, 16, 32 segments: errors of the rise %.2e %.2e %.2e\n", span_share,
                    errors[0], errors[1], errors[2]);
        CHECK(errors[1] < 1e-2);
        CHECK(errors[2] < 1e-3);
        CHECK(bent(32, span).energy == Approx(wanted.energy()).epsilon(2e-3));
        const double force = (bent(32, span - step).energy - bent(32, span + step).energy) / (2 * step);
        CHECK(force == Approx(wanted.force()).epsilon(5e-3));
    }
}

TEST_CASE("a cantilever gives way by P L³ / 3 EI under a load at its tip, by q L⁴ / 8 EI under its weight") {
    double tip[3], weight[3];
    for (const int k : {0, 1, 2}) {
        const std::size_t segments = std::size_t{8} << k;
        SimScene scene = held_yarn(segments, length, 2, 0);
        const Eigen::MatrixXd stiffness = across(scene);
        const Eigen::Index last = stiffness.rows() - 1;
        const Eigen::VectorXd load = Eigen::VectorXd::Unit(stiffness.rows(), last);
        tip[k] = error_of(stiffness.ldlt().solve(load)[last], std::pow(length, 3) / (3 * bending));

        scene.gravity_mm_ms2 = gravity;
        scene.yarns[0].gram_per_mm = 1e-5;
        double energy = 0;
        const double low = relaxed(scene, 0, energy).control.back().z();
        weight[k] = error_of(-low, 1e-5 * gravity * std::pow(length, 4) / (8 * bending));
    }
    std::printf(
        "cantilever, 8, 16, 32 segments: errors %.2e %.2e %.2e at its tip, %.2e %.2e %.2e by weight\n",
        tip[0], tip[1], tip[2], weight[0], weight[1], weight[2]);
    CHECK(tip[2] < 0.03);
    CHECK(weight[2] < 0.04);
    CHECK(std::abs(2 * tip[2] - tip[1]) < 0.003);
    CHECK(std::abs(2 * weight[2] - weight[1]) < 0.003);
}

TEST_CASE("a heavy yarn without stiffness hangs as a catenary") {
    const double span = 8;
    SimScene scene = held_yarn(32, span, 1, 1);
    scene.yarns[0].bending_N_mm2 = 0;
    scene.yarns[0].gram_per_mm = 10;
    scene.gravity_mm_ms2 = gravity;
    double low = 0.1, high = 100;  // c of z = c cosh(x/c): sinh(span/2c) = length/2c
    for (int halving = 0; halving < 80; ++halving) {
        const double c = (low + high) / 2;
        (std::sinh(span / (2 * c)) * 2 * c > length ? low : high) = c;
    }
    const double sag = low * (std::cosh(span / (2 * low)) - 1);
    double energy = 0;
    const Spline spline = relaxed(scene, -2.5, energy);
    CHECK(-spline.place(16).z() == Approx(sag).epsilon(2e-3));
}
