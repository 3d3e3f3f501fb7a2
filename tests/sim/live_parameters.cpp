#include "scenes.hpp"

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/plan_run.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

Plan plan_of(const Design& design) {
    SimulationRequest request;
    request.fidelity = Fidelity::draft;
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
    const Design design = find_sample("satin-5")->make();
    const Plan plan = plan_of(design);
    PlanRun run(design, plan, {.residual = 1e-2}, 1);
    run.relax({});
    CHECK(run.is_at_rest());
    const std::vector<LiveParameters> jumps{{1.5, 1, 1},  {1, 1, 1},    {1.01, 1, 1.6}, {1.01, 1, 0.3},
                                            {1.01, 100, 1}, {1.01, 0.01, 1}, {1.2, 10, 0.6}, {1.01, 1, 1}};
    for (const LiveParameters& jump : jumps) {
        INFO("S " << jump.strain << ", stiffness " << jump.stiffness << ", radius " << jump.radius);
        REQUIRE(run.ask(System::warp, jump));
        REQUIRE(run.ask(System::weft, jump));
        for (int leg = 0; leg < 40 && !run.at_end() && !(leg > 20 && run.parameters().have_arrived()); ++leg) run.leg(300, {});
        CHECK(std::isfinite(run.last().residual));
        CHECK(is_finite(run.scene()));
        CHECK(lost_in(plan, run.scene()) == 0);
        CHECK(run.parameters().now(System::warp).strain == jump.strain);
        CHECK(run.parameters().now(System::warp).radius == jump.radius);
        CHECK(run.scene().yarns[0].radius_mm == Approx(plan.scene.yarns[0].radius_mm * jump.radius));
    }
}

TEST_CASE("parameters out of range are refused and change nothing") {
    const Design design = find_sample("plain")->make();
    PlanRun run(design, plan_of(design), {.residual = 1e-2}, 1);
    CHECK_FALSE(run.ask(System::warp, {0.9, 1, 1}));
    CHECK_FALSE(run.ask(System::warp, {1.01, 0, 1}));
    CHECK_FALSE(run.ask(System::warp, {1.01, 1, -1}));
    CHECK_FALSE(run.ask(System::warp, {1.01, std::nan(""), 1}));
    run.relax({});
    CHECK(run.parameters().now(System::warp).radius == 1);
}

TEST_CASE("a strain reached by and by gives the cloth that a scene with it gives") {
    const Design design = find_sample("plain")->make();
    Design tighter = design;
    tighter.scene.warp.strain = 1.06;
    const BlockPtr block = evaluate(design)->block;
    const Plan plan = make_plan(design, *block, {}).value(), wanted = make_plan(tighter, *block, {}).value();
    PlanRun live(design, plan, {.residual = 1e-7}, 1), fresh(tighter, wanted, {.residual = 1e-7}, 1);
    live.relax({});
    REQUIRE(live.ask(System::warp, {1.06, 1, 1}));
    live.relax({});
    fresh.relax({});
    CHECK(live.last().energy == Approx(fresh.last().energy).epsilon(1e-4));
}

TEST_CASE("a run that is stopped on its way keeps what it has, and the next goes on") {
    const Design design = find_sample("plain")->make();
    PlanRun run(design, plan_of(design), {.residual = 1e-3}, 1);
    run.relax({});
    REQUIRE(run.ask(System::warp, {1.4, 1, 1}));
    run.relax([](const Progress&) { return false; });
    CHECK(run.last().ending == Ending::stopped);
    CHECK(run.parameters().now(System::warp).strain < 1.4);
    CHECK(is_finite(run.scene()));
    run.relax({});
    CHECK(run.is_at_rest());
    CHECK(run.parameters().now(System::warp).strain == 1.4);
}
