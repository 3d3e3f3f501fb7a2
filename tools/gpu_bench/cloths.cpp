#include "cloths.hpp"

#include <weave/block/operations.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>

#include <random>

namespace weave::gpu_bench {

sim::SimScene sample_scene(const std::string& name, sim::Fidelity fidelity, std::uint32_t tiles, std::uint32_t seed) {
    const Design design = find_sample(name)->make();
    Block block = *evaluate(design)->block;
    if (tiles > 1) block = tile(block, tiles, tiles, 1).value();
    sim::SimulationRequest request;
    request.fidelity = fidelity;
    request.reduce = tiles == 1;
    sim::SimScene scene = sim::make_plan(design, block, request).value().scene;
    std::mt19937_64 random(seed);
    for (sim::SimYarn& yarn : scene.yarns) {
        if (tiles == 1 && seed == 0) break;
        for (Vec3& point : yarn.control) {
            for (int k = 0; k < 3; ++k) point[k] += 0.02 * yarn.radius_mm * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
        }
    }
    return scene;
}

}  // namespace weave::gpu_bench
