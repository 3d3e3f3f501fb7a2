// Runs that this computer computes.

#include <weave/design/evaluate.hpp>
#include <weave/sim/forecast.hpp>
#include <weave/sim/memory_room.hpp>
#include <weave/sim/simulate.hpp>

#include <catch2/catch.hpp>

#include <QElapsedTimer>
#include <QRegularExpression>

#include <studio/jobs/local_relaxation.hpp>
#include <studio/support/follow_run.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

const char* const cloth = "angle-interlock-b";

Yarns simulated(const char* name, sim::Fidelity fidelity) {
    const Design design = sample(name);
    const Evaluation evaluation = evaluate(design).value();
    sim::SimulationRequest request;
    request.fidelity = fidelity;
    return sim::simulate(design, sim::make_plan(design, *evaluation.block, request).value(), {});
}

/// The same in legs, with a change before the step `at`.
Yarns changed_at(const char* name, sim::Fidelity fidelity, const SystemScene& warp, const SystemScene& weft,
                 std::size_t at) {
    const auto run = std::move(sim::Run::begin(sample(name), request_at(fidelity), 0)).value();
    const std::size_t leg = sim::leg_steps(run->now().plan(), sim::Solver::relax);
    const auto until = [&](const sim::Progress& progress) {
        return run->now().steps_before() + progress.iteration < at;
    };
    while (run->steps() < at && !run->is_over()) REQUIRE(run->advance(leg, until));
    REQUIRE(run->steps() == at);
    REQUIRE(run->change(warp, weft));
    while (!run->is_over()) REQUIRE(run->advance(leg, {}));
    return run->yarns();
}

}  // namespace

TEST_CASE("a simulation run here comes to the bits of the library's, and tells its way there") {
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(sample(cloth), request_at(sim::Fidelity::draft));
    CHECK(run.phase() == RunPhase::planning);
    REQUIRE(told.until_phase(RunPhase::paused));
    REQUIRE(told.plan);
    CHECK(told.plan->lines.size() >= 8);
    CHECK(told.plan->expected_bytes > 0);
    REQUIRE(told.frame);
    CHECK(told.frame->counts.size() == told.layouts.back()->yarns.size());
    CHECK(told.yarns.empty());  // nothing has moved
    run.run();
    REQUIRE(told.until([&] { return told.inspection != nullptr; }));
    CHECK(run.phase() == RunPhase::at_rest);
    CHECK(told.phases ==
          std::vector{RunPhase::planning, RunPhase::paused, RunPhase::running, RunPhase::at_rest});
    REQUIRE(told.yarns.size() == 1);
    check_same(*told.yarns.back(), simulated(cloth, sim::Fidelity::draft));
    CHECK(told.frame->head.at_rest);
    CHECK(told.frame->head.is_last);
    CHECK(told.progress.step == told.yarns.back()->report.at("iterations"));
    CHECK(told.progress.residual <= told.progress.goal);
    CHECK(told.progress.lost_crossings == 0);
    REQUIRE(told.history.size() >= told.progress.step);
    for (std::size_t k = 1; k < told.history.size(); ++k)
        CHECK(told.history[k].step >= told.history[k - 1].step);
}

TEST_CASE("a simulation run that is stepped and paused comes to the bits of one that is not") {
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(sample(cloth), request_at(sim::Fidelity::draft));
    std::size_t stands = 0;
    for (const std::uint64_t steps : {1, 3, 10}) {
        run.step(steps);
        REQUIRE(told.until_yarns(RunPhase::paused, ++stands));
    }
    CHECK(told.progress.step == 14);
    CHECK(told.yarns.back()->report.at("iterations") == 14);
    CHECK(told.yarns.back()->report.at("converged") == false);
    run.run();
    REQUIRE(told.until_phase(RunPhase::running));
    run.pause();
    REQUIRE(told.until([&] { return run.phase() == RunPhase::paused || run.phase() == RunPhase::at_rest; }));
    const std::uint64_t paused_at = told.progress.step;
    CHECK(paused_at >= 14);
    run.run();
    REQUIRE(told.until_phase(RunPhase::at_rest));
    REQUIRE(told.until([&] { return told.inspection != nullptr; }));
    check_same(*told.yarns.back(), simulated(cloth, sim::Fidelity::draft));
}

TEST_CASE("a simulation run takes parameters between two steps, as the library's run does there") {
    const SystemScene warp{.strain = 1.03, .stiffness_scale = {}, .radius_scale = 1.1},
        weft{.strain = {}, .stiffness_scale = 0.5, .radius_scale = {}};
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(sample(cloth), request_at(sim::Fidelity::draft));
    run.step(20);
    REQUIRE(told.until_yarns(RunPhase::paused, 1));
    const double before = told.layouts.back()->yarns.back().radius_mm;
    run.set_parameters(warp, weft);
    run.run();
    REQUIRE(told.until([&] { return told.inspection != nullptr; }));
    CHECK(told.arrivals == 1);
    CHECK(told.layouts.size() == 2);
    CHECK(told.layouts.back()->yarns.back().radius_mm == Approx(1.1 * before));
    check_same(*told.yarns.back(), changed_at(cloth, sim::Fidelity::draft, warp, weft, 20));
}

TEST_CASE("cloth at rest goes on by itself when its parameters change, and refuses what makes no sense") {
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(sample("plain"), request_at(sim::Fidelity::draft));
    run.run();
    REQUIRE(told.until([&] { return told.inspection != nullptr; }));
    const std::uint64_t rested = told.progress.step;
    run.set_parameters({.strain = 3, .stiffness_scale = {}, .radius_scale = {}}, {});
    REQUIRE(told.until([&] { return !told.refusals.empty(); }));
    CHECK(told.refusals.front().message == "must be from 1 to 2");
    run.hold({{true, 500}});
    REQUIRE(told.until([&] { return told.refusals.size() == 2; }));
    CHECK_THAT(told.refusals.back().message, Catch::Contains("pick 501"));
    CHECK(run.phase() == RunPhase::at_rest);
    told.inspection.reset();
    run.set_parameters({.strain = 1.05, .stiffness_scale = {}, .radius_scale = {}}, {});
    REQUIRE(told.until([&] { return told.arrivals == 1 && told.inspection; }));
    CHECK(run.phase() == RunPhase::at_rest);
    CHECK(told.progress.step > rested);
}

TEST_CASE("a flip in a simulation run is made, or refused with its reason") {
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(sample("layer-to-layer"), request_at(sim::Fidelity::draft));
    run.run();
    REQUIRE(told.until([&] { return told.inspection != nullptr; }));
    const Evaluation evaluation = evaluate(sample("layer-to-layer")).value();
    std::optional<Flip> good, bad;
    for (std::size_t pick = 0; pick < evaluation.block->picks(); ++pick) {
        for (std::size_t end = 0; end < evaluation.block->ends(); ++end) {
            const PlacedStack at = stack_at(*evaluation.block, pick, end);
            const Flip flip{pick, end, !at.stack.weft_over(pick - at.first_pick, end - at.first_end)};
            (weave::flip(at, pick, end) ? good : bad) = flip;
        }
    }
    REQUIRE(good);
    REQUIRE(bad);
    run.flip(*bad);
    REQUIRE(told.until([&] { return told.flips.size() == 1; }));
    CHECK_FALSE(told.flips.back().done);
    CHECK(told.flips.back().flip == *bad);
    CHECK_FALSE(told.flips.back().reason.empty());
    run.flip(*good);
    REQUIRE(told.until([&] { return told.flips.size() == 2; }));
    INFO(told.flips.back().reason);
    CHECK(told.flips.back().done);
    REQUIRE(told.until_phase(RunPhase::at_rest));
}

TEST_CASE("a flip in a tiled cloth makes a simulation run go on with the whole of it") {
    Design design = sample("twill-2-2");
    design.blocks["tiled"] = std::make_shared<const Node>(Node{TileOperation{design.root, 2, 2, 1}, {}});
    design.root = "tiled";
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(design, request_at(sim::Fidelity::draft));
    run.run();
    REQUIRE(told.until([&] { return told.inspection != nullptr; }));
    CHECK(told.layouts.back()->repeats != std::array<std::uint64_t, 2>{1, 1});
    const Evaluation evaluation = evaluate(design).value();
    const PlacedStack at = stack_at(*evaluation.block, 1, 1);
    run.flip({1, 1, !at.stack.weft_over(1 - at.first_pick, 1 - at.first_end)});
    REQUIRE(told.until([&] { return told.flips.size() == 1; }));
    INFO(told.flips.back().reason);
    CHECK(told.flips.back().done);
    REQUIRE(told.until([&] { return told.layouts.size() == 2; }));
    REQUIRE(told.until_phase(RunPhase::at_rest));
    CHECK(told.layouts.back()->repeats == std::array<std::uint64_t, 2>{1, 1});
}

TEST_CASE("a simulation run can be destroyed or begun anew at any moment") {
    const Design design = sample(cloth);
    for (int k = 0; k < 20; ++k) {
        auto run = std::make_unique<LocalRelaxation>();
        FollowedRun told(*run);
        run->start(design, request_at(sim::Fidelity::standard));
        run->run();
        if (k % 4 == 1) REQUIRE(told.until([&] { return told.frames > 0; }));
        if (k % 4 == 2) REQUIRE(told.until([&] { return told.progress.step > 5; }));
        if (k % 4 == 3) run->start(design, request_at(sim::Fidelity::draft));
        QElapsedTimer clock;
        clock.start();
        run.reset();
        CHECK(clock.elapsed() <
              (is_instrumented ? 10'000 : 1'000));  // it waits for nothing, so the time is that of a call
    }
    // From within its own signals too.
    auto run = std::make_unique<LocalRelaxation>();
    bool gone = false;
    QObject::connect(run.get(), &Relaxation::frame_came, [&] {
        run.reset();
        gone = true;
    });
    run->start(design, request_at(sim::Fidelity::draft));
    CHECK(QTest::qWaitFor([&] { return gone; }, patience_ms));
}

TEST_CASE("a stopped simulation run leaves its yarns as they lie, and takes nothing more") {
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(sample(cloth), request_at(sim::Fidelity::standard));
    run.run();
    REQUIRE(told.until([&] { return told.progress.step > 3; }));
    run.stop();
    REQUIRE(told.until([&] { return run.phase() == RunPhase::stopped; }));
    CHECK_FALSE(run.is_open());
    REQUIRE(told.yarns.size() == 1);
    CHECK(told.yarns.back()->report.at("converged") == false);
    CHECK(told.yarns.back()->report.at("iterations") == told.progress.step);
    run.run();
    run.step(3);
    CHECK(run.phase() == RunPhase::stopped);
    told.frame.reset();  // another run counts its own
    run.start(sample("plain"), request_at(sim::Fidelity::draft));
    REQUIRE(told.until_phase(RunPhase::paused));
}

TEST_CASE("a run that is stopped while its yarns are laid out is stopped at once") {
    LocalRelaxation run;
    FollowedRun told(run);
    run.start(sample("hexagon-tubes"), request_at(sim::Fidelity::draft));
    REQUIRE(run.phase() == RunPhase::planning);
    run.stop();
    CHECK(run.phase() == RunPhase::stopped);
    CHECK_FALSE(run.is_open());
}

TEST_CASE("a cloth with no room at all is refused before it is laid out, with what has room; a draft is not told to be one") {
    const Design shoe = sample("shoe-adult");
    const Evaluation evaluation = evaluate(shoe).value();
    const auto need = sim::foreseen_need(shoe, *evaluation.block, request_at(sim::Fidelity::draft).plan);
    REQUIRE(need);
    CHECK(need->points == Approx(14'366'216).epsilon(0.01));  // as its plan has them
    LocalRelaxation run(LocalMeans{.threads = 1, .memory_bytes = std::uint64_t{2} << 30});
    FollowedRun told(run);
    run.start(shoe, request_at(sim::Fidelity::draft));
    REQUIRE(QTest::qWaitFor([&] { return told.error.has_value(); }, patience_ms));
    CHECK_FALSE(told.plan);
    CHECK_THAT(told.error->message, Catch::Contains("simulate a part of the cloth, up to ") && !Catch::Contains("draft"));
    CHECK_THAT(told.error->message, Catch::Contains("2.0 GiB are free"));
    const sim::MemoryNeed standard{1'000'000, sim::Fidelity::standard, 4, 48, 6, 6};
    CHECK_THAT(sim::check_room(standard, {sim::expected_bytes(600'000), {}}).error().message, Catch::Contains(", or all of it as draft, or have a server do it"));
    CHECK_THAT(sim::check_room(standard, {sim::expected_bytes(400'000), "box"}).error().message, !Catch::Contains("draft") && !Catch::Contains("server do it"));
}

TEST_CASE("a cloth of many repeats is refused where there is room for one alone, which is told") {
    sim::MemoryNeed need{3500, sim::Fidelity::standard, 4, 8, 1, 1};
    need.copied_bytes = std::uint64_t{5} << 30;
    need.picks_and_ends = {35, 25};
    const Status refused = sim::check_room(need, {std::uint64_t{4} << 30, {}});
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, Catch::Contains("simulate a design of one of its repeats, 35 picks and 25 ends, or a part of the cloth"));
    CHECK(sim::check_room(need, {std::uint64_t{6} << 30, {}}));
    const Status neither = sim::check_room(need, {std::uint64_t{8} << 20, {}});
    REQUIRE_FALSE(neither);
    CHECK_THAT(neither.error().message, !Catch::Contains("repeats"));
}

TEST_CASE("the part that is said to have room has, wherever it is taken, and one of twice its sides has none") {
    const Design shoe = sample("shoe-adult");
    const Evaluation evaluation = evaluate(shoe).value();
    sim::SimulationRequest request = request_at(sim::Fidelity::draft).plan;
    const sim::MemoryRoom room{std::uint64_t{256} << 20, {}};
    const Status refused = sim::check_room(sim::foreseen_need(shoe, *evaluation.block, request).value(), room);
    REQUIRE_FALSE(refused);
    const QRegularExpressionMatch told = QRegularExpression("up to (\\d+) picks and (\\d+) ends").match(QString::fromStdString(refused.error().message));
    REQUIRE(told.hasMatch());
    const std::size_t picks = told.captured(1).toULongLong(), ends = told.captured(2).toULongLong();
    for (const auto& [pick, end] : {std::pair<std::size_t, std::size_t>{0, 0}, {3000, 1080}, {600, 900}, {5000, 1200}}) {
        INFO("from pick " << pick << " and end " << end << " from 0");
        request.region = Region{evaluation.block->row_of_pick(pick), evaluation.block->row_of_pick(pick + picks - 1),
                                evaluation.block->column_of_end(end), evaluation.block->column_of_end(end + ends - 1)};
        const auto plan = sim::make_plan(shoe, *evaluation.block, request);
        if (plan) CHECK(sim::check_room(sim::need_of(*plan), room));
        else CHECK(pick == 0);  // its corner is bare
    }
    request.region = Region{400, 400 + 2 * picks / 6, 150, 150 + 2 * ends / 6};
    CHECK_FALSE(sim::check_room(sim::foreseen_need(shoe, *evaluation.block, request).value(), room));
}

TEST_CASE("memory is foreseen about as the plan has it, of a part as well") {
    const auto compare = [](const char* name, std::optional<Region> region) {
        INFO(name);
        Design design = sample(name);
        design.scene.boundary_x = design.scene.boundary_y = Boundary::frozen;
        const Evaluation evaluation = evaluate(design).value();
        sim::SimulationRequest request = request_at(sim::Fidelity::draft).plan;
        request.region = region;
        const auto plan = sim::make_plan(design, *evaluation.block, request);
        if (!plan) return false;  // too small to be held at its rims
        const sim::MemoryNeed foreseen = sim::foreseen_need(design, *evaluation.block, request).value(), planned = sim::need_of(*plan);
        CHECK(static_cast<double>(foreseen.points) == Approx(static_cast<double>(planned.points)).epsilon(0.05));
        CHECK(foreseen.points_in_a_stack >= planned.points_in_a_stack / 1.5);
        CHECK(foreseen.picks_in_a_row == Approx(planned.picks_in_a_row));
        CHECK(foreseen.ends_in_a_column == Approx(planned.ends_in_a_column));
        return true;
    };
    int planned = 0;
    for (const char* name : {"plain", "angle-interlock-b", "hexagon-tubes", "pocket"}) planned += compare(name, {}) ? 1 : 0;
    CHECK(planned >= 1);
    CHECK(compare("shoe-adult", Region{400, 419, 200, 219}));
    CHECK_FALSE(sim::foreseen_need(sample("plain"), *evaluate(sample("plain")).value().block, {}));  // its repeat may do
}

TEST_CASE("a cloth that needs more than is free is refused before it is laid out, also where it is not much more") {
    Design design = sample("pocket");
    design.scene.boundary_x = design.scene.boundary_y = Boundary::frozen;
    const Evaluation evaluation = evaluate(design).value();
    const std::uint64_t needed = sim::expected_bytes(sim::foreseen_need(design, *evaluation.block, request_at(sim::Fidelity::draft).plan).value().points);
    LocalRelaxation run(LocalMeans{.threads = 1, .memory_bytes = needed - 1});
    FollowedRun told(run);
    run.start(design, request_at(sim::Fidelity::draft));
    REQUIRE(QTest::qWaitFor([&] { return told.error.has_value(); }, patience_ms));
    CHECK_FALSE(told.plan);
}

TEST_CASE("a design that cannot be simulated is told as it is") {
    LocalRelaxation run;
    FollowedRun told(run);
    Design design = sample("plain");
    design.scene.boundary_x = Boundary::free;
    run.start(design, request_at(sim::Fidelity::draft));
    REQUIRE(QTest::qWaitFor([&] { return told.error.has_value(); }, patience_ms));
    CHECK_THAT(told.error->message, Catch::Contains("fed at constant tension"));
    CHECK(run.phase() == RunPhase::failed);
    CHECK_FALSE(run.is_open());
}

TEST_CASE("a cloth that this computer has no room for is refused before it begins") {
    LocalRelaxation run(LocalMeans{.threads = 1, .memory_bytes = 1'000'000});
    FollowedRun told(run);
    run.start(sample(cloth), request_at(sim::Fidelity::draft));
    REQUIRE(QTest::qWaitFor([&] { return told.error.has_value(); }, patience_ms));
    CHECK_THAT(told.error->message,
               Catch::Contains("MiB of memory") && Catch::Contains("a part of the cloth"));
    CHECK(told.plan);  // what it would have been
}
