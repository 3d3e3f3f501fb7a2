// What comes from clients that mean harm or are broken: it is refused, or ends their own connection, and a session that somebody
// else has on the same daemon goes on as if nothing were.

#include "box.hpp"
#include "people.hpp"

#include <weave/net/websocket_client.hpp>

#include <filesystem>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

using namespace weave;
using namespace weave::simd::testing;

namespace {

/// A WebSocket without our client's manners.
class Rude {
  public:
    explicit Rude(const wire::ServerPlace& place) : m_socket(open(place)) {}

    /// False once the connection has ended.
    bool send(const std::string& text, bool binary = false) { return static_cast<bool>(m_socket.send(text, binary)); }
    void greet() {
        send(R"({"client":"rude","type":"hello","versions":[1]})");
        REQUIRE(next().value_or("").find("\"welcome\"") != std::string::npos);
    }
    /// The next message as text; nothing where none comes any more.
    std::optional<std::string> next(std::chrono::milliseconds patience = 60s) {
        auto message = m_socket.receive(patience);
        if (!message || !*message) return {};
        return std::move((*message)->bytes);
    }
    /// Sends, and takes the next message, which is to be a refusal.
    wire::Refused refused(const std::string& text) {
        send(text);
        const auto answer = next();
        INFO(text.substr(0, 200));
        REQUIRE(answer);
        const auto read = wire::read_server_message(*answer);
        INFO(*answer);
        REQUIRE(read);
        REQUIRE(std::holds_alternative<wire::Refused>(*read));
        return std::get<wire::Refused>(*read);
    }
    /// How the connection ends, whatever comes before; 0: not in time.
    int end(std::chrono::milliseconds patience = 60s) {
        const auto late = std::chrono::steady_clock::now() + patience;
        while (std::chrono::steady_clock::now() < late) {
            if (!m_socket.receive(100ms)) break;
        }
        const auto how = m_socket.end();
        return how ? how->code : 0;
    }

  private:
    static net::WebSocketClient open(const wire::ServerPlace& place) {
        net::Headers headers;
        if (!place.token.empty()) headers.set("Authorization", "Bearer " + place.token);
        auto socket = net::WebSocketClient::connect(place.options, "/api/v1/wire", headers);
        INFO((socket ? "" : socket.error().text()));
        REQUIRE(socket);
        return std::move(*socket);
    }
    net::WebSocketClient m_socket;
};

/// A session that nothing of this is to harm.
class Bystander {
  public:
    explicit Bystander(const Box& box) : m_session(box, document_of("plain"), at(sim::Fidelity::draft)) {}
    /// It takes steps, tells of them, and has lost no event.
    void check_unharmed() {
        for (int k = 0; k < 2; ++k) {
            m_session.ask(wire::Step{wire::new_request_id(), m_session.number, 1});
            REQUIRE(m_session.until_phase(wire::Phase::paused, 60s));
        }
        std::uint64_t seq = 0;
        for (const wire::ServerMessage& message : m_session.told) {
            std::visit(
                [&](const auto& one) {
                    if constexpr (requires { one.seq; one.step; one.session; } && !std::is_same_v<std::decay_t<decltype(one)>, wire::State>) CHECK(one.seq == ++seq);
                    if constexpr (std::is_same_v<std::decay_t<decltype(one)>, wire::Layout>) CHECK(one.seq == ++seq);
                    CHECK_FALSE((std::is_same_v<std::decay_t<decltype(one)>, wire::Recovered>));
                },
                message);
        }
        CHECK(m_session.state().seq == seq);
    }
    Followed& session() { return m_session; }

  private:
    Followed m_session;
};

/// A bare socket, for bytes that are no HTTP.
class Bare {
  public:
    explicit Bare(const std::filesystem::path& path) : m_socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_un place{};
        place.sun_family = AF_UNIX;
        path.native().copy(place.sun_path, sizeof place.sun_path - 1);
        m_connected = ::connect(m_socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
    }
    ~Bare() { ::close(m_socket); }
    Bare(const Bare&) = delete;
    Bare& operator=(const Bare&) = delete;
    [[nodiscard]] bool connected() const { return m_connected; }
    void send(std::string_view bytes) const { static_cast<void>(::send(m_socket, bytes.data(), bytes.size(), MSG_NOSIGNAL)); }

  private:
    int m_socket;
    bool m_connected = false;
};

std::filesystem::path socket_of(const Box& box) {
    return box.folder() / "simd.sock";
}

std::string open_wire(const char* more) {
    return std::string("GET /api/v1/wire HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                       "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n") +
           more;
}

std::size_t descriptors(pid_t process) {
    const std::filesystem::directory_iterator begin("/proc/" + std::to_string(process) + "/fd"), end;
    return static_cast<std::size_t>(std::distance(begin, end));
}

/// The processes that one has started, once there are so many (or after a minute, those that there are).
std::vector<pid_t> children(pid_t process, std::size_t number) {
    std::vector<pid_t> found;
    for (int k = 0; k < 6000; ++k) {
        found.clear();
        for (const auto& thread : std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
            std::ifstream list(thread.path() / "children");
            for (pid_t child = 0; list >> child;) found.push_back(child);
        }
        if (found.size() >= number) break;
        std::this_thread::sleep_for(10ms);
    }
    return found;
}

std::string list_jobs(const std::string& request) {
    return wire::write_message(wire::ClientMessage(wire::ListJobs{request}));
}

std::string nested(std::size_t levels) {
    return std::string(levels, '[') + std::string(levels, ']');
}

/// Waits until it is so, for a minute at most.
bool comes_true(const std::function<bool()>& it) {
    for (int k = 0; k < 600; ++k) {
        if (it()) return true;
        std::this_thread::sleep_for(100ms);
    }
    return it();
}

}  // namespace

TEST_CASE("what is no message is refused or ends its own connection, and a session beside it goes on") {
    const Box box;
    Bystander bystander(box);
    Rude silent(box.place());  // its ten seconds pass meanwhile
    std::vector<std::unique_ptr<Bare>> half_open;
    for (const std::string& bytes : {std::string(), std::string("GET /api/v1/wi"), open_wire(""), open_wire("\r\n"), open_wire("\r\n\x81"),
                                     open_wire("\r\n\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff"), std::string(100, '\0')}) {
        half_open.push_back(std::make_unique<Bare>(socket_of(box)));
        REQUIRE(half_open.back()->connected());
        half_open.back()->send(bytes);
    }
    SECTION("text that is no message") {
        Rude rude(box.place());
        rude.greet();
        for (const std::string& text :
             {std::string("garbage"), std::string(), std::string("{}"), std::string("null"), std::string("{\"type\":\"no such\"}"),
              std::string("{\"type\":\"list_jobs\",\"request\":\"abcdefgh\",\"more\":1}"), std::string(R"({"request":"short","type":"list_jobs"})"),
              std::string("{\"type\":\"list_jobs\",\"type\":\"list_jobs\",\"request\":\"abcdefgh\"}"), std::string(R"({"request":"abcdefgh","type":"list_jobs"} x)"),
              nested(64), nested(65), nested(1'000'000), std::string(16 << 20, ' '), std::string(R"({"client":"x","type":"hello","versions":[1]})"),
              std::string(R"({"request":"abcdefgh","session":18446744073709551616,"type":"run"})"), std::string(R"({"request":"abcdefgh","session":9007199254740992,"type":"run"})"),
              std::string(R"({"request":"abcdefgh","session":0,"type":"run"})"), std::string(R"({"request":"abcdefgh","session":-1,"type":"run"})"),
              std::string(R"({"request":"abcdefgh","session":1.5,"type":"run"})"), std::string(R"({"request":"abcdefgh","session":1e400,"type":"run"})")})
            CHECK(!rude.refused(text).error.message.empty());
        const wire::Refused refused = rude.refused(R"({"request":"abcdefgh","type":"no such"})");
        CHECK(refused.request == "abcdefgh");
        rude.send(list_jobs("abcdefgh"));
        CHECK(rude.next().value_or("").find("\"jobs\"") != std::string::npos);  // and is served
    }
    SECTION("a hundred messages that cannot be read") {
        Rude rude(box.place());
        rude.greet();
        for (int k = 0; k < 99; ++k) rude.refused("garbage");
        rude.send(list_jobs("abcdefgh"));
        CHECK(rude.next().value_or("").find("\"jobs\"") != std::string::npos);
        rude.send("garbage");
        CHECK(rude.end() == 1008);
    }
    SECTION("what ends a connection") {
        Rude binary(box.place()), foreign(box.place()), large(box.place()), torn(box.place()), old(box.place()), none(box.place()), hasty(box.place());
        binary.greet();
        binary.send("WVFR", true);
        CHECK(binary.end() == 1003);
        foreign.send("\xff\xfe");
        CHECK(foreign.end() == 1007);
        large.greet();
        large.send(std::string(wire::most_client_bytes + 1, ' '));
        const int too_large = large.end();
        CHECK((too_large == 1009 || too_large == 1006));  // where it still sends, the network may lose the farewell
        CHECK(torn.refused("{").error.code == ErrorCode::bad_input);
        CHECK(torn.end() == 1002);
        old.send(R"({"client":"rude","type":"hello","versions":[2,3,9007199254740991]})");
        CHECK(old.next() == R"({"type":"unsupported","versions":[1]})");
        CHECK(old.end() == 1002);
        none.send(R"({"client":"rude","type":"hello","versions":[]})");
        CHECK(none.end() == 1002);
        // No second try on the same connection, and nothing is served before a hello.
        hasty.send(list_jobs("abcdefgh"));
        hasty.send(R"({"client":"rude","type":"hello","versions":[1]})");
        hasty.send(list_jobs("abcdefgi"));
        const std::string answer = hasty.next().value_or("");
        CHECK(answer.find("the first message is hello") != std::string::npos);
        for (auto more = hasty.next(2s); more; more = hasty.next(2s)) {
            CHECK(more->find("welcome") == std::string::npos);
            CHECK(more->find("\"jobs\"") == std::string::npos);
        }
        CHECK(hasty.end() == 1002);
    }
    CHECK(silent.end() == 1002);
    bystander.check_unharmed();
}

TEST_CASE("who is thrown out for the second time waits before the next connection, and nobody else does") {
    const People people;
    const auto thrown_out = [&](const wire::ServerPlace& place) {
        Rude rude(place);
        rude.greet();
        for (int k = 0; k < 100; ++k) rude.send("garbage");
        CHECK(rude.end() == 1008);
    };
    thrown_out(people.place("mallory"));
    thrown_out(people.place("mallory"));
    const auto refused = wire::Client::connect(people.place("mallory"), "test");
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::system);  // which passes, so a follower tries again
    CHECK(refused.error().message.find("wait a little") != std::string::npos);
    CHECK(wire::Client::connect(people.place("dora"), "test"));
    for (int k = 0; k < 3; ++k) thrown_out(people.box().place());  // the machine's owner
    CHECK(wire::Client::connect(people.box().place(), "test"));
    CHECK(comes_true([&] { return bool(wire::Client::connect(people.place("mallory"), "test")); }));
}

TEST_CASE("what others have is, for a stranger, as if it were not there") {
    const People people;
    Followed owned(people.follower("dora"), document_of("plain"), at(sim::Fidelity::draft));
    auto dora = wire::Client::connect(people.place("dora"), "test").value(), abel = wire::Client::connect(people.place("abel"), "test").value();
    const auto submitted = wire::answer_of<wire::Accepted>(dora.ask(wire::Submit{"the-same-id", document_of("plain"), at(sim::Fidelity::draft), {}}, 60s));
    REQUIRE(submitted);
    const std::uint64_t session = owned.number, job = submitted->job.value();
    const auto words = [](std::string text, std::uint64_t number) {
        const std::string digits = " " + std::to_string(number);
        for (auto found = text.find(digits); found != std::string::npos; found = text.find(digits)) text.replace(found, digits.size(), " N");
        return text;
    };
    const auto answer = [&](const wire::ClientMessage& message, std::uint64_t number) {
        const auto told = abel.ask(message, 60s);
        REQUIRE(told);
        const auto* refused = std::get_if<wire::Refused>(&*told);
        INFO(wire::write_message(*told));
        REQUIRE(refused != nullptr);
        return words(refused->error.text(), number);
    };
    constexpr std::uint64_t most = (std::uint64_t{1} << 53) - 1;
    for (const std::uint64_t other : {std::uint64_t{987654}, most}) {
        const auto same = [&](const auto& make) { CHECK(answer(make(session), session) == answer(make(other), other)); };
        same([](std::uint64_t n) { return wire::Attach{wire::new_request_id(), n, 0, 0}; });
        same([](std::uint64_t n) { return wire::Run{wire::new_request_id(), n}; });
        same([](std::uint64_t n) { return wire::Pause{wire::new_request_id(), n}; });
        same([](std::uint64_t n) { return wire::Step{wire::new_request_id(), n, most}; });
        same([](std::uint64_t n) { return wire::MakeChange{wire::new_request_id(), n, wire::Pins{}}; });
        same([](std::uint64_t n) { return wire::ReadState{wire::new_request_id(), n}; });
        same([](std::uint64_t n) { return wire::Checkpoint{wire::new_request_id(), n}; });
        same([](std::uint64_t n) { return wire::Close{wire::new_request_id(), n}; });
        same([](std::uint64_t n) { return wire::WantFrames{wire::new_request_id(), n, 1000}; });
        CHECK(answer(wire::Cancel{wire::new_request_id(), job}, job) == answer(wire::Cancel{wire::new_request_id(), other}, other));
        const auto file = [&](const std::string& target, std::uint64_t number) {
            const auto bytes = wire::download(people.place("abel"), target, 1 << 20);
            REQUIRE_FALSE(bytes);
            return words(bytes.error().text(), number);
        };
        CHECK(file(wire::session_yarns(session), session) == file(wire::session_yarns(other), other));
        CHECK(file(wire::job_yarns(job), job) == file(wire::job_yarns(other), other));
        CHECK(file(wire::job_evidence(job), job) == file(wire::job_evidence(other), other));
    }
    for (const char* target : {"/api/v1/sessions/0/yarns", "/api/v1/sessions/-1/yarns", "/api/v1/sessions/18446744073709551617/yarns",
                               "/api/v1/sessions/1%2f..%2f2/yarns", "/api/v1/jobs/%00/yarns", "/api/v1/jobs/1e0/evidence"})
        CHECK_FALSE(wire::download(people.place("dora"), target, 1 << 20));
    // What changes nothing of others' is not answered at all, and the same id means somebody else's request.
    REQUIRE(abel.send(wire::Acknowledge{session, most}));
    REQUIRE(abel.send(wire::AcknowledgeJob{job}));
    const auto own = wire::answer_of<wire::Accepted>(abel.ask(wire::Submit{"the-same-id", document_of("plain"), at(sim::Fidelity::draft), {}}, 60s));
    REQUIRE(own);
    CHECK(own->job != job);
    CHECK(wire::answer_of<wire::JobList>(abel.ask(wire::ListJobs{wire::new_request_id()}, 60s)).value().jobs.size() == 1);
    CHECK(wire::answer_of<wire::SessionList>(abel.ask(wire::ListSessions{wire::new_request_id()}, 60s)).value().sessions.empty());
    // The owner's numbers at their limits.
    CHECK_FALSE(wire::answer_of<wire::Accepted>(dora.ask(wire::Attach{wire::new_request_id(), session, most, 0}, 60s)));
    CHECK_FALSE(wire::answer_of<wire::Accepted>(dora.ask(wire::Attach{wire::new_request_id(), session, 0, most}, 60s)));
    owned.ask(wire::WantFrames{wire::new_request_id(), session, 1e-300});
    owned.ask(wire::WantFrames{wire::new_request_id(), session, 1000});
    REQUIRE(dora.send(wire::Acknowledge{session, most}));
    owned.ask(wire::Step{wire::new_request_id(), session, most});
    REQUIRE(owned.until_phase(wire::Phase::at_rest));
    owned.ask(wire::Step{wire::new_request_id(), session, most});
    CHECK(owned.state().phase == wire::Phase::at_rest);
}

TEST_CASE("a connection serves one session, also to who asks for two at once") {
    const Box box;
    Rude rude(box.place());
    rude.greet();
    const std::string document = document_of("plain");
    const auto create = [&](const char* request) { return wire::write_message(wire::ClientMessage(wire::Create{request, document, at(sim::Fidelity::draft)})); };
    for (const char* request : {"create-1", "create-2", "create-1", "create-1"}) rude.send(create(request));
    std::size_t accepted = 0, refused = 0, layouts = 0;
    for (auto text = rude.next(20s); text; text = rude.next(3s)) {
        const auto read = wire::read_server_message(*text);
        if (!read) continue;  // a frame
        if (const auto* made = std::get_if<wire::Accepted>(&*read)) {
            CHECK(made->request == "create-1");
            ++accepted;
        }
        if (const auto* no = std::get_if<wire::Refused>(&*read)) {
            CHECK(no->request == "create-2");
            ++refused;
        }
        layouts += std::holds_alternative<wire::Layout>(*read) ? 1 : 0;
    }
    CHECK(accepted == 3);
    CHECK(refused == 1);
    CHECK(layouts == 1);  // each event once
    CHECK(box.status().at("sessions").size() == 1);
    // Nor by attaching while the first is still being planned.
    Followed other(box, document, at(sim::Fidelity::draft));
    Rude both(box.place());
    both.greet();
    both.send(create("create-3"));
    both.send(wire::write_message(wire::ClientMessage(wire::Attach{"attach-1", other.number, 0, 0})));
    std::size_t granted = 0;
    for (auto text = both.next(20s); text; text = both.next(3s)) {
        const auto read = wire::read_server_message(*text);
        granted += read && std::holds_alternative<wire::Accepted>(*read) ? 1 : 0;
    }
    CHECK(granted == 1);
}

TEST_CASE("who reads nothing loses frames and nothing else, and is closed only for what must arrive") {
    const Box box(Json{{"threads", 1}});
    Followed watcher(box, document_of("tl013-corrected"), at(sim::Fidelity::standard));
    Rude slow(box.place()), idle(box.place());
    slow.greet();
    idle.greet();
    slow.send(wire::write_message(wire::ClientMessage(wire::Attach{"attach-1", watcher.number, 0, 0})));
    slow.send(wire::write_message(wire::ClientMessage(wire::WantFrames{"frames-1", watcher.number, 1000})));
    watcher.ask(wire::WantFrames{wire::new_request_id(), watcher.number, 1000});
    watcher.run();
    REQUIRE(watcher.until_rest());  // frames numbered upwards, and the last one
    const std::uint64_t last = watcher.last_frame;
    std::uint64_t events = 0, newest = 0, frames = 0;
    for (auto text = slow.next(20s); text; text = slow.next(2s)) {
        if (!text->starts_with("WVFR")) {
            events += text->find("\"seq\":") != std::string::npos ? 1 : 0;
            continue;
        }
        const auto frame = wire::decode_frame({text->data(), text->size()});
        REQUIRE(frame);
        CHECK(frame->head.number > newest);
        newest = frame->head.number;
        ++frames;
    }
    CHECK(newest == last);
    CHECK(frames <= last);
    CHECK(events == watcher.state().seq);
    // Answers are no frames: who asks on and on and reads nothing is sent away.
    const std::string ask = wire::write_message(wire::ClientMessage(wire::ReadState{"state-01", watcher.number}));
    for (int k = 0; k < 60'000 && idle.send(ask); ++k) {}
    const int code = idle.end();
    CHECK((code == 1013 || code == 1006));
    CHECK(watcher.state().phase == wire::Phase::at_rest);
}

TEST_CASE("who waits for files of a session that does not answer keeps nobody else waiting") {
    const People people(Json{{"workers", 4}});
    Followed stuck(people.follower("dora"), document_of("plain"), at(sim::Fidelity::draft)), other(people.follower("abel"), document_of("plain"), at(sim::Fidelity::draft));
    const pid_t worker = people.box().worker("session", stuck.number).value();
    REQUIRE(::kill(worker, SIGSTOP) == 0);
    std::vector<std::jthread> askers;
    for (int k = 0; k < 20; ++k) {
        askers.emplace_back([&, place = people.place("dora")] { static_cast<void>(wire::download(place, wire::session_yarns(stuck.number), 1 << 24)); });
    }
    std::this_thread::sleep_for(500ms);
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < 3; ++k) {
        other.ask(wire::Step{wire::new_request_id(), other.number, 1});
        CHECK(other.until_phase(wire::Phase::paused, 30s));
    }
    CHECK(other.yarns().size() > 100);
    CHECK(std::chrono::steady_clock::now() - begin < 30s);  // they wait for a minute
    REQUIRE(::kill(worker, SIGCONT) == 0);
}

TEST_CASE("designs that are planned for ever keep others waiting for seconds, and are given up") {
    const People people(Json{{"stall_seconds", 20}});
    const std::string large = document_of("shoe-adult");
    std::vector<wire::Client> hostile;
    for (int k = 0; k < 6; ++k) {
        hostile.push_back(wire::Client::connect(people.place("dora"), "test").value());
        REQUIRE(hostile.back().send(wire::Create{wire::new_request_id(), large, at(sim::Fidelity::standard)}));
    }
    const std::vector<pid_t> workers = children(people.box().process(), 2);
    for (const pid_t worker : workers) REQUIRE(::kill(worker, SIGSTOP) == 0);
    REQUIRE(workers.size() == 2);  // so many plan at once
    auto abel = wire::Client::connect(people.place("abel"), "test").value();
    CHECK(wire::answer_of<wire::Accepted>(abel.ask(wire::Create{wire::new_request_id(), document_of("plain"), at(sim::Fidelity::draft)}, 120s)));
    CHECK(children(people.box().process(), 3).size() == 3);  // dora's others wait for her first two
    for (std::size_t k = 0; k < 2; ++k) {
        bool refused = false;
        for (int tries = 0; tries < 60 && !refused; ++tries) {
            const auto received = hostile[k].receive(1s);
            REQUIRE(received);
            const auto* message = *received ? std::get_if<wire::ServerMessage>(&**received) : nullptr;
            const auto* no = message == nullptr ? nullptr : std::get_if<wire::Refused>(message);
            refused = no != nullptr && no->error.message.find("planned for 20 s") != std::string::npos;
        }
        CHECK(refused);
    }
    abel = wire::Client::connect(people.place("abel"), "test").value();
    CHECK(wire::answer_of<wire::Accepted>(abel.ask(wire::Create{wire::new_request_id(), document_of("plain"), at(sim::Fidelity::draft)}, 120s)));
}

TEST_CASE("thousands of connections, one after another and at once, leave nothing behind") {
    const Box box;
    Bystander bystander(box);
    bystander.check_unharmed();
    const std::size_t before = descriptors(box.process());
    for (int k = 0; k < 10'000; ++k) {
        const Bare bare(socket_of(box));
        if (k % 3 == 1) bare.send("GET / HTTP/1.1\r\n");
        if (k % 3 == 2) bare.send(open_wire("\r\n\x81\x80"));
    }
    for (int k = 0; k < 300; ++k) {
        Rude rude(box.place());
        if (k % 2 == 0) rude.greet();
    }
    bystander.check_unharmed();
    {
        std::vector<std::unique_ptr<Bare>> many;
        for (int k = 0; k < 600; ++k) {
            many.push_back(std::make_unique<Bare>(socket_of(box)));
            if (many.back()->connected()) many.back()->send(open_wire("\r\n"));
        }
        bystander.check_unharmed();
        CHECK(descriptors(box.process()) < before + 400);  // one person's are bounded
    }
    CHECK(comes_true([&] { return descriptors(box.process()) <= before; }));
    CHECK(box.status().at("clients") == 1);
    bystander.check_unharmed();
}

TEST_CASE("a design as large as a message may be, or as deep, is planned or refused like any other") {
    const Box box;
    Bystander bystander(box);
    auto client = wire::Client::connect(box.place(), "test").value();
    const auto create = [&](const std::string& document) {
        return wire::answer_of<wire::Accepted>(client.ask(wire::Create{wire::new_request_id(), document, at(sim::Fidelity::draft)}, 120s));
    };
    const std::size_t room = wire::most_client_bytes - 4096;
    CHECK_FALSE(create(nested(64)));
    CHECK_FALSE(create(nested(1'000'000)));
    CHECK_FALSE(create(std::string(room / 2 - 10, '"')));
    CHECK_FALSE(create(std::string(room / 6, '\x01')));
    std::string all;
    for (std::size_t k = 0; all.size() < room / 2; ++k) all += (k == 0 ? "[[" : ",[") + std::to_string(k) + "]";
    CHECK_FALSE(create(all + "]"));
    std::string padded = document_of("plain");
    padded.insert(1, std::string(room - 2 * padded.size(), ' '));
    CHECK(create(padded));
    bystander.check_unharmed();
    for (const std::string& document : {nested(64), std::string(room / 2 - 10, '"'), all})
        CHECK_FALSE(wire::answer_of<wire::Accepted>(client.ask(wire::Submit{wire::new_request_id(), document, at(sim::Fidelity::draft), {}}, 60s)));
    bystander.check_unharmed();
}
