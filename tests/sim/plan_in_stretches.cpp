// A plan whose points are made stretch by stretch is the plan of the whole.

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/plan_in_stretches.hpp>

#include <catch2/catch.hpp>

#include <map>
#include <string>

using namespace weave;
using namespace weave::sim;

namespace {

struct Asked {
    std::string sample;
    SimulationRequest request;
};

std::vector<Asked> asked() {
    std::vector<Asked> all;
    const auto add = [&](const std::string& sample) -> SimulationRequest& {
        all.push_back({sample, {}});
        all.back().request.fidelity = Fidelity::draft;
        return all.back().request;
    };
    add("plain");
    add("angle-interlock-b").reduce = false;
    add("hexagon-tubes").points_per_key = 3.3;
    add("satin-e").weft_mode = WeftMode::wraparound;
    add("pocket");
    add("shoe-baby");
    add("twill-g").region = Region{0, 4, 1, 6};
    add("orthogonal").held = {{0, 0}, {1, 2}};
    add("orthogonal").weft_mode = WeftMode::wraparound;
    return all;
}

double worst_apart = 0;

}  // namespace

TEST_CASE("a plan in stretches has the points, the yarns and the crossings of the whole plan") {
    worst_apart = 0;
    for (const Asked& one : asked()) {
        Design design = find_sample(one.sample)->make();
        design.scene.pins = {{true, 1}, {false, 1}};
        const BlockPtr block = evaluate(design)->block;
        const Plan whole = make_plan(design, *block, one.request).value();
        for (const std::size_t points : {37, 150, 1 << 20}) {
            INFO(one.sample << " in stretches of " << points);
            const auto made = PlanInStretches::make(design, *block, one.request, points);
            REQUIRE(made);
            const Plan& plan = made->plan();
            REQUIRE(plan.scene.yarns.size() == whole.scene.yarns.size());
            CHECK(plan.curve_of == whole.curve_of);
            for (std::size_t y = 0; y < plan.scene.yarns.size(); ++y) {
                const SimYarn &a = plan.scene.yarns[y], &b = whole.scene.yarns[y];
                REQUIRE(made->points(y) == b.control.size());
                REQUIRE((a.control.empty() && a.is_periodic == b.is_periodic && a.shift == b.shift && a.radius_mm == b.radius_mm && a.is_fed == b.is_fed && a.turns == b.turns));
                REQUIRE(a.planned_mm == Approx(b.planned_mm).epsilon(1e-13));
                REQUIRE(a.rest_mm == Approx(b.rest_mm).epsilon(1e-13));
            }
            CHECK(lines_json(plan) == lines_json(whole));
            std::size_t seen = 0;
            made->each_stretch([&](const Stretch& stretch) {
                const SimYarn& yarn = whole.scene.yarns[stretch.yarn];
                const auto count = static_cast<std::ptrdiff_t>(yarn.control.size());
                seen += stretch.last - stretch.first;
                REQUIRE(stretch.control.size() == stretch.frozen.size());
                const std::ptrdiff_t end = stretch.begin + static_cast<std::ptrdiff_t>(stretch.control.size());
                REQUIRE(stretch.begin == (yarn.is_periodic ? std::ptrdiff_t(stretch.first) - 3 : std::max<std::ptrdiff_t>(0, std::ptrdiff_t(stretch.first) - 3)));
                REQUIRE(end == (yarn.is_periodic ? std::ptrdiff_t(stretch.last) + 3 : std::min(count, std::ptrdiff_t(stretch.last) + 3)));
                for (std::size_t k = 0; k < stretch.control.size(); ++k) {
                    const std::size_t index = static_cast<std::size_t>(((stretch.begin + std::ptrdiff_t(k)) % count + count) % count);
                    worst_apart = std::max(worst_apart, (stretch.control[k] - yarn.control[index]).norm());
                    REQUIRE((stretch.frozen[k] != 0) == (!yarn.frozen.empty() && yarn.frozen[index] != 0));
                    REQUIRE(made->points(stretch.yarn) == yarn.control.size());
                }
            });
            std::size_t points_of_all = 0;
            for (const SimYarn& yarn : whole.scene.yarns) points_of_all += yarn.control.size();
            CHECK(seen == points_of_all);
            std::vector<Crossing> crossings;
            made->each_crossing([&](const Crossing& crossing) { crossings.push_back(crossing); });
            REQUIRE(crossings.size() == whole.curves.crossings.size());
            for (std::size_t k = 0; k < crossings.size(); ++k) {
                const Crossing &a = crossings[k], &b = whole.curves.crossings[k];
                if (a.weft != PlanInStretches::none) REQUIRE(plan.curve_of[a.weft] == b.weft);
                if (a.warp != PlanInStretches::none) REQUIRE(plan.curve_of[a.warp] == b.warp);
                REQUIRE((a.weft_key == b.weft_key && a.warp_key == b.warp_key && a.pick == b.pick && a.end == b.end && a.weft_over == b.weft_over));
            }
        }
    }
    CHECK(worst_apart < 1e-12);  // mm
}

TEST_CASE("a point has the same bits in whichever stretch it stands") {
    Design design = find_sample("pocket")->make();
    const BlockPtr block = evaluate(design)->block;
    SimulationRequest request;
    request.weft_mode = WeftMode::wraparound;
    const auto made = PlanInStretches::make(design, *block, request, 50);
    REQUIRE(made);
    std::map<std::pair<std::size_t, std::size_t>, Vec3> places;
    std::size_t again = 0;
    made->each_stretch([&](const Stretch& stretch) {
        const auto count = static_cast<std::ptrdiff_t>(made->points(stretch.yarn));
        for (std::size_t k = 0; k < stretch.control.size(); ++k) {
            const auto index = static_cast<std::size_t>(((stretch.begin + std::ptrdiff_t(k)) % count + count) % count);
            const auto [at, is_new] = places.emplace(std::pair(stretch.yarn, index), stretch.control[k]);
            REQUIRE(at->second == stretch.control[k]);
            again += is_new ? 0 : 1;
        }
    });
    CHECK(again > 100);
    CHECK(made->point(0, 77) == places.at({0, 77}));
}

TEST_CASE("a plan in stretches refuses what a plan refuses") {
    Design design = find_sample("satin-5")->make();
    design.scene.boundary_x = Boundary::free;
    const BlockPtr block = evaluate(design)->block;
    const auto refused = PlanInStretches::make(design, *block, {}, 20);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().text() == make_plan(design, *block, {}).error().text());
    SimulationRequest nowhere;
    nowhere.held = {{3000, 1}};
    CHECK(PlanInStretches::make(design, *block, nowhere).error().text() == make_plan(design, *block, nowhere).error().text());
}
