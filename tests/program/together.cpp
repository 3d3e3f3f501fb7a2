// Several processes that mpirun starts relax one cloth together: the same bits whatever their number, and nothing lost where one of
// them is gone.

#include "run.hpp"

#include <weave/sim/yarns_file.hpp>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

namespace program_tests {

namespace {

using Catch::Contains;

#if !defined(WEAVE_MPIRUN)
constexpr const char* mpirun = nullptr;
#else
constexpr const char* mpirun = WEAVE_MPIRUN;
#endif

bool is_skipped() {
    if (mpirun == nullptr) WARN("skipped: no mpirun");
    return mpirun == nullptr;
}

/// As root, with more processes than cores, and without a network. Under the address sanitizer leaks are not looked for: Open MPI's
/// modules keep what they took and are unloaded when it looks, so that no suppression can name them.
void allow() {
    for (const auto& [name, value] : {std::pair{"OMPI_ALLOW_RUN_AS_ROOT", "1"}, std::pair{"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"}, std::pair{"OMPI_MCA_mpi_yield_when_idle", "1"},
                                      std::pair{"OMPI_MCA_rmaps_base_oversubscribe", "1"}, std::pair{"OMPI_MCA_hwloc_base_binding_policy", "none"}, std::pair{"ASAN_OPTIONS", "detect_leaks=0"}})
        ::setenv(name, value, 1);
}

struct Loom {
    Workshop shop;
    Loom() {
        allow();
        (void)shop.must({"samples", "three-colour-stencil", "-o", "d.weave"});
    }
    /// Relaxes a part of it that makes two blocks.
    [[nodiscard]] Workshop::Running start(std::size_t processes, std::vector<std::string> more) const {
        more.insert(more.end(), {"--region", "picks:1-50,ends:1-60"});
        if (std::ranges::find(more, "--explain") == more.end()) more.insert(more.end(), {"--residual", "1e-12"});
        return start_whole(processes, more);
    }
    [[nodiscard]] Workshop::Running start_whole(std::size_t processes, const std::vector<std::string>& more) const {
        std::vector<std::string> words{"-n", std::to_string(processes), WEAVE_PROGRAM, "simulate", "d.weave", "--fidelity", "draft"};
        words.insert(words.end(), more.begin(), more.end());
        return shop.start_program(mpirun, "mpirun", words);
    }
    [[nodiscard]] Ended run(std::size_t processes, const std::vector<std::string>& more) const { return start(processes, more).finish(); }

    [[nodiscard]] std::vector<weave::Vec3> places(const std::string& file) const {
        const weave::Yarns yarns = weave::read_yarns(shop.get(file)).value();
        std::vector<weave::Vec3> all;
        for (const weave::SimulatedYarn& yarn : yarns.yarns) all.insert(all.end(), yarn.spline.control.begin(), yarn.spline.control.end());
        return all;
    }
};

/// The processes that mpirun started.
std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> children;
    for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(parent) + "/task")) {
        std::ifstream list(entry.path() / "children");
        for (pid_t child = 0; list >> child;) children.push_back(child);
    }
    return children;
}

/// Whether a file is there, sooner or later.
bool comes(const fs::path& place) {
    for (int wait = 0; wait < 6000 && !fs::exists(place); ++wait) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return fs::exists(place);
}

weave::Json json_of(const Ended& ended) {
    INFO(ended.err);
    auto json = weave::parse_json(ended.out);
    REQUIRE(json);
    return *json;
}

}  // namespace

TEST_CASE("any number of processes that mpirun starts writes the same yarns, and each holds less the more there are") {
    if (is_skipped()) return;
    Loom loom;
    std::uint64_t peak_before = UINT64_MAX;
    std::vector<weave::Vec3> first;
    for (const std::size_t processes : {1, 2, 4, 8}) {
        INFO(processes << " processes");
        const Ended ended = loom.start_whole(processes, {"-o", "c.yarns", "--steps", "6", "--json"}).finish();
        CHECK(ended.exit == 1);  // not at rest after so few
        const weave::Json report = json_of(ended);
        CHECK((report.at("iterations") == 6 && report.at("ending") == "iterations" && report.at("ranks").size() == processes));
        CHECK(report.at("yarns_sha256").get<std::string>().size() == 64);
        std::uint64_t points = 0;
        for (const weave::Json& rank : report.at("ranks")) points += rank.at("points").get<std::uint64_t>();
        CHECK(points == report.at("points"));
        const std::vector<weave::Vec3> places = loom.places("c.yarns");
        if (first.empty()) first = places;
        CHECK(places == first);
        if (processes <= 4) CHECK(report.at("peak_bytes") < peak_before);  // there are six blocks
        peak_before = report.at("peak_bytes").get<std::uint64_t>();
    }
}

TEST_CASE("what several processes would do is told once, with the share of each, and a plan asks less of each the more there are") {
    if (is_skipped()) return;
    Loom loom;
    (void)loom.shop.must({"tile", "d.weave", "--x", "5", "--y", "5", "-o", "large.weave"});
    const auto explained = [&](const std::string& processes) {
        const Ended ended = loom.shop.start_program(mpirun, "mpirun", {"-n", processes, WEAVE_PROGRAM, "simulate", "large.weave", "--whole", "--explain", "--json"}).finish();
        CHECK(ended.exit == 0);
        return json_of(ended);
    };
    const weave::Json one = explained("1"), three = explained("3");
    CHECK(one.at("ranks").size() == 1);
    CHECK(three.at("ranks").size() == 3);
    CHECK(one.at("points") > 1000000);
    CHECK(three.at("points") == one.at("points"));
    CHECK(three.at("plan") == one.at("plan"));
    std::uint64_t points = 0, peak = 0;
    for (const weave::Json& rank : three.at("ranks")) {
        points += rank.at("points").get<std::uint64_t>();
        peak = std::max(peak, rank.at("peak_bytes").get<std::uint64_t>());
    }
    CHECK(points == one.at("points"));
    // Two thirds of the points, at 48 bytes, are 43 MiB, whatever planning takes besides.
    CHECK(peak + (30U << 20U) < one.at("ranks").at(0).at("peak_bytes").get<std::uint64_t>());
    const Ended told = loom.run(2, {"--explain"});
    CHECK(told.exit == 0);
    CHECK_THAT(told.out, Contains("blocks: ") && Contains("process 2: "));
    CHECK(told.out.find("gravity: off") == told.out.rfind("gravity: off"));
}

TEST_CASE("a process that is killed ends the run with a report, and another number of them goes on to the same bits") {
    if (is_skipped()) return;
    Loom loom;
    Workshop::Running running = loom.start(2, {"-o", "c.yarns", "--checkpoint", "ck", "--checkpoint-every", "0.001", "--steps", "210"});
    REQUIRE(comes(loom.shop.path("ck/step-200/complete.json")));
    const std::vector<pid_t> ranks = children_of(running.child);
    REQUIRE(ranks.size() == 2);
    ::kill(ranks[1], SIGKILL);
    const Ended killed = running.finish();
    CHECK(killed.exit != 0);
    CHECK_FALSE(loom.shop.has("c.yarns"));
    // The checkpoint may have become whole before the first process heard of it.
    CHECK_THAT(killed.err, Contains("weave: ended from outside; the checkpoint of step 200 in ck is whole: the same command goes on from the newest that is, with any number of processes") ||
                               Contains("weave: ended from outside; no checkpoint in ck was known to be whole yet: the same command goes on from the newest that is, or begins anew, with any number "
                                        "of processes"));
    const Ended after = loom.run(3, {"-o", "c.yarns", "--checkpoint", "ck", "--steps", "210"});
    CHECK_THAT(after.err, Contains("going on from the checkpoint of step 200"));
    (void)loom.run(2, {"-o", "alone.yarns", "--steps", "210"});
    CHECK(loom.places("c.yarns") == loom.places("alone.yarns"));
}

TEST_CASE("processes that hear nothing of one another for too long are given up, with the cause") {
    if (is_skipped()) return;
    Loom loom;
    Workshop::Running running = loom.start(2, {"-o", "c.yarns", "--checkpoint", "ck", "--checkpoint-every", "0.001", "--patience", "2"});
    REQUIRE(comes(loom.shop.path("ck/step-200/complete.json")));
    const std::vector<pid_t> ranks = children_of(running.child);
    REQUIRE(ranks.size() == 2);
    ::kill(ranks[1], SIGSTOP);  // to the other it is as if the network between them were cut
    const Ended ended = running.finish();
    ::kill(ranks[1], SIGKILL);
    CHECK(ended.exit != 0);
    CHECK_THAT(ended.err, Contains("weave: rank 0 of 2 has had no answer from the others for 2 s") && Contains("network"));
    CHECK(loom.shop.has("ck/step-200/complete.json"));
}

TEST_CASE("a wish to stop that mpirun hands on writes the yarns as they lie") {
    if (is_skipped()) return;
    Loom loom;
    Workshop::Running running = loom.start(2, {"-o", "c.yarns", "--checkpoint", "ck", "--checkpoint-every", "0.001", "--json"});
    REQUIRE(comes(loom.shop.path("ck/step-200/complete.json")));
    ::kill(running.child, SIGUSR1);
    const Ended ended = running.finish();
    CHECK(ended.exit == 1);
    const weave::Json report = json_of(ended);
    CHECK((report.at("ending") == "stopped" && report.at("interrupted") == true && report.at("iterations") >= 200));
    CHECK(loom.places("c.yarns").size() == report.at("points"));
}

TEST_CASE("what processes together cannot do is told once, before anything is read") {
    if (is_skipped()) return;
    Loom loom;
    for (const std::vector<std::string>& more : {std::vector<std::string>{"--flip", "1,1"}, {"--starts", "2"}, {"--solver", "paper"}, {"--symmetry"}, {"--resume", "x.yarns"}}) {
        std::vector<std::string> words{"-o", "c.yarns"};
        words.insert(words.end(), more.begin(), more.end());
        const Ended ended = loom.run(3, words);
        CHECK(ended.exit == 2);
        const std::string line = "weave: " + more.front() + ": is not computed by several processes together";
        CHECK_THAT(ended.err, Contains(line));
        CHECK(ended.err.find(line) == ended.err.rfind(line));
    }
    loom.shop.refused({"simulate", "d.weave", "-o", "c.yarns", "--checkpoint", "ck"}, 2, {"--checkpoint", "mpirun -n 1"});
    loom.shop.refused({"simulate", "d.weave", "-o", "c.yarns", "--patience", "3"}, 2, {"--patience", "mpirun"});
    const auto told_once = [&](const std::vector<std::string>& words, int exit, const std::vector<std::string>& pieces) {
        const Ended ended = loom.run(4, words);
        INFO(ended.err);
        CHECK(ended.exit == exit);
        for (const std::string& piece : pieces) CHECK_THAT(ended.err, Contains(piece));
        const std::string lines = "\n" + ended.err, line = "\nweave: ";
        CHECK((Contains(line).match(lines) && lines.find(line) == lines.rfind(line)));
    };
    told_once({"-o", "c.yarns", "--checkpoint", "d.weave"}, 5, {"d.weave"});
    told_once({"-o", "c.yarns", "--checkpoint", "/proc/nope"}, 5, {"/proc/nope"});
    told_once({"-o", "c.yarns", "--checkpoint-every", "-1"}, 2, {"--checkpoint-every"});
    told_once({"-o", "no/folder/c.yarns", "--steps", "100000"}, 5, {"no/folder"});
    told_once({"-o", "c.yarns", "--checkpoint", ""}, 2, {"--checkpoint"});
    (void)loom.run(2, {"-o", "c.yarns", "--checkpoint", "ck", "--steps", "3"});
    REQUIRE(loom.shop.has("ck/step-3/rank-1.part"));
    loom.shop.put("ck/step-3/rank-1.part", "{}");
    told_once({"-o", "c.yarns", "--checkpoint", "ck"}, 3, {"rank-1.part"});
}

}  // namespace program_tests
