// What a plan is expected to take, before it relaxes.

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/forecast.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;

TEST_CASE("a plan's points are those of its yarns, and memory grows with them") {
    const Design design = find_sample("plain")->make();
    const Evaluation evaluation = evaluate(design).value();
    std::size_t last = 0;
    for (const Fidelity fidelity : {Fidelity::draft, Fidelity::standard, Fidelity::reference}) {
        SimulationRequest request;
        request.fidelity = fidelity;
        const Plan plan = make_plan(design, *evaluation.block, request).value();
        std::size_t points = 0;
        for (const SimYarn& yarn : plan.scene.yarns) points += yarn.control.size();
        CHECK(points_of(plan) == points);
        CHECK(points > last);
        CHECK(goal_of(fidelity) == plan.goal);
        last = points;
    }
    CHECK(expected_bytes(1'000'000) > 5'700'000'000);  // as was measured of 980,000
    CHECK(expected_bytes(2000) < 100'000'000);
    CHECK(points_within(expected_bytes(2000)) == 2000);
    CHECK(points_within(expected_bytes(2000) - 1) == 1999);
    CHECK(points_within(1000) == 0);
    CHECK(memory_text(std::uint64_t{56} << 20) == "56 MiB");
    CHECK(memory_text(std::uint64_t{31} << 30) == "31.0 GiB");
}
