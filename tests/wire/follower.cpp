// A client that outlives its connections: no event lost or told twice, whatever happens to them.

#include <weave/wire/follower.hpp>

#include <catch2/catch.hpp>

#include <support/scripted_simd.hpp>
#include <thread>

using namespace weave;
using namespace weave::wire;
using namespace std::chrono_literals;
using Catch::Contains;
using weave::testing::JobResult;
using weave::testing::Mishap;
using weave::testing::ScriptedSimd;

namespace {

Frame small_frame() {
    Frame frame;
    frame.head.quantum_mm = 0.01;
    frame.counts = {1};
    frame.points = {{1, 2, 3}};
    return frame;
}

/// Ten events and nine frames between them.
std::vector<Received> script() {
    std::vector<Received> items{ServerMessage(Layout{})};
    for (std::uint64_t k = 1; k <= 9; ++k) {
        items.emplace_back(small_frame());
        PhaseChanged changed;
        changed.step = 10 * k;
        if (k < 9) items.emplace_back(ServerMessage(changed));
        else items.emplace_back(ServerMessage(Ended{}));
    }
    return items;
}

Follower following(const ScriptedSimd& simd, std::chrono::milliseconds patience = 20s) {
    auto follower = Follower::connect(simd.place(), "test", patience);
    REQUIRE((follower ? "" : follower.error().text()) == "");
    return std::move(*follower);
}

/// What a caller saw of a session.
struct Seen {
    std::vector<std::uint64_t> events, frames;
    bool ended = false;
};

std::uint64_t seq_of(const ServerMessage& message) {
    return std::visit([](const auto& one) -> std::uint64_t { if constexpr (requires { one.seq; }) return one.seq; else return 0; }, message);
}

/// Takes what comes until the session has ended and its last frame is there.
Status watch(Follower& follower, Seen& seen) {
    const auto end = std::chrono::steady_clock::now() + 60s;
    while (!(seen.ended && !seen.frames.empty() && seen.frames.back() == 9) && std::chrono::steady_clock::now() < end) {
        WEAVE_TRY(const auto received, follower.receive(1s));
        if (!received) continue;
        if (const auto* frame = std::get_if<Frame>(&*received)) {
            seen.frames.push_back(frame->head.number);
            continue;
        }
        const auto& message = std::get<ServerMessage>(*received);
        if (const std::uint64_t seq = seq_of(message); seq > 0) seen.events.push_back(seq);
        seen.ended = std::holds_alternative<Ended>(message);
    }
    return {};
}

const std::vector<std::uint64_t> all_events{1, 2, 3, 4, 5, 6, 7, 8, 9, 10};

/// Follows one session from its making to its end, and holds what was seen to what must be.
void follow_to_the_end(ScriptedSimd& simd) {
    Follower follower = following(simd);
    const auto made = follower.create("{}", {}, 20s);
    REQUIRE((made ? "" : made.error().text()) == "");
    REQUIRE(made->session == 1U);
    Seen seen;
    const Status watched = watch(follower, seen);
    REQUIRE((watched ? "" : watched.error().text()) == "");
    CHECK(seen.events == all_events);
    CHECK(std::is_sorted(seen.frames.begin(), seen.frames.end()));
    CHECK(std::adjacent_find(seen.frames.begin(), seen.frames.end()) == seen.frames.end());
    REQUIRE_FALSE(seen.frames.empty());
    CHECK(seen.frames.back() == 9);  // never the last one
    REQUIRE(follower.acknowledge());
    follower.close();
    CHECK_FALSE(simd.look([](ScriptedSimd& s) { return s.repeated_attach; }));
}

/// The error with which a follower gives up on a session that brings this in place of message `at`.
Error given_up_on(const Mishap& mishap, std::size_t at = 3) {
    ScriptedSimd simd;
    simd.script()->session = script();
    simd.script()->mishaps[at] = mishap;
    Follower follower = following(simd);
    REQUIRE(follower.create("{}", {}, 20s));
    Seen seen;
    const Status watched = watch(follower, seen);
    REQUIRE_FALSE(watched);
    CHECK(follower.receive(0ms).error().text() == watched.error().text());  // and stays with it
    CHECK(simd.look([](ScriptedSimd& s) { return s.connections; }) == 1);   // without another try
    return watched.error();
}

std::string event_text(std::uint64_t seq, std::uint64_t session = 1) {
    PhaseChanged changed;
    changed.session = session, changed.seq = seq;
    return write_message(ServerMessage(changed));
}

}  // namespace

TEST_CASE("a session is followed to its end and acknowledged as it goes") {
    ScriptedSimd simd;
    simd.script()->session = script();
    follow_to_the_end(simd);
    CHECK(simd.look([](ScriptedSimd& s) { return s.acknowledged; }).at(1) == 10);
    CHECK(simd.look([](ScriptedSimd& s) { return s.connections; }) == 1);
    CHECK(simd.look([](ScriptedSimd& s) { return s.count_of<Acknowledge>(); }) >= 1);
}

TEST_CASE("no event is lost or told twice, whichever message the connection breaks at") {
    const std::uint16_t code = GENERATE(as<std::uint16_t>{}, 1000, 1001, 1011, 1013);
    std::size_t messages = 0;
    {
        ScriptedSimd simd;
        simd.script()->session = script();
        follow_to_the_end(simd);
        messages = simd.look([](ScriptedSimd& s) { return s.sent; });
    }
    REQUIRE(messages >= 20);
    for (std::size_t at = 1; at < messages; ++at) {
        INFO("broken with " << code << " at message " << at);
        ScriptedSimd simd;
        simd.script()->session = script();
        simd.script()->mishaps[at] = {code, "", ""};
        follow_to_the_end(simd);
        CHECK(simd.look([](ScriptedSimd& s) { return s.count_of<Hello>(); }) >= 2);
    }
}

TEST_CASE("nor where it breaks again and again") {
    for (const std::size_t every : {4U, 5U, 7U}) {
        INFO("broken every " << every << " messages");
        ScriptedSimd simd;
        simd.script()->session = script();
        simd.script()->break_every = every;
        follow_to_the_end(simd);
        CHECK(simd.look([](ScriptedSimd& s) { return s.connections; }) >= 20 / every);
    }
}

TEST_CASE("a restarted server is found again, and its session taken up behind the last event") {
    ScriptedSimd simd;
    simd.script()->session = script();
    Follower follower = following(simd);
    REQUIRE(follower.create("{}", {}, 20s));
    REQUIRE(answer_of<Accepted>(follower.ask(WantFrames{new_request_id(), 1, 5}, 20s)));
    for (int k = 0; k < 5; ++k) REQUIRE(follower.receive(20s).value());
    simd.restart();
    Seen seen;
    REQUIRE(watch(follower, seen));
    CHECK(seen.events.back() == 10);
    REQUIRE(answer_of<Accepted>(follower.ask(Run{new_request_id(), 1}, 20s)));
    CHECK(simd.look([](ScriptedSimd& s) { return s.count_of<WantFrames>(); }) == 2);  // the pace is asked for again
    CHECK_FALSE(follower.trouble());
}

TEST_CASE("who attaches to an earlier session gets what came after, though others acknowledged some") {
    ScriptedSimd simd;
    simd.script()->session = script();
    REQUIRE(following(simd).create("{}", {}, 20s));
    Follower follower = following(simd);
    REQUIRE(follower.attach(1, 4, 2, 20s));
    const auto second = follower.create("{}", {}, 1s);
    REQUIRE_FALSE(second);
    CHECK(second.error().code == ErrorCode::usage);  // one at a time
    Seen seen;
    REQUIRE(watch(follower, seen));
    CHECK(seen.events == std::vector<std::uint64_t>{5, 6, 7, 8, 9, 10});
    CHECK(follower.create("{}", {}, 20s).value().session == 2U);  // once the first is over
    Follower other = following(simd);
    const Status none = other.attach(9, 0, 0, 20s);
    REQUIRE_FALSE(none);
    CHECK(none.error().message == "there is no such session");
    CHECK(other.attach(2, 0, 0, 20s));  // which does not end it
}

TEST_CASE("where the server tells what cannot be, the follower ends and says why") {
    CHECK_THAT(given_up_on({{}, event_text(1), ""}).text(), Contains("event 1 comes after event 1"));
    CHECK_THAT(given_up_on({{}, event_text(4), ""}).text(), Contains("event 4 comes after event 1"));
    CHECK_THAT(given_up_on({{}, event_text(2, 8), ""}).text(), Contains("a session that was not asked for"));
    CHECK_THAT(given_up_on({{}, R"({"type":"welcome","version":1,"server":"x"})", ""}).text(), Contains("greets twice"));
    CHECK_THAT(given_up_on({{}, "nonsense", ""}).text(), Contains("cannot be read"));
    CHECK_THAT(given_up_on({{}, "", std::string(most_frame_bytes + 1, 'x')}).text(), Contains("too long"));
    CHECK_THAT(given_up_on({{}, R"({"type":"refused","error":{"kind":"usage","where":"type","message":"what?"}})", ""}).text(),
               Contains("could not read a message: type: what?"));
    CHECK(given_up_on({1008, "", ""}).code == ErrorCode::refused);
    CHECK(given_up_on({1002, "", ""}).code == ErrorCode::bad_input);
    CHECK(given_up_on({1009, "", ""}).code == ErrorCode::bad_input);
}

TEST_CASE("an event that the server leaves out is missed by who made the session") {
    CHECK_THAT(given_up_on({}, 4).text(), Contains("event 3 comes after event 1"));
}

TEST_CASE("a frame that was seen already is left out, and so is one of another session") {
    ScriptedSimd simd;
    simd.script()->session = script();
    Frame late = small_frame(), foreign = small_frame();
    foreign.head.session = 5;
    foreign.head.number = 99;
    simd.script()->mishaps[7] = {{}, "", encode_frame(late).value()};
    simd.script()->mishaps[9] = {{}, "", encode_frame(foreign).value()};
    follow_to_the_end(simd);
}

TEST_CASE("after the time that its caller named the follower gives up, with the last error") {
    ScriptedSimd simd;
    simd.script()->session = script();
    Follower follower = following(simd, 700ms);
    REQUIRE(follower.create("{}", {}, 20s));
    simd.stop();
    Seen seen;
    const auto begin = std::chrono::steady_clock::now();
    Status watched = watch(follower, seen);
    if (watched) {  // all had come already
        const auto more = follower.receive(20s);
        REQUIRE_FALSE(more);
        watched = more.error();
    }
    CHECK(watched.error().code == ErrorCode::system);
    CHECK_THAT(watched.error().text(), Contains("127.0.0.1:"));
    CHECK(std::chrono::steady_clock::now() - begin >= 700ms);
    CHECK(follower.trouble());
    CHECK_FALSE(Follower::connect(follower.place(), "test", 20s));  // the first is tried once
}

TEST_CASE("a server that greets and falls at once is given up as well") {
    ScriptedSimd simd;
    simd.script()->break_every = 2;
    Follower follower = following(simd, 700ms);
    const auto answer = follower.ask(ListJobs{new_request_id()}, 60s);
    REQUIRE_FALSE(answer);
    CHECK(answer.error().code == ErrorCode::system);
    CHECK_THAT(answer.error().text(), Contains("has stopped"));
}

TEST_CASE("a question is asked again until it is answered, under the same id") {
    ScriptedSimd simd;
    simd.script()->work = [](const Submit&) { return JobResult{{}, {{"converged", true}}, "yarns", {}}; };
    simd.script()->mishaps[1] = {1011, "", ""};  // the answer to the first, which is done all the same
    Follower follower = following(simd);
    const auto accepted = answer_of<Accepted>(follower.ask(Submit{new_request_id(), "{}", {}, {}}, 20s));
    REQUIRE(accepted.value().job == 1U);
    CHECK(simd.look([](ScriptedSimd& s) { return s.count_of<Submit>(); }) == 2);
    CHECK(answer_of<JobList>(follower.ask(ListJobs{new_request_id()}, 20s)).value().jobs.size() == 1);
    CHECK(follower.ask(AcknowledgeJob{1}, 1s).error().code == ErrorCode::usage);
    CHECK(follower.ask(Attach{new_request_id(), 1, 0, 0}, 1s).error().code == ErrorCode::usage);
}

TEST_CASE("a question that nobody answers ends in time") {
    ScriptedSimd simd;
    simd.script()->mishaps[1] = {};
    Follower follower = following(simd);
    const auto answer = follower.ask(ListJobs{new_request_id()}, 300ms);
    CHECK_THAT(answer.error().text(), Contains("does not answer in time"));
    CHECK(follower.ask(ListJobs{new_request_id()}, 20s));  // the next one is
}

TEST_CASE("the end of a job is told once, and again to nobody once it is acknowledged") {
    ScriptedSimd simd;
    simd.script()->work = [](const Submit&) { return JobResult{{}, {{"converged", true}}, "yarns", {}}; };
    const auto ends_seen = [](Follower& follower) {
        // An answer comes after all that every connection begins with, however slow the machine.
        REQUIRE(follower.ask(ListJobs{new_request_id()}, 60s));
        int ends = 0;
        while (const auto received = follower.receive(0ms).value()) {
            const auto* message = std::get_if<ServerMessage>(&*received);
            ends += message != nullptr && std::holds_alternative<JobEnded>(*message) ? 1 : 0;
        }
        return ends;
    };
    Follower follower = following(simd);
    REQUIRE(follower.ask(Submit{new_request_id(), "{}", {}, {}}, 20s));
    CHECK(ends_seen(follower) == 1);
    simd.restart();
    CHECK(ends_seen(follower) == 0);
    simd.restart();
    REQUIRE(follower.download(job_yarns(1), 100).value() == "yarns");
    REQUIRE(follower.acknowledge_job(1, 20s));
    CHECK(simd.look([](ScriptedSimd& s) { return s.acknowledged_jobs; }) == std::set<std::uint64_t>{1});
    Follower other = following(simd);
    CHECK(ends_seen(other) == 0);
}

TEST_CASE("a file is asked for again while the server is away, and no longer than the caller's patience") {
    ScriptedSimd simd;
    simd.script()->work = [](const Submit&) { return JobResult{{}, Json::object(), "yarns", {}}; };
    Follower follower = following(simd, 10s), hasty = following(simd, 300ms);
    REQUIRE(follower.ask(Submit{new_request_id(), "{}", {}, {}}, 20s));
    simd.stop();
    CHECK(hasty.download(job_yarns(1), 100).error().code == ErrorCode::system);
    std::thread later([&] {
        std::this_thread::sleep_for(300ms);
        simd.restart();
    });
    const auto bytes = follower.download(job_yarns(1), 100);
    later.join();
    CHECK(bytes.value() == "yarns");
    CHECK(follower.download(job_yarns(7), 100).error().code == ErrorCode::refused);
}
