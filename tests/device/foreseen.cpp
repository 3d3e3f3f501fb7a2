// The memory that a device is expected to take, against what relaxations took.

#include <weave/sim/device/host_machines.hpp>
#include <weave/sim/device/relax_device.hpp>
#include <weave/sim/device/relax_on.hpp>

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/plan.hpp>

#include <catch2/catch.hpp>

#include <sim/scenes.hpp>

#include <string>
#include <vector>

using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

struct Taken {
    double foreseen, bytes;  ///< MB
    std::string counts;
};

/// What a relaxation takes in the end, with double forces.
Taken taken_by(const SimScene& scene, double most_seconds) {
    const Executor executor(2);
    const Fabric<double> fabric(scene);
    Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state();
    CoresMachine machine(executor);
    RelaxOptions options;
    options.residual = 1e-6;
    options.most_seconds = most_seconds;
    weave::sim::spread_points(energy, state);
    RelaxingCloth<double, Cores> cloth(machine.memory(), energy, state, options);
    lead<double>(machine, cloth);
    return {double(device_bytes(fabric)) / 1e6, double(cloth.bytes()) / 1e6,
            std::to_string(fabric.samples()) + " samples, " + std::to_string(fabric.segments()) + " segments, " + std::to_string(fabric.points()) + " points"};
}

/// `points`: a key point, or 0 for those of the fidelity.
void check_sample(const std::string& name, double most_seconds, std::size_t points = 0) {
    const weave::Design design = weave::find_sample(name)->make();
    const auto evaluation = weave::evaluate(design);
    for (const Fidelity fidelity : {Fidelity::draft, Fidelity::standard, Fidelity::reference}) {
        SimulationRequest request;
        request.fidelity = fidelity;
        if (points > 0) request.points_per_key = points;
        const auto plan = make_plan(design, *evaluation->block, request);
        REQUIRE(plan);
        double within_thickness = 0;
        for (const SimYarn& yarn : plan->scene.yarns) within_thickness += 2 * yarn.radius_mm * double(yarn.control.size()) / yarn.rest_mm / double(plan->scene.yarns.size());
        const Taken taken = taken_by(plan->scene, most_seconds);
        WARN(name << ", " << name_of(fidelity) << ", " << points << " (" << within_thickness << " in a thickness): " << taken.foreseen << " MB foreseen, " << taken.bytes << " taken (" << taken.foreseen / taken.bytes << "); " << taken.counts);
        CHECK(taken.foreseen > taken.bytes);
        CHECK(taken.foreseen < 2 * taken.bytes + 1);
    }
}

}  // namespace

TEST_CASE("foreseen: small samples take less memory than was foreseen, but not much less", "[device]") {
    for (const char* name : {"plain", "satin-5", "layer-to-layer"}) check_sample(name, 10);
}

TEST_CASE("foreseen: all samples take less memory than was foreseen", "[.][long][foreseen]") {
    for (const char* name : {"plain", "twill-2-2", "satin-5", "sateen-8", "rib", "basket", "herringbone", "satin-e", "twill-g", "layer-to-layer",
                             "angle-interlock-a", "angle-interlock-b", "orthogonal", "stitched-layers", "hexagon-tubes", "tl013-wrong",
                             "tl013-corrected", "i-beam", "pocket", "three-colour-stencil", "shoe-baby"})
        check_sample(name, 30);
}

TEST_CASE("foreseen: more points than usual", "[.][long][foreseen]") {
    for (const std::size_t points : {8, 16, 24, 40}) {
        for (const char* name : {"plain", "satin-5", "layer-to-layer"}) check_sample(name, 30, points);
    }
}
