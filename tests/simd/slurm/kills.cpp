// Many jobs in Slurm, while copies of them, the nodes, Slurm's controller and simd itself are killed. Seeds are printed.

#include "cluster.hpp"

#include <weave/core/sha256.hpp>

#include <algorithm>
#include <fstream>
#include <map>
#include <random>
#include <set>

using namespace weave;
using namespace weave::simd::testing;

namespace {

struct Kills {
    std::size_t copies = 0, nodes = 0, controllers = 0, daemons = 0;
};

/// Kills one of a kind, and starts it again where nobody else would; false where there was none.
bool kill_one(const Cluster& cluster, Box& box, std::mt19937& random, Kills& kills) {
    const auto what = random() % 10;
    if (what < 6) {
        const std::vector<pid_t> copies = cluster.copies();
        if (copies.empty()) return false;
        ::kill(copies[random() % copies.size()], SIGKILL);
        ++kills.copies;
    } else if (what < 8) {
        const std::string node = random() % 2 == 0 ? "n1" : "n2";
        cluster.signal(node, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 500));
        cluster.start_again(node);
        ++kills.nodes;
    } else if (what < 9) {
        cluster.signal("slurmctld", SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 500));
        cluster.start_again("slurmctld");
        ++kills.controllers;
    } else {
        box.kill();
        box.start();
        ++kills.daemons;
    }
    return true;
}

/// Hands over jobs and kills; each job ends once, done, with the bits of a run that was left alone.
void kill_under(std::size_t count, std::chrono::milliseconds between, std::size_t most_kills, std::chrono::seconds patience) {
    const unsigned seed = std::random_device()();
    std::printf("seed %u\n", seed);
    INFO("seed " << seed);
    std::mt19937 random(seed);
    std::map<std::string, std::string> wanted;
    const std::vector<std::pair<const char*, wire::Simulation>> kinds{{"plain", at(sim::Fidelity::draft)}, {"layer-to-layer", at(sim::Fidelity::standard)}, {long_cloth, long_run()}};
    {
        const Box here;
        for (const auto& [cloth, simulation] : kinds) {
            wire::Follower follower = here.follower();
            const std::uint64_t job = submit(follower, document_of(cloth), simulation);
            REQUIRE(end_of(follower, job).phase == wire::JobPhase::done);
            wanted[cloth] = yarns_of(follower, job);
        }
    }
    const Cluster cluster;
    Box box(cluster.config());
    wire::Follower follower = box.follower();
    std::map<std::uint64_t, std::string> jobs;
    for (std::size_t k = 0; k < count; ++k) {
        const auto& [cloth, simulation] = kinds[k % 5 == 0 ? 2 : k % 5 < 3 ? 1 : 0];
        jobs[submit(follower, document_of(cloth), simulation)] = cloth;
    }
    const auto begin = std::chrono::steady_clock::now();
    auto next = begin + between;
    Kills kills;
    std::size_t made = 0;
    std::map<std::uint64_t, wire::JobEnded> ended;
    while (ended.size() < jobs.size() && std::chrono::steady_clock::now() - begin < patience) {
        if (made < most_kills && std::chrono::steady_clock::now() > next) {
            if (!kill_one(cluster, box, random, kills)) continue;
            ++made;
            next = std::chrono::steady_clock::now() + between;
        }
        const auto received = follower.receive(50ms);
        INFO((received ? "" : received.error().text()));
        REQUIRE(received);
        const auto* message = *received ? std::get_if<wire::ServerMessage>(&**received) : nullptr;
        const auto* end = message == nullptr ? nullptr : std::get_if<wire::JobEnded>(message);
        if (end == nullptr) continue;
        INFO("job " << end->job << ": " << (end->error ? end->error->text() : "") << "\n" << box.told());
        REQUIRE(end->phase == wire::JobPhase::done);
        const auto [at, is_new] = ended.emplace(end->job, *end);
        if (!is_new) CHECK(at->second.report == end->report);  // told again after the daemon was killed, the same
    }
    INFO(box.told());
    REQUIRE(ended.size() == jobs.size());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    for (const auto& [job, cloth] : jobs) {
        const std::string bytes = yarns_of(follower, job);
        CHECK(sha256_hex(bytes) == ended.at(job).report.at("yarns_sha256"));
        check_same_yarns(bytes, wanted.at(cloth));
    }
    CHECK(until([&] { return cluster.queued("|RUNNING|") + cluster.queued("|PENDING|") == 0; }, 90s));
    CHECK(until([&] { return cluster.copies().empty(); }));
    std::printf("%zu jobs ended once each in %.0f s; killed: %zu copies, %zu nodes, %zu controllers, %zu daemons\n", jobs.size(), seconds, kills.copies, kills.nodes, kills.controllers,
                kills.daemons);
    CHECK(kills.copies + kills.nodes + kills.controllers + kills.daemons > 0);
}

}  // namespace

TEST_CASE("12 jobs end once with one result each while copies and nodes and the controller and the daemon are killed") {
    kill_under(12, 1000ms, 10, 600s);
}

TEST_CASE("the same with 50 jobs and 100 kills", "[.][long]") {
    kill_under(50, 700ms, 100, 1800s);
}

namespace {

/// A sweep as people ask for one, on a plain weave; until all of its jobs have ended well.
void sweep(std::size_t runs) {
    const Cluster cluster;
    Json config = cluster.config();
    config["slurm"].erase("gres");  // which would let one run on each node at a time
    const Box box(config);
    REQUIRE(write_file(cluster.folder() / "plain.weave", document_of("plain")));
    std::string values;
    for (std::size_t k = 0; k < runs; ++k) values += (k == 0 ? "" : ",") + std::to_string(1 + 0.0001 * static_cast<double>(k));
    const auto begin = std::chrono::steady_clock::now();
    weave::testing::Program weave("weave",
                                  {"simulate", (cluster.folder() / "plain.weave").string(), "--fidelity", "draft", "--sweep", "warp.strain=" + values, "--on",
                                   "unix:" + (box.folder() / "simd.sock").string()},
                                  (cluster.folder() / "weave.told").string());
    const std::string told = weave.rest();
    REQUIRE(weave.exit_code() == 0);
    CHECK(static_cast<std::size_t>(std::ranges::count(told, '\n')) == runs);
    const double handed_over = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    wire::Follower follower = box.follower();
    std::set<std::uint64_t> ended;
    while (ended.size() < runs && std::chrono::steady_clock::now() - begin < 1200s) {
        const auto received = follower.receive(200ms);
        REQUIRE(received);
        const auto* message = *received ? std::get_if<wire::ServerMessage>(&**received) : nullptr;
        const auto* end = message == nullptr ? nullptr : std::get_if<wire::JobEnded>(message);
        if (end == nullptr) continue;
        REQUIRE(end->phase == wire::JobPhase::done);
        CHECK(ended.insert(end->job).second);
    }
    REQUIRE(ended.size() == runs);
    std::set<std::string> arrays;
    for (const std::string& line : cluster.queue()) arrays.insert(line.substr(0, line.find('|')));
    CHECK(arrays.size() <= 1 + runs / 20);
    std::printf("%zu jobs of a sweep, handed over in %.1f s in %zu arrays, done after %.1f s\n", runs, handed_over, arrays.size(),
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace

TEST_CASE("a sweep of 12 runs goes to Slurm as an array") {
    sweep(12);
}

TEST_CASE("a sweep of 300 runs", "[.][long]") {
    sweep(300);
}
