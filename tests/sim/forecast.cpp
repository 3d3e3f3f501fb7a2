// What a plan is expected to take, before it relaxes.

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/forecast.hpp>
#include <weave/sim/simulate.hpp>
#include <weave/sim/yarns_file.hpp>

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

TEST_CASE("a cloth of many repeats is expected to take what its copies and their file take, and one that no file holds is not begun") {
    const Design design = find_sample("plain")->make();
    const auto tiled = [&](std::size_t times) {
        Design many = design;
        many.blocks["many"] = std::make_shared<const Node>(Node{TileOperation{many.root, times, times, 1}, {}});
        many.root = "many";
        return many;
    };
    const auto plan_of = [](const Design& of) { return make_plan(of, *evaluate(of).value().block, {}); };
    const Plan one = plan_of(tiled(4)).value(), many = plan_of(tiled(40)).value();
    REQUIRE(points_of(one) == points_of(many));
    CHECK(copied_bytes(many) == 100 * copied_bytes(one));
    CHECK(expected_bytes(many) == expected_bytes(points_of(many)) + copied_bytes(many));
    const Yarns yarns = simulate(tiled(4), one, {});
    std::size_t in_memory = yarns.crossings.size() * sizeof(Crossing);
    for (const SimulatedYarn& yarn : yarns.yarns) in_memory += 2 * yarn.planned.size() * sizeof(Vec3) + 2 * yarn.strain.size() * sizeof(double);
    const std::size_t file = write_yarns(yarns).value().size();
    CHECK(copied_bytes(one) >= in_memory);
    CHECK(copied_bytes(one) <= in_memory + file);
    CHECK(2 * copied_bytes(one) > in_memory + file);  // the file's header is not counted

    const auto no_file = plan_of(tiled(1500));  // 2,250,000 repeats of 32 points
    REQUIRE_FALSE(no_file);
    CHECK(no_file.error().code == ErrorCode::refused);
    CHECK_THAT(no_file.error().message, Catch::Contains("72000000 control points, and a .yarns file has at most 67108864"));
}
