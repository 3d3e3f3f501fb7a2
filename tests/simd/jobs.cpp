// Jobs: queued durably, run one after the other, cancelled, taken up again, told of until they are acknowledged.

#include "box.hpp"
#include "results.hpp"
#include "submitted.hpp"

#include <weave/core/sha256.hpp>
#include <weave/keys/server_key.hpp>
#include <weave/keys/signed_document.hpp>
#include <weave/keys/signer.hpp>
#include <weave/sim/run.hpp>
#include <weave/wire/evidence.hpp>

using namespace weave;
using namespace weave::simd::testing;

TEST_CASE("a job runs to its end, hands out its yarns, and is told of until it is acknowledged") {
    const Box box;
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of("layer-to-layer"), at(sim::Fidelity::standard));
    const wire::JobEnded ended = end_of(follower, job);
    CHECK(ended.phase == wire::JobPhase::done);
    CHECK_FALSE(ended.error);
    CHECK_FALSE(ended.evidence);
    CHECK(ended.report.at("converged") == true);
    const std::string bytes = yarns_of(follower, job);
    CHECK(sha256_hex(bytes) == ended.report.at("yarns_sha256"));
    CHECK(read_yarns(bytes).value().report.at("converged") == true);
    wire::Follower other = box.follower();
    CHECK(end_of(other, job).phase == wire::JobPhase::done);
    REQUIRE(other.acknowledge_job(job, 10s));
    wire::Follower third = box.follower();
    const auto list = wire::answer_of<wire::JobList>(third.ask(wire::ListJobs{wire::new_request_id()}, 10s));
    REQUIRE(list);
    CHECK(list->jobs.empty());
    CHECK_FALSE(third.download(wire::job_yarns(job), 1 << 20));
}

TEST_CASE("a job with flips and rougher points first is what the same run gives on this machine") {
    const Box box;
    wire::Follower follower = box.follower();
    Design design = find_sample("layer-to-layer")->make();
    wire::Simulation simulation = at(sim::Fidelity::standard);
    simulation.start_from = sim::Fidelity::draft;
    const std::uint64_t job = submit(follower, write_document(design), simulation, {{0, 0, true}, {0, 0, false}});
    const wire::JobEnded ended = end_of(follower, job);
    CHECK(ended.phase == wire::JobPhase::done);
    CHECK(ended.report.at("coarser").at("fidelity") == "draft");
    CHECK(ended.report.at("flips").size() == 2);

    sim::RunRequest here;
    here.plan = simulation.plan;
    here.start_from = simulation.start_from;
    here.flips = {{0, 0, true}, {0, 0, false}};
    auto run = sim::Run::begin(design, here, 1).value();
    while (!run->is_over()) REQUIRE(run->advance(sim::leg_steps(run->now().plan(), here.goal.solver), {}));
    check_same_yarns(yarns_of(follower, job), write_yarns(run->yarns()).value());
}

TEST_CASE("a design that cannot be simulated is a failed job that says why") {
    const Box box;
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, "{\"format\":\"weave\",\"title\":\"nothing\"}", at(sim::Fidelity::draft));
    const wire::JobEnded ended = end_of(follower, job);
    CHECK(ended.phase == wire::JobPhase::failed);
    REQUIRE(ended.error);
    CHECK(ended.error->code != ErrorCode::system);
    CHECK_FALSE(wire::answer_of<wire::Accepted>(follower.ask(wire::Submit{wire::new_request_id(), "no json", at(sim::Fidelity::draft), {}}, 10s)));
}

TEST_CASE("a cloth of many repeats has the room of all of them, and is refused where that is not there") {
    Design design = find_sample("plain")->make();
    constexpr std::size_t times = 250;  // some 500 MiB, where a repeat alone would be bounded by 340 MiB
    design.blocks["many"] = std::make_shared<const Node>(Node{TileOperation{design.root, times, times, 1}, {}});
    design.root = "many";
    const std::string document = write_document(design);
    {
        const Box box;
        wire::Follower follower = box.follower();
        const wire::JobEnded ended = end_of(follower, submit(follower, document, at(sim::Fidelity::standard)));
        if (ended.error) FAIL(ended.error->text());
        CHECK(ended.phase == wire::JobPhase::done);
    }
    const Box small(Json{{"memory_mib", 200}});
    wire::Follower follower = small.follower();
    const wire::JobEnded ended = end_of(follower, submit(follower, document, at(sim::Fidelity::standard)));
    CHECK(ended.phase == wire::JobPhase::failed);
    REQUIRE(ended.error);
    CHECK(ended.error->code == ErrorCode::refused);
    CHECK_THAT(ended.error->message, Catch::Contains("200 MiB is all that there is"));
}

TEST_CASE("jobs that wait are cancelled at once, one that runs keeps its yarns as they lay") {
    const Box box(Json{{"jobs_at_once", 1}});
    wire::Follower follower = box.follower();
    wire::Simulation endless = long_run();
    endless.residual = 1e-15;
    const std::uint64_t running = submit(follower, document_of(long_cloth), endless), waiting = submit(follower, document_of("plain"), at(sim::Fidelity::draft));
    std::this_thread::sleep_for(1s);
    const auto list = wire::answer_of<wire::JobList>(follower.ask(wire::ListJobs{wire::new_request_id()}, 10s));
    REQUIRE(list);
    REQUIRE(list->jobs.size() == 2);
    CHECK(list->jobs[0].phase == wire::JobPhase::running);
    CHECK(list->jobs[1].phase == wire::JobPhase::waiting);
    CHECK(list->jobs[1].place == 1);
    REQUIRE(wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), waiting}, 10s)));
    const wire::JobEnded gone = end_of(follower, waiting);
    CHECK(gone.phase == wire::JobPhase::cancelled);
    CHECK(gone.report.empty());
    CHECK_FALSE(follower.download(wire::job_yarns(waiting), 1 << 20));
    REQUIRE(wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), running}, 10s)));
    const wire::JobEnded stopped = end_of(follower, running);
    CHECK(stopped.phase == wire::JobPhase::cancelled);
    CHECK(stopped.report.at("ending") == "stopped");
    CHECK(stopped.report.at("converged") == false);
    CHECK(read_yarns(yarns_of(follower, running)).value().report.at("iterations").get<std::size_t>() > 0);
    CHECK_FALSE(wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), running}, 10s)));
}

TEST_CASE("a cancelled job whose worker dies meanwhile keeps its yarns as they lay all the same") {
    const Box box;
    wire::Follower follower = box.follower();
    wire::Simulation endless = long_run();
    endless.residual = 1e-15;
    const std::uint64_t job = submit(follower, document_of(long_cloth), endless);
    const auto is_running = [&] { return box.status().at("jobs").at(0).at("step") > 0; };
    for (int k = 0; k < 1000 && !is_running(); ++k) std::this_thread::sleep_for(20ms);
    const auto worker = box.worker("job", job);
    REQUIRE(worker);
    REQUIRE(::kill(*worker, SIGSTOP) == 0);
    REQUIRE(wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), job}, 10s)));
    REQUIRE(::kill(*worker, SIGKILL) == 0);
    const wire::JobEnded ended = end_of(follower, job);
    CHECK(ended.phase == wire::JobPhase::cancelled);
    CHECK_FALSE(ended.error);
    CHECK(ended.report.at("ending") == "stopped");
    CHECK_FALSE(read_yarns(yarns_of(follower, job)).value().yarns.empty());
}

TEST_CASE("a job that is broken off by kills of its worker and of the daemon ends bit by bit as one that was not") {
    Box box;
    wire::Follower follower = box.follower();
    const std::uint64_t whole = submit(follower, document_of(long_cloth), long_run());
    CHECK(end_of(follower, whole).phase == wire::JobPhase::done);
    const std::string wanted = yarns_of(follower, whole);
    const std::uint64_t broken = submit(follower, document_of(long_cloth), long_run());
    std::this_thread::sleep_for(1500ms);
    if (const auto worker = box.worker("job", broken)) ::kill(*worker, SIGKILL);
    std::this_thread::sleep_for(1s);
    box.kill();
    box.start();
    std::this_thread::sleep_for(500ms);
    CHECK(box.stop() == 0);
    box.start();
    CHECK(end_of(follower, broken).phase == wire::JobPhase::done);
    check_same_yarns(yarns_of(follower, broken), wanted);
}

TEST_CASE("a machine with a key signs what a job found, of the very design, scene and yarns") {
    weave::testing::TemporaryFolder keys;
    const KeyPair key = create_server_key(keys.path / "box.key", ServerKeyRole::evidence).value();
    REQUIRE(save_signer_note(keys.path / "box.key", {key.id(), "the mill", "box"}));
    const Box box(Json{{"evidence_key", (keys.path / "box.key").string()}});
    wire::Follower follower = box.follower();
    const auto signs = [](wire::Follower& asking) { return wire::answer_of<wire::JobList>(asking.ask(wire::ListJobs{wire::new_request_id()}, 10s)).value().signs; };
    CHECK(signs(follower) == true);
    const Box without;
    wire::Follower there = without.follower();
    CHECK(signs(there) == false);
    const Design design = find_sample("plain")->make();
    const std::uint64_t job = submit(follower, write_document(design), at(sim::Fidelity::standard));
    const wire::JobEnded ended = end_of(follower, job);
    REQUIRE(ended.evidence);
    const auto document = follower.download(wire::job_evidence(job), 1 << 24);
    REQUIRE(document);
    CHECK(canonical_json(*ended.evidence) == *document);
    const auto evidence = wire::read_evidence(*document);
    INFO((evidence ? "" : evidence.error().text()));
    REQUIRE(evidence);
    CHECK(verify_body(key.public_key(), Purpose::evidence, evidence->statement, evidence->signature));
    const wire::SimulationStatement statement = wire::read_simulation(evidence->statement).value();
    CHECK(statement.site == "the mill");
    CHECK(hash_hex(statement.design_sha256) == design_sha256(design));
    CHECK(hash_hex(statement.scene_sha256) == scene_sha256(design));
    CHECK(hash_hex(statement.result_sha256) == sha256_hex(yarns_of(follower, job)));
    CHECK(statement.converged);
    wire::Simulation endless = at(sim::Fidelity::standard);
    endless.residual = 1e-15;
    const std::uint64_t cancelled = submit(follower, document_of(long_cloth), endless);
    std::this_thread::sleep_for(500ms);
    REQUIRE(wire::answer_of<wire::Accepted>(follower.ask(wire::Cancel{wire::new_request_id(), cancelled}, 10s)));
    CHECK_FALSE(end_of(follower, cancelled).evidence);
}
