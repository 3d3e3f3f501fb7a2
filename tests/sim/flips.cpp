#include "scenes.hpp"

#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/flips.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/simulate.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

/// Two crossed rods, free, and one that both touch.
SimScene crossed(Random& random, double contact) {
    SimScene scene = heap(random, 3);
    const double half = 0.5 * static_cast<double>(scene.yarns[0].control.size() - 1);
    scene.transition = {.yarn = {0, 1},
                        .at = {half + uniform(random, -0.4, 0.4), half + uniform(random, -0.4, 0.4)},
                        .reach = {1.3, 1.1},
                        .height_mm = uniform(random, -0.3, 0.3),
                        .spring_N_per_mm = 7,
                        .contact = contact};
    return scene;
}

double worst_difference(const SimScene& scene) {
    Bench bench(scene);
    bench.evaluate();
    const std::vector<double> gradient = bench.gradient;
    double worst = 0, scale = 0;
    for (std::size_t slot = 0; slot < bench.fabric.slots(); ++slot) {
        if (bench.fabric.moves()[slot] == 0) continue;
        for (std::size_t i = 3 * slot; i < 3 * slot + 3; ++i) {
            std::vector<double> more = bench.state, less = bench.state;
            more[i] += 1e-6;
            less[i] -= 1e-6;
            const double slope = (bench.energy_at(more) - bench.energy_at(less)) / 2e-6;
            worst = std::max(worst, std::abs(slope - gradient[i]));
            scale = std::max(scale, std::abs(gradient[i]));
        }
    }
    return worst / scale;
}

struct Relaxed {
    Design design;
    BlockPtr block;
    Plan plan;
    Yarns yarns;
};

Relaxed relaxed(const std::string& name) {
    Relaxed of;
    of.design = find_sample(name)->make();
    of.block = evaluate(of.design)->block;
    SimulationRequest request;
    request.reduce = false;
    of.plan = make_plan(of.design, *of.block, request).value();
    return of;
}

}  // namespace

TEST_CASE("a transition pulls as its energy says, with and without a share of contact") {
    weave::testing::for_all(
        [](Random& random) { CHECK(worst_difference(crossed(random, random.coin() ? 0 : uniform(random, 0.1, 1))) < 1e-6); }, 20);
}

TEST_CASE("with all of its contact and no spring a transition is the plain contact") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene = crossed(random, 1);
            scene.transition->spring_N_per_mm = 0;
            Bench with(scene);
            const double energy = with.evaluate();
            scene.transition.reset();
            Bench without(scene);
            CHECK(without.evaluate() == Approx(energy).epsilon(1e-9));
            for (std::size_t i = 0; i < with.gradient.size(); ++i)
                CHECK(with.gradient[i] == Approx(without.gradient[i]).margin(1e-9));
        },
        10);
}

TEST_CASE("a transition across the seam of a repeat pulls as its energy says") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene = plain_weave({.count = 2, .swing = 0.5});
            for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.02);
            const auto points = static_cast<double>(scene.yarns[0].control.size());
            scene.transition = {.yarn = {2, 0}, .at = {points + uniform(random, 0.5, 2), uniform(random, -0.5, 2)},
                                .reach = {2.5, 2.5}, .height_mm = 0.2, .spring_N_per_mm = 5, .contact = 0.5};
            CHECK(worst_difference(scene) < 1e-6);
        },
        6);
}

TEST_CASE("a crossing of relaxed cloth changes sides, and no other does") {
    for (const char* name : {"plain", "satin-5", "layer-to-layer"}) {
        INFO(name);
        Relaxed of = relaxed(name);
        SimulationOptions options;
        options.threads = 1;
        std::size_t legal = 0;
        for (std::size_t pick = 0; pick < of.block->picks() && legal == 0; ++pick) {
            for (std::size_t end = 0; end < of.block->ends() && legal == 0; ++end) {
                if (!flip(*of.block, pick, end)) continue;
                options.flips = {{pick, end, !of.block->weft_over(pick, end)}};
                ++legal;
            }
        }
        REQUIRE(legal == 1);
        const Yarns yarns = simulate(of.design, of.plan, options);
        const Json& report = yarns.report;
        INFO(report.at("flips").dump());
        CHECK(report.at("flips").at(0).at("done") == true);
        CHECK(report.at("order_kept") == true);
        CHECK(report.at("converged") == true);
        // The yarns are those of the design with the flip: every crossing is as its card says.
        Design flipped = of.design;
        REQUIRE(apply_edit(flipped, PutFlip{flipped.root, options.flips[0]}));
        CHECK(yarns.design_sha256 == design_sha256(flipped));
        const BlockPtr block = evaluate(flipped)->block;
        for (const Crossing& crossing : yarns.crossings)
            CHECK(crossing.weft_over == block->weft_over(crossing.pick, crossing.end));
    }
}

// The yarns round some of these lie so that the first segment of one has a share in its last row alone.
TEST_CASE("a crossing is flipped at each of its places in a small cloth, one after the other") {
    Design design = find_sample("plain")->make();
    REQUIRE(apply_edit(design, PutBlock{"cloth", std::make_shared<const Node>(Node{TileOperation{design.root, 2, 3, 1}, {}})}));
    REQUIRE(apply_edit(design, SetRoot{"cloth"}));
    const BlockPtr block = evaluate(design)->block;
    SimulationRequest request;
    request.fidelity = Fidelity::draft;
    request.reduce = false;
    SimulationOptions options;
    options.threads = 1;
    for (const std::size_t pick : {1, 3}) {
        for (const std::size_t end : {1, 3, 5}) options.flips.push_back({pick, end, !block->weft_over(pick, end)});
    }
    const Yarns yarns = simulate(design, make_plan(design, *block, request).value(), options);
    const Json& flips = yarns.report.at("flips");
    REQUIRE(flips.size() == 6);
    for (const Json& flip : flips) CHECK(flip.at("done") == true);
    CHECK(yarns.report.at("order_kept") == true);
}

TEST_CASE("a flip that the card cannot make alone, or has made, is not tried in the cloth") {
    Relaxed of = relaxed("layer-to-layer");
    SimulationOptions options;
    options.threads = 1;
    for (std::size_t pick = 0; pick < of.block->picks() && options.flips.empty(); ++pick) {
        for (std::size_t end = 0; end < of.block->ends() && options.flips.empty(); ++end) {
            if (!flip(*of.block, pick, end)) options.flips = {{pick, end, !of.block->weft_over(pick, end)}};
        }
    }
    REQUIRE(options.flips.size() == 1);
    options.flips.push_back({0, 0, of.block->weft_over(0, 0)});
    const Yarns yarns = simulate(of.design, of.plan, options);
    const Json& flips = yarns.report.at("flips");
    CHECK(flips.at(0).at("done") == false);
    CHECK_THAT(flips.at(0).at("reason").get<std::string>(), Catch::Contains("in the way stand"));
    CHECK(flips.at(1).at("done") == false);
    CHECK(flips.at(1).at("reason") == "they lie so already");
    CHECK(yarns.design_sha256 == design_sha256(of.design));
}

TEST_CASE("a crossing that is held where it is does not flip, and all stays as it was") {
    Relaxed of = relaxed("plain");
    SimulationRequest request;
    request.reduce = false;
    request.held = {{0, 0}};
    of.plan = make_plan(of.design, *of.block, request).value();
    SimulationOptions options;
    options.threads = 1;
    options.flips = {{0, 0, !of.block->weft_over(0, 0)}};
    const Yarns yarns = simulate(of.design, of.plan, options);
    CHECK(yarns.report.at("flips").at(0).at("done") == false);
    CHECK_FALSE(yarns.report.at("flips").at(0).at("reason").get<std::string>().empty());
    CHECK(yarns.report.at("order_kept") == true);
    CHECK(yarns.design_sha256 == design_sha256(of.design));
    options.flips.clear();
    const Yarns plain = simulate(of.design, of.plan, options);
    REQUIRE(plain.yarns.size() == yarns.yarns.size());
    for (std::size_t y = 0; y < plain.yarns.size(); ++y)
        CHECK(plain.yarns[y].spline.control == yarns.yarns[y].spline.control);
}

TEST_CASE("a flip that is broken off or not begun is listed as not tried, with why") {
    const Relaxed of = relaxed("plain");
    SimulationOptions options;
    options.threads = 1;
    options.flips = {{0, 0, !of.block->weft_over(0, 0)}, {1, 1, !of.block->weft_over(1, 1)}};
    const auto reason = [](const Yarns& yarns, std::size_t flip) {
        CHECK(yarns.report.at("flips").at(flip).at("done") == false);
        CHECK(yarns.report.at("flips").at(flip).at("tried") == false);
        return yarns.report.at("flips").at(flip).at("reason").get<std::string>();
    };
    options.most_seconds = 1e-9;
    const Yarns late = simulate(of.design, of.plan, options);
    CHECK(reason(late, 0) == "not begun, as the time was up");
    options.most_seconds = 1e30;
    options.most_iterations = 1;
    CHECK(reason(simulate(of.design, of.plan, options), 1) == "not begun, as the steps were used up");
    options.most_iterations = 20000;
    options.watch = [](const Progress& progress) { return progress.residual > 0; };  // a flip tells of none
    const Yarns stopped = simulate(of.design, of.plan, options);
    CHECK(stopped.report.at("converged") == true);
    CHECK(reason(stopped, 0) == "broken off, as it was stopped");
    CHECK(reason(stopped, 1) == "not begun, as it was stopped");
    CHECK(stopped.design_sha256 == design_sha256(of.design));
}
