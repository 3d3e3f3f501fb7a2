// Simulation on a server: the same words, files and exit status as on this machine, whatever happens to the connection.

#include "run.hpp"

#include <weave/core/sha256.hpp>
#include <weave/design/document.hpp>
#include <weave/keys/key.hpp>
#include <weave/sim/run.hpp>
#include <weave/sim/yarns_file.hpp>
#include <weave/wire/evidence.hpp>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <support/scripted_simd.hpp>
#include <thread>

using namespace weave;
using Catch::Contains;
using program_tests::Ended;
using program_tests::Workshop;
using weave::testing::JobResult;
using weave::testing::ScriptedSimd;

namespace {

std::string signed_for(const Json& report) {
    return wire::write_evidence(wire::sign_evidence(KeyPair::generate(), "mill", canonical_json(report), std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now())).value());
}

/// Relaxes as a server does; `steps` (0: no limit) ends it as a cancelled job is.
JobResult relaxed(const wire::Submit& submit, std::size_t steps = 0) {
    const auto design = read_document(submit.document);
    if (!design) return {design.error(), Json::object(), "", {}};
    sim::RunRequest request;
    request.plan = submit.simulation.plan;
    request.goal = {submit.simulation.solver, submit.simulation.residual, submit.simulation.most_steps.value_or(20000),
                    submit.simulation.most_seconds.value_or(1e30)};
    request.start_from = submit.simulation.start_from;
    request.flips = submit.flips;
    auto run = sim::Run::begin(*design, request, 1);
    if (!run) return {run.error(), Json::object(), "", {}};
    const auto stops = [&](const sim::Progress& progress) { return steps == 0 || progress.iteration < steps; };
    if (steps > 0) static_cast<void>((*run)->advance(steps, stops));
    while (steps == 0 && !(*run)->is_over()) {
        if (Status went = (*run)->advance(1000, stops); !went) return {went.error(), Json::object(), "", {}};
    }
    Yarns yarns = (*run)->yarns();
    JobResult result{{}, yarns.report, write_yarns(yarns).value(), {}};
    result.report["yarns_sha256"] = sha256_hex(result.yarns);
    result.evidence = signed_for(result.report);
    return result;
}

/// A server that relaxes, and a workshop with a design.
struct Mill {
    Workshop shop;
    ScriptedSimd simd;
    Mill() {
        simd.script()->work = [](const wire::Submit& submit) { return relaxed(submit); };
        shop.must({"samples", "plain", "-o", "d.weave"});
    }
    [[nodiscard]] std::vector<std::string> on(std::vector<std::string> words) const {
        words.emplace_back("--on");
        words.push_back(simd.origin());
        return words;
    }
    std::set<std::uint64_t> settled() {
        return simd.look([](ScriptedSimd& s) { return s.acknowledged_jobs; });
    }
};

constexpr rlim_t full_disk = 100;  ///< bytes that a file may have at most: too few for yarns, which shows once they are written

/// Words without figures of time.
std::string timeless(std::string words) {
    for (std::size_t at = 0; (at = words.find(" s", at)) != std::string::npos; ++at) {
        std::size_t first = at;
        while (first > 0 && (std::isdigit(static_cast<unsigned char>(words[first - 1])) != 0 || words[first - 1] == '.')) --first;
        if (first == at) continue;
        words.replace(first, at - first, "T");
        at = first;
    }
    return words;
}

/// A report without what differs from run to run.
Json timeless(Json report) {
    for (const char* key : {"seconds", "peak_bytes", "threads", "file", "saved_design", "job", "server", "yarns_sha256"}) report.erase(key);
    if (report.contains("coarser")) report["coarser"].erase("seconds");
    for (Json& flip : report.contains("flips") ? report["flips"] : report["none"] = Json::array())
        for (const char* key : {"flip_seconds", "settle_seconds"}) flip.erase(key);
    report.erase("none");
    return report;
}

}  // namespace

TEST_CASE("a server's run is told as one of this machine") {
    const std::vector<std::vector<std::string>> wishes{
        {"--residual", "1e-6"},
        {"--steps", "3"},
        {"--fidelity", "draft", "--wraparound"},
        {"--fidelity", "reference", "--residual", "1e-5"},
        {"--fidelity", "reference", "--steps", "2"},
        {"--set", "warp.strain=1.02", "--boundary", "x=relaxing:0.1", "--pin", "1,2", "--field", "sphere:0,0,3,1,0.1", "--whole"},
        {"--region", "picks:1-5,ends:2-6", "--start-from", "draft"},
        {"--flip", "1,1", "--save-design"},
    };
    for (std::vector<std::string> wish : wishes) {
        Mill mill;
        mill.shop.must({"tile", "d.weave", "--x", "3", "--y", "3", "-o", "large.weave"});
        INFO(Workshop::joined(wish));
        const bool saves = wish.back() == "--save-design";
        const auto words = [&](const std::string& place) {
            std::vector<std::string> all{"simulate", "large.weave", "-o", place + ".yarns"};
            all.insert(all.end(), wish.begin(), wish.end());
            if (saves) all.push_back(place + ".weave");
            return all;
        };
        const Ended here = mill.shop.run(words("here")), there = mill.shop.run(mill.on(words("there")));
        INFO(there.err);
        CHECK(here.exit <= 1);
        CHECK(there.exit == here.exit);
        CHECK(there.complaints() == here.complaints());
        CHECK(timeless(there.out.substr(there.out.find(','))) == timeless(here.out.substr(here.out.find(','))));
        const Json of_here = mill.shop.json(words("here"), here.exit), of_there = mill.shop.json(mill.on(words("there")), here.exit);
        CHECK(canonical_json(timeless(of_there)) == canonical_json(timeless(of_here)));
        CHECK(of_there.at("job") == 2);
        CHECK(of_there.at("server") == mill.simd.place().name);
        CHECK(of_there.at("file") == "there.yarns");
        CHECK(of_there.at("yarns_sha256") == sha256_hex(mill.shop.get("there.yarns")));
        const Yarns ours = read_yarns(mill.shop.get("here.yarns")).value(), theirs = read_yarns(mill.shop.get("there.yarns")).value();
        CHECK((ours.design_sha256 == theirs.design_sha256 && ours.scene_sha256 == theirs.scene_sha256));
        REQUIRE(ours.yarns.size() == theirs.yarns.size());
        for (std::size_t k = 0; k < ours.yarns.size(); ++k) CHECK(ours.yarns[k].spline.control == theirs.yarns[k].spline.control);
        CHECK(mill.settled() == std::set<std::uint64_t>{1, 2});
        CHECK(mill.shop.has("there.weave") == mill.shop.has("here.weave"));
        if (mill.shop.has("here.weave")) CHECK(mill.shop.get("there.weave") == mill.shop.get("here.weave"));
    }
}

TEST_CASE("what a server cannot do is refused by name before anything is sent") {
    Mill mill;
    mill.shop.must({"simulate", "d.weave", "-o", "before.yarns"});
    const std::vector<std::vector<std::string>> wishes{{"--starts", "3"}, {"--symmetry"}, {"--resume", "before.yarns"}, {"--seed", "1"}, {"--threads", "2"},
                                                       {"--backend", "cuda"}};
    for (const auto& wish : wishes) {
        std::vector<std::string> words{"simulate", "d.weave", "-o", "d.yarns"};
        words.insert(words.end(), wish.begin(), wish.end());
        mill.shop.refused(mill.on(words), 2, {wish.front(), "--on"});
    }
    mill.shop.refused(mill.on({"simulate", "d.weave", "--explain"}), 2, {"--on", "--explain"});
    mill.shop.refused({"simulate", "d.weave", "-o", "x", "--evidence", "e"}, 2, {"--evidence requires --on"});
    mill.shop.refused({"simulate", "d.weave", "-o", "x", "--on", "http://box:9000"}, 2, {"--on http://box:9000", "within this machine"});
    mill.shop.refused({"simulate", "d.weave", "-o", "x", "--on", "two words"}, 2, {"--on two words"});
    mill.shop.refused({"simulate", "d.weave", "-o", "x", "--on", "box", "--fingerprint", "12"}, 2, {"--fingerprint", "64 hexadecimal digits"});
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "x", "--fingerprint", std::string(64, 'a')}), 2, {"--fingerprint", "TLS"});
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.connections; }) == 0);
    // What the plan would refuse is told without a queue.
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "x", "--region", "picks:1-9,ends:1-2"}), 2, {"within 2 picks"});
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "x", "--set", "friction=-1"}), 2, {"d.weave", "--set friction=-1: must be from 0 to 100"});
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0);
    // So are files that could not be written once the job has ended.
    mill.shop.put("there", "");
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "no/folder.yarns"}), 5, {"no/folder.yarns", "No such file or directory"});
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "x", "--evidence", "there/e.json"}), 5, {"there/e.json", "Not a directory"});
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "x", "--flip", "1,1", "--save-design", "."}), 5, {"is a folder"});
    mill.shop.refused({"simulate", "d.weave", "-o", "no/folder.yarns"}, 5, {"no/folder.yarns", "No such file or directory"});
    mill.shop.refused(mill.on({"jobs", "fetch", "1", "-o", "no/folder.yarns"}), 5, {"no/folder.yarns"});
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0);
    // And so is what the protocol does not take.
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "x", "--seconds", "2e9"}), 2, {"simulation.most_seconds"});
}

TEST_CASE("a server computes on what it was set up for, and is asked for nothing else") {
    Mill mill;
    mill.shop.must({"simulate", "d.weave", "-o", "here.yarns", "--backend", "cpu"});
    mill.shop.must(mill.on({"simulate", "d.weave", "-o", "there.yarns"}));
    mill.shop.must(mill.on({"simulate", "d.weave", "-o", "there.yarns", "--backend", "auto"}));
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "there.yarns", "--backend", "cpu"}), 2, {"--backend cpu", "auto"});
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "there.yarns", "--backend", "abacus"}), 2, {"--backend abacus"});
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "there.yarns", "--backend", "cuda"}), 2, {"--backend cuda", "auto"});
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 2);
}

TEST_CASE("broken connections and a restarted server change nothing but the time it takes") {
    const std::uint16_t code = GENERATE(as<std::uint16_t>{}, 1001, 1011);
    for (std::size_t at = 0; at < 8; ++at) {
        INFO("broken with " << code << " at message " << at);
        Mill mill;
        mill.simd.script()->mishaps[at + 1] = {code, "", ""};
        const Ended ended = mill.shop.run(mill.on({"simulate", "d.weave", "-o", "d.yarns"}));
        INFO(ended.err);
        CHECK(ended.exit == 0);
        CHECK(ended.out.find("at rest") != std::string::npos);
        CHECK(mill.settled() == std::set<std::uint64_t>{1});  // submitted once, whatever was sent twice
    }
    Mill mill;
    mill.simd.script()->holds_jobs = true;
    Workshop::Running running = mill.shop.start(mill.on({"simulate", "d.weave", "-o", "d.yarns"}));
    while (mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    mill.simd.stop();
    REQUIRE(running.says("trying again"));
    mill.simd.restart();
    REQUIRE(running.says("connected again"));
    REQUIRE(running.says("relaxing on 127.0.0.1"));
    mill.simd.let_go();
    const Ended ended = running.finish();
    INFO(ended.err);
    CHECK(ended.exit == 0);
    CHECK_THAT(ended.err, Contains("residual 5.00e-01 (goal 1e-03) after 20 steps, to go some 12 s, so far "));
    CHECK(read_yarns(mill.shop.get("d.yarns")));
}

TEST_CASE("a job that the server lost is not waited for") {
    Mill mill;
    mill.simd.script()->holds_jobs = true;
    Workshop::Running running = mill.shop.start(mill.on({"simulate", "d.weave", "-o", "d.yarns"}));
    while (mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const bool by_hand = GENERATE(false, true);
    mill.simd.lose_jobs();
    if (by_hand) ::kill(running.child, SIGINT);
    else mill.simd.restart();
    const Ended ended = running.finish();
    INFO(ended.err);
    CHECK(ended.exit == 4);
    CHECK_THAT(ended.err, Contains("does not have it any more") && !Contains("is kept"));
}

TEST_CASE("a job that waits tells its place and how long, and Ctrl-C takes it out of the queue") {
    Mill mill;
    mill.simd.script()->holds_queue = true;
    Workshop::Running running = mill.shop.start(mill.on({"simulate", "d.weave", "-o", "d.yarns"}));
    while (mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    mill.simd.restart();  // after which it is told again
    REQUIRE(running.says("place 3 in the queue, begins in some 240 s, so far "));
    ::kill(running.child, SIGINT);
    const Ended ended = running.finish();
    INFO(ended.err);
    CHECK(ended.exit == 1);
    CHECK_THAT(ended.err, Contains("again to end at once, and the job goes on") && Contains("cancelled before it began"));
    CHECK(mill.shop.names() == std::set<std::string>{"d.weave"});
    CHECK(mill.settled() == std::set<std::uint64_t>{1});
}

TEST_CASE("Ctrl-C cancels the job and leaves its yarns as they lay, as on this machine") {
    Mill mill;
    mill.simd.script()->holds_jobs = true;
    mill.simd.script()->work = [](const wire::Submit& submit) { return relaxed(submit, 2); };
    Workshop::Running running = mill.shop.start(mill.on({"simulate", "d.weave", "-o", "d.yarns", "--evidence", "d.evidence", "--json"}));
    while (mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ::kill(running.child, SIGINT);
    const Ended ended = running.finish();
    INFO(ended.err);
    CHECK(ended.exit == 4);  // a cancelled job has no evidence
    const Json answer = parse_json(ended.out).value();
    CHECK(answer.at("interrupted") == true);
    CHECK(answer.at("left_undone").at(0) == "coming to rest");
    CHECK(answer.at("converged") == false);
    CHECK(answer.at("error").at("exit") == 4);
    CHECK(read_yarns(mill.shop.get("d.yarns")));
    CHECK_FALSE(mill.shop.has("d.evidence"));
    CHECK(mill.settled() == std::set<std::uint64_t>{1});
}

TEST_CASE("a token goes to the server and nowhere else") {
    Mill mill;
    mill.simd.script()->token = "a-very-secret-token";
    mill.shop.put("right", "a-very-secret-token\n");
    mill.shop.put("wrong", "another-secret-token\n");
    mill.shop.put("none", "no token\n");
    const std::vector<std::string> words = mill.on({"simulate", "d.weave", "-o", "d.yarns"});
    const auto with = [&](const std::string& file) {
        std::vector<std::string> all = words;
        all.insert(all.end(), {"--token-file", file});
        return all;
    };
    CHECK_THAT(mill.shop.refused(words, 4, {"401"}), !Contains("secret"));
    CHECK_THAT(mill.shop.refused(with("wrong"), 4, {"401"}), !Contains("secret"));
    mill.shop.refused(with("none"), 3, {"none: token"});
    mill.shop.refused(with("missing"), 3, {"missing"});
    CHECK(mill.shop.run(with("right")).exit == 0);
    ::setenv("WEAVE_TOKEN", "a-very-secret-token", 1);
    CHECK(mill.shop.run(words).exit == 0);
    CHECK(mill.shop.run(with("wrong")).exit == 4);  // the file is meant, where one is named
    ::unsetenv("WEAVE_TOKEN");
}

TEST_CASE("a failed job ends with the server's reason and its exit status") {
    Mill mill;
    mill.simd.script()->work = [](const wire::Submit&) { return JobResult{system_fault("the worker ran out of memory"), Json::object(), "", {}}; };
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "d.yarns"}), 5, {"d.weave: ", "ran out of memory"});
    CHECK(mill.settled() == std::set<std::uint64_t>{1});
}

TEST_CASE("what a server gives is believed only so far as it fits together") {
    const auto refused = [](const std::string& why, auto change) {
        INFO(why);
        Mill mill;
        mill.simd.script()->work = [&](const wire::Submit& submit) {
            JobResult result = relaxed(submit);
            change(result);
            return result;
        };
        const std::string line = mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "d.yarns", "--evidence", "e"}), 3, {why});
        CHECK_THAT(line, Contains("weave jobs fetch 1 --on http://127.0.0.1"));
        CHECK(mill.settled().empty());  // it can be looked into
    };
    const auto rehash = [](JobResult& result) { result.report["yarns_sha256"] = sha256_hex(result.yarns); };
    refused("SHA-256", [](JobResult& result) { result.yarns[result.yarns.size() / 2] ^= 1; });
    refused("not one that this program knows", [](JobResult& result) { result.report.erase("yarns_sha256"); });
    refused("not one that this program knows", [](JobResult& result) { result.report.erase("ending"); });
    refused("not one that this program knows", [](JobResult& result) { result.report["residual"] = "small"; });
    refused("not one that this program knows", [](JobResult& result) { result.report["fidelity"] = "\x1b[31m"; });
    refused("something else than was asked for", [](JobResult& result) { result.report["flips"] = Json::array({{{"pick", 1}, {"end", 1}, {"done", true}, {"tried", true}, {"flip_seconds", 0}, {"settle_seconds", 0}}}); });
    refused("not one that this program knows", [](JobResult& result) { result.report["flips"] = {{"first", {{"pick", 1}, {"end", 1}, {"done", true}, {"tried", true}, {"flip_seconds", 0}, {"settle_seconds", 0}}}}; });
    refused("", [&](JobResult& result) { result.yarns = "no yarns", rehash(result); });
    refused("version: is missing", [](JobResult& result) { result.evidence = R"({"format":"weave-signed-evidence"})"; });
    refused("another than was told", [](JobResult& result) { *result.evidence += "\n"; });
    refused("of other yarns", [](JobResult& result) {
        Json other = result.report;
        other["yarns_sha256"] = std::string(64, 'a');
        result.evidence = signed_for(other);
    });
    refused("something else than was asked for", [&](JobResult& result) {
        Yarns yarns = read_yarns(result.yarns).value();
        yarns.scene_sha256 = std::string(64, 'a');
        result.yarns = write_yarns(yarns).value(), rehash(result);
    });
}

TEST_CASE("what the server signed is written beside, byte by byte") {
    Mill mill;
    std::string signed_bytes;
    mill.simd.script()->work = [&](const wire::Submit& submit) {
        JobResult result = relaxed(submit);
        signed_bytes = *result.evidence;
        return result;
    };
    mill.shop.must(mill.on({"simulate", "d.weave", "-o", "d.yarns", "--evidence", "d.evidence"}));
    CHECK(mill.shop.get("d.evidence") == mill.simd.look([&](ScriptedSimd&) { return signed_bytes; }));
    mill.simd.script()->work = [](const wire::Submit& submit) {
        JobResult result = relaxed(submit);
        result.evidence.reset();
        return result;
    };
    const Ended none = mill.shop.run(mill.on({"simulate", "d.weave", "-o", "e.yarns", "--evidence", "e.evidence"}));
    CHECK(none.exit == 4);
    CHECK_THAT(none.err, Contains("no key to sign"));
    CHECK_THAT(none.out, Contains("e.yarns, at rest"));
    CHECK((mill.shop.has("e.yarns") && !mill.shop.has("e.evidence")));
    const Json told = mill.shop.json(mill.on({"simulate", "d.weave", "-o", "e.yarns", "--evidence", "e.evidence"}), 4);
    CHECK(told.at("converged") == true);
    CHECK((told.at("error").at("kind") == "refused" && told.at("error").at("exit") == 4));
    CHECK_THAT(told.at("error").at("message").get<std::string>(), Contains("no key to sign"));
    CHECK_THAT(told.at("error").at("where").get<std::string>(), Contains("job 3"));
    mill.shop.refused(mill.on({"simulate", "d.weave", "-o", "e.yarns", "--evidence", "d.weave"}), 2, {"d.weave"});
}

TEST_CASE("evidence that a server will not sign is refused before it is given a job") {
    Mill mill;
    mill.simd.script()->signs = false;
    const std::vector<std::string> words = mill.on({"simulate", "d.weave", "-o", "d.yarns", "--evidence", "d.evidence"});
    mill.shop.refused(words, 4, {mill.simd.place().name, "no key to sign", "--evidence"});
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0);
    CHECK(mill.shop.names() == std::set<std::string>{"d.weave"});
    CHECK(mill.shop.json(mill.on({"jobs"})).at("signs") == false);
    mill.shop.must(mill.on({"simulate", "d.weave", "-o", "d.yarns"}));
    mill.simd.script()->signs = true;
    mill.shop.must(words);
    CHECK(mill.shop.has("d.evidence"));
    CHECK(mill.shop.json(mill.on({"jobs"})).at("signs") == true);
}

TEST_CASE("a job that is fetched later leaves the flipped design too, made of the design that it was made of") {
    Mill mill;
    mill.shop.must({"tile", "d.weave", "--x", "3", "--y", "3", "-o", "large.weave"});
    mill.shop.must({"tile", "d.weave", "--x", "2", "--y", "2", "-o", "other.weave"});
    mill.shop.must(mill.on({"simulate", "large.weave", "-o", "there.yarns", "--flip", "1,1", "--save-design", "there.weave"}));
    const auto left = [&](const std::vector<std::string>& more) {  // a job that is still there, as its files could not be written
        std::vector<std::string> words{"simulate", "large.weave", "-o", "full.yarns"};
        words.insert(words.end(), more.begin(), more.end());
        CHECK(mill.shop.run(mill.on(words), full_disk).exit == 5);
    };
    left({"--flip", "1,1"});
    left({});
    const auto fetch = [&](const char* job, const std::string& of, const std::string& saved) {
        return mill.on({"jobs", "fetch", job, "-o", "later.yarns", "--of", of, "--save-design", saved});
    };
    mill.shop.refused(fetch("2", "other.weave", "later.weave"), 3, {"other.weave", "not the design", "job 2"});
    mill.shop.refused(fetch("2", "missing.weave", "later.weave"), 3, {"missing.weave"});
    mill.shop.refused(fetch("2", "large.weave", "later.yarns"), 2, {"later.yarns"});
    mill.shop.refused(fetch("3", "large.weave", "later.weave"), 2, {"--save-design later.weave", "job 3", "given none"});
    mill.shop.refused(mill.on({"jobs", "fetch", "2", "-o", "later.yarns", "--save-design", "later.weave"}), 2, {"--of"});
    mill.shop.refused(mill.on({"jobs", "fetch", "2", "-o", "later.yarns", "--of", "large.weave"}), 2, {"--save-design"});
    CHECK((!mill.shop.has("later.yarns") && !mill.shop.has("later.weave")));
    CHECK(mill.settled() == std::set<std::uint64_t>{1});
    CHECK(mill.shop.json(fetch("2", "large.weave", "later.weave")).at("saved_design") == "later.weave");
    CHECK(mill.shop.get("later.weave") == mill.shop.get("there.weave"));
    CHECK(mill.settled() == std::set<std::uint64_t>{1, 2});
    const Design saved = load_design(mill.shop.path("later.weave")).value();
    CHECK(read_yarns(mill.shop.get("later.yarns")).value().design_sha256 == design_sha256(saved));
}

TEST_CASE("a flip that was not made leaves the design as it was, and is not written") {
    Mill mill;
    mill.simd.script()->work = [](const wire::Submit& submit) { return relaxed(submit, 2); };  // over before its flips
    CHECK(mill.shop.run(mill.on({"simulate", "d.weave", "-o", "full.yarns", "--flip", "1,1"}), full_disk).exit == 5);
    const Ended fetched = mill.shop.run(mill.on({"jobs", "fetch", "1", "-o", "d.yarns", "--of", "d.weave", "--save-design", "flipped.weave"}));
    INFO(fetched.err);
    CHECK(fetched.exit == 1);
    CHECK_THAT(fetched.out, Contains("flipped.weave is NOT written: no flip was made"));
    CHECK((mill.shop.has("d.yarns") && !mill.shop.has("flipped.weave")));
}

TEST_CASE("sessions are listed, and closed for good") {
    Mill mill;
    mill.simd.script()->session = {wire::ServerMessage(wire::PhaseChanged{1, 1, 0, wire::Phase::at_rest}),
                         wire::ServerMessage(wire::Ended{1, 2, 20, wire::Why::closed, {}, {{"converged", true}}})};
    CHECK(mill.shop.must(mill.on({"sessions"})).out == "no sessions\n");
    for (int k = 0; k < 3; ++k) {
        auto client = wire::Client::connect(mill.simd.place(), "test").value();
        REQUIRE(client.ask(wire::Create{wire::new_request_id(), "{}", {}}, std::chrono::seconds(20)));
    }
    CHECK(mill.shop.must(mill.on({"sessions"})).out ==
          "1  cloth: at rest, residual 5.00e-01 after 20 steps, 136 points, nobody attached, ended in some 60 min\n"
          "2  cloth: ended, residual 5.00e-01 after 20 steps, 136 points, nobody attached, forgotten in some 25 h\n"
          "3  cloth: at rest, residual 5.00e-01 after 20 steps, 136 points, 2 clients attached\n");
    const Json list = mill.shop.json(mill.on({"sessions"}));
    CHECK(list.at("server") == mill.simd.place().name);
    CHECK((list.at("sessions").at(0).at("left_s") == 3600 && list.at("sessions").at(0).at("ended") == false && list.at("sessions").at(2).at("attached") == 2));
    CHECK(mill.shop.must(mill.on({"sessions", "close", "1"})).out == "session 1 is closed, after 20 steps\n");
    const Json closed = mill.shop.json(mill.on({"sessions", "close", "3"}));
    CHECK((closed.at("session") == 3 && closed.at("why") == "closed" && closed.at("step") == 20 && closed.at("report").at("converged") == true));
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.acknowledged; }) == std::map<std::uint64_t, std::uint64_t>{{1, 2}, {3, 2}});
    mill.shop.refused(mill.on({"sessions", "close", "1"}), 2, {"session 1", "no such session"});
    mill.shop.refused(mill.on({"sessions", "close", "0"}), 2, {"0"});
    mill.shop.refused({"sessions"}, 2, {"--on HOST"});
}

TEST_CASE("a sweep hands over a job for each combination of its numbers and each can be fetched") {
    Mill mill;
    const std::vector<std::string> words = mill.on({"simulate", "d.weave", "--fidelity", "draft", "--set", "weft.strain=1.01", "--sweep", "warp.strain=1.01,1.02", "--sweep", "friction=0,0.1,0.2"});
    CHECK(mill.shop.must(words).out ==
          "1  warp.strain=1.01 friction=0\n2  warp.strain=1.01 friction=0.1\n3  warp.strain=1.01 friction=0.2\n"
          "4  warp.strain=1.02 friction=0\n5  warp.strain=1.02 friction=0.1\n6  warp.strain=1.02 friction=0.2\n");
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 6);
    CHECK(mill.settled().empty());
    mill.shop.must({"simulate", "d.weave", "--fidelity", "draft", "--set", "weft.strain=1.01", "--set", "warp.strain=1.02", "--set", "friction=0.1", "-o", "here.yarns"});
    mill.shop.must(mill.on({"jobs", "fetch", "5", "-o", "there.yarns"}));
    const Yarns here = read_yarns(mill.shop.get("here.yarns")).value(), there = read_yarns(mill.shop.get("there.yarns")).value();
    CHECK(here.scene_sha256 == there.scene_sha256);
    CHECK(here.design_sha256 == there.design_sha256);
    const Json told = mill.shop.json(mill.on({"simulate", "d.weave", "--sweep", "warp.radius=1,1.1"}));
    CHECK((told.at("server") == mill.simd.place().name && told.at("jobs").size() == 2));
    CHECK((told.at("jobs").at(1).at("job") == 8 && told.at("jobs").at(1).at("set") == Json::array({"warp.radius=1.1"})));
}

TEST_CASE("a sweep that makes no sense is refused before any job is handed over") {
    Mill mill;
    const auto sweep = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"simulate", "d.weave"});
        return mill.on(std::move(more));
    };
    mill.shop.refused({"simulate", "d.weave", "--sweep", "friction=0,1"}, 2, {"--on"});
    mill.shop.refused(sweep({"--sweep", "friction=0,1", "-o", "d.yarns"}), 2, {"--sweep friction=0,1", "weave jobs fetch"});
    mill.shop.refused(sweep({"--sweep", "friction=0,1", "--explain"}), 2, {"--sweep"});
    for (const char* word : {"friction", "friction=", "=1", "friction=0,,1", "friction=0,0", "friction=0,"})
        mill.shop.refused(sweep({"--sweep", word}), 2, {std::string("--sweep ") + word, "NAME=N,N"});
    mill.shop.refused(sweep({"--sweep", "friction=0,a"}), 2, {"--sweep friction=a"});
    mill.shop.refused(sweep({"--sweep", "speed=1,2"}), 2, {"--sweep speed=1"});
    mill.shop.refused(sweep({"--sweep", "friction=0,1", "--sweep", "friction=2"}), 2, {"--sweep friction=2", "given before"});
    std::string many = "warp.strain=1";
    for (int k = 1; k <= 40; ++k) many += ",1.0" + std::to_string(10 + k);
    mill.shop.refused(sweep({"--sweep", many, "--sweep", "weft" + many.substr(4)}), 2, {"more than 1000 runs"});
    CHECK(mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0);
}

TEST_CASE("jobs are listed, fetched and cancelled") {
    Mill mill;
    mill.simd.script()->holds_jobs = true;
    Workshop::Running running = mill.shop.start(mill.on({"simulate", "d.weave", "-o", "full.yarns"}), full_disk);
    while (mill.simd.look([](ScriptedSimd& s) { return s.count_of<wire::Submit>(); }) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    CHECK(mill.shop.must(mill.on({"jobs"})).out == "1  cloth: running, residual 5.00e-01 after 20 steps, to go some 12 s\n");
    const Json list = mill.shop.json(mill.on({"jobs"}));
    CHECK((list.at("jobs").at(0).at("job") == 1 && list.at("jobs").at(0).at("phase") == "running" && list.at("server") == mill.simd.place().name));
    mill.shop.refused(mill.on({"jobs", "fetch", "1", "-o", "d.yarns"}), 4, {"job 1", "has not ended yet"});
    mill.shop.refused(mill.on({"jobs", "fetch", "7", "-o", "d.yarns"}), 4, {"job 7", "no such job"});
    mill.shop.refused(mill.on({"jobs", "cancel", "9"}), 2, {"job 9", "there is no such job"});
    CHECK_THAT(mill.shop.must(mill.on({"jobs", "cancel", "1"})).out, Contains("job 1 is cancelled; weave jobs fetch gets its yarns"));
    const Ended ended = running.finish();  // which could not write, so the job is kept
    CHECK(ended.exit == 5);
    CHECK_THAT(ended.err, Contains("weave jobs fetch 1 --on "));
    const Json fetched = mill.shop.json(mill.on({"jobs", "fetch", "1", "-o", "d.yarns"}));
    CHECK((fetched.at("job") == 1 && fetched.at("converged") == true && fetched.at("file") == "d.yarns"));
    CHECK(fetched.at("yarns_sha256") == sha256_hex(mill.shop.get("d.yarns")));
    CHECK(mill.settled() == std::set<std::uint64_t>{1});
    CHECK(mill.shop.must(mill.on({"jobs"})).out == "no jobs\n");
    CHECK_THAT(mill.shop.must({"jobs", "fetch", "--help"}).out, Contains("--of") && Contains("--save-design") && Contains("--evidence"));
    mill.shop.refused({"jobs"}, 2, {"--on HOST"});
}
