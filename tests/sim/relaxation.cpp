#include "scenes.hpp"

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/relaxation.hpp>
#include <weave/sim/simulate.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

Plan plan_of(const std::string& name, Fidelity fidelity = Fidelity::draft) {
    const Design design = find_sample(name)->make();
    SimulationRequest request;
    request.fidelity = fidelity;
    return make_plan(design, *evaluate(design)->block, request).value();
}

std::size_t lost_in(const Plan& plan, const SimScene& scene) {
    std::vector<Spline> splines(plan.curves.yarns.size());
    for (std::size_t y = 0; y < scene.yarns.size(); ++y)
        splines[plan.curve_of[y]] = {scene.yarns[y].control, scene.yarns[y].is_periodic, scene.yarns[y].shift};
    return lost_crossings(plan.curves, splines).size();
}

bool is_finite(const SimScene& scene) {
    for (const SimYarn& yarn : scene.yarns) {
        for (const Vec3& point : yarn.control) {
            if (!point.allFinite()) return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("parameters that jump over their whole range leave every crossing as it was, and no broken number") {
    const Plan plan = plan_of("satin-5");
    Relaxation relaxation(plan, 1);
    const RelaxOptions options{.residual = 1e-2, .most_iterations = 300, .watch = {}};
    CHECK(relaxation.run(options).ending == Ending::converged);
    const std::vector<LiveParameters> jumps{{1.5, 1, 1},  {1, 1, 1},    {1.01, 1, 1.6}, {1.01, 1, 0.3},
                                            {1.01, 100, 1}, {1.01, 0.01, 1}, {1.2, 10, 0.6}, {1.01, 1, 1}};
    for (const LiveParameters& jump : jumps) {
        INFO("S " << jump.strain << ", stiffness " << jump.stiffness << ", radius " << jump.radius);
        REQUIRE(relaxation.set(System::warp, jump));
        REQUIRE(relaxation.set(System::weft, jump));
        const RelaxResult result = relaxation.run(options);
        CHECK(std::isfinite(result.residual));
        CHECK(is_finite(relaxation.scene()));
        CHECK(lost_in(plan, relaxation.scene()) == 0);
        CHECK(relaxation.now(System::warp).strain == jump.strain);
        CHECK(relaxation.now(System::warp).radius == jump.radius);
        CHECK(relaxation.scene().yarns[0].radius_mm == Approx(plan.scene.yarns[0].radius_mm * jump.radius));
    }
}

TEST_CASE("parameters out of range are refused and change nothing") {
    Relaxation relaxation(plan_of("plain"), 1);
    CHECK_FALSE(relaxation.set(System::warp, {0.9, 1, 1}));
    CHECK_FALSE(relaxation.set(System::warp, {1.01, 0, 1}));
    CHECK_FALSE(relaxation.set(System::warp, {1.01, 1, -1}));
    CHECK_FALSE(relaxation.set(System::warp, {1.01, std::nan(""), 1}));
    relaxation.run({.residual = 1e-2, .watch = {}});
    CHECK(relaxation.now(System::warp).radius == 1);
}

TEST_CASE("a strain reached by and by gives the cloth that a scene with it gives") {
    const Design design = find_sample("plain")->make();
    const BlockPtr block = evaluate(design)->block;
    Design tighter = design;
    tighter.scene.warp.strain = 1.06;
    const Plan plan = make_plan(design, *block, {}).value(), wanted = make_plan(tighter, *block, {}).value();
    Relaxation live(plan, 1), fresh(wanted, 1);
    const RelaxOptions options{.residual = 1e-7, .watch = {}};
    live.run(options);
    REQUIRE(live.set(System::warp, {1.06, 1, 1}));
    const RelaxResult moved = live.run(options), direct = fresh.run(options);
    CHECK(moved.energy == Approx(direct.energy).epsilon(1e-4));
}

TEST_CASE("a run that is stopped on its way keeps what it has, and the next goes on") {
    const Plan plan = plan_of("plain");
    Relaxation relaxation(plan, 1);
    relaxation.run({.residual = 1e-3, .watch = {}});
    REQUIRE(relaxation.set(System::warp, {1.4, 1, 1}));
    const RelaxResult stopped = relaxation.run({.residual = 1e-3, .watch = [](const Progress&) { return false; }});
    CHECK(stopped.ending == Ending::stopped);
    CHECK(relaxation.now(System::warp).strain < 1.4);
    CHECK(is_finite(relaxation.scene()));
    CHECK(relaxation.run({.residual = 1e-3, .watch = {}}).ending == Ending::converged);
    CHECK(relaxation.now(System::warp).strain == 1.4);
}
