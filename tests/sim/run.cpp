#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/run.hpp>
#include <weave/sim/simulate.hpp>
#include <weave/sim/yarns_file.hpp>

#include <catch2/catch.hpp>

#include <functional>

using namespace weave;
using namespace weave::sim;

namespace {

/// Something done to a run between two legs.
using Deed = std::function<Status(Run&)>;

/// The yarns of a run that is driven leg by leg, with the deeds before the legs of these numbers; and, where `broken`, written
/// down and taken up again before every leg, each time with another number of threads.
Yarns driven(const Design& design, const RunRequest& request, std::size_t leg, const std::vector<std::pair<std::size_t, Deed>>& deeds, bool broken) {
    std::unique_ptr<Run> run = Run::begin(design, request, 1).value();
    std::size_t next = 0;
    for (std::size_t k = 0; k < 400; ++k) {
        if (broken) {
            const std::vector<std::uint8_t> bytes = Json::to_cbor(run->state());
            auto taken_up = Run::resume(design, request, Json::from_cbor(bytes), 1 + k % 2);
            INFO((taken_up ? "" : taken_up.error().text()));
            REQUIRE(taken_up);
            run = std::move(*taken_up);
        }
        for (; next < deeds.size() && (deeds[next].first <= k || run->is_over()); ++next) REQUIRE(deeds[next].second(*run));
        if (run->is_over() && next == deeds.size()) break;
        REQUIRE(run->advance(leg, {}));
    }
    CHECK(run->is_over());
    return run->yarns();
}

void check_same_cloth(const Yarns& one, const Yarns& other) {
    REQUIRE(one.yarns.size() == other.yarns.size());
    for (std::size_t y = 0; y < one.yarns.size(); ++y) {
        CHECK(one.yarns[y].spline.control == other.yarns[y].spline.control);
        CHECK(one.yarns[y].radius_mm == other.yarns[y].radius_mm);
    }
    CHECK(one.size_mm == other.size_mm);
    for (const char* member : {"residual", "iterations", "converged", "ending", "energy_N_mm", "lost_crossings", "design_sha256", "scene_sha256"}) {
        INFO(member);
        CHECK(one.report.at(member) == other.report.at(member));
    }
}

/// Plain weave, two by two times: it is simulated as one of them.
Design tiled() {
    Design design = find_sample("plain")->make();
    design.blocks["tiled"] = std::make_shared<const Node>(Node{TileOperation{design.root, 2, 2, 1}, {}});
    design.root = "tiled";
    return design;
}

RunRequest draft() {
    RunRequest request;
    request.plan.fidelity = Fidelity::draft;
    return request;
}

}  // namespace

TEST_CASE("a run in one leg is a simulation") {
    const Design design = find_sample("satin-5")->make();
    RunRequest request;
    SimulationOptions options;
    options.threads = 1;
    const Plan plan = make_plan(design, *evaluate(design)->block, {}).value();
    check_same_cloth(driven(design, request, 20000, {}, false), simulate(design, plan, options));
}

TEST_CASE("a run that is taken up again before every leg ends bit by bit as the unbroken one") {
    const Design plain = find_sample("plain")->make();
    Design rubbing = plain;
    rubbing.scene.friction = 0.2;
    RunRequest coarse, flipping = draft(), loose = draft(), slow = draft();
    coarse.start_from = Fidelity::draft;
    flipping.flips = {{0, 0, !evaluate(plain)->block->weft_over(0, 0)}};
    loose.plan.relaxing_N_per_mm = {0.5, std::nullopt};
    slow.goal.solver = Solver::paper;
    const struct {
        const char* what;
        Design design;
        RunRequest request;
        std::size_t leg;
    } cases[]{{"as it is", find_sample("satin-5")->make(), {}, 20}, {"fewer points first", plain, coarse, 20},
              {"a flip, for which the repeat becomes the whole", tiled(), flipping, 15}, {"friction", rubbing, draft(), 25},
              {"a period that relaxes", plain, loose, 20}, {"in time", plain, slow, 2000}};
    for (const auto& of : cases) {
        INFO(of.what);
        const Yarns unbroken = driven(of.design, of.request, of.leg, {}, false);
        CHECK(unbroken.report.at("converged") == true);
        for (const Json& flip : unbroken.report.value("flips", Json::array())) CHECK(flip.at("done") == true);
        CHECK(unbroken.report.value("flips", Json::array()).size() == of.request.flips.size());
        check_same_cloth(driven(of.design, of.request, of.leg, {}, true), unbroken);
    }
}

TEST_CASE("changes at numbered legs are the same changes in a run that is taken up again") {
    const Design design = tiled();
    const Flip turn{1, 1, !evaluate(design)->block->weft_over(1, 1)};
    const std::vector<std::pair<std::size_t, Deed>> deeds{
        {1, [](Run& run) { return run.change({.strain = 1.05, .stiffness_scale = {}, .radius_scale = 1.3}, {}); }},
        {4, [](Run& run) { return run.hold({{false, 1}}); }},
        {7, [](Run& run) { return run.push({{{1, 1, 0}, 2, 0.01}}); }},
        {9, [&](Run& run) { return run.flip(turn, {}); }},
        {10, [](Run& run) { return run.change({}, {.strain = {}, .stiffness_scale = 2, .radius_scale = {}}); }}};
    const Yarns unbroken = driven(design, draft(), 10, deeds, false);
    CHECK(unbroken.yarns.size() == evaluate(design)->block->picks() + evaluate(design)->block->ends());
    REQUIRE(unbroken.report.at("flips").size() == 1);
    INFO(unbroken.report.at("flips").dump());
    CHECK(unbroken.report.at("flips").at(0).at("tried") == true);
    check_same_cloth(driven(design, draft(), 10, deeds, true), unbroken);
}

TEST_CASE("the smallest repeat becomes the whole cloth for what happens at one place, in the parameters that it had") {
    const Design design = tiled();
    auto run = Run::begin(design, draft(), 1).value();
    REQUIRE(run->change({.strain = {}, .stiffness_scale = {}, .radius_scale = 1.1}, {}));
    while (!run->is_over()) REQUIRE(run->advance(50, {}));
    const std::size_t small = run->now().scene().yarns.size();
    const double radius = run->now().scene().yarns.back().radius_mm;
    REQUIRE(run->push({{{1, 1, 0}, 2, 0.01}}));
    CHECK(run->level() == 2);
    CHECK(run->now().scene().yarns.size() > small);
    CHECK(run->now().scene().yarns.back().radius_mm == Approx(radius).epsilon(1e-12));
    REQUIRE(run->push({}));
    while (!run->is_over()) REQUIRE(run->advance(50, {}));
    CHECK(run->yarns().report.at("lost_crossings") == 0);
}

TEST_CASE("what cannot be changed is refused, and the run goes on as before") {
    const Design design = find_sample("plain")->make();
    auto run = Run::begin(design, draft(), 1).value();
    CHECK_FALSE(run->hold({{true, 100000}}));
    CHECK_FALSE(run->change({.strain = 5, .stiffness_scale = {}, .radius_scale = {}}, {}));
    std::vector<Pin> all;
    const BlockPtr block = evaluate(design)->block;
    for (std::size_t pick = 0; pick < block->picks(); ++pick) all.push_back({true, pick});
    for (std::size_t end = 0; end < block->ends(); ++end) all.push_back({false, end});
    CHECK_FALSE(run->hold(all));
    CHECK(run->level() == 1);
    while (!run->is_over()) REQUIRE(run->advance(1000, {}));
    check_same_cloth(run->yarns(), driven(design, draft(), 1000, {}, false));
}

TEST_CASE("a state that no such run wrote is refused") {
    const Design design = find_sample("plain")->make(), other = find_sample("satin-5")->make();
    const Json good = Run::begin(design, draft(), 1).value()->state();
    CHECK(Run::resume(design, draft(), good, 1));
    CHECK_FALSE(Run::resume(other, draft(), good, 1));
    for (const char* member : {"level", "base", "now", "version"}) {
        INFO(member);
        Json broken = good;
        broken.erase(member);
        CHECK_FALSE(Run::resume(design, draft(), broken, 1));
        broken[member] = "no";
        CHECK_FALSE(Run::resume(design, draft(), broken, 1));
    }
    for (const char* member : {"control", "frozen", "fields", "last", "end", "warp", "flipped"}) {
        INFO(member);
        Json broken = good;
        broken["now"][member] = "no";
        CHECK_FALSE(Run::resume(design, draft(), broken, 1));
    }
}

TEST_CASE("yarns can be looked at within a leg, and the run does not notice") {
    const Design design = find_sample("satin-5")->make();
    auto looked = Run::begin(design, draft(), 1).value();
    std::size_t looks = 0;
    while (!looked->is_over()) {
        REQUIRE(looked->advance(1000, [&](const Progress& progress) {
            if (progress.iteration % 7 == 3) {
                const Yarns yarns = looked->yarns();
                CHECK(write_yarns(yarns));
                ++looks;
            }
            return true;
        }));
    }
    CHECK(looks > 1);
    Yarns unseen = driven(design, draft(), 1000, {}, false);
    check_same_cloth(looked->yarns(), unseen);
}
