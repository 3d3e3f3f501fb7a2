// What simd says to Slurm and reads of it, the folder that all nodes share, and what the store keeps of jobs that Slurm has. (A whole
// cluster: tests/simd/slurm.)

#include "store_case.hpp"

#include <weave/core/file.hpp>
#include <weave/samples/samples.hpp>

#include <atomic>
#include <cstdlib>
#include <set>
#include <simd/commands/config.hpp>
#include <simd/daemon/slurm_arrays.hpp>
#include <simd/daemon/slurm_crew.hpp>
#include <simd/slurm/job_folder.hpp>
#include <simd/slurm/process.hpp>
#include <simd/slurm/slurm.hpp>
#include <support/temporary_folder.hpp>
#include <thread>

using namespace weave;
using namespace weave::simd;
using namespace weave::simd::testing;

namespace {

WorkOrder an_order() {
    WorkOrder order;
    order.is_job = true;
    order.number = 7;
    order.document = "{\"format\":\"weave\"}";
    order.checkpoint_s = 120;
    return order;
}

const std::atomic<bool> goes_on{false};

Number a_job(Store& store, const std::string& request) {
    return store.add_job({"dora", request, "shoe", "{document}", "{simulation}"}, [](Number) { return std::string("{}"); }).value().number;
}

}  // namespace

TEST_CASE("lines of the queue are read and those of other forms passed over") {
    const auto jobs = parse_queue("4711|3|simd-ab-1|RUNNING|n1|None\n4711|4|simd-ab-1|PENDING||Resources|and|more\n"
                                  "4712|N/A|other|RUNNING|n2|None\n|||||\nnonsense\n-1|2|x|RUNNING|n|r\n99999999999999999999|1|x|R|n|r\n12|1|last|COMPLETED|n1|None");
    REQUIRE(jobs.size() == 3);
    CHECK((jobs[0].id() == "4711_3" && jobs[0].name == "simd-ab-1" && jobs[0].node == "n1" && jobs[0].is_alive()));
    CHECK((jobs[1].reason == "Resources|and|more" && jobs[1].node.empty() && jobs[1].is_alive()));
    CHECK((jobs[2].array == 12 && !jobs[2].is_alive()));
    CHECK(parse_queue("").empty());
    for (const char* over : {"CANCELLED", "FAILED", "TIMEOUT", "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "DEADLINE", "BOOT_FAIL", "REVOKED", ""}) {
        INFO(over);
        CHECK_FALSE(QueuedJob{1, 1, "", over, "", ""}.is_alive());
    }
}

TEST_CASE("places of an array are written in ranges and its number is read") {
    CHECK(ranges_text({0}) == "0");
    CHECK(ranges_text({0, 1, 2, 5, 7, 8}) == "0-2,5,7-8");
    CHECK(parse_submitted("4711\n") == 4711U);
    CHECK(parse_submitted("4711;mill\n") == 4711U);
    CHECK_FALSE(parse_submitted("Submitted batch job 4711\n"));
    CHECK_FALSE(parse_submitted(""));
}

TEST_CASE("a command gets its words as they are and no more of the environment than it needs") {
    ::setenv("SIMD_TEST_SECRET", "secret", 1);
    const auto printed = run_command({"printf", "%s", "$(id); `id` \"'"}, std::chrono::seconds(10), goes_on);
    REQUIRE(printed);
    CHECK((printed->status == 0 && printed->answer == "$(id); `id` \"'"));
    const auto known = run_command({"env"}, std::chrono::seconds(10), goes_on);
    REQUIRE(known);
    CHECK(known->answer.find("SIMD_TEST_SECRET") == std::string::npos);
    CHECK(known->answer.find("PATH=") != std::string::npos);
    const auto failed = run_command({"ls", "/there is no such file"}, std::chrono::seconds(10), goes_on);
    REQUIRE(failed);
    CHECK((failed->status != 0 && failed->told.find("there is no such file") != std::string::npos));
}

TEST_CASE("a command that is missing or too slow or given up is an error and leaves no process behind") {
    const auto missing = run_command({"there-is-no-such-program"}, std::chrono::seconds(10), goes_on);
    REQUIRE_FALSE(missing);
    CHECK(missing.error().text() == "there-is-no-such-program: cannot be started: No such file or directory");
    const auto slow = run_command({"sleep", "1000"}, std::chrono::milliseconds(200), goes_on);
    REQUIRE_FALSE(slow);
    CHECK_THAT(slow.error().message, Catch::Contains("does not answer within 1 s"));
    std::atomic<bool> gives_up{false};
    std::thread later([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        gives_up = true;
    });
    CHECK_FALSE(run_command({"sleep", "1000"}, std::chrono::seconds(500), gives_up));
    later.join();
}

TEST_CASE("attempts at a job have a number of their own each however many begin at once") {
    const weave::testing::TemporaryFolder shared;
    const JobFolder folder = SharedFolder{shared.path}.job(7);
    CHECK(folder.is_gone());
    CHECK_FALSE(folder.begin_attempt());
    REQUIRE(folder.give(an_order()));
    CHECK_FALSE(folder.is_gone());
    CHECK(folder.newest_attempt().value() == 0);
    std::mutex lock;
    std::multiset<std::uint64_t> numbers;
    std::vector<std::thread> copies;
    for (int k = 0; k < 8; ++k) {
        copies.emplace_back([&] {
            for (int n = 0; n < 25; ++n) {
                const auto number = folder.begin_attempt();
                const std::lock_guard held(lock);
                numbers.insert(number ? *number : 0);
            }
        });
    }
    for (std::thread& copy : copies) copy.join();
    CHECK(numbers.size() == 200);
    CHECK(std::set<std::uint64_t>(numbers.begin(), numbers.end()).size() == 200);
    CHECK((*numbers.begin() == 1 && *numbers.rbegin() == 200 && folder.newest_attempt().value() == 200));
}

TEST_CASE("an order and its stop and news and ends come back as they were written") {
    const weave::testing::TemporaryFolder shared;
    const JobFolder folder = SharedFolder{shared.path}.job(7);
    REQUIRE(folder.give(an_order()));
    WorkOrder other = an_order();
    other.document = "{}";
    REQUIRE(folder.give(other));
    const WorkOrder order = folder.order().value();
    CHECK((order.document == an_order().document && order.checkpoint_s == 120 && order.number == 7 && order.is_job));
    CHECK(input_sha256(order) == input_sha256(an_order()));
    CHECK(input_sha256(order) != input_sha256(other));
    CHECK_FALSE(folder.stop());
    folder.ask_to_stop(Stop::with_yarns);
    CHECK(folder.stop() == Stop::with_yarns);
    folder.ask_to_stop(Stop::at_once);
    CHECK(folder.stop() == Stop::at_once);
    REQUIRE(folder.begin_attempt().value() == 1);
    CHECK((!folder.news(1) && !folder.end_of(1).value()));
    const AttemptNews news{"n1", "0", 1200, 40, 0.5, 1e-4, 3, "the disk is full"};
    folder.tell(1, news);
    CHECK(folder.news(1) == news);
    AttemptEnd end;
    end.outcome = Outcome::again;
    end.input_sha256 = input_sha256(order);
    end.node = "n1";
    end.is_the_nodes_fault = true;
    end.step = 40;
    end.error = system_fault("no room", "checkpoint");
    REQUIRE(folder.end(1, end));
    const AttemptEnd read = *folder.end_of(1).value();
    CHECK((read.outcome == Outcome::again && read.node == "n1" && read.is_the_nodes_fault && !read.was_stopped && read.step == 40));
    CHECK((read.error && read.error->text() == "checkpoint: no room" && read.report.empty() && read.input_sha256 == end.input_sha256));
    folder.refuse(1);
    CHECK_FALSE(folder.end_of(1).value());
}

TEST_CASE("files in the shared folder that nobody of us wrote are errors with their names and no more") {
    const weave::testing::TemporaryFolder shared;
    const JobFolder folder = SharedFolder{shared.path}.job(7);
    REQUIRE(folder.give(an_order()));
    REQUIRE(folder.begin_attempt().value() == 1);
    for (const char* stray : {"x", "-3", "0", "99999999999999999999", "2.tmp"}) std::filesystem::create_directory(folder.attempt(1).parent_path() / stray);
    CHECK(folder.newest_attempt().value() == 1);
    for (const char* text : {"", "no json", "[]", "{}", R"({"outcome":"won"})", R"({"outcome":"done","input_sha256":7})",
                             R"({"outcome":"done","input_sha256":"","node":"","was_stopped":false,"is_the_nodes_fault":false,"step":-1,"error":null,"report":{}})",
                             R"({"outcome":"done","input_sha256":"","node":"","was_stopped":false,"is_the_nodes_fault":false,"step":1,"error":7,"report":{}})",
                             R"({"outcome":"done","input_sha256":"","node":"","was_stopped":false,"is_the_nodes_fault":false,"step":1,"error":null,"report":[]})"}) {
        INFO(text);
        REQUIRE(write_file(folder.attempt(1) / "end.json", text));
        REQUIRE(write_file(folder.attempt(1) / "news.json", text));
        REQUIRE(write_file(shared.path / "jobs/7/order.json", text));
        REQUIRE(write_file(shared.path / "array.json", text));
        const auto end = folder.end_of(1);
        REQUIRE_FALSE(end);
        CHECK_THAT(end.error().where, Catch::Contains("end.json"));
        CHECK_FALSE(folder.news(1));
        CHECK_FALSE(folder.order());
        CHECK_FALSE(job_at(shared.path / "array.json", 0));
    }
    REQUIRE(write_array(shared.path / "array.json", {{0, 12}, {3, 9}}));
    CHECK(job_at(shared.path / "array.json", 3).value() == 9);
    CHECK_THAT(job_at(shared.path / "array.json", 1).error().message, Catch::Contains("no job at place 1"));
}

TEST_CASE("the store knows of each job in which array it is and which attempt counts and refuses stale ones") {
    const Folder folder;
    std::string id;
    {
        const auto store = opened(folder / "s.db");
        id = store->cluster_id().value();
        CHECK(id.size() == 16);
        const std::vector<Number> jobs{a_job(*store, "request-1"), a_job(*store, "request-2"), a_job(*store, "request-3")};
        CHECK(store->submissions().value().empty());
        CHECK(store->note_attempt(jobs[0], 1).error().code == ErrorCode::usage);
        REQUIRE(store->add_submission(jobs).value() == 1);
        REQUIRE(store->name_submission(1, 4711));
        REQUIRE(store->note_attempt(jobs[1], 2));
        REQUIRE(store->note_attempt(jobs[1], 2));
        const Status stale = store->note_attempt(jobs[1], 1);
        REQUIRE_FALSE(stale);
        CHECK((stale.error().code == ErrorCode::refused && stale.error().text() == "job 2: attempt 1 is stale: attempt 2 has begun since"));
        REQUIRE(store->end_job(jobs[2], {JobPhase::cancelled, {}, "{}", {}, {}}));
        CHECK(store->add_submission({jobs[2]}).error().code == ErrorCode::usage);
        CHECK(store->add_submission({99}).error().code == ErrorCode::usage);
        REQUIRE(store->add_submission({jobs[1]}).value() > 1);
    }
    const auto store = opened(folder / "s.db");
    CHECK(store->cluster_id().value() == id);
    const auto kept = store->submissions().value();
    REQUIRE(kept.size() == 2);
    CHECK((kept[0].slurm_id == Number{4711} && kept[0].jobs == std::vector<SubmittedJob>{{1, 0, 0}, {3, 2, 0}}));
    CHECK((!kept[1].slurm_id && kept[1].jobs == std::vector<SubmittedJob>{{2, 0, 2}}));  // its attempts go on being counted
    CHECK_FALSE(store->note_attempt(2, 1));
    REQUIRE(store->forget_job(3));
    CHECK(store->submissions().value().at(0).jobs.size() == 1);
    CHECK(opened(folder / "other.db")->cluster_id().value() != id);
}

namespace {

/// Programs in the place of Slurm's, as long as it lives: the queue is the file `queue`, sbatch tells what is in `made` (where that is
/// missing it fails), and scancel notes in `cancelled` what it is given.
class ScriptedSlurm {
  public:
    ScriptedSlurm() : m_path(std::getenv("PATH")) {
        program("squeue", "cat \"${0%/*}/queue\"");
        program("sbatch", "echo asked >>\"${0%/*}/asked\"; cat \"${0%/*}/made\"");
        program("scancel", "echo \"$@\" >>\"${0%/*}/cancelled\"");
        write("queue", "");
        ::setenv("PATH", ((m_folder / "").string() + ":" + m_path).c_str(), 1);
    }
    ~ScriptedSlurm() { ::setenv("PATH", m_path.c_str(), 1); }
    ScriptedSlurm(const ScriptedSlurm&) = delete;
    ScriptedSlurm& operator=(const ScriptedSlurm&) = delete;
    void write(const char* name, const std::string& text) const { REQUIRE(write_file(m_folder / name, text)); }
    [[nodiscard]] std::string told(const char* name) const {
        const auto text = read_file(m_folder / name);
        return text ? *text : std::string();
    }

  private:
    void program(const char* name, const std::string& text) const {
        write(name, "#!/bin/sh\n" + text + "\n");
        std::filesystem::permissions(m_folder / name, std::filesystem::perms::owner_all);
    }
    const Folder m_folder;
    const std::string m_path;
};

}  // namespace

TEST_CASE("of an array that Slurm has twice because a call that failed was only slow the copy that lives counts and the other is cancelled") {
    const Folder folder;
    const ScriptedSlurm scripted;
    const auto store = opened(folder / "s.db");
    const Number job = a_job(*store, "request-1");
    const Slurm slurm(goes_on);
    const std::string name = "|0|simd-" + store->cluster_id().value() + "-1|";
    const auto arrays = [&] { return std::make_unique<SlurmArrays>(*store, slurm, SlurmArrays::Rules{{}, {folder / "shared"}, "/bin/simd"}); };
    auto before = arrays();
    REQUIRE(before->take_up());
    REQUIRE(before->add("dora", {}, {job}));
    REQUIRE(before->look());
    CHECK_FALSE(before->refusal());
    CHECK(scripted.told("asked") == "asked\n");
    before.reset();  // dies before it can note what the queue shows, in which the older copy was cancelled
    scripted.write("queue", "4711" + name + "CANCELLED||None\n4712" + name + "RUNNING|n1|None\n4713" + name + "COMPLETED|n1|None\n");
    const auto after = arrays();
    REQUIRE(after->take_up());
    const auto seen = after->look();
    REQUIRE(seen);
    CHECK((seen->jobs.at(job).array == 4712 && seen->missing.empty()));
    CHECK(store->submissions().value().at(0).slurm_id == Number{4712});
    scripted.write("queue", "4711" + name + "RUNNING|n2|None\n4712" + name + "RUNNING|n1|None\n");  // it comes late
    const auto later = after->look();
    REQUIRE(later);
    CHECK((later->jobs.at(job).array == 4712 && later->missing.empty()));
    CHECK(scripted.told("cancelled") == "4711_0\n");
    CHECK(scripted.told("asked") == "asked\n");
}

TEST_CASE("what Slurm refused is no trouble any more once it was taken after all or nobody wants it") {
    const Folder folder;
    const ScriptedSlurm scripted;
    const auto store = opened(folder / "s.db");
    const Number first = a_job(*store, "request-1"), second = a_job(*store, "request-2");
    const Slurm slurm(goes_on);
    SlurmArrays arrays(*store, slurm, {{}, {folder / "shared"}, "/bin/simd"});
    REQUIRE(arrays.take_up());
    REQUIRE(arrays.add("dora", {}, {first}));
    REQUIRE(arrays.look());
    CHECK_FALSE(arrays.refusal());
    scripted.write("made", "4712\n");
    REQUIRE(arrays.add("emil", {}, {second}));
    REQUIRE(arrays.look());
    CHECK_FALSE(arrays.refusal());  // another's success is none of the first
    scripted.write("queue", "4711|0|simd-" + store->cluster_id().value() + "-1|PENDING||Priority\n");
    REQUIRE(arrays.look());
    CHECK(arrays.refusal());
    scripted.write("made", "nonsense\n");
    const Number third = a_job(*store, "request-3");
    REQUIRE(arrays.add("dora", {}, {third}));
    REQUIRE(arrays.look());
    CHECK_FALSE(arrays.refusal());
    arrays.drop(third);
    REQUIRE(arrays.look());
    CHECK(arrays.refusal());
}

TEST_CASE("no array is handed over whose file cannot be written and one that a daemon left without gets it") {
    const Folder folder;
    const ScriptedSlurm scripted;
    scripted.write("made", "4711\n");
    const auto store = opened(folder / "s.db");
    const Number job = a_job(*store, "request-1");
    const Slurm slurm(goes_on);
    const SharedFolder shared{folder / "shared"};
    std::filesystem::create_directories(shared.path);
    REQUIRE(write_file(shared.arrays(), "in the way"));
    {
        SlurmArrays arrays(*store, slurm, {{}, shared, "/bin/simd"});
        REQUIRE(arrays.take_up());
        REQUIRE(arrays.add("dora", {}, {job}));
        REQUIRE(arrays.look());
        CHECK_FALSE(arrays.refusal());
        CHECK(scripted.told("asked").empty());
    }
    std::filesystem::remove(shared.arrays());
    SlurmArrays arrays(*store, slurm, {{}, shared, "/bin/simd"});
    REQUIRE(arrays.take_up());
    REQUIRE(arrays.look());
    CHECK(arrays.refusal());
    CHECK(scripted.told("asked") == "asked\n");
    CHECK(job_at(shared.array(1), 0).value() == job);
}

TEST_CASE("a shared folder is one daemon's and nobody else can write there") {
    const Folder folder;
    const auto store = opened(folder / "s.db"), other = opened(folder / "other.db");
    std::mutex lock;
    SlurmCrew::Rules rules;
    rules.shared = folder / "shared";
    CHECK(SlurmCrew(lock, *store, rules).take_up());
    CHECK(SlurmCrew(lock, *store, rules).take_up());
    const Status refused = SlurmCrew(lock, *other, rules).take_up();
    REQUIRE_FALSE(refused);
    CHECK((refused.error().code == ErrorCode::refused && refused.error().message == "holds jobs of another simd: each needs a folder of its own"));
    std::filesystem::permissions(rules.shared, std::filesystem::perms::group_write, std::filesystem::perm_options::add);
    const Status open_to_others = SlurmCrew(lock, *store, rules).take_up();
    REQUIRE_FALSE(open_to_others);
    CHECK_THAT(open_to_others.error().message, Catch::Contains("can be written by others"));
    std::filesystem::permissions(rules.shared, std::filesystem::perms::group_write, std::filesystem::perm_options::remove);
    REQUIRE(write_file(rules.shared / "file", "x"));
    rules.shared = rules.shared / "file";
    CHECK_FALSE(SlurmCrew(lock, *store, rules).take_up());
}

TEST_CASE("folders of jobs that nobody knows any more go away at the start and those of others stay") {
    const Folder folder;
    const auto store = opened(folder / "s.db");
    const Number job = a_job(*store, "request-1");
    std::mutex lock;
    SlurmCrew::Rules rules;
    rules.shared = folder / "shared";
    const SharedFolder shared{rules.shared};
    REQUIRE(shared.job(job).give(an_order()));
    REQUIRE(shared.job(99).give(an_order()));
    CHECK(SlurmCrew(lock, *store, rules).take_up());
    CHECK_FALSE(shared.job(job).is_gone());
    CHECK(shared.job(99).is_gone());
}

TEST_CASE("how jobs go to Slurm is configured and what is no word of a site is refused at its place") {
    const auto config = parse_config(R"({"slurm":{"folder":"shared","program":"/opt/simd","partition":"gpu","account":"cloth","qos":"night","gres":"gpu:a100:1","cpus":4,)"
                                     R"("memory_mib":4096,"minutes":600,"jobs_at_once":50,"watch_seconds":2,"checkpoint_seconds":60}})",
                                     "/etc");
    REQUIRE(config);
    REQUIRE(config->slurm);
    CHECK((config->slurm->folder == "/etc/shared" && config->slurm->program == "/opt/simd" && config->slurm->wishes.gres == "gpu:a100:1"));
    CHECK((config->slurm->wishes.partition == "gpu" && config->slurm->wishes.account == "cloth" && config->slurm->wishes.qos == "night"));
    CHECK((config->slurm->wishes.cpus == 4 && config->slurm->wishes.memory_mib == 4096 && config->slurm->wishes.minutes == 600));
    CHECK((config->slurm->jobs_at_once == 50 && config->slurm->watch_seconds == 2 && config->slurm->checkpoint_seconds == 60));
    CHECK_FALSE(parse_config("{}")->slurm);
    const auto plain = parse_config(R"({"slurm":{"folder":"/shared"}})");
    REQUIRE(plain);
    CHECK((plain->slurm->jobs_at_once == 1000 && plain->slurm->checkpoint_seconds == 120 && plain->slurm->wishes.cpus == 1));
    const std::vector<std::pair<const char*, const char*>> wrong{{R"({"slurm":7})", "slurm"},
                                                                 {R"({"slurm":{}})", "slurm.folder"},
                                                                 {R"({"slurm":{"folder":"/s","partition":"a b"}})", "slurm.partition"},
                                                                 {R"({"slurm":{"folder":"/s","account":"--uid=0"}})", "slurm.account"},
                                                                 {R"({"slurm":{"folder":"/s","qos":"a;id"}})", "slurm.qos"},
                                                                 {R"({"slurm":{"folder":"/s","cpus":0}})", "slurm.cpus"},
                                                                 {R"({"slurm":{"folder":"/s","jobs_at_once":1001}})", "slurm.jobs_at_once"},
                                                                 {R"({"slurm":{"folder":"/s","queue":"x"}})", "slurm"}};
    for (const auto& [text, where] : wrong) {
        INFO(text);
        const auto read = parse_config(text);
        REQUIRE_FALSE(read);
        CHECK_THAT(read.error().where, Catch::StartsWith(where));
    }
}
