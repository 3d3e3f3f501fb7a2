// Sessions as people have them: a daemon is started, and clients speak with it over its socket.

#include "box.hpp"
#include "results.hpp"

using namespace weave;
using namespace weave::simd::testing;

namespace {

const wire::Parameters tighter{{.strain = 1.04, .stiffness_scale = {}, .radius_scale = 1.15}, {}};

}  // namespace

TEST_CASE("a session is seen to relax, takes changes, and ends with a report") {
    const Box box;
    Followed session(box, document_of("layer-to-layer"), at(sim::Fidelity::standard));
    REQUIRE(session.all<wire::Layout>().size() == 1);
    const wire::Layout layout = session.all<wire::Layout>().front();
    CHECK(layout.layout == 1);
    CHECK(session.state().phase == wire::Phase::paused);
    CHECK(session.state().step == 0);
    session.run();
    REQUIRE(session.until_rest());
    CHECK(session.newest->head.residual <= 1e-3);
    CHECK(session.newest->counts.size() == layout.yarns.size());
    const std::string request = session.change(tighter);
    const auto applied = session.next<wire::Applied>();
    REQUIRE(applied);
    CHECK(applied->request == request);
    CHECK_FALSE(applied->error);
    REQUIRE(session.until_phase(wire::Phase::at_rest));
    CHECK(box.status().at("sessions").at(0).at("phase") == "at_rest");
    const std::vector<wire::Layout> layouts = session.all<wire::Layout>();
    CHECK(layouts.back().yarns.back().radius_mm == Approx(1.15 * layout.yarns.back().radius_mm));
    const Yarns yarns = read_yarns(session.yarns()).value();
    CHECK(yarns.report.at("converged") == true);
    CHECK(yarns.report.at("lost_crossings") == 0);
    session.ask(wire::Close{wire::new_request_id(), session.number});
    const auto ended = session.next<wire::Ended>();
    REQUIRE(ended);
    CHECK(ended->why == wire::Why::closed);
    CHECK(ended->report.at("converged") == true);
    const std::vector<wire::ServerMessage> told = session.told;
    std::uint64_t seq = 0;
    for (const wire::ServerMessage& message : told) {
        std::visit(
            [&](const auto& one) {
                if constexpr (requires { one.seq; }) CHECK(one.seq == ++seq);
            },
            message);
    }
}

TEST_CASE("radii that are led a long way are laid out once, as they will be") {
    const Box box;
    Followed session(box, document_of("layer-to-layer"), at(sim::Fidelity::standard));
    const wire::Layout before = session.all<wire::Layout>().front();
    session.change(wire::Parameters{{.strain = {}, .stiffness_scale = {}, .radius_scale = 0.3}, {}});  // seven parts of the way
    REQUIRE(session.next<wire::Applied>());
    session.run();
    REQUIRE(session.until_rest());
    const std::vector<wire::Layout> layouts = session.all<wire::Layout>();
    REQUIRE(layouts.size() == 2);
    CHECK(session.newest->head.layout == layouts.back().layout);
    CHECK(layouts.back().seq == session.all<wire::Applied>().front().seq + 1);
    const Yarns yarns = read_yarns(session.yarns()).value();
    for (std::size_t y = 0; y < before.yarns.size(); ++y) {
        CHECK(layouts.back().yarns[y].radius_mm == Approx((before.yarns[y].system == System::warp ? 0.3 : 1) * before.yarns[y].radius_mm));
        CHECK(layouts.back().yarns[y].radius_mm == yarns.yarns[y].radius_mm);
    }
}

TEST_CASE("a session goes so many steps, pauses, and goes on as one that never paused") {
    const Box box;
    Followed whole(box, document_of("layer-to-layer"), at(sim::Fidelity::standard)), pieces(box, document_of("layer-to-layer"), at(sim::Fidelity::standard));
    whole.run();
    REQUIRE(whole.until_phase(wire::Phase::at_rest));
    for (const std::uint64_t steps : {1, 3, 10}) {
        pieces.ask(wire::Step{wire::new_request_id(), pieces.number, steps});
        REQUIRE(pieces.until_phase(wire::Phase::paused));
    }
    CHECK(pieces.state().step == 14);
    CHECK(pieces.state().phase == wire::Phase::paused);
    pieces.run();
    std::this_thread::sleep_for(5ms);
    pieces.ask(wire::Pause{wire::new_request_id(), pieces.number});
    pieces.run();
    REQUIRE(pieces.until_phase(wire::Phase::at_rest));
    check_same_yarns(pieces.yarns(), whole.yarns());
}

TEST_CASE("a change that the cloth does not take is told, and changes nothing") {
    const Box box;
    Followed session(box, document_of("plain"), at(sim::Fidelity::draft));
    session.change(wire::Pins{{{true, 500}}});
    const auto applied = session.next<wire::Applied>();
    REQUIRE(applied);
    REQUIRE(applied->error);
    CHECK_THAT(applied->error->message, Catch::Contains("pick 501 is not in the cloth"));
    session.run();
    CHECK(session.until_phase(wire::Phase::at_rest));
}

TEST_CASE("a design that cannot be simulated is refused with its place, and leaves no session behind") {
    const Box box;
    wire::Follower follower = box.follower();
    for (const char* document : {"", "{}", "[1,2", "{\"format\":\"weave\"}"}) {
        INFO(document);
        const auto made = follower.create(document, at(sim::Fidelity::draft), 60s);
        REQUIRE_FALSE(made);
        CHECK(made.error().code != ErrorCode::system);
        CHECK(made.error().where.starts_with("document"));
    }
    wire::Simulation outside = at(sim::Fidelity::draft);
    outside.plan.region = Region{0, 500, 0, 500};
    const auto made = follower.create(document_of("plain"), outside, 60s);
    REQUIRE_FALSE(made);
    CHECK_THAT(made.error().text(), Catch::Contains("region"));
    CHECK(box.status().at("sessions").empty());
}

TEST_CASE("what was asked under an id is done once, whatever number of times and connections it is asked on") {
    const Box box;
    Followed session(box, document_of("plain"), at(sim::Fidelity::draft));
    const wire::Step step{wire::new_request_id(), session.number, 3};
    for (int k = 0; k < 3; ++k) session.ask(step);
    REQUIRE(session.until_phase(wire::Phase::paused));
    std::this_thread::sleep_for(300ms);
    CHECK(session.state().step == 3);
    const wire::MakeChange change{wire::new_request_id(), session.number, tighter};
    for (int k = 0; k < 3; ++k) session.ask(change);
    REQUIRE(session.next<wire::Applied>());
    CHECK_FALSE(session.next<wire::Applied>(500ms));

    auto one = wire::Client::connect(box.place(), "test").value(), other = wire::Client::connect(box.place(), "test").value();
    const wire::Create create{wire::new_request_id(), document_of("plain"), at(sim::Fidelity::draft)};
    const auto made = wire::answer_of<wire::Accepted>(one.ask(create, 60s)), again = wire::answer_of<wire::Accepted>(other.ask(create, 60s));
    REQUIRE(made);
    REQUIRE(again);
    CHECK(made->session == again->session);
    CHECK(box.status().at("sessions").size() == 2);
}

TEST_CASE("a connection that broke gets every event that it missed, and is told of the frames that it will not get") {
    const Box box;
    Followed session(box, document_of("tl013-corrected"), at(sim::Fidelity::draft));
    session.run();
    REQUIRE(session.until_rest());
    session.change(tighter);
    REQUIRE(session.until_rest());
    auto client = wire::Client::connect(box.place(), "test").value();
    const auto attached = wire::answer_of<wire::Accepted>(client.ask(wire::Attach{wire::new_request_id(), session.number, 1, 1}, 10s));
    REQUIRE(attached);
    std::uint64_t seq = 1;
    bool gap = false, frame = false;
    for (auto received = client.receive(500ms); received && *received; received = client.receive(500ms)) {
        if (std::holds_alternative<wire::Frame>(**received)) {
            CHECK(std::get<wire::Frame>(**received).head.number == session.last_frame);
            frame = true;
            continue;
        }
        const auto& message = std::get<wire::ServerMessage>(**received);
        if (const auto* told = std::get_if<wire::Gap>(&message)) {
            gap = true;
            CHECK(told->first == 2);
            CHECK(told->last == session.last_frame - 1);
        }
        std::visit(
            [&](const auto& one) {
                if constexpr (requires { one.seq; }) {
                    CHECK(one.seq > seq);
                    seq = one.seq;
                }
            },
            message);
    }
    CHECK(seq == session.state().seq);
    CHECK(gap);
    CHECK(frame);
}

TEST_CASE("a cloth for which there is no room is refused, with what it needs and what there is") {
    const Box box(Json{{"memory_mib", 90}});
    wire::Follower follower = box.follower();
    const auto never = follower.create(document_of("tl013-corrected"), at(sim::Fidelity::reference), 60s);
    REQUIRE_FALSE(never);
    CHECK(never.error().code == ErrorCode::refused);
    CHECK_THAT(never.error().message, Catch::Contains("90 MiB is all that there is"));
    Followed first(box, document_of("plain"), at(sim::Fidelity::draft)), second(box, document_of("plain"), at(sim::Fidelity::draft));
    const auto later = follower.create(document_of("plain"), at(sim::Fidelity::draft), 60s);
    REQUIRE_FALSE(later);
    CHECK_THAT(later.error().message, Catch::Contains("free now"));
    auto asking = wire::Client::connect(box.place(), "test");
    REQUIRE(asking);
    const auto answer = asking->ask(wire::Create{wire::new_request_id(), document_of("plain"), at(sim::Fidelity::draft)}, 60s);
    REQUIRE(answer);
    const auto* refused = std::get_if<wire::Refused>(&*answer);
    REQUIRE(refused != nullptr);
    CHECK_FALSE(refused->wait_s);  // somebody is attached to each session: nobody knows for how long
    first.ask(wire::Close{wire::new_request_id(), first.number});
    REQUIRE(first.next<wire::Ended>());
    CHECK(follower.create(document_of("plain"), at(sim::Fidelity::draft), 60s));
}

TEST_CASE("one person has only so many sessions, and nobody sees another's") {
    const Box box(Json{{"sessions_per_person", 2}});
    Followed first(box, document_of("plain"), at(sim::Fidelity::draft)), second(box, document_of("plain"), at(sim::Fidelity::draft));
    wire::Follower third = box.follower();
    const auto refused = third.create(document_of("plain"), at(sim::Fidelity::draft), 60s);
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, Catch::Contains("as many as one person may"));
    CHECK_FALSE(third.attach(first.number + 100, 0, 0, 10s));
}

TEST_CASE("steps that are asked for count from where the cloth is, not from where it was told to be") {
    const Box box;
    Followed session(box, document_of("layer-to-layer"), at(sim::Fidelity::reference));
    session.run();
    constexpr std::uint64_t begun = 20, steps = 5;
    REQUIRE(session.until([&](const wire::Received&) { return session.newest && session.newest->head.step >= begun; }));
    session.ask(wire::Pause{wire::new_request_id(), session.number});
    const std::uint64_t seen = session.newest->head.step;
    session.ask(wire::Step{wire::new_request_id(), session.number, steps});
    wire::State state = session.state();
    for (int tries = 0; tries < 600 && (state.phase != wire::Phase::paused || state.step < seen + steps); ++tries) {
        std::this_thread::sleep_for(50ms);
        state = session.state();
    }
    CHECK(state.phase == wire::Phase::paused);
    CHECK(state.step >= seen + steps);
}

TEST_CASE("a session to which nobody is attached ends after a while, and says so to whoever comes back") {
    const Box box(Json{{"expire_seconds", 1}});
    std::uint64_t number = 0;
    {
        Followed session(box, document_of("plain"), at(sim::Fidelity::draft));
        number = session.number;
        std::this_thread::sleep_for(1500ms);
        CHECK(session.state().phase == wire::Phase::paused);  // somebody is attached
    }
    std::this_thread::sleep_for(2500ms);
    auto client = wire::Client::connect(box.place(), "test").value();
    const auto list = wire::answer_of<wire::SessionList>(client.ask(wire::ListSessions{wire::new_request_id()}, 10s)).value();
    REQUIRE(list.sessions.size() == 1);
    CHECK(list.sessions.front().ended == true);
    CHECK((list.sessions.front().left_s.value() > 3500 && list.sessions.front().left_s.value() < 3600));  // an hour, if nobody comes
    REQUIRE(wire::answer_of<wire::Accepted>(client.ask(wire::Attach{wire::new_request_id(), number, 0, 0}, 10s)));
    bool expired = false;
    for (auto received = client.receive(500ms); received && *received && !expired; received = client.receive(500ms)) {
        const auto* message = std::get_if<wire::ServerMessage>(&**received);
        const auto* ended = message == nullptr ? nullptr : std::get_if<wire::Ended>(message);
        expired = ended != nullptr && ended->why == wire::Why::expired;
    }
    CHECK(expired);
}

TEST_CASE("a list tells who looks on, and until when a session stays where nobody does") {
    const Box box(Json{{"expire_seconds", 1000}});
    wire::Follower other = box.follower();
    const auto listed = [&] {
        const auto list = wire::answer_of<wire::SessionList>(other.ask(wire::ListSessions{wire::new_request_id()}, 10s)).value();
        REQUIRE(list.sessions.size() == 1);
        return list.sessions.front();
    };
    {
        Followed session(box, document_of("plain"), at(sim::Fidelity::draft));
        const wire::SessionSummary seen = listed();
        CHECK((seen.attached == 1 && seen.ended == false && !seen.left_s));
    }
    wire::SessionSummary alone = listed();
    for (int tries = 0; alone.attached > 0 && tries < 100; ++tries) std::this_thread::sleep_for(20ms), alone = listed();
    CHECK((alone.attached == 0 && alone.ended == false && alone.left_s.value_or(0) > 900 && alone.left_s.value_or(2000) <= 1000));
}

TEST_CASE("whoever attaches gets all events that are kept, more than one connection may have waiting") {
    const Box box;
    Followed session(box, document_of("plain"), at(sim::Fidelity::draft));
    auto client = wire::Client::connect(box.place(), "test").value();
    // Nobody acknowledges: the follower that made the session is not read from any more.
    constexpr std::size_t changes = 80;
    const wire::Pins pins{std::vector<Pin>(2000, Pin{false, 0})};
    for (std::size_t k = 0; k < changes; ++k) {
        const auto answer = client.ask(wire::MakeChange{wire::new_request_id(), session.number, pins}, 10s);
        REQUIRE(wire::answer_of<wire::Accepted>(answer));
        std::this_thread::sleep_for(35ms);  // a box takes 30 requests a second in the long run
    }
    std::this_thread::sleep_for(1s);
    auto late = wire::Client::connect(box.place(), "test").value();
    REQUIRE(wire::answer_of<wire::Accepted>(late.ask(wire::Attach{wire::new_request_id(), session.number, 0, 0}, 10s)));
    std::uint64_t seq = 0;
    std::size_t applied = 0, bytes = 0;
    for (auto received = late.receive(2s); received && *received; received = late.receive(2s)) {
        const auto* message = std::get_if<wire::ServerMessage>(&**received);
        if (message == nullptr) continue;
        applied += std::holds_alternative<wire::Applied>(*message) ? 1 : 0;
        bytes += wire::write_message(*message).size();
        std::visit(
            [&](const auto& one) {
                if constexpr (requires { one.seq; one.session; }) {
                    CHECK(one.seq == seq + 1);
                    seq = one.seq;
                }
            },
            *message);
    }
    CHECK(applied == changes);
    CHECK(bytes > std::size_t{4} << 20);
}

TEST_CASE("who asks for more in a second than a person could is told to wait, and others are not") {
    const Box box;
    Followed session(box, document_of("plain"), at(sim::Fidelity::draft));
    auto client = wire::Client::connect(box.place(), "test").value();
    std::size_t granted = 0;
    std::optional<wire::Refused> refused;
    for (int k = 0; k < 2000 && !refused; ++k) {
        const auto answer = client.ask(wire::Pause{wire::new_request_id(), session.number}, 10s);
        REQUIRE(answer);
        if (const auto* no = std::get_if<wire::Refused>(&*answer)) refused = *no;
        else ++granted;
    }
    REQUIRE(refused);
    CHECK(granted >= 50);
    CHECK(refused->wait_s);
    CHECK_THAT(refused->error.message, Catch::Contains("too many requests"));
    std::this_thread::sleep_for(1200ms);
    CHECK(wire::answer_of<wire::Accepted>(client.ask(wire::Pause{wire::new_request_id(), session.number}, 10s)));
}
