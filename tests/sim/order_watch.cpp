// That whoever watches a relaxation learns whether crossings lie in order, and at what cost.

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/order_watch.hpp>
#include <weave/sim/simulate.hpp>

#include <catch2/catch.hpp>

#include <chrono>
#include <thread>

using namespace weave;
using namespace weave::sim;

TEST_CASE("crossings are looked up every two seconds at most, and for a tenth of the time at most") {
    for (const double cost : {0.001, 0.19, 0.5, 7.0}) {
        INFO("a look takes " << cost << " s");
        OrderWatch watch(100);
        std::size_t looks = 0;
        double last = -2;
        for (double now = 0; now < 300; now += 0.01) {
            if (!watch.is_due(now)) continue;
            CHECK(now - last >= 2);
            watch.looked(now, now + cost);
            now += cost;
            last = now;
            ++looks;
            // The first look's cost is not known before.
            if (looks > 1) CHECK(static_cast<double>(looks) * cost <= 0.1 * now + 1e-9);
        }
        CHECK(static_cast<double>(looks) >= 0.9 * std::min(150 / (1 + cost / 2), 30 / cost));
        CHECK(watch.spent_s() == Approx(static_cast<double>(looks) * cost));
    }
    CHECK_FALSE(OrderWatch(100'000).is_due(10));  // some 5 s
    CHECK(OrderWatch(100'000).is_due(51));
}

TEST_CASE("a relaxation tells whoever watches of lost crossings") {
    const Design design = find_sample("plain")->make();
    const BlockPtr block = evaluate(design)->block;
    const Plan plan = make_plan(design, *block, {}).value();
    const auto last_told = [&](const std::optional<StartState>& start) {
        SimulationOptions options;
        options.threads = 1;
        options.start = start;
        std::optional<std::size_t> lost;
        options.watch = [&](const Progress& progress) {
            lost = progress.lost_crossings;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            return progress.iteration < 20;
        };
        simulate(design, plan, options);
        return lost;
    };
    CHECK(last_told({}) == std::optional<std::size_t>(0));
    // Every weft on the other side of the warps.
    StartState mirrored{{}, plan.scene.period_mm};
    for (const SimYarn& yarn : plan.scene.yarns) {
        mirrored.control.push_back(yarn.control);
        for (Vec3& place : mirrored.control.back()) place.z() = -place.z();
    }
    CHECK(last_told(mirrored) == std::optional<std::size_t>(4));
}
