#pragma once

#include <weave/sim/energy.hpp>
#include <weave/sim/hessian.hpp>

#include <Eigen/Dense>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <support/random.hpp>
#include <vector>

namespace weave::sim::testing {

using weave::testing::Random;

inline double uniform(Random& random, double low, double high) {
    constexpr std::size_t steps = std::size_t{1} << 40;
    return low + (high - low) * static_cast<double>(random.between(0, steps)) / static_cast<double>(steps);
}

inline Vec3 jitter(Random& random, double size) {
    const double x = uniform(random, -size, size), y = uniform(random, -size, size);
    return {x, y, uniform(random, -size, size)};
}

/// A scene with its arithmetic; what belongs together keeps its place, since parts refer to one another.
template <class Real = double>
struct Bench {
    Executor executor;
    Fabric<Real> fabric;
    Energy<Real> energy;
    std::vector<Real> state, gradient;

    explicit Bench(const SimScene& scene, std::size_t threads = 1)
        : executor(threads), fabric(scene), energy(fabric, executor), state(fabric.state()) {}
    Bench(const Bench&) = delete;
    Bench& operator=(const Bench&) = delete;

    double evaluate(Terms terms = {}) { return energy.evaluate(state, gradient, terms); }
    /// Energy after numbers of a control point have changed.
    double energy_at(std::vector<Real> changed, Terms terms = {}) {
        fabric.follow(changed);
        std::vector<Real> unused;
        return energy.evaluate(changed, unused, terms);
    }
    /// Index in the state of a control point's x.
    [[nodiscard]] std::size_t at(std::size_t yarn, std::size_t point) const {
        return 3 * (fabric.yarns()[yarn].first_slot + 1 + point);
    }
    /// Sum of the gradient over the control points of a yarn, N.
    [[nodiscard]] Vec3 pull_on(std::size_t yarn) const {
        Vec3 sum(0, 0, 0);
        for (std::size_t i = 0; i < fabric.yarns()[yarn].points; ++i)
            sum += load(&gradient[at(yarn, i)]).template cast<double>();
        return sum;
    }
};

/// A yarn of usual stiffness, without points. Forces are of the order of 1 N.
inline SimYarn usual_yarn(double radius_mm = 0.12) {
    SimYarn yarn;
    yarn.radius_mm = radius_mm;
    yarn.stretch_N = 40;
    yarn.bending_N_mm2 = 0.02;
    yarn.contact_N_mm2 = 3;
    yarn.is_fed = true;
    yarn.strain = 1.02;
    return yarn;
}

/// Lays evenly spread points from one place to another: of an open yarn both ends, of a periodic one the last
/// goes on to `to`, which is the first of the next repeat.
inline SimYarn laid(SimYarn yarn, const Vec3& from, const Vec3& to, std::size_t points,
                    bool is_periodic = false) {
    yarn.is_periodic = is_periodic;
    yarn.shift = is_periodic ? Vec3(to - from) : Vec3(0, 0, 0);
    yarn.control.clear();
    const auto segments = static_cast<double>(is_periodic ? points : points - 1);
    for (std::size_t i = 0; i < points; ++i)
        yarn.control.push_back(from + (to - from) * (static_cast<double>(i) / segments));
    if (yarn.rest_mm == 0) yarn.rest_mm = (to - from).norm();
    return yarn;
}

inline void shake(Random& random, SimYarn& yarn, double size) {
    for (Vec3& point : yarn.control) point += jitter(random, size);
}

/// Free yarns that lie across one another in a heap, fed and of fixed length, radii from `least` to 0.12 mm.
inline SimScene heap(Random& random, std::size_t yarns, double least = 0.12) {
    SimScene scene;
    double z = 0;
    for (std::size_t y = 0; y < yarns; ++y) {
        SimYarn yarn = usual_yarn(y == 0 ? 0.12 : uniform(random, least, 0.12));
        yarn.is_fed = random.coin();
        yarn.contact_N_mm2 = uniform(random, 1, 4);
        if (y > 0) z += 0.7 * (yarn.radius_mm + scene.yarns.back().radius_mm);
        const double turn = uniform(random, 0, std::numbers::pi);
        const Vec3 along(std::cos(turn), std::sin(turn), 0), middle = Vec3(0, 0, z) + jitter(random, 0.02);
        yarn = laid(yarn, middle - 0.8 * along, middle + 0.8 * along, 6);
        shake(random, yarn, 0.03);
        scene.yarns.push_back(yarn);
    }
    return scene;
}

/// One layer of plain weave, periodic in both directions: warps fed along x, wefts of fixed length along y.
/// `swing` is the height of its waves in radii; 1 lets centrelines clear one another by two.
struct WeaveShape {
    std::size_t count = 2, points_a_crossing = 4;
    double pitch_mm = 0.5, radius_mm = 0.12, swing = 1;
};

inline SimScene plain_weave(const WeaveShape& shape) {
    SimScene scene;
    const double size = static_cast<double>(shape.count) * shape.pitch_mm;
    scene.is_periodic = {true, true};
    scene.period_mm = {size, size};
    for (const bool warp : {true, false}) {
        for (std::size_t y = 0; y < shape.count; ++y) {
            SimYarn yarn = usual_yarn(shape.radius_mm);
            yarn.is_fed = warp;
            yarn.rest_mm = 1.05 * size;
            const double across = (static_cast<double>(y) + 0.5) * shape.pitch_mm;
            const Vec3 from = warp ? Vec3(0, across, 0) : Vec3(across, 0, 0);
            const Vec3 along = warp ? Vec3(size, 0, 0) : Vec3(0, size, 0);
            yarn = laid(yarn, from, from + along, shape.count * shape.points_a_crossing, true);
            yarn.turns = {warp ? 1 : 0, warp ? 0 : 1};
            for (Vec3& point : yarn.control) {
                const double wave =
                    std::sin(std::numbers::pi * (warp ? point.x() : point.y()) / shape.pitch_mm);
                const double side = (y % 2 == 0 ? 1 : -1) * (warp ? 1 : -1);
                point.z() = side * wave * shape.swing * shape.radius_mm;
            }
            scene.yarns.push_back(yarn);
        }
    }
    return scene;
}

/// Relative error where the right value is not 0.
inline double error_of(double value, double right) {
    return std::abs(value / right - 1);
}

/// A rod without weight, straight and pressed together along itself, held at both ends.
inline SimScene pressed_rod() {
    SimScene scene;
    SimYarn yarn = laid(usual_yarn(), {0, 0, 0}, {2, 0, 0}, 17, false);
    yarn.is_fed = false;
    yarn.rest_mm = 2.2;
    yarn.frozen.assign(17, 0);
    for (const std::size_t point : {0, 1, 15, 16}) yarn.frozen[point] = 1;
    scene.yarns = {yarn};
    return scene;
}

}  // namespace weave::sim::testing
