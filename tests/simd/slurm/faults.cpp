// What happens to jobs in Slurm when copies go astray, disks are full, clocks are wrong, and what is between daemon and nodes is cut.

#include "cluster.hpp"

#include <weave/core/sha256.hpp>

#include <fstream>
#include <simd/slurm/job_folder.hpp>
#include <sys/resource.h>
#include <sys/stat.h>

using namespace weave;
using namespace weave::simd;
using namespace weave::simd::testing;

namespace {

/// The one job of this daemon, in the folder that all nodes share.
JobFolder folder_of(const Cluster& cluster, std::uint64_t job) {
    return SharedFolder{cluster.shared()}.job(job);
}

bool has_attempt(const JobFolder& folder, std::uint64_t number) {
    return until([&] {
        const auto newest = folder.newest_attempt();
        return newest && *newest >= number && folder.news(number).has_value();
    });
}

/// The program of a job, as Slurm starts it, but by hand: a copy that Slurm knows nothing of.
std::unique_ptr<weave::testing::Program> stray_copy(const Cluster& cluster, const char* array, const std::string& told) {
    ::setenv("SLURM_ARRAY_TASK_ID", "0", 1);
    ::setenv("SLURMD_NODENAME", "astray", 1);
    ::setenv("SLURM_CPUS_PER_TASK", "1", 1);
    auto program = std::make_unique<weave::testing::Program>("simd", std::vector<std::string>{"job", (cluster.shared() / "arrays" / array).string()}, told);
    for (const char* name : {"SLURM_ARRAY_TASK_ID", "SLURMD_NODENAME", "SLURM_CPUS_PER_TASK"}) ::unsetenv(name);
    return program;
}

}  // namespace

TEST_CASE("of two copies of a job the later one counts and the stale one ends itself with that reason") {
    const std::string wanted = yarns_made_here(lasting_run());
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), lasting_run());
    const JobFolder folder = folder_of(cluster, job);
    REQUIRE(has_attempt(folder, 1));
    const std::string told = (cluster.folder() / "stray").string();
    const auto copy = stray_copy(cluster, "1.json", told);
    REQUIRE(has_attempt(folder, 2));
    REQUIRE(until([&] { return folder.end_of(1).value().has_value(); }));
    const AttemptEnd stale = *folder.end_of(1).value();
    CHECK(stale.outcome == Outcome::never);
    REQUIRE(stale.error);
    CHECK_THAT(stale.error->message, Catch::Contains("attempt 1 is stale: attempt "));
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
    check_same_yarns(yarns_of(follower, job), wanted);
    const int exit = copy->exit_code();  // where Slurm's own copy began once more before it was done it is the stale one
    CHECK((exit == 0 || exit == 70));
}

TEST_CASE("a stale copy that writes its result all the same is refused by its token") {
    const std::string wanted = yarns_made_here(lasting_run());
    const Cluster cluster;
    Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), lasting_run());
    const JobFolder folder = folder_of(cluster, job);
    REQUIRE(has_attempt(folder, 1));
    const auto copy = stray_copy(cluster, "1.json", (cluster.folder() / "stray").string());
    REQUIRE(has_attempt(folder, 2));
    copy->suspend();
    // The first, which has looked before the second began and knows no better, hands in what is a whole result in all else.
    REQUIRE(until([&] { return folder.end_of(1).value().has_value(); }));
    const auto order = folder.order();
    REQUIRE(order);
    REQUIRE(write_file(folder.attempt(1) / "result.yarns", wanted));
    AttemptEnd forged;
    forged.input_sha256 = input_sha256(*order);
    forged.node = "n1";
    forged.report = read_yarns(wanted).value().report;
    forged.report["yarns_sha256"] = sha256_hex(wanted);
    forged.report["forged"] = true;
    REQUIRE(folder.end(1, forged));
    REQUIRE(until([&] { return box.told().find("a result from n1 is refused: job " + std::to_string(job) + ": attempt 1 is stale: attempt ") != std::string::npos; }));
    box.kill();  // and so it stays
    box.start();
    REQUIRE(folder.end(1, forged));
    REQUIRE(until([&] { return !std::filesystem::exists(folder.attempt(1) / "end.json"); }));
    copy->end(SIGCONT);
    const wire::JobEnded ended = end_of(follower, job);
    CHECK(ended.phase == wire::JobPhase::done);
    CHECK_FALSE(ended.report.contains("forged"));
    check_same_yarns(yarns_of(follower, job), wanted);
    const int exit = copy->exit_code();  // where Slurm's own copy began once more before it was done it is the stale one
    CHECK((exit == 0 || exit == 70));
    wire::Follower another = box.follower();
    CHECK(end_of(another, job).report == ended.report);
}

TEST_CASE("a result that is not of the order or not what its report tells is refused and the job is done again") {
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    wire::Simulation endless = long_run();
    endless.residual = 1e-15;
    const std::uint64_t job = submit(follower, document_of(long_cloth), endless);
    const JobFolder folder = folder_of(cluster, job);
    REQUIRE(has_attempt(folder, 1));
    AttemptEnd forged;
    forged.input_sha256 = std::string(64, '0');
    forged.node = "n1";
    forged.report = Json{{"yarns_sha256", std::string(64, '0')}};
    REQUIRE(write_file(folder.attempt(1) / "result.yarns", "others"));
    REQUIRE(folder.end(1, forged));
    CHECK(until([&] { return std::filesystem::exists(folder.attempt(1) / "refused.json"); }));
    std::this_thread::sleep_for(1500ms);
    CHECK(box.status().at("jobs").size() == 1);
    cancel(follower, job);
    CHECK(end_of(follower, job).phase == wire::JobPhase::cancelled);
}

TEST_CASE("a job that Slurm puts back goes on soon from its checkpoint and ends with the same bits") {
    const std::string wanted = yarns_made_here(lasting_run());
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), lasting_run());
    const JobFolder folder = folder_of(cluster, job);
    REQUIRE(has_attempt(folder, 1));
    REQUIRE(until([&] { return std::filesystem::exists(folder.attempt(1) / "checkpoint"); }));
    const std::string id = cluster.queue().front().substr(0, cluster.queue().front().find('|')) + "_0";
    told_by("scontrol requeue " + id);
    REQUIRE(has_attempt(folder, 2));
    const AttemptEnd first = *folder.end_of(1).value();
    CHECK(first.outcome == Outcome::again);
    CHECK_THAT(first.error->message, Catch::Contains("Slurm has asked it to end"));
    CHECK(std::filesystem::exists(folder.attempt(2) / "checkpoint"));
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
    check_same_yarns(yarns_of(follower, job), wanted);
}

TEST_CASE("while Slurm does not answer that is told and jobs that run end well and those that wait go on afterwards") {
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), lasting_run());
    REQUIRE(has_attempt(folder_of(cluster, job), 1));
    cluster.signal("slurmctld", SIGKILL);
    const std::uint64_t later = submit(follower, document_of("plain"), at(sim::Fidelity::draft));
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
    REQUIRE(until([&] { return box.told().find("Unable to contact slurm controller") != std::string::npos; }));
    CHECK_THAT(box.told(), Catch::Contains("slurmctld does not answer: jobs that run go on meanwhile"));
    const auto health = wire::download(box.place(), "/healthz", 1 << 20);
    CHECK_FALSE(health);  // 503
    const auto list = wire::answer_of<wire::JobList>(follower.ask(wire::ListJobs{wire::new_request_id()}, 10s));
    REQUIRE(list);
    for (const wire::JobState& state : list->jobs) {
        if (state.job == later) CHECK_THAT(state.batch.value_or(""), Catch::Contains("being handed over; ") && Catch::Contains("slurmctld does not answer"));
    }
    cluster.start_again("slurmctld");
    CHECK(end_of(follower, later).phase == wire::JobPhase::done);
    CHECK(until([&] { return wire::download(box.place(), "/healthz", 1 << 20).operator bool(); }, 20s));
}

TEST_CASE("a node that dies while its job goes on costs nothing") {
    const std::string wanted = yarns_made_here(lasting_run());
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), lasting_run());
    const JobFolder folder = folder_of(cluster, job);
    REQUIRE(has_attempt(folder, 1));
    cluster.signal(folder.news(1)->node, SIGKILL);
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
    check_same_yarns(yarns_of(follower, job), wanted);
}

TEST_CASE("a node that is cut off from all others loses its job to another and does not count when it is back") {
    const std::string wanted = yarns_made_here(lasting_run());
    const Cluster cluster;
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of(long_cloth), lasting_run());
    const JobFolder folder = folder_of(cluster, job);
    REQUIRE(has_attempt(folder, 1));
    const std::string node = folder.news(1)->node;
    const std::vector<pid_t> copies = cluster.copies();
    REQUIRE(copies.size() == 1);
    const std::string workers = told_by("pgrep -P " + std::to_string(copies.front()));
    REQUIRE_FALSE(workers.empty());
    const std::vector<pid_t> cut{cluster.process(node), copies.front(), std::stoi(workers)};
    for (const pid_t process : cut) REQUIRE(::kill(process, SIGSTOP) == 0);
    REQUIRE(has_attempt(folder, 2));  // once Slurm has given the node up
    CHECK(folder.news(2)->node != node);
    const wire::JobEnded ended = end_of(follower, job);
    CHECK(ended.phase == wire::JobPhase::done);
    for (const pid_t process : cut) ::kill(process, SIGCONT);
    CHECK(until([&] { return cluster.copies().empty(); }));
    check_same_yarns(yarns_of(follower, job), wanted);
    wire::Follower another = box.follower();
    CHECK(end_of(another, job).report == ended.report);
    CHECK(until([&] { return std::filesystem::is_empty(cluster.shared() / "jobs"); }));
}

TEST_CASE("a disk that is full on one node is told with the node and the job goes to another") {
    if (is_sanitized) return;  // whose reports want room themselves
    const Cluster cluster;
    const Box box(cluster.config(Json{{"checkpoint_seconds", 3600}}));
    wire::Follower follower = box.follower();
    const rlimit full{8192, RLIM_INFINITY};
    REQUIRE(::prlimit(cluster.process("n1"), RLIMIT_FSIZE, &full, nullptr) == 0);
    const std::uint64_t first = submit(follower, document_of(long_cloth), long_run()), second = submit(follower, document_of(long_cloth), long_run());
    for (const std::uint64_t job : {first, second}) {
        wire::Follower another = box.follower();
        CHECK(end_of(another, job).phase == wire::JobPhase::done);
    }
    CHECK_THAT(box.told(), Catch::Contains("File too large (on n1)"));
    CHECK(cluster.queued("|n2|") >= 2);
}

TEST_CASE("while the folder that nodes share is full that is told and nothing is handed over until there is room") {
    const Cluster cluster;
    std::filesystem::create_directories(cluster.shared());
    struct Mounted {
        std::string at;
        bool is_mounted;
        explicit Mounted(const std::string& path) : at(path), is_mounted(told_by("mount -t tmpfs -o size=80m,mode=700 simd '" + at + "' && echo done") == "done\n") {}
        ~Mounted() {
            if (is_mounted) told_by("umount -l '" + at + "'");
        }
        Mounted(const Mounted&) = delete;
        Mounted& operator=(const Mounted&) = delete;
    } const mounted(cluster.shared().string());
    if (!mounted.is_mounted) {
        WARN("SKIPPED: no file system can be mounted here");
        return;
    }
    const Box box(cluster.config());
    wire::Follower follower = box.follower();
    REQUIRE(write_file(cluster.shared() / "filler", std::string(std::size_t{40} << 20, 'x')));
    const std::uint64_t job = submit(follower, document_of("plain"), at(sim::Fidelity::draft));
    REQUIRE(until([&] { return box.told().find("there is hardly any room left in the folder that nodes share") != std::string::npos; }));
    const auto list = wire::answer_of<wire::JobList>(follower.ask(wire::ListJobs{wire::new_request_id()}, 10s));
    REQUIRE((list && list->jobs.size() == 1));
    CHECK_THAT(list->jobs[0].batch.value_or(""), Catch::Contains("being handed over; there is hardly any room left"));
    CHECK(cluster.queue().empty());
    std::filesystem::remove(cluster.shared() / "filler");
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
}

TEST_CASE("a clock that is an hour ahead keeps jobs from being handed over until it is put right and is told as the cause") {
    if (is_sanitized) return;  // a sanitizer's own library must be the first one
    const Cluster cluster;
    // This machine's clock, as the cluster sees it: what munged here writes into its credentials.
    const std::string here = (cluster.folder() / "here").string();
    std::filesystem::create_directories(here);
    told_by("cp '" + cluster.folder().string() + "/munge.key' '" + here + "/munge.key'; WEAVE_CLOCK_AHEAD_S=3600 LD_PRELOAD=" WEAVE_JUMPING_CLOCK " munged --force --socket=" + here +
            "/socket --key-file=" + here + "/munge.key --pid-file=" + cluster.folder().string() + "/munged-ahead.pid --log-file=" + here + "/log --seed-file=" + here + "/seed");
    auto conf = read_file(cluster.folder() / "slurm.conf").value();
    const std::string socket = "socket=" + cluster.folder().string() + "/munge.socket";
    conf.replace(conf.find(socket), socket.size(), "socket=" + here + "/socket");
    REQUIRE(write_file(here + "/slurm.conf", conf));
    std::filesystem::copy_file(cluster.folder() / "gres.conf", here + "/gres.conf");
    const std::string right = std::getenv("SLURM_CONF");
    ::setenv("SLURM_CONF", (here + "/slurm.conf").c_str(), 1);
    Box box(cluster.config());
    ::setenv("SLURM_CONF", right.c_str(), 1);
    wire::Follower follower = box.follower();
    const std::uint64_t job = submit(follower, document_of("plain"), at(sim::Fidelity::draft));
    CHECK(until([&] { return box.told().find("the clocks of this machine and of the cluster must be the same") != std::string::npos; }, 30s));
    INFO(box.told());
    CHECK(box.stop() == 0);
    box.start();  // with the clock of the cluster
    CHECK(end_of(follower, job).phase == wire::JobPhase::done);
}
