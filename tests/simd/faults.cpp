// What happens to sessions when processes die, memory and disk run out, and clocks jump. Seeds are printed.

#include "box.hpp"
#include "results.hpp"

#include <map>
#include <random>
#include <sys/resource.h>

using namespace weave;
using namespace weave::simd::testing;

namespace {

const wire::Parameters tighter{{.strain = 1.03, .stiffness_scale = {}, .radius_scale = 1.05}, {}};
const wire::Fields pushed{{{{2, 1, 0}, 2, 0.01}}};

/// A session with changes at steps that do not depend on how fast anything is, up to its last run to rest.
void prepare(Followed& session) {
    session.ask(wire::Step{wire::new_request_id(), session.number, 40});
    REQUIRE(session.until_phase(wire::Phase::paused));
    session.change(tighter);
    REQUIRE(session.next<wire::Applied>());
    session.ask(wire::Step{wire::new_request_id(), session.number, 60});
    REQUIRE(session.until_phase(wire::Phase::paused));
    session.change(pushed);
    REQUIRE(session.next<wire::Applied>());
    session.run();
}

unsigned seed_of_test() {
    const unsigned seed = std::random_device()();
    std::printf("seed %u\n", seed);
    return seed;
}

/// Events come once each, in order and without a hole, whatever happens.
void check_events(const Followed& session) {
    std::uint64_t seq = 0;
    for (const wire::ServerMessage& message : session.told) {
        std::visit(
            [&](const auto& one) {
                if constexpr (requires { one.seq; one.session; }) {
                    if constexpr (!std::is_same_v<std::decay_t<decltype(one)>, wire::State>) CHECK(one.seq == ++seq);
                }
            },
            message);
    }
}

void limit(pid_t process, __rlimit_resource what, rlim_t most) {
    const rlimit now{most, RLIM_INFINITY};
    REQUIRE(::prlimit(process, what, &now, nullptr) == 0);
}

}  // namespace

TEST_CASE("a session whose worker is killed again and again ends bit by bit as one that was left alone") {
    const Box box;
    Followed unbroken(box, document_of(long_cloth), long_run());
    prepare(unbroken);
    REQUIRE(unbroken.until_rest());
    const std::string wanted = unbroken.yarns();

    std::mt19937 random(seed_of_test());
    Followed killed(box, document_of(long_cloth), long_run());
    prepare(killed);
    std::size_t kills = 0;
    std::uint64_t next = 110 + random() % 60;  // each further than the last: without that a session is given up
    while (!killed.until_rest(20ms)) {
        INFO(box.told());
        REQUIRE(killed.all<wire::Ended>().empty());
        if (kills == 5 || killed.state().step < next) continue;
        if (const auto worker = box.worker("session", killed.number)) kills += ::kill(*worker, SIGKILL) == 0 ? 1 : 0;
        next += 20 + random() % 60;
    }
    CHECK(kills > 0);
    CHECK(killed.all<wire::Recovered>().size() >= 1);
    CHECK(killed.all<wire::Applied>().size() == 2);
    check_same_yarns(killed.yarns(), wanted);
    check_events(killed);
}

TEST_CASE("a fault of one session harms no other, and one that dies at once each time is given up with the reason") {
    const Box box;
    Followed doomed(box, document_of(long_cloth), long_run()), other(box, document_of("layer-to-layer"), at(sim::Fidelity::standard));
    doomed.run();
    std::optional<wire::Ended> ended;
    for (int k = 0; k < 400 && !ended; ++k) {
        if (const auto worker = box.worker("session", doomed.number)) ::kill(*worker, SIGKILL);
        ended = doomed.next<wire::Ended>(50ms);
    }
    REQUIRE(ended);
    CHECK(ended->why == wire::Why::failed);
    REQUIRE(ended->error);
    CHECK_THAT(ended->error->message, Catch::Contains("signal") && Catch::Contains("in a row"));
    other.run();
    CHECK(other.until_rest());
    CHECK(other.all<wire::Recovered>().empty());
}

TEST_CASE("the daemon is killed and started again: sessions go on, and end as if nothing had been") {
    Box box;
    Followed unbroken(box, document_of(long_cloth), long_run());
    prepare(unbroken);
    REQUIRE(unbroken.until_rest());
    const std::string wanted = unbroken.yarns();
    Followed killed(box, document_of(long_cloth), long_run());
    prepare(killed);
    std::this_thread::sleep_for(1s);
    box.kill();
    std::this_thread::sleep_for(200ms);
    box.start();
    REQUIRE(killed.until_rest());
    CHECK(killed.all<wire::Recovered>().size() >= 1);
    check_same_yarns(killed.yarns(), wanted);
    check_events(killed);
}

TEST_CASE("asked to end, the daemon puts everything away, and takes it up at its next start") {
    Box box;
    Followed session(box, document_of(long_cloth), long_run());
    prepare(session);
    std::this_thread::sleep_for(700ms);
    CHECK(box.stop() == 0);
    box.start();
    REQUIRE(session.until_rest());
    CHECK(session.all<wire::Recovered>().size() == 1);
    session.ask(wire::Checkpoint{wire::new_request_id(), session.number});
    const double rested = session.state().residual;
    const Json before = box.status().at("sessions").at(0);
    CHECK((rested > 0 && rested <= 1e-4));
    CHECK(before.at("checkpoint_step") == before.at("step"));
    CHECK(box.stop() == 0);
    box.start();
    REQUIRE(session.next<wire::Recovered>());
    double residual = 0;  // its worker tells it, soon after
    for (int k = 0; k < 100 && residual == 0; ++k) {
        std::this_thread::sleep_for(50ms);
        residual = session.state().residual;
    }
    CHECK(residual == rested);
    CHECK(box.status().at("sessions").at(0).at("checkpoint_step") == before.at("checkpoint_step"));
    check_events(session);
}

TEST_CASE("a session that takes more memory than it may ends with that reason, and no other does") {
    const Box box;
    Followed greedy(box, document_of(long_cloth), long_run()), other(box, document_of("plain"), at(sim::Fidelity::draft));
    const auto worker = box.worker("session", greedy.number);
    REQUIRE(worker);
    if (is_sanitized) return;  // it would end the process itself
    limit(*worker, RLIMIT_DATA, 1 << 20);
    greedy.run();
    const auto ended = greedy.next<wire::Ended>();
    REQUIRE(ended);
    CHECK(ended->why == wire::Why::failed);
    REQUIRE(ended->error);
    CHECK_THAT(ended->error->message, Catch::Contains("out of memory"));
    other.run();
    CHECK(other.until_rest());
}

TEST_CASE("a checkpoint for which the disk has no room is refused with the reason; the session goes on, and the last good one stays") {
    const Box box;
    Followed session(box, document_of(long_cloth), long_run());
    session.ask(wire::Step{wire::new_request_id(), session.number, 40});
    REQUIRE(session.until_phase(wire::Phase::paused));
    session.change(tighter);  // between two legs there is a state to write
    REQUIRE(session.next<wire::Applied>());
    session.ask(wire::Checkpoint{wire::new_request_id(), session.number});
    const auto worker = box.worker("session", session.number);
    REQUIRE(worker);
    limit(*worker, RLIMIT_FSIZE, 100);
    const auto refused = session.follower().ask(wire::Checkpoint{wire::new_request_id(), session.number}, 10s);
    REQUIRE(refused);
    REQUIRE(std::holds_alternative<wire::Refused>(*refused));
    const Error error = std::get<wire::Refused>(*refused).error;
    CHECK(error.code == ErrorCode::system);
    CHECK_THAT(error.message, Catch::Contains("File too large"));
    session.run();
    std::this_thread::sleep_for(4s);  // checkpoints that fail meanwhile harm nothing
    ::kill(*worker, SIGKILL);
    REQUIRE(session.next<wire::Recovered>());
    REQUIRE(session.until_rest());
    session.ask(wire::Checkpoint{wire::new_request_id(), session.number});
}

TEST_CASE("a worker that answers no more is ended, and its session goes on") {
    const Box box(Json{{"stall_seconds", 1}, {"threads", 1}});
    Followed stuck(box, document_of(long_cloth), long_run()), other(box, document_of("layer-to-layer"), at(sim::Fidelity::standard));
    stuck.run();
    std::this_thread::sleep_for(300ms);
    const auto worker = box.worker("session", stuck.number);
    REQUIRE(worker);
    REQUIRE(::kill(*worker, SIGSTOP) == 0);
    other.run();
    CHECK(other.until_rest());
    CHECK(stuck.next<wire::Recovered>());
    CHECK(stuck.until_rest());
}

TEST_CASE("a worker that hangs while nobody else waits is ended too, and so is one that does not end when it is asked to") {
    const Box box(Json{{"stall_seconds", 2}});
    Followed stuck(box, document_of(long_cloth), long_run());
    stuck.run();
    std::this_thread::sleep_for(300ms);
    const auto first = box.worker("session", stuck.number);
    REQUIRE(first);
    REQUIRE(::kill(*first, SIGSTOP) == 0);
    CHECK(stuck.next<wire::Recovered>());
    CHECK(stuck.until_rest());
    const auto second = box.worker("session", stuck.number);
    REQUIRE(second);
    REQUIRE(::kill(*second, SIGSTOP) == 0);
    stuck.ask(wire::Close{wire::new_request_id(), stuck.number});
    const auto ended = stuck.next<wire::Ended>();
    REQUIRE(ended);
    CHECK(ended->why == wire::Why::closed);
    REQUIRE(ended->error);
    CHECK_THAT(ended->error->message, Catch::Contains("said nothing for 2 s"));
}

TEST_CASE("while the disk is full a session pauses when asked to, and shows no frame whose number could come twice") {
    const auto is_frame = [](const wire::Received& one) { return std::holds_alternative<wire::Frame>(one); };
    Box box;
    wire::Simulation endless = long_run();
    endless.residual = 1e-15;
    Followed session(box, document_of(long_cloth), endless);
    session.run();
    REQUIRE(session.until_phase(wire::Phase::running));  // else the next daemon is told a change, and what it writes of that promises numbers too
    REQUIRE(session.until(is_frame));
    box.kill();
    box.start();
    limit(box.process(), RLIMIT_FSIZE, 100);  // its next frame needs numbers that the disk has not promised yet
    session.until([](const wire::Received&) { return false; }, 2s);
    limit(box.process(), RLIMIT_FSIZE, RLIM_INFINITY);
    REQUIRE(session.until(is_frame));
    session.until([](const wire::Received&) { return false; }, 1s);
    const std::uint64_t shown = session.last_frame;
    box.kill();
    box.start();
    const auto recovered = session.next<wire::Recovered>();
    REQUIRE(recovered);
    CHECK(recovered->frame >= shown);  // else its next ones would have numbers that stood for others
    limit(box.process(), RLIMIT_FSIZE, 100);
    for (int k = 0; k < 2; ++k) {
        const auto refused = session.follower().ask(wire::Run{wire::new_request_id(), session.number}, 10s);
        REQUIRE(refused);
        CHECK(std::holds_alternative<wire::Refused>(*refused));
        session.ask(wire::Pause{wire::new_request_id(), session.number});
    }
    CHECK_FALSE(session.until(is_frame, 1s));
    limit(box.process(), RLIMIT_FSIZE, RLIM_INFINITY);
    session.run();
    REQUIRE(session.until(is_frame));
    box.kill();
    box.start();
    REQUIRE(session.next<wire::Recovered>());
    CHECK(session.state().frame >= session.last_frame);
    REQUIRE(session.until(is_frame));
    check_events(session);
}

TEST_CASE("clocks that jump by a day at every look change nothing") {
    if (is_sanitized) return;  // a sanitizer's own library must be the first one
    ::setenv("LD_PRELOAD", WEAVE_JUMPING_CLOCK, 1);
    Box box(Json{{"expire_seconds", 60}});
    ::unsetenv("LD_PRELOAD");
    Followed session(box, document_of("layer-to-layer"), at(sim::Fidelity::standard));
    session.run();
    REQUIRE(session.until_rest());
    const auto worker = box.worker("session", session.number);
    REQUIRE(worker);
    ::kill(*worker, SIGKILL);
    CHECK(session.next<wire::Recovered>());
    std::this_thread::sleep_for(1s);
    CHECK(session.state().phase == wire::Phase::at_rest);
    CHECK(session.all<wire::Ended>().empty());
}

namespace {

constexpr std::size_t most_faults = 3;  // after which, without a step between, simd gives a session up

/// Sessions of one cloth, while daemon and workers are killed at random moments: each ends at rest with the same bits, or is given up where its
/// own workers were killed too often.
void kill_under(std::size_t sessions, std::size_t kills, const char* cloth, const wire::Simulation& simulation) {
    const unsigned seed = seed_of_test();
    INFO("seed " << seed);
    std::mt19937 random(seed);
    Box box(Json{{"sessions_per_person", 64}});
    Followed unbroken(box, document_of(cloth), simulation);
    unbroken.run();
    REQUIRE(unbroken.until_rest());
    const std::string wanted = unbroken.yarns();
    unbroken.ask(wire::Close{wire::new_request_id(), unbroken.number});

    std::size_t made = 0, of_daemon = 0, given_up = 0, at_rest = 0;
    while (made < kills) {
        std::vector<std::unique_ptr<Followed>> all;
        std::map<std::uint64_t, std::size_t> killed;  // workers of each session
        for (std::size_t k = 0; k < sessions; ++k) {
            all.push_back(std::make_unique<Followed>(box, document_of(cloth), simulation));
            all.back()->run();
        }
        for (const std::size_t end = std::min(kills, made + 2 * sessions); made < end; ++made) {
            std::this_thread::sleep_for(std::chrono::milliseconds(random() % 300));
            if (random() % 4 == 0) {
                box.kill();
                box.start();
                ++of_daemon;
            } else {
                const std::uint64_t session = all[random() % sessions]->number;
                const auto worker = box.worker("session", session);
                if (worker && ::kill(*worker, SIGKILL) == 0) ++killed[session];
            }
        }
        for (const auto& session : all) {
            const bool rests = session->until(
                [](const wire::Received& one) {
                    const auto* frame = std::get_if<wire::Frame>(&one);
                    const auto* message = std::get_if<wire::ServerMessage>(&one);
                    return (frame != nullptr && frame->head.at_rest) || (message != nullptr && std::holds_alternative<wire::Ended>(*message));
                },
                300s);
            if (!rests) FAIL("session " << session->number << " comes to no end; what simd says of it: " << box.status().dump(1) << box.told());
            check_events(*session);
            // The worker may have been killed once more since it showed that: the session gets another, or ends where that was once too often.
            const auto yarns = [&] { return session->follower().download(wire::session_yarns(session->number), std::uint64_t{1} << 30); };
            auto bytes = yarns();
            for (const auto late = std::chrono::steady_clock::now() + patience_for_rest; !bytes && session->all<wire::Ended>().empty() && std::chrono::steady_clock::now() < late;) {
                session->until([](const wire::Received&) { return false; }, 100ms);
                bytes = yarns();
            }
            if (const auto ended = session->all<wire::Ended>(); !ended.empty()) {
                REQUIRE(ended.front().error);
                CHECK_THAT(ended.front().error->message, Catch::Contains("in a row"));
                CHECK(killed[session->number] > most_faults);
                ++given_up;
                continue;
            }
            INFO((bytes ? "" : bytes.error().text()));
            REQUIRE(bytes);
            check_same_yarns(*bytes, wanted);
            ++at_rest;
            session->ask(wire::Close{wire::new_request_id(), session->number});
            REQUIRE(session->next<wire::Ended>());
        }
    }
    std::printf("%zu kills, %zu of the daemon: %zu sessions came to rest, %zu were given up\n", made, of_daemon, at_rest, given_up);
    CHECK(given_up <= 1 + at_rest / 4);  // one of few may be, by chance
}

}  // namespace

TEST_CASE("daemon and workers are killed at random moments under several sessions: each ends with the same bits") {
    kill_under(4, 8, "layer-to-layer", at(sim::Fidelity::standard));
}

TEST_CASE("the same 200 times under 16 sessions", "[.][long]") {
    kill_under(16, 200, long_cloth, long_run());
}
