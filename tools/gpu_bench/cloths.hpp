#pragma once

#include <weave/sim/energy.hpp>
#include <weave/sim/plan.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace weave::gpu_bench {

/// The scene of a sample in the points of a fidelity, in its smallest repeat or tiled so many times each way and unreduced. With a
/// seed, and where it is tiled, its points are moved by up to 0.02 of their yarn's radius, so that it begins on no saddle.
sim::SimScene sample_scene(const std::string& name, sim::Fidelity fidelity, std::uint32_t tiles = 1, std::uint32_t seed = 0);

/// A scene with all that its relaxation needs, here.
struct Cloth {
    sim::Executor executor;
    sim::Fabric<double> fabric;
    sim::Energy<double> energy;
    std::vector<double> state;

    /// `threads`: 0 for one a core.
    explicit Cloth(const sim::SimScene& scene, std::size_t threads = 0)
        : executor(threads), fabric(scene), energy(fabric, executor), state(fabric.state()) {}
    Cloth(const Cloth&) = delete;
    Cloth& operator=(const Cloth&) = delete;
};

}  // namespace weave::gpu_bench
