#include "service.hpp"

#include <atomic>
#include <mutex>
#include <thread>

using namespace weave;
using namespace weave::net;
using namespace weave::net::testing;

namespace {

/// A server of one connection at a time that says what it is told to, whatever is asked.
class Liar {
  public:
    explicit Liar(std::string words, bool hold = false) : m_words(std::move(words)), m_hold(hold) {
        m_socket = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        REQUIRE(::bind(m_socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0);
        REQUIRE(::listen(m_socket, 16) == 0);
        socklen_t size = sizeof place;
        ::getsockname(m_socket, reinterpret_cast<sockaddr*>(&place), &size);
        m_port = ntohs(place.sin_port);
        m_thread = std::thread([this] { serve(); });
    }
    ~Liar() {
        m_done = true;
        ::shutdown(m_socket, SHUT_RDWR);
        m_thread.join();
        ::close(m_socket);
    }
    Liar(const Liar&) = delete;
    Liar& operator=(const Liar&) = delete;
    [[nodiscard]] ClientOptions client() const {
        ClientOptions options;
        options.port = m_port;
        options.answer_time = 300ms;
        options.stall_time = 300ms;
        options.most_body_bytes = 1000;
        return options;
    }

  private:
    void serve() {
        while (!m_done) {
            const int client = ::accept(m_socket, nullptr, nullptr);
            if (client < 0) return;
            char piece[4096];
            static_cast<void>(::recv(client, piece, sizeof piece, 0));
            static_cast<void>(::send(client, m_words.data(), m_words.size(), MSG_NOSIGNAL));
            while (m_hold && !m_done && ::recv(client, piece, sizeof piece, 0) > 0) continue;
            ::close(client);
        }
    }

    std::string m_words;
    bool m_hold;
    int m_socket = -1;
    std::uint16_t m_port = 0;
    std::atomic<bool> m_done{false};
    std::thread m_thread;
};

Result<Response> ask(const Liar& liar) {
    return HttpClient(liar.client()).send({"GET", "/", {}, {}});
}

}  // namespace

TEST_CASE("a client sends, reads and keeps its connection") {
    ServerOptions options;
    options.metrics = std::make_shared<Metrics>();
    const Server server = started(usual_routes(), options);
    HttpClient client(client_of(server));
    for (int k = 0; k < 5; ++k) {
        const auto echoed = client.send({"POST", "/echo", {{"X-A", "b"}}, "body " + std::to_string(k)});
        REQUIRE(echoed);
        REQUIRE(echoed->status == 200);
        REQUIRE(*echoed->body == "body " + std::to_string(k));
        REQUIRE(client.send({"HEAD", "/hello", {}, {}}).value().body->empty());
        REQUIRE(client.send({"GET", "/none", {}, {}}).value().status == 404);
    }
    REQUIRE(options.metrics->counter("weave_http_connections_total", "Connections taken").value() == 1);
    REQUIRE(client.send({"POST", "/echo", {}, std::string(2000, 'a')}).value().status == 413);
    REQUIRE(client.send({"GET", "/hello", {}, {}}));
}

TEST_CASE(
    "a kept connection that the server closed is replaced for what may be asked twice, and for nothing "
    "else") {
    auto server = std::make_unique<Server>(started(usual_routes()));
    HttpClient client(client_of(*server));
    REQUIRE(client.send({"GET", "/hello", {}, {}}));
    ServerOptions same;
    same.port = server->port();
    server->stop(10s);
    server = std::make_unique<Server>(started(usual_routes(), same));
    REQUIRE(client.send({"GET", "/hello", {}, {}}));
    server->stop(10s);
    server = std::make_unique<Server>(started(usual_routes(), same));
    REQUIRE_FALSE(client.send({"POST", "/echo", {}, "a"}));
    REQUIRE(client.send({"POST", "/echo", {}, "a"}));
}

TEST_CASE("a large body goes to a sink in pieces, which may end it") {
    const Bytes large = make_bytes(std::string(3'000'000, 'z'));
    Router router = usual_routes();
    REQUIRE(router.add({"large",
                        "GET",
                        "/large",
                        "Gives much",
                        0,
                        [&](const Request&) { return answer(200, "application/octet-stream", large); },
                        {}}));
    const Server server = started(std::move(router));
    ClientOptions options = client_of(server);
    options.most_body_bytes = 1000;
    HttpClient client(options);
    REQUIRE(client.send({"GET", "/large", {}, {}}).error().code == ErrorCode::bad_input);
    std::string got;
    std::size_t largest = 0;
    const auto answered = client.send({"GET", "/large", {}, {}}, [&](std::string_view piece) {
        largest = std::max(largest, piece.size());
        got += piece;
        return Status();
    });
    REQUIRE(answered);
    REQUIRE(got == *large);
    REQUIRE(largest <= 65536);
    const auto ended = client.send({"GET", "/large", {}, {}},
                                   [](std::string_view) { return Status(system_fault("disk full")); });
    REQUIRE(ended.error().message == "disk full");
    bool called = false;
    const auto missing =
        client.send({"GET", "/none", {}, {}}, [&](std::string_view) { return called = true, Status(); });
    REQUIRE(missing.value().status == 404);
    REQUIRE_FALSE(missing->body->empty());
    REQUIRE_FALSE(called);
}

TEST_CASE("what a server answers may be anything, and a client says so or gives up in time") {
    REQUIRE(ask(Liar("SSH-2.0-nonsense\r\n\r\n")).error().code == ErrorCode::bad_input);
    REQUIRE(ask(Liar("")).error().code == ErrorCode::system);
    REQUIRE(ask(Liar("HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\nabc")).error().code == ErrorCode::system);
    REQUIRE(
        ask(Liar("HTTP/1.1 200 OK\r\nContent-Length: 1001\r\n\r\n" + std::string(1001, 'a'))).error().code ==
        ErrorCode::bad_input);
    REQUIRE(ask(Liar("HTTP/1.1 200 OK\r\n\r\n" + std::string(5000, 'a'))).error().code ==
            ErrorCode::bad_input);
    REQUIRE(ask(Liar("HTTP/1.1 200 OK\r\nX: " + std::string(100000, 'a'))).error().code ==
            ErrorCode::bad_input);
    REQUIRE(ask(Liar("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nxyz\r\n")).error().code ==
            ErrorCode::bad_input);
    REQUIRE(*ask(Liar("HTTP/1.1 200 OK\r\n\r\nuntil the end")).value().body == "until the end");
    const auto late = ask(Liar("", true));
    REQUIRE(late.error().code == ErrorCode::system);
    REQUIRE(late.error().message.find("in time") != std::string::npos);
    REQUIRE(
        ask(Liar("HTTP/1.1 200 OK\r\nContent-Length: 10\r\n\r\nabc", true)).error().message.find("in time") !=
        std::string::npos);
}

TEST_CASE("a request that would be two is not sent") {
    const Server server = started(usual_routes());
    HttpClient client(client_of(server));
    for (const ClientRequest& bad :
         {ClientRequest{"GET", "/a b", {}, {}}, ClientRequest{"GET", "/a\r\nX: y", {}, {}},
          ClientRequest{"GE T", "/", {}, {}}, ClientRequest{"GET", "hello", {}, {}},
          ClientRequest{"GET", "/", {{"X", "a\r\nY: b"}}, {}},
          ClientRequest{"GET", "/", {{"X Y", "a"}}, {}}}) {
        const auto sent = client.send(bad);
        REQUIRE_FALSE(sent);
        REQUIRE(sent.error().code == ErrorCode::usage);
    }
}

TEST_CASE("nobody at the port is an error of the network") {
    std::uint16_t port = 0;
    {
        const Server server = started(usual_routes());
        port = server.port();
    }
    ClientOptions options;
    options.port = port;
    REQUIRE(HttpClient(options).send({"GET", "/", {}, {}}).error().code == ErrorCode::system);
}

TEST_CASE("addresses of services are read as people write them") {
    const auto plain = parse_origin("http://127.0.0.1:8080/");
    REQUIRE(plain);
    REQUIRE(plain->host == "127.0.0.1");
    REQUIRE(plain->port == 8080);
    REQUIRE_FALSE(plain->tls);
    REQUIRE(parse_origin("https://loom.example").value().port == 443);
    REQUIRE(parse_origin("https://loom.example").value().tls);
    REQUIRE(parse_origin("https://[::1]:9").value().host == "::1");
    for (const char* bad : {"", "loom", "ftp://a", "http://", "http://a:0", "http://a:65536", "http://a:x",
                            "http://a/b", "http://a@b", "https://a b", "http://a\r\n", "http://[::1"}) {
        INFO(bad);
        REQUIRE_FALSE(parse_origin(bad));
    }
}
