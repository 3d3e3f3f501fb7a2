// Starts in fewer points, refined.

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/inspect.hpp>
#include <weave/sim/simulate.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;

namespace {

Plan plan_at(const Design& design, Fidelity fidelity, std::optional<Region> region = {}) {
    SimulationRequest request;
    request.fidelity = fidelity;
    request.region = region;
    return make_plan(design, *evaluate(design)->block, request).value();
}

StartState planned(const Plan& plan) {
    StartState state{{}, plan.scene.period_mm};
    for (const SimYarn& yarn : plan.scene.yarns) state.control.push_back(yarn.control);
    return state;
}

/// Both yarns of a plan's first crossing change heights all along: each has passed through whatever lay
/// between.
StartState with_first_crossing_turned(const Plan& plan, StartState state) {
    const Crossing& crossing = plan.curves.crossings.front();
    for (std::size_t y = 0; y < plan.curve_of.size(); ++y) {
        const bool weft = plan.curve_of[y] == crossing.weft, warp = plan.curve_of[y] == crossing.warp;
        const double up = crossing.weft_over == weft ? -1 : 1;
        for (Vec3& point : state.control[y]) point.z() += weft || warp ? up : 0;
    }
    return state;
}

}  // namespace

TEST_CASE("refined yarns are the same curves in more points") {
    const Design design = find_sample("satin-5")->make();
    const Plan coarse = plan_at(design, Fidelity::draft), fine = plan_at(design, Fidelity::standard);
    const auto start = refined_start(fine, coarse, planned(coarse));
    REQUIRE(start);
    for (std::size_t y = 0; y < fine.scene.yarns.size(); ++y) {
        const SimYarn &from = coarse.scene.yarns[y], &to = fine.scene.yarns[y];
        REQUIRE(start->control[y].size() == to.control.size());
        const Spline before{from.control, from.is_periodic, from.shift},
            after{start->control[y], to.is_periodic, to.shift};
        const double finer = static_cast<double>(after.segments()) / static_cast<double>(before.segments());
        for (double t = 0; t < static_cast<double>(before.segments()); t += 0.3)
            CHECK((before.place(t) - after.place(finer * t)).norm() < 1e-9);
    }
}

TEST_CASE("refining leaves what is held where the finer plan holds it") {
    const Design design = find_sample("satin-5")->make();
    const Region region{1, 3, 1, 3};
    const Plan coarse = plan_at(design, Fidelity::draft, region),
               fine = plan_at(design, Fidelity::standard, region);
    const auto start = refined_start(fine, coarse, planned(coarse));
    REQUIRE(start);
    std::size_t held = 0;
    for (std::size_t y = 0; y < fine.scene.yarns.size(); ++y) {
        const SimYarn& yarn = fine.scene.yarns[y];
        for (std::size_t i = 0; i < yarn.frozen.size(); ++i) {
            if (yarn.frozen[i] == 0) continue;
            ++held;
            CHECK((start->control[y][i] - yarn.control[i]).norm() == 0);
        }
    }
    CHECK(held > 0);
}

TEST_CASE("coarse yarns that passed through one another are not gone on from") {
    const Design design = find_sample("plain")->make();
    const Plan coarse = plan_at(design, Fidelity::draft), fine = plan_at(design, Fidelity::standard);
    CHECK(refined_start(fine, coarse, planned(coarse)));
    CHECK_FALSE(refined_start(fine, coarse, with_first_crossing_turned(coarse, planned(coarse))));
}

TEST_CASE("a run that begins in fewer points comes to the rest of one that does not, and counts both") {
    const Design design = find_sample("plain")->make();
    const Plan coarse = plan_at(design, Fidelity::draft), fine = plan_at(design, Fidelity::standard);
    SimulationOptions options;
    options.threads = 1;
    options.residual = 1e-8;
    const Yarns at_once = simulate(design, fine, options);
    options.coarser = &coarse;
    std::vector<Yarns> shown;
    options.after_coarser = [&](const Yarns& yarns) { return shown.push_back(yarns), true; };
    const Yarns by_levels = simulate(design, fine, options);
    REQUIRE(shown.size() == 1);
    CHECK(shown[0].report.at("fidelity") == "draft");
    CHECK(shown[0].report.at("goal").get<double>() == coarse.goal);
    CHECK(by_levels.report.at("fidelity") == "standard");
    CHECK(by_levels.report.at("converged") == true);
    CHECK(by_levels.report.at("order_kept") == true);
    // Points that lie elsewhere along their yarns touch a little otherwise.
    CHECK(by_levels.report.at("energy_N_mm").get<double>() ==
          Approx(at_once.report.at("energy_N_mm").get<double>()).epsilon(1e-4));
    const Json& coarser = by_levels.report.at("coarser");
    CHECK(coarser.at("taken") == true);
    CHECK(by_levels.report.at("iterations").get<int>() > coarser.at("iterations").get<int>());
    CHECK(by_levels.report.at("seconds").get<double>() > coarser.at("seconds").get<double>());
}

TEST_CASE("whoever is shown the coarser yarns may end there") {
    const Design design = find_sample("plain")->make();
    const Plan coarse = plan_at(design, Fidelity::draft), fine = plan_at(design, Fidelity::standard);
    SimulationOptions options;
    options.threads = 1;
    options.coarser = &coarse;
    options.after_coarser = [](const Yarns&) { return false; };
    options.residual = 1e-7;
    options.flips = {{0, 0, false}};
    const auto ends_in_draft = [&](const char* ending) {
        const Json report = simulate(design, fine, options).report;
        INFO(report.dump());
        CHECK(report.at("fidelity") == "draft");
        CHECK(report.at("goes_on") == "standard");
        CHECK(report.at("converged") == false);
        CHECK(report.at("ending") == ending);
        CHECK(report.at("goal") == 1e-7);
        CHECK(report.at("coarser").at("goal") == coarse.goal);
        CHECK(report.at("flips").at(0).at("tried") == false);
        return report;
    };
    // The coarser yarns are at rest, what was asked for is not.
    CHECK(ends_in_draft("stopped").at("coarser").at("ending") == "converged");
    options.after_coarser = nullptr;
    options.watch = [](const Progress&) { return false; };
    ends_in_draft("stopped");
    options.watch = nullptr;
    options.most_seconds = 1e-9;
    ends_in_draft("time");
    options.most_seconds = 1e30;
    options.most_iterations = 3;
    CHECK(ends_in_draft("iterations").at("iterations") == 3);
}

TEST_CASE("both levels have one number of steps") {
    const Design design = find_sample("plain")->make();
    const Plan coarse = plan_at(design, Fidelity::draft), fine = plan_at(design, Fidelity::standard);
    SimulationOptions options;
    options.threads = 1;
    options.residual = 1e-30;
    options.coarser = &coarse;
    std::size_t first = 0;
    options.after_coarser = [&](const Yarns& yarns) { return first = yarns.report.at("iterations"), true; };
    options.most_iterations = 60;
    const Json report = simulate(design, fine, options).report;
    REQUIRE(first > 0);
    REQUIRE(first < 60);
    CHECK(report.at("fidelity") == "standard");
    CHECK(report.at("iterations") == 60);
}

TEST_CASE("slip against friction counts from the plan through both levels") {
    Design design = find_sample("plain")->make();
    design.scene.friction = 0.5;
    const Plan coarse = plan_at(design, Fidelity::draft), fine = plan_at(design, Fidelity::standard);
    SimulationOptions options;
    options.threads = 1;
    options.residual = 1e-6;
    const auto crimp_of = [](const Yarns& yarns) { return inspect(yarns)->warp_crimp->mean; };
    const Yarns at_once = simulate(design, fine, options);
    options.coarser = &coarse;
    const Yarns by_levels = simulate(design, fine, options);
    CHECK(by_levels.report.at("converged") == true);
    CHECK(by_levels.report.at("friction").at("stuck_share").get<double>() ==
          Approx(at_once.report.at("friction").at("stuck_share").get<double>()).margin(0.02));
    CHECK(crimp_of(by_levels) == Approx(crimp_of(at_once)).epsilon(2e-3));
}

TEST_CASE("plain weave at a loose residual is not called a saddle, and at a tight one it is none") {
    const Design design = find_sample("plain")->make();
    const Plan plan = plan_at(design, Fidelity::standard);
    SimulationOptions options;
    options.threads = 1;
    CHECK(simulate(design, plan, options).report.at("smallest_curvature") != "negative");
    options.residual = 1e-8;
    CHECK(simulate(design, plan, options).report.at("smallest_curvature") == "positive");
}
