#include <weave/wire/mill_client.hpp>
#include <weave/wire/mill_designs.hpp>
#include <weave/wire/mill_sign_in.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <atomic>
#include <chrono>
#include <netinet/in.h>
#include <support/temporary_folder.hpp>
#include <sys/socket.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

using namespace weave;
using weave::testing::TemporaryFolder;

namespace {

/// Takes connections, and by itself never reads.
class Listener {
  public:
    Listener() {
        m_socket = ::socket(AF_INET, SOCK_STREAM, 0);
        struct sockaddr_in place {};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof place;
        auto* const address = reinterpret_cast<struct sockaddr*>(&place);
        REQUIRE(::bind(m_socket, address, size) == 0);
        REQUIRE(::listen(m_socket, 8) == 0);
        REQUIRE(::getsockname(m_socket, address, &size) == 0);
        m_port = ntohs(place.sin_port);
    }
    ~Listener() { ::close(m_socket); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;
    [[nodiscard]] std::string origin() const { return "http://127.0.0.1:" + std::to_string(m_port); }

  protected:
    int m_socket = -1;

  private:
    std::uint16_t m_port = 0;
};

/// A server that answers one connection after another as it is told: an empty answer breaks it off.
class ScriptedServer : public Listener {
  public:
    explicit ScriptedServer(std::vector<std::string> answers)
        : m_thread([this, answers = std::move(answers)] {
              for (const std::string& answer : answers) serve_one(answer);
          }) {}
    ~ScriptedServer() {
        ::shutdown(m_socket, SHUT_RDWR);
        m_thread.join();
    }
    ScriptedServer(const ScriptedServer&) = delete;
    ScriptedServer& operator=(const ScriptedServer&) = delete;

    /// The bodies that came.
    std::vector<std::string> bodies;

  private:
    void serve_one(const std::string& answer) {
        const int connection = ::accept(m_socket, nullptr, nullptr);
        if (connection < 0) return;
        std::string request;
        std::array<char, 4096> piece{};
        const auto whole = [&] {
            const bool has_body = request.starts_with("POST");
            return request.find(has_body ? "}" : "\r\n\r\n") != std::string::npos;
        };
        while (!whole()) {
            const auto got = ::read(connection, piece.data(), piece.size());
            if (got <= 0) break;
            request.append(piece.data(), static_cast<std::size_t>(got));
        }
        bodies.push_back(request.substr(request.find("\r\n\r\n") + 4));
        const auto sent = ::write(connection, answer.data(), answer.size());
        static_cast<void>(sent);
        ::close(connection);
    }

    std::thread m_thread;
};

std::string http(const std::string& status, const std::string& body) {
    return "HTTP/1.1 " + status + "\r\nContent-Length: " + std::to_string(body.size()) +
           "\r\nConnection: close\r\n\r\n" + body;
}

wire::MillClient client_of(const ScriptedServer& server) {
    return wire::MillClient::of(wire::MillSession{server.origin(), {}, "dora", "token", {}}).value();
}

}  // namespace

TEST_CASE("a change is asked for again under its own id when the connection breaks or the server is busy",
          "[mill]") {
    ScriptedServer server(
        {"", http("503 Service Unavailable", "{}"), http("200 OK", R"({"state":"submitted"})")});
    wire::MillClient client = client_of(server);
    const auto answer = client.post("/designs/shoe/revisions/1/submit", {{"reason", "x"}});
    REQUIRE(answer);
    CHECK(answer->at("state") == "submitted");
    REQUIRE(server.bodies.size() == 3);
    CHECK(server.bodies[1] == server.bodies[0]);
    CHECK(server.bodies[2] == server.bodies[0]);
    const auto id = parse_json(server.bodies[0]).value().at("request").get<std::string>();
    CHECK(id.size() >= 8);
}

TEST_CASE("where an earlier try may have been recorded nobody is told that nothing was", "[mill]") {
    const std::string away = http("503 Service Unavailable", R"({"error":{"kind":"system","message":"nothing was recorded"}})");
    for (const std::string& first : {std::string(), http("504 Gateway Timeout", "{}")}) {
        ScriptedServer server({first, away, away});
        const auto answer = client_of(server).post("/designs", {{"name", "x"}});
        REQUIRE_FALSE(answer);
        CHECK(answer.error().code == ErrorCode::system);
        CHECK_THAT(answer.error().text(), Catch::Contains("may have been recorded") && Catch::Contains("look before you repeat it"));
        CHECK(server.bodies.size() == 3);
    }
    ScriptedServer server({away, away, away});
    CHECK(client_of(server).post("/designs", {{"name", "x"}}).error().message == "nothing was recorded");
}

TEST_CASE("what a server answers is believed for what it is, and nothing more", "[mill]") {
    struct Case {
        std::string answer;
        ErrorCode code;
        std::string says;
    };
    const std::vector<Case> cases{
        {http("409 Conflict", R"({"error":{"kind":"refused","where":"conflict","message":"too late"}})"),
         ErrorCode::refused, "me: too late"},
        {http("422 Unprocessable Content", R"({"error":{"kind":"invalid","where":"x","message":"no"}})"),
         ErrorCode::invalid, "x: no"},
        {http("400 Bad Request", R"({"error":{"kind":"bad input","where":"name","message":"is missing"}})"),
         ErrorCode::bad_input, "name: is missing"},
        {http("401 Unauthorized", R"({"error":{"kind":"refused","where":"","message":"sign in first"}})"),
         ErrorCode::refused, "sign in first"},
        {http("502 Bad Gateway", "<html>"), ErrorCode::system, "502"},
        {http("404 Not Found", "[1]"), ErrorCode::bad_input, "404"},
        {http("403 Forbidden", R"({"error":{"kind":7,"where":[],"message":{}}})"), ErrorCode::bad_input,
         "403"},
        {http("403 Forbidden", R"({"error":"no"})"), ErrorCode::bad_input, "403"},
        {http("200 OK", "[1]"), ErrorCode::bad_input, "no JSON object"},
        {http("200 OK", "nothing"), ErrorCode::bad_input, "no JSON object"},
    };
    for (const Case& one : cases) {
        ScriptedServer server({one.answer});
        wire::MillClient client = client_of(server);
        const auto answer = client.change("POST", "/me", {{"x", 1}});
        INFO(one.answer);
        REQUIRE_FALSE(answer);
        CHECK(answer.error().code == one.code);
        CHECK_THAT(answer.error().text(), Catch::Contains(one.says));
    }
}

TEST_CASE("an error names what was asked for as people write it", "[mill]") {
    ScriptedServer server(
        {http("404 Not Found", R"({"error":{"kind":"refused","message":"is not there"}})")});
    wire::MillClient client = client_of(server);
    const auto answer = client.change("POST", wire::mill_path({"looms", "EP 1", "releases"}), {{"x", 1}});
    REQUIRE_FALSE(answer);
    CHECK(answer.error().text() == "looms/EP 1/releases: is not there");
}

TEST_CASE("bytes beyond what was asked for are refused", "[mill]") {
    ScriptedServer server({http("200 OK", "12345678}")});
    wire::MillClient client = client_of(server);
    const auto bytes = client.get_bytes("/looms/x/releases/1/files/a", 4);
    REQUIRE_FALSE(bytes);
    CHECK(bytes.error().code == ErrorCode::bad_input);
}

TEST_CASE("a path is what was meant, whatever a name holds", "[mill]") {
    CHECK(wire::mill_path({"looms", "EP 1/../x", "index"}) == "/looms/EP%201%2F..%2Fx/index");
}

TEST_CASE("a call that is given up between two tries is not made again", "[mill]") {
    ScriptedServer server({http("503 Service Unavailable", "{}")});
    wire::MillClient client = client_of(server);
    client.report_to(
        [](std::size_t, std::size_t of) { return of > 0; });  // nothing is under way between two tries
    const auto answer = client.post("/designs", {{"name", "x"}});
    REQUIRE_FALSE(answer);
    CHECK_THAT(answer.error().text(), Catch::Contains("given up"));
    CHECK(server.bodies.size() == 1);
}

TEST_CASE("a silent server is left when the caller gives up", "[mill]") {
    Listener server;
    wire::MillClient client = wire::MillClient::of({server.origin(), {}, "dora", "token", {}}).value();
    std::atomic<bool> gives_up{false};
    std::size_t most_sent = 0, whole = 0;
    client.report_to([&](std::size_t sent, std::size_t of) {
        most_sent = std::max(most_sent, sent);
        whole = of;
        gives_up = true;
        return false;
    });
    const auto answer = client.post("/designs", {{"name", std::string(std::size_t{40} << 20, 'x')}});
    REQUIRE_FALSE(answer);
    CHECK(answer.error().code == ErrorCode::refused);
    CHECK_THAT(answer.error().text(), Catch::Contains("given up"));
    CHECK(whole > (std::size_t{40} << 20));
    CHECK(most_sent < whole);
}

// ---- Designs ----

TEST_CASE("the history of a design says where a branch stands and where a new one starts", "[mill]") {
    const std::string body = R"({"name":"shoe","branches":[{"name":"main","head":2},{"name":"red","head":3}],
        "revisions":[{"number":3,"state":"draft","author":"Dora","at":"2026-11-27T08:00:00.000Z","message":"Red","sha256":"x","parents":[2]},
                     {"number":2,"state":"approved"}],"releases":[{"loom":"EP 1","number":1,"state":"released","revision":2}]})";
    ScriptedServer server({http("200 OK", body)});
    wire::MillClient client = client_of(server);
    const auto history = wire::history_of(client, "shoe");
    REQUIRE(history);
    CHECK(history->head_of("red") == 3);
    CHECK(history->head_of("main") == 2);
    CHECK(history->head_of("new") == 2);
    REQUIRE(history->revisions.size() == 2);
    CHECK(history->revisions[0].message == "Red");
    CHECK(history->revisions[1].author.empty());
    CHECK(history->releases == std::vector<wire::MillRelease>{{"EP 1", "released", 1, 2}});
    CHECK_FALSE(wire::MillHistory().head_of("main"));
}

TEST_CASE("a review is read for what it says; what is not there is empty", "[mill]") {
    const std::string body =
        R"({"design":"shoe","number":3,"state":"submitted","author":"dora","author_name":"Dora Dill","picks":8,"ends":4,
        "missing":["1 approval"],"may":["comment",7],"submission":{"by":"Dora","at":"s","reason":"Ready"},"decisions":[{"what":"approved","by":"Abel","at":"t","reason":"Fine"}],
        "comments":[{"by":"Abel","at":"t","text":"Here","pick":3}],"evidence":[{"kind":"simulation","covers":"all","result":"draft","signer":"box","at":"t","stale":null}]})";
    ScriptedServer server({http("200 OK", body)});
    wire::MillClient client = client_of(server);
    const auto review = wire::review_of(client, "shoe", 3);
    REQUIRE(review);
    CHECK(review->revision.author == "Dora Dill");
    CHECK(review->allows("comment"));
    CHECK_FALSE(review->allows("submit"));
    CHECK(review->comments.at(0).pick == 3);
    CHECK_FALSE(review->comments.at(0).end);
    CHECK(review->evidence.at(0).stale.empty());
    CHECK(review->decisions.at(0).reason == "Fine");
    CHECK(review->submission == wire::MillDecision{"submitted", "Dora", "s", "Ready"});
}

TEST_CASE("an answer without what it must have is no answer", "[mill]") {
    for (const char* body :
         {R"({})", R"({"designs":7})", R"({"designs":[{"newest":null}]})", R"({"designs":[7]})"}) {
        ScriptedServer server({http("200 OK", body)});
        wire::MillClient client = client_of(server);
        const auto designs = wire::list_designs(client);
        INFO(body);
        REQUIRE_FALSE(designs);
        CHECK(designs.error().code == ErrorCode::bad_input);
    }
}

TEST_CASE("what is saved and submitted is sent as the API asks for it", "[mill]") {
    ScriptedServer server({http("200 OK", R"({"number":4})"), http("200 OK", R"({"state":"submitted"})"),
                           http("200 OK", R"({"at":"t"})")});
    wire::MillClient client = client_of(server);
    REQUIRE(wire::save_revision(client, "shoe", {"text", "main", 3, "Why", {}}));
    REQUIRE(wire::submit_revision(client, "shoe", 4, "Ready", {}, "secret"));
    REQUIRE(wire::comment_on(client, "shoe", 4, "Here", 12));
    const auto check_sent = [&](std::size_t k, const Json& expected) {
        Json body = parse_json(server.bodies.at(k)).value();
        body.erase("request");
        CHECK(canonical_json(body) == canonical_json(expected));
    };
    check_sent(0, {{"document", "text"}, {"branch", "main"}, {"expected", 3}, {"message", "Why"}});
    check_sent(1, {{"reason", "Ready"}, {"password", "secret"}});
    check_sent(2, {{"text", "Here"}, {"pick", 12}});
}

// ---- Sessions ----

TEST_CASE("a session is kept for its owner alone, and none is there before", "[mill]") {
    const TemporaryFolder folder;
    const auto file = folder.path / "deep" / "session.json";
    CHECK(wire::load_session(file).value().origin.empty());
    REQUIRE(wire::save_session(file, {"https://mill:8443", std::string(64, 'a'), "dora", "token", "site"}));
    const auto kept = wire::load_session(file).value();
    CHECK(kept.origin == "https://mill:8443");
    CHECK(kept.token == "token");
    CHECK(kept.site == "site");
    REQUIRE(::chmod(file.c_str(), 0644) == 0);
    const auto open = wire::load_session(file);
    REQUIRE_FALSE(open);
    CHECK(open.error().code == ErrorCode::refused);
}

TEST_CASE("plain HTTP goes to this machine alone, and a fingerprint belongs to TLS", "[mill]") {
    CHECK(wire::client_options({"http://127.0.0.1:1", {}, {}, {}, {}}));
    CHECK(wire::client_options({"http://mill:1", {}, {}, {}, {}}).error().code == ErrorCode::refused);
    for (const char* stranger : {"http://127.0.0.1.evil.example:1", "http://127.evil.example:1", "http://127.0.0.1a:1"}) {
        INFO(stranger);
        CHECK_FALSE(wire::client_options({stranger, {}, {}, {}, {}}));
    }
    CHECK(wire::client_options({"http://localhost:1", {}, {}, {}, {}}));
    CHECK(wire::client_options({"http://127.0.0.2:1", {}, {}, {}, {}}));
    CHECK(wire::client_options({"http://127.0.0.1:1", std::string(64, 'a'), {}, {}, {}}).error().code ==
          ErrorCode::usage);
    CHECK(wire::server_wished("https://mill", "4f3a", {}, "fingerprint")
              .error()
              .text()
              .starts_with("fingerprint: must be 64"));
}
