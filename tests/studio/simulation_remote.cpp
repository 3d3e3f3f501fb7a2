// Runs that a simulation server computes: the daemon itself, started by the test.

#include <weave/core/json.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/wire/client.hpp>

#include <catch2/catch.hpp>

#include <csignal>
#include <fstream>
#include <studio/jobs/remote_relaxation.hpp>
#include <studio/support/follow_run.hpp>
#include <support/program.hpp>
#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

/// A simd of its own on a Unix socket, in a folder that goes away with the test.
class Server {
  public:
    explicit Server(Json settings = Json::object()) : m_settings(std::move(settings)) { start(); }
    void start() {
        m_settings["address"] = "";
        std::ofstream(config()) << m_settings;
        m_program.emplace(
            "simd", std::vector<std::string>{"serve", folder().string(), "--config", config(), "--json"},
            (m_folder.path / "told").string());
        const auto answer = parse_json(m_program->line());
        REQUIRE(answer);
        REQUIRE_FALSE(answer->contains("error"));
    }
    /// As a fault of the machine ends it.
    void kill() {
        m_program->end(SIGKILL);
        m_program->exit_code();
    }
    /// It stands still, and keeps its connections, as one does that is overloaded.
    void suspend() { m_program->suspend(); }
    [[nodiscard]] ServerWish wish() const {
        return {.host = "unix:" + (folder() / "simd.sock").string(), .token_file = {}, .fingerprint = {}};
    }
    [[nodiscard]] std::size_t sessions() const {
        const auto text = wire::download(place_of(wish()).value(), "/api/v1/status", 1 << 24);
        REQUIRE(text);
        return parse_json(*text).value().at("sessions").size();
    }

  private:
    [[nodiscard]] std::filesystem::path folder() const { return m_folder.path / "box"; }
    [[nodiscard]] std::string config() const { return (m_folder.path / "config.json").string(); }
    weave::testing::TemporaryFolder m_folder;
    Json m_settings;
    std::optional<weave::testing::Program> m_program;
};

Yarns run_here(const Design& design, const sim::RunRequest& request) {
    const auto run = std::move(sim::Run::begin(design, request, 0)).value();
    const std::size_t leg = sim::leg_steps(run->now().plan(), sim::Solver::relax);
    while (!run->is_over()) REQUIRE(run->advance(leg, {}));
    return run->yarns();
}

}  // namespace

TEST_CASE("a run on a server comes to the bits of one here, and its session is closed in the end") {
    const Server server;
    const Design design = sample("angle-interlock-b");
    {
        RemoteRelaxation run(server.wish());
        FollowedRun told(run);
        run.start(design, request_at(sim::Fidelity::draft));
        REQUIRE(told.until_phase(RunPhase::paused));
        CHECK(told.plan);
        run.step(14);
        REQUIRE(told.until_yarns(RunPhase::paused, 1));
        CHECK(told.progress.step == 14);
        run.run();
        REQUIRE(told.until([&] { return told.inspection != nullptr; }));
        CHECK(run.phase() == RunPhase::at_rest);
        REQUIRE(told.frame);
        CHECK(told.frame->head.at_rest);
        CHECK(told.layouts.size() == 1);
        CHECK(told.progress.goal == 1e-2);
        check_same(*told.yarns.back(), run_here(design, request_at(sim::Fidelity::draft)));
        CHECK(server.sessions() == 1);
    }
    CHECK(QTest::qWaitFor([&] { return server.sessions() == 0; }, patience_ms));
}

TEST_CASE("a cloth that a server can never have room for is refused here, with what the server has, before it is laid out") {
    const Server server(Json{{"memory_mib", 41}});
    Design design = sample("pocket");
    design.scene.boundary_x = design.scene.boundary_y = Boundary::frozen;
    RemoteRelaxation run(server.wish());
    FollowedRun told(run);
    run.start(design, request_at(sim::Fidelity::draft));
    REQUIRE(QTest::qWaitFor([&] { return told.error.has_value(); }, patience_ms));
    CHECK_FALSE(told.plan);
    CHECK_THAT(told.error->message, Catch::Contains("41 MiB is all that there is on unix:") && Catch::Contains("simulate a part of the cloth"));
    CHECK_THAT(told.error->message, !Catch::Contains("on a server"));
}

TEST_CASE("a run on a server takes parameters and flips, and tells what is refused") {
    const Server server;
    RemoteRelaxation run(server.wish());
    FollowedRun told(run);
    run.start(sample("plain"), request_at(sim::Fidelity::draft));
    run.run();
    REQUIRE(told.until_yarns(RunPhase::at_rest, 1));
    const double before = told.layouts.back()->yarns.back().radius_mm;
    run.set_parameters({.strain = 1.03, .stiffness_scale = {}, .radius_scale = 1.1}, {});
    REQUIRE(told.until([&] { return told.arrivals == 1 && told.layouts.size() == 2; }));
    CHECK(told.layouts.back()->yarns.back().radius_mm == Approx(1.1 * before));
    run.set_parameters({.strain = 3, .stiffness_scale = {}, .radius_scale = {}}, {});
    REQUIRE(told.until([&] { return !told.refusals.empty(); }));
    CHECK_FALSE(told.refusals.front().text().empty());
    run.flip({500, 0, true});
    REQUIRE(told.until([&] { return told.flips.size() == 1; }));
    CHECK_FALSE(told.flips.front().done);
    CHECK_FALSE(told.flips.front().reason.empty());
    const Evaluation evaluation = evaluate(sample("plain")).value();
    run.flip({0, 0, !evaluation.block->stack(0, 0).weft_over(0, 0)});
    REQUIRE(told.until([&] { return told.flips.size() == 2; }));
    INFO(told.flips.back().reason);
    CHECK(told.flips.back().flip.pick == 0);
    CHECK_FALSE(told.error);
}

TEST_CASE("a run on a server outlives the server's fault, and says meanwhile what is wrong") {
    Server server;
    RemoteRelaxation run(server.wish());
    FollowedRun told(run);
    sim::RunRequest request = request_at(sim::Fidelity::draft);
    request.goal.residual = 1e-7;  // long enough to be in the midst of it
    run.start(sample("hexagon-tubes"), request);
    run.run();
    REQUIRE(told.until([&] { return told.progress.step > 3; }));
    server.kill();
    REQUIRE(told.until([&] { return !told.troubles.empty() && !told.troubles.back().isEmpty(); }));
    run.pause();  // is asked for once there is somebody to ask
    server.start();
    REQUIRE(told.until([&] { return run.phase() == RunPhase::paused || run.phase() == RunPhase::at_rest; }));
    run.run();
    REQUIRE(told.until([&] { return told.inspection != nullptr; }));
    CHECK(run.phase() == RunPhase::at_rest);
    CHECK(told.troubles.back().isEmpty());
    CHECK_FALSE(told.error);
}

TEST_CASE("a run on a server that is stopped brings its yarns, and one that is left asks for nothing") {
    const Server server;
    auto run = std::make_unique<RemoteRelaxation>(server.wish());
    FollowedRun told(*run);
    sim::RunRequest request = request_at(sim::Fidelity::standard);
    request.goal.residual = 1e-12;
    run->start(sample("hexagon-tubes"), request);
    run->run();
    REQUIRE(told.until([&] { return told.progress.step > 3; }));
    run->stop();
    REQUIRE(told.until([&] { return run->phase() == RunPhase::stopped; }));
    REQUIRE_FALSE(told.yarns.empty());
    CHECK(told.yarns.back()->report.at("converged") == false);
    CHECK(QTest::qWaitFor([&] { return server.sessions() == 0; }, patience_ms));
    run->start(sample("hexagon-tubes"), request);
    run->run();
    run.reset();
    CHECK(QTest::qWaitFor([&] { return server.sessions() == 0; }, patience_ms));
}

TEST_CASE("a run on a server that answers nothing any more is stopped all the same") {
    Server server;
    RemoteRelaxation run(server.wish());
    FollowedRun told(run);
    sim::RunRequest request = request_at(sim::Fidelity::standard);
    request.goal.residual = 1e-12;
    run.start(sample("hexagon-tubes"), request);
    run.run();
    REQUIRE(told.until([&] { return told.progress.step > 3; }));
    server.suspend();
    run.stop();
    REQUIRE(told.until([&] { return run.phase() == RunPhase::stopped; }));
    CHECK_FALSE(told.error);
}

TEST_CASE("a server that is not there, and one that refuses, are told as they are") {
    const weave::testing::TemporaryFolder folder;
    const auto error_of = [&](const ServerWish& wish, const Design& design) {
        RemoteRelaxation run(wish);
        FollowedRun told(run);
        run.start(design, request_at(sim::Fidelity::draft));
        REQUIRE(QTest::qWaitFor([&] { return told.error.has_value(); }, patience_ms));
        CHECK(run.phase() == RunPhase::failed);
        return told.error->text();
    };
    const ServerWish nowhere{
        .host = "unix:" + (folder.path / "none").string(), .token_file = {}, .fingerprint = {}};
    CHECK_THAT(error_of(nowhere, sample("plain")), Catch::Contains("none"));
    CHECK_THAT(
        error_of({.host = "http://far.example:9", .token_file = {}, .fingerprint = {}}, sample("plain")),
        Catch::Contains("plain HTTP"));
    ServerWish no_token = nowhere;
    no_token.token_file = (folder.path / "token").string();
    CHECK_THAT(error_of(no_token, sample("plain")), Catch::Contains("token"));
    const Server server;
    Design design = sample("plain");
    design.scene.boundary_x = Boundary::free;
    CHECK_THAT(error_of(server.wish(), design), Catch::Contains("fed at constant tension"));
}
