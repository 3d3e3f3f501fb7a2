#pragma once

// Scenes, and their relaxations here and there from the same start.

#include "relaxers.hpp"

#include <weave/sim/deviation.hpp>
#include <weave/sim/device/relax_stages.hpp>

#include <sim/scenes.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace device_tests {

using namespace weave::sim;
using namespace weave::sim::testing;
using weave::Spline;
using weave::Vec3;

struct Rest {
    RelaxResult result;
    std::vector<double> state;
};

/// A scene and its relaxations, all from the same start.
struct Relaxed {
    Bench<double> bench;

    explicit Relaxed(const SimScene& scene) : bench(scene) {}

    Rest here(const RelaxOptions& options) {
        Rest rest{{}, bench.state};
        rest.result = relax(bench.energy, rest.state, options);
        return rest;
    }
    template <class Real, class Relaxer>
    Rest there(Relaxer& relaxer, const RelaxOptions& options) {
        Rest rest{{}, bench.state};
        rest.result = relax_on<Real>(relaxer.machine, bench.energy, rest.state, options);
        return rest;
    }

    [[nodiscard]] std::vector<Spline> splines(const std::vector<double>& state) const {
        std::vector<Spline> splines;
        const auto control = bench.fabric.control(state);
        for (std::size_t y = 0; y < control.size(); ++y) {
            const SimYarn& yarn = bench.fabric.scene().yarns[y];
            splines.push_back({control[y], yarn.is_periodic, yarn.shift});
        }
        return splines;
    }
    /// How far two states lie apart, in radii of the thinnest yarn. Cloth without held points may have drifted.
    [[nodiscard]] double apart(const Rest& a, const Rest& b) const {
        const bool held = std::ranges::any_of(bench.fabric.scene().yarns, [](const SimYarn& yarn) { return !yarn.frozen.empty(); });
        return deviation_of(splines(a.state), splines(b.state), !held).max_mm / (bench.fabric.least_reach() / 2);
    }
};

/// A weave whose repeats lie a little differently, so that it begins at no saddle.
inline SimScene shaken_weave(std::size_t count) {
    Random random(5);
    SimScene scene = plain_weave({.count = count});
    for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.01);
    return scene;
}

inline SimScene held_weave(std::size_t count) {
    SimScene scene = shaken_weave(count);
    for (SimYarn& yarn : scene.yarns) {
        yarn.frozen.assign(yarn.control.size(), 0);
        yarn.frozen.front() = 1;
    }
    scene.yarns.front().frozen.assign(scene.yarns.front().control.size(), 1);
    return scene;
}

/// Pushed by a field, and heavy.
inline SimScene pushed_weave(std::size_t count) {
    SimScene scene = held_weave(count);
    scene.fields.push_back({.centre_mm = {1, 1, -0.3}, .radius_mm = 0.7, .strength_N_per_mm = 0.5});
    scene.gravity_mm_ms2 = 9.81e-3;
    for (SimYarn& yarn : scene.yarns) yarn.gram_per_mm = 1e-3;
    return scene;
}

/// Held at one end of each yarn: where they are not, such yarns slide to one of many rests.
inline SimScene thick_and_thin(std::size_t count) {
    SimScene scene = held_weave(count);
    for (std::size_t y = 0; y < scene.yarns.size(); y += 3) scene.yarns[y].radius_mm *= 0.75;
    return scene;
}

/// Cloth of few yarns of all kinds that a device must relax, by name; each has one rest near its start.
inline std::vector<std::pair<const char*, SimScene>> several(std::size_t count) {
    return {{"free", shaken_weave(count)}, {"held", held_weave(count)}, {"pushed", pushed_weave(count)}, {"thick and thin", thick_and_thin(count)}};
}

inline RelaxOptions to(double residual) {
    RelaxOptions options;
    options.residual = residual;
    return options;
}

}  // namespace device_tests
