#include "commands_case.hpp"

#include <array>
#include <loomlink/commands/api_client.hpp>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

/// A server that answers one connection after another as it is told: an empty answer breaks it off.
class ScriptedServer {
  public:
    explicit ScriptedServer(std::vector<std::string> answers) {
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
        m_thread = std::thread([this, answers = std::move(answers)] {
            for (const std::string& answer : answers) serve_one(answer);
        });
    }
    ~ScriptedServer() {
        ::shutdown(m_socket, SHUT_RDWR);
        m_thread.join();
        ::close(m_socket);
    }
    ScriptedServer(const ScriptedServer&) = delete;
    ScriptedServer& operator=(const ScriptedServer&) = delete;

    [[nodiscard]] std::string origin() const { return "http://127.0.0.1:" + std::to_string(m_port); }
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

    int m_socket = -1;
    std::uint16_t m_port = 0;
    std::thread m_thread;
};

std::string http(const std::string& status, const std::string& body) {
    return "HTTP/1.1 " + status + "\r\nContent-Length: " + std::to_string(body.size()) +
           "\r\nConnection: close\r\n\r\n" + body;
}

ApiClient client_of(const ScriptedServer& server) {
    return ApiClient::of(KeptSession{server.origin(), {}, "dora", "token", {}}).value();
}

}  // namespace

TEST_CASE("a change is asked for again under its own id when the connection breaks or the server is busy",
          "[commands]") {
    ScriptedServer server(
        {"", http("503 Service Unavailable", "{}"), http("200 OK", R"({"state":"submitted"})")});
    ApiClient client = client_of(server);
    const auto answer = client.post("/designs/shoe/revisions/1/submit", {{"reason", "x"}});
    REQUIRE(answer);
    CHECK(answer->at("state") == "submitted");
    REQUIRE(server.bodies.size() == 3);
    CHECK(server.bodies[1] == server.bodies[0]);
    CHECK(server.bodies[2] == server.bodies[0]);
    const auto id = parse_json(server.bodies[0]).value().at("request").get<std::string>();
    CHECK(id.size() >= 8);
}

TEST_CASE("what a server answers is believed for what it is, and nothing more", "[commands]") {
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
         ErrorCode::refused, "loomlink login"},
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
        ApiClient client = client_of(server);
        const auto answer = client.change("POST", "/me", {{"x", 1}});
        INFO(one.answer);
        REQUIRE_FALSE(answer);
        CHECK(answer.error().code == one.code);
        CHECK_THAT(answer.error().text(), Catch::Contains(one.says));
    }
}

TEST_CASE("an error names what was asked for as people write it", "[commands]") {
    ScriptedServer server(
        {http("404 Not Found", R"({"error":{"kind":"refused","message":"is not there"}})")});
    ApiClient client = client_of(server);
    const auto answer = client.change("POST", api_path({"looms", "EP 1", "releases"}), {{"x", 1}});
    REQUIRE_FALSE(answer);
    CHECK(answer.error().text() == "looms/EP 1/releases: is not there");
}

TEST_CASE("bytes beyond what was asked for are refused", "[commands]") {
    ScriptedServer server({http("200 OK", "12345678}")});
    ApiClient client = client_of(server);
    const auto bytes = client.get_bytes("/looms/x/releases/1/files/a", 4);
    REQUIRE_FALSE(bytes);
    CHECK(bytes.error().code == ErrorCode::bad_input);
}

TEST_CASE("a path is what was meant, whatever a name holds", "[commands]") {
    CHECK(api_path({"looms", "EP 1/../x", "index"}) == "/looms/EP%201%2F..%2Fx/index");
}
