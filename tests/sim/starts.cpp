// Starts that differ a little, and repeats that should lie alike.

#include "scenes.hpp"

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/starts.hpp>
#include <weave/sim/symmetry.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

struct Planned {
    Design design;
    Plan plan, whole;  ///< smallest repeat, and all of it
};

Planned planned(const std::string& name) {
    Planned of;
    of.design = find_sample(name)->make();
    const BlockPtr block = evaluate(of.design)->block;
    SimulationRequest request;
    request.fidelity = Fidelity::draft;
    of.plan = make_plan(of.design, *block, request).value();
    request.reduce = false;
    of.whole = make_plan(of.design, *block, request).value();
    return of;
}

SimulationOptions on_one_core() {
    SimulationOptions options;
    options.threads = 1;
    return options;
}

std::vector<Spline> splines_of(const Plan& plan, const StartState& start) {
    std::vector<Spline> splines(plan.curves.yarns.size());
    for (std::size_t y = 0; y < plan.scene.yarns.size(); ++y)
        splines[plan.curve_of[y]] = {start.control[y], plan.scene.yarns[y].is_periodic,
                                     plan.scene.yarns[y].shift};
    return splines;
}

}  // namespace

TEST_CASE(
    "a start with noise is near the start, the same for the same seed, and no yarn has gone through "
    "another") {
    for (const char* name : {"satin-5", "layer-to-layer", "orthogonal"}) {
        const Plan plan = planned(name).plan;
        double farthest = 0;
        for (const std::uint64_t seed : {1, 2, 3}) {
            const StartState start = perturbed_start(plan, {}, seed, 1);
            CHECK(start.control == perturbed_start(plan, {}, seed, 2).control);
            CHECK(start.control != perturbed_start(plan, {}, seed + 1, 1).control);
            CHECK(lost_crossings(plan.curves, splines_of(plan, start)).empty());
            for (std::size_t y = 0; y < start.control.size(); ++y) {
                for (std::size_t i = 0; i < start.control[y].size(); ++i) {
                    const SimYarn& yarn = plan.scene.yarns[y];
                    farthest =
                        std::max(farthest, (start.control[y][i] - yarn.control[i]).norm() / yarn.radius_mm);
                }
            }
        }
        CHECK(farthest <= start_noise_radii * 1.000001);
        CHECK(farthest > start_noise_radii / 2);
    }
}

TEST_CASE("noise gives way where yarns all but meet, and frozen points stay") {
    Plan plan = planned("satin-5").plan;
    for (SimYarn& yarn : plan.scene.yarns) {
        for (Vec3& point : yarn.control) point.z() *= 0.01;  // all crossings far closer than the noise
    }
    plan.scene.yarns[0].frozen.assign(plan.scene.yarns[0].control.size(), 0);
    plan.scene.yarns[0].frozen[2] = 1;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const StartState start = perturbed_start(plan, {}, seed, 1);
        CHECK(start.control[0][2] == plan.scene.yarns[0].control[2]);
        CHECK(lost_crossings(plan.curves, splines_of(plan, start)).empty());
    }
}

TEST_CASE("relaxing again begins at the starts with noise also where the first run had begun in fewer points") {
    const Planned of = planned("satin-5");
    SimulationOptions options = on_one_core();
    options.backend = Backend::cpu;
    const Yarns yarns = simulate(of.design, of.plan, options);
    const Json right = relaxed_again(of.design, of.plan, options, yarns, 2);
    options.coarser = &of.plan;
    const Json found = relaxed_again(of.design, of.plan, options, yarns, 2);
    CHECK(found == right);
    CHECK(found.at("each")[1] != found.at("each")[2]);
    CHECK(found.at("at_once") == false);
}

TEST_CASE("relaxing again from other starts tells how far the results lie apart") {
    const Planned of = planned("satin-5");
    SimulationOptions options = on_one_core();
    options.residual = 1e-5;
    Yarns yarns = simulate(of.design, of.plan, options);
    const Json told = relaxed_again(of.design, of.plan, options, yarns, 3);
    INFO(told.dump());
    CHECK(told.at("runs") == 3);
    CHECK(told.at("asked") == 3);
    CHECK(told.at("each").size() == 4);
    CHECK(told.at("not_at_rest") == 0);
    CHECK(told.at("order_lost") == 0);
    CHECK(told.at("elsewhere") == 0);
    CHECK(told.at("furthest").at("max_radii").get<double>() > 0);
    CHECK(told.at("furthest").at("max_radii").get<double>() < same_rest_radii);
    CHECK(told.at("warp_crimp").at("least").get<double>() <= told.at("warp_crimp").at("most").get<double>());
    CHECK(told == relaxed_again(of.design, of.plan, options, yarns, 3));
    yarns.report["starts"] = told;
    CHECK(starts_text(yarns.report).rfind("Not sensitive to its start: 3 more relaxations", 0) == 0);
    yarns.report["starts"]["asked"] = 1000;
    CHECK(starts_text(yarns.report).find("3 more relaxations (of 1000 asked for)") != std::string::npos);
    yarns.report["starts"]["elsewhere"] = 2;
    CHECK(starts_text(yarns.report).rfind("SENSITIVE to its start: of 3 more relaxations", 0) == 0);
}

TEST_CASE("what a report from anywhere says of starts and symmetry is never a fault") {
    for (
        const char* text :
        {"{}", R"({"starts":3})", R"({"starts":{"runs":"x"}})", R"({"starts":{"runs":1e300}})",
         R"({"symmetry":[]})",
         R"({"starts":{"runs":1,"elsewhere":1,"furthest":{"kind":"end","number":"x"},"warp_crimp":{"least":[]}}})",
         R"({"symmetry":{"broken":true,"between_repeats":{"kind":3,"repeat":[1,"x"]}}})"}) {
        const Json report = Json::parse(text);
        INFO(text);
        CHECK(starts_text(report).size() + symmetry_text(report).size() < 1000);
    }
    CHECK(starts_text({}).empty());
    CHECK(symmetry_text({}).empty());
}

TEST_CASE(
    "repeats that were copied lie alike; a yarn that has moved in one of them breaks that, and is found") {
    const Planned of = planned("tl013-wrong");
    REQUIRE(of.plan.repeats == std::array<std::size_t, 2>{2, 1});
    SimulationOptions options = on_one_core();
    options.most_iterations = 1;
    const Yarns copied = simulate(of.design, of.plan, options);
    Json told = compared_repeats(of.plan, copied, copied);
    INFO(told.dump());
    CHECK(told.at("broken") == false);
    CHECK(told.at("between_repeats").at("max_radii").get<double>() < 1e-6);
    CHECK(told.at("from_smallest_repeat").at("max_radii").get<double>() < 1e-6);

    // The last pick, half a radius up; the others do not follow.
    Yarns moved = copied;
    std::size_t last = 0;
    for (std::size_t y = 0; y < moved.yarns.size(); ++y) {
        if (moved.yarns[y].system == System::weft && moved.yarns[y].number >= moved.yarns[last].number)
            last = y;
    }
    for (Vec3& point : moved.yarns[last].spline.control) point.z() += 0.5 * moved.yarns[last].radius_mm;
    told = compared_repeats(of.plan, moved, copied);
    INFO(told.dump());
    CHECK(told.at("broken") == true);
    CHECK(told.at("between_repeats").at("max_radii").get<double>() == Approx(0.5).epsilon(0.05));
    CHECK(told.at("between_repeats").at("kind") == "pick");
    CHECK(told.at("between_repeats").at("number") == moved.yarns[last].number + 1);
    CHECK(told.at("between_repeats").at("repeat") == Json({2, 1}));
    CHECK(told.at("from_smallest_repeat").at("number") == moved.yarns[last].number + 1);
    moved.report["symmetry"] = told;
    CHECK(symmetry_text(moved.report).rfind("SYMMETRY BROKEN", 0) == 0);
}
