// Jobs in Slurm: handed over in arrays, run on nodes, brought home, cancelled, and found again by a daemon that was killed.

#include "cluster.hpp"

#include <fstream>
#include <set>
#include <sys/stat.h>

using namespace weave;
using namespace weave::simd::testing;

namespace {

wire::Simulation endless() {
    wire::Simulation simulation = long_run();
    simulation.residual = 1e-15;
    return simulation;
}

std::string batch_of(wire::Follower& follower, std::uint64_t job) {
    const auto list = wire::answer_of<wire::JobList>(follower.ask(wire::ListJobs{wire::new_request_id()}, 10s));
    REQUIRE(list);
    for (const wire::JobState& state : list->jobs) {
        if (state.job == job) return state.batch.value_or("");
    }
    return {};
}

/// Until Slurm runs it, and it has made steps.
bool makes_steps(const Box& box, std::uint64_t job) {
    const bool made = until([&] {
        const Json status = box.status();  // of which the list below is a part
        for (const Json& one : status.at("jobs")) {
            if (one.at("job") == job && one.at("step") > 0) return true;
        }
        return false;
    });
    if (!made) UNSCOPED_INFO("what simd says of its jobs: " << box.status().dump(1));
    return made;
}

/// Arrays that the queue has seen.
std::set<std::string> arrays(const Cluster& cluster) {
    std::set<std::string> found;
    for (const std::string& line : cluster.queue()) found.insert(line.substr(0, line.find('|')));
    return found;
}

/// Has a daemon that starts from now on run this in the place of sbatch. The PATH that was.
std::string put_before_sbatch(const Cluster& cluster, const std::string& script) {
    const std::filesystem::path folder = cluster.folder() / "bin";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "sbatch") << "#!/bin/sh\nhere=${0%/*}\nPATH=/usr/bin:/bin\n[ \"$1\" = --version ] && exec sbatch \"$@\"\n" + script;
    ::chmod((folder / "sbatch").c_str(), 0755);
    const std::string path = std::getenv("PATH");
    ::setenv("PATH", (folder.string() + ":" + path).c_str(), 1);
    return path;
}

}  // namespace

TEST_CASE("jobs run in Slurm as they do on this machine with a GPU of their own each and leave nothing behind") {
    const std::string wanted = yarns_made_here(lasting_run());
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t first = submit(follower, document_of(long_cloth), lasting_run()), second = submit(follower, document_of(long_cloth), lasting_run());
    REQUIRE(makes_steps(box, first));
    REQUIRE(makes_steps(box, second));
    std::set<std::string> places{batch_of(follower, first), batch_of(follower, second)};
    INFO(*places.begin() << ", " << *places.rbegin());
    CHECK(places.begin()->find("Slurm ") == 0);
    CHECK(places.begin()->find("_0: running on n") != std::string::npos);
    CHECK(places.rbegin()->find("_1: running on n") != std::string::npos);
    CHECK(places.begin()->find(", GPU 0") != std::string::npos);
    CHECK(cluster.queued("|RUNNING|n1|") == 1);
    CHECK(cluster.queued("|RUNNING|n2|") == 1);
    CHECK(arrays(cluster).size() == 1);
    for (const std::uint64_t job : {first, second}) {
        wire::Follower another = box.follower();  // which is told of all ends
        CHECK(end_of(another, job).phase == wire::JobPhase::done);
        check_same_yarns(yarns_of(another, job), wanted);
        REQUIRE(another.acknowledge_job(job, 10s));
    }
    CHECK(until([&] { return std::filesystem::is_empty(cluster.shared() / "jobs"); }, 20s));
    CHECK(std::filesystem::is_empty(box.folder() / "jobs"));
}

TEST_CASE("what a design does not allow or needs more memory than Slurm gives fails with the reason and is not tried again") {
    const Cluster cluster;
    const Box box(cluster.config(Json{{"memory_mib", 100}}));
    wire::Follower follower = box.follower();
    const std::uint64_t none = submit(follower, "{\"format\":\"weave\",\"title\":\"nothing\"}", at(sim::Fidelity::draft));
    wire::Simulation fine = at(sim::Fidelity::reference);
    fine.plan.reduce = false;
    const std::uint64_t large = submit(follower, document_of("shoe-baby"), fine);
    const wire::JobEnded first = end_of(follower, none);
    CHECK(first.phase == wire::JobPhase::failed);
    REQUIRE(first.error);
    CHECK(first.error->code != ErrorCode::system);
    wire::Follower another = box.follower();
    const wire::JobEnded second = end_of(another, large);
    CHECK(second.phase == wire::JobPhase::failed);
    REQUIRE(second.error);
    CHECK_THAT(second.error->message, Catch::Contains("and a job gets 100 MiB here (slurm.memory_mib"));
    CHECK(arrays(cluster).size() == 1);
}

TEST_CASE("a job that waits in Slurm is cancelled at once and one that runs keeps its yarns as they lay and Slurm is rid of both") {
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    std::vector<std::uint64_t> jobs;
    for (int k = 0; k < 3; ++k) jobs.push_back(submit(follower, document_of(long_cloth), endless()));
    REQUIRE(makes_steps(box, jobs[0]));
    REQUIRE(makes_steps(box, jobs[1]));
    CHECK_THAT(batch_of(follower, jobs[2]), Catch::Contains("pending (Resources)") || Catch::Contains("pending (Priority)"));
    cancel(follower, jobs[2]);
    const wire::JobEnded waited = end_of(follower, jobs[2]);
    CHECK(waited.phase == wire::JobPhase::cancelled);
    CHECK(waited.report.empty());
    cancel(follower, jobs[0]);
    const wire::JobEnded ran = end_of(follower, jobs[0]);
    CHECK(ran.phase == wire::JobPhase::cancelled);
    CHECK_FALSE(ran.error);
    CHECK(ran.report.at("ending") == "stopped");
    CHECK(read_yarns(yarns_of(follower, jobs[0])).value().report.at("iterations").get<std::size_t>() > 0);
    CHECK(until([&] { return cluster.queued("|RUNNING|") == 1 && cluster.queued("|PENDING|") == 0; }));
    told_by("scancel " + cluster.queue().front().substr(0, cluster.queue().front().find('|')) + "_1");
    const wire::JobEnded outside = end_of(follower, jobs[1]);
    CHECK(outside.phase == wire::JobPhase::failed);
    REQUIRE(outside.error);
    CHECK_THAT(outside.error->message, Catch::Contains("was cancelled in Slurm"));
}

TEST_CASE("a daemon that is killed finds its jobs in Slurm again and hands none over twice and gets what ended meanwhile") {
    const Cluster cluster;
    Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t quick = submit(follower, document_of(long_cloth), lasting_run()), slow = submit(follower, document_of(long_cloth), endless());
    REQUIRE(makes_steps(box, quick));
    REQUIRE(makes_steps(box, slow));
    box.kill();
    REQUIRE(until([&] { return cluster.queued("|COMPLETED|") == 1; }, 180s));  // it computes for a quarter of a minute where nothing else does
    box.start();
    CHECK(end_of(follower, quick).phase == wire::JobPhase::done);
    CHECK(makes_steps(box, slow));
    CHECK(box.stop() == 0);  // Slurm's jobs go on
    CHECK(cluster.queued("|RUNNING|") == 1);
    box.start();
    CHECK(makes_steps(box, slow));
    CHECK(arrays(cluster).size() == 1);
    cancel(follower, slow);
    CHECK(end_of(follower, slow).report.at("ending") == "stopped");
}

TEST_CASE("a daemon that dies while Slurm takes its jobs finds them by their name and does not hand them over again") {
    const Cluster cluster;
    // Slurm has them, and the daemon never hears of it.
    const std::string path = put_before_sbatch(cluster, "sbatch \"$@\" >/dev/null\nkill -9 $PPID\n");
    Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), long_run());
    ::setenv("PATH", path.c_str(), 1);
    REQUIRE(until([&] { return arrays(cluster).size() == 1; }));
    box.kill();  // which it is already
    box.start();
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
    CHECK(arrays(cluster).size() == 1);
}

TEST_CASE("jobs that Slurm has twice because a call that failed was only slow end once with the same bits") {
    const std::string wanted = yarns_made_here(long_run());
    const Cluster cluster;
    // What the first call asks for comes to pass after the second was answered.
    const std::string path = put_before_sbatch(cluster, R"(if mkdir "$here/first"; then
    (until [ -e "$here/second" ]; do sleep 0.1; done; sbatch "$@" >"$here/late") </dev/null >/dev/null 2>&1 &
    echo "sbatch: error: Batch job submission failed: Socket timed out on send/recv operation" >&2
    exit 1
fi
sbatch "$@" && : >"$here/second"
)");
    Box box(cluster.config());
    ::setenv("PATH", path.c_str(), 1);
    wire::Follower follower = box.follower();
    const std::uint64_t first = submit(follower, document_of(long_cloth), long_run()), second = submit(follower, document_of(long_cloth), long_run());
    CHECK(end_of(follower, first).phase == wire::JobPhase::done);
    wire::Follower another = box.follower();  // which is told of what ended meanwhile
    CHECK(end_of(another, second).phase == wire::JobPhase::done);
    for (const std::uint64_t job : {first, second}) check_same_yarns(yarns_of(follower, job), wanted);
    INFO(box.told());
    CHECK(box.told().find("Socket timed out") != std::string::npos);
    REQUIRE(until([&] { return arrays(cluster).size() >= 2; }));
    CHECK(until([&] { return cluster.queued("|RUNNING|") + cluster.queued("|PENDING|") == 0; }, 90s));
    CHECK(until([&] { return cluster.copies().empty(); }));
}

TEST_CASE("names and titles reach no shell and the site sees whose a job is") {
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    Design design = find_sample("plain")->make();
    const std::filesystem::path trap = cluster.folder() / "trap";
    design.title = "$(touch " + trap.string() + "); `touch " + trap.string() + "` '\"";
    const std::uint64_t job = submit(follower, write_document(design), at(sim::Fidelity::draft));
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
    CHECK_FALSE(std::filesystem::exists(trap));
    const std::string line = cluster.queue().front();
    CHECK(line.find("|simd-") != std::string::npos);
    CHECK(line.back() != '|');
}
