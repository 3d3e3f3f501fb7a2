#include "service.hpp"

#include <weave/core/log.hpp>
#include <weave/net/outbox.hpp>
#include <weave/net/websocket_client.hpp>

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

using namespace weave;
using namespace weave::net;
using namespace weave::net::testing;

namespace {

/// What a handler under test has seen, and its socket.
struct Seen {
    std::mutex mutex;
    std::shared_ptr<WebSocket> socket;
    std::vector<WebSocketMessage> messages;
    std::vector<WebSocketEnd> ends;
    std::atomic<int> destroyed{0};
    std::atomic<int> inside{0};
    std::atomic<bool> overlapped{false};

    template <class Read>
    auto read(Read get) {
        const std::lock_guard lock(mutex);
        return get(*this);
    }
    std::shared_ptr<WebSocket> opened() {
        REQUIRE(comes_true([&] { return read([](Seen& s) { return s.socket != nullptr; }); }));
        return read([](Seen& s) { return s.socket; });
    }
    WebSocketEnd ended() {
        REQUIRE(comes_true([&] { return read([](Seen& s) { return !s.ends.empty(); }); }));
        return read([](Seen& s) { return s.ends.front(); });
    }
};

/// Repeats what it gets; fails on "throw".
class Echo : public WebSocketHandler {
  public:
    explicit Echo(std::shared_ptr<Seen> seen) : m_seen(std::move(seen)) {}
    ~Echo() override { ++m_seen->destroyed; }
    void opened(std::shared_ptr<WebSocket> socket) override {
        m_socket = socket;
        const std::lock_guard lock(m_seen->mutex);
        m_seen->socket = std::move(socket);
    }
    void message(WebSocketMessage message) override {
        if (m_seen->inside++ > 0) m_seen->overlapped = true;
        if (message.bytes == "throw") {
            --m_seen->inside;
            throw std::runtime_error("as asked");
        }
        m_socket->send_control(make_bytes(message.bytes), message.binary);
        const std::lock_guard lock(m_seen->mutex);
        m_seen->messages.push_back(std::move(message));
        --m_seen->inside;
    }
    void closed(const WebSocketEnd& end) override {
        const std::lock_guard lock(m_seen->mutex);
        m_seen->ends.push_back(end);
    }

  private:
    std::shared_ptr<Seen> m_seen;
    std::shared_ptr<WebSocket> m_socket;
};

Router with_echo(std::shared_ptr<Seen> seen) {
    Router router = usual_routes();
    const auto admit = [seen](const Request& request) -> WebSocketAdmission {
        if (!request.query.empty()) return error_answer({ErrorCode::refused, "no", {}}, 401);
        return std::make_unique<Echo>(seen);
    };
    REQUIRE(router.add({"socket", "GET", "/socket", "Repeats", 10000, {}, admit}));
    return router;
}

WebSocketClient connected(const ClientOptions& options, const std::string& target = "/socket") {
    auto client = WebSocketClient::connect(options, target);
    REQUIRE(client);
    return std::move(*client);
}

std::string received(WebSocketClient& client) {
    const auto message = client.receive(20s);
    REQUIRE(message);
    REQUIRE(message->has_value());
    return (*message)->bytes;
}

const std::string upgrade_fields =
    "Host: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

std::string first_line(std::uint16_t port, const std::string& bytes) {
    RawSocket socket(port);
    socket.send(bytes);
    const std::string reply =
        socket.read_until([](const std::string& read) { return read.find("\r\n") != std::string::npos; });
    return reply.substr(0, reply.find("\r\n"));
}

}  // namespace

TEST_CASE("the lanes of an outbox: control in order, the newest frame, then the farewell") {
    int woken = 0;
    Outbox box(3, 10, [&] { ++woken; });
    REQUIRE(box.take().bytes == nullptr);
    box.send_frame(make_bytes("f1"));
    REQUIRE(box.send_control(make_bytes("c1"), false));
    box.send_frame(make_bytes("f2"));
    REQUIRE(box.send_control(make_bytes("c2"), true));
    box.close(1000, "bye");
    REQUIRE_FALSE(box.send_control(make_bytes("late"), false));
    box.send_frame(make_bytes("late"));
    REQUIRE(woken == 5);
    REQUIRE(box.dropped_frames() == 1);
    REQUIRE(box.bytes_before_farewell() == 6);
    REQUIRE(*box.take().bytes == "c1");
    REQUIRE(*box.take().bytes == "c2");
    REQUIRE(*box.take().bytes == "f2");
    REQUIRE(box.take().farewell->code == 1000);
}

TEST_CASE("an outbox that is passed over its bounds says goodbye and sends no list with a gap") {
    const bool by_bytes = GENERATE(true, false);
    Outbox box(3, 10, [] {});
    for (int k = 0; k < 3; ++k) REQUIRE(box.send_control(make_bytes("abc"), false));
    REQUIRE_FALSE(box.send_control(make_bytes(by_bytes ? "ab" : ""), false));
    const Outbox::Next next = box.take();
    REQUIRE(next.bytes == nullptr);
    REQUIRE(next.farewell->code == 1013);
    box.end();
    REQUIRE_FALSE(box.send_control(make_bytes("x"), false));
    box.send_frame(make_bytes("x"));
    box.close(1000, {});
}

TEST_CASE("messages go both ways, in order, text and binary, and the handler is called one at a time") {
    const auto seen = std::make_shared<Seen>();
    const Server server = started(with_echo(seen));
    WebSocketClient client = connected(client_of(server));
    int sent = 0;  // Catch's assertions are for one thread
    std::thread sender([&] {
        for (int k = 0; k < 200; ++k) sent += client.send("message " + std::to_string(k), k % 2 == 1) ? 1 : 0;
    });
    for (int k = 0; k < 200; ++k) REQUIRE(received(client) == "message " + std::to_string(k));
    sender.join();
    REQUIRE(sent == 200);
    REQUIRE_FALSE(seen->overlapped);
    REQUIRE(seen->read([](Seen& s) { return s.messages[0].binary == false && s.messages[1].binary; }));
    REQUIRE_FALSE(client.receive(10ms).value());
    REQUIRE(client.send(std::string("\0\xff", 2), true));
    REQUIRE(received(client) == std::string("\0\xff", 2));
    client.close();
    REQUIRE(seen->ended().code == 1000);
    REQUIRE(comes_true([&] { return seen->destroyed == 1; }));
    REQUIRE(client.end().has_value());
    REQUIRE(client.receive(1s).error().code == ErrorCode::system);
    REQUIRE_FALSE(seen->opened()->send_control(make_bytes("late")));
}

TEST_CASE("a WebSocket works over TLS") {
    const Folder folder;
    const auto facts = make_certificate(folder.tls(), {"127.0.0.1"});
    REQUIRE(facts);
    const auto seen = std::make_shared<Seen>();
    ServerOptions options;
    options.tls = folder.tls();
    const Server server = started(with_echo(seen), options);
    ClientOptions there = client_of(server);
    there.tls = Trust{{}, facts->fingerprint};
    WebSocketClient client = connected(there);
    const std::string large(9000, 'x');
    REQUIRE(client.send(large));
    REQUIRE(received(client) == large);
    there.tls->fingerprint = std::string(64, '0');
    REQUIRE(WebSocketClient::connect(there, "/socket").error().code == ErrorCode::refused);
}

TEST_CASE("who may not, or cannot, open a WebSocket has an answer that says so") {
    const auto seen = std::make_shared<Seen>();
    ServerOptions options;
    options.origins = {"https://studio.example"};
    const Server server = started(with_echo(seen), options);
    const auto refused = WebSocketClient::connect(client_of(server), "/socket?token=bad");
    REQUIRE(refused.error().code == ErrorCode::refused);
    REQUIRE(refused.error().message.find("401") != std::string::npos);
    REQUIRE(WebSocketClient::connect(client_of(server), "/hello").error().code == ErrorCode::refused);
    const auto line = [&](const std::string& fields) {
        return first_line(server.port(), "GET /socket HTTP/1.1\r\n" + fields + "\r\n");
    };
    REQUIRE(line(upgrade_fields) == "HTTP/1.1 101 Switching Protocols");
    REQUIRE(line(upgrade_fields + "Origin: http://x\r\n") == "HTTP/1.1 101 Switching Protocols");
    REQUIRE(line(upgrade_fields + "Origin: https://studio.example\r\n") ==
            "HTTP/1.1 101 Switching Protocols");
    REQUIRE(line(upgrade_fields + "Origin: https://evil.example\r\n") == "HTTP/1.1 403 Forbidden");
    REQUIRE(line(upgrade_fields + "Origin: null\r\n") == "HTTP/1.1 403 Forbidden");
    REQUIRE(line("Host: x\r\n") == "HTTP/1.1 426 Upgrade Required");
    REQUIRE(line("Host: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n") ==
            "HTTP/1.1 400 Bad Request");
    REQUIRE(line("Host: x\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 8\r\n") ==
            "HTTP/1.1 426 Upgrade Required");
    REQUIRE(line(upgrade_fields + "\r\nearly") == "HTTP/1.1 400 Bad Request");
}

TEST_CASE("the number of WebSockets is bounded") {
    const auto seen = std::make_shared<Seen>();
    ServerOptions options;
    options.limits.websockets = 1;
    const Server server = started(with_echo(seen), options);
    WebSocketClient first = connected(client_of(server));
    REQUIRE(WebSocketClient::connect(client_of(server), "/socket").error().message.find("503") !=
            std::string::npos);
    first.close();
    REQUIRE(comes_true(
        [&] { return static_cast<bool>(WebSocketClient::connect(client_of(server), "/socket")); }));
}

TEST_CASE("a message beyond the route's limit, and a handler that throws, end the connection alone") {
    const auto seen = std::make_shared<Seen>();
    const Server server = started(with_echo(seen));
    WebSocketClient large = connected(client_of(server));
    REQUIRE(large.send(std::string(10001, 'x')));
    REQUIRE_FALSE(large.receive(20s));
    REQUIRE(large.end()->code == 1009);
    WebSocketClient thrower = connected(client_of(server));
    REQUIRE(thrower.send("throw"));
    REQUIRE_FALSE(thrower.receive(20s));
    REQUIRE(thrower.end()->code == 1011);
    WebSocketClient last = connected(client_of(server));
    REQUIRE(last.send("still here"));
    REQUIRE(received(last) == "still here");
}

TEST_CASE("a slow reader loses frames but no control message, gets the newest frame, and slows nobody") {
    const auto slow_seen = std::make_shared<Seen>();
    const Server server = started(with_echo(slow_seen));
    WebSocketClient slow = connected(client_of(server));
    const auto socket = slow_seen->opened();
    constexpr int frames = 400;
    for (int k = 0; k < frames; ++k) {
        std::string frame(200'000,
                          'f');  // 80 MB in all: more than the kernel takes for a reader that does not read
        frame.replace(0, 8, (std::to_string(k) + "        ").substr(0, 8));
        socket->send_frame(make_bytes(std::move(frame)));
        if (k % 10 == 0) REQUIRE(socket->send_control(make_bytes("control " + std::to_string(k))));
        if (k % 50 == 0) REQUIRE(HttpClient(client_of(server)).send({"GET", "/hello", {}, {}}));
    }
    int last_frame = -1, next_control = 0, got = 0;
    while (last_frame < frames - 1 || next_control < frames) {
        const auto message = slow.receive(20s);
        REQUIRE(message);
        REQUIRE(message->has_value());
        const std::string& bytes = (*message)->bytes;
        if ((*message)->binary) {
            const int number = std::atoi(bytes.substr(0, 8).c_str());
            REQUIRE(number > last_frame);
            last_frame = number;
            ++got;
        } else {
            REQUIRE(bytes == "control " + std::to_string(next_control));
            next_control += 10;
        }
    }
    REQUIRE(socket->dropped_frames() > 0);
    REQUIRE(static_cast<std::uint64_t>(got) + socket->dropped_frames() == frames);
}

TEST_CASE("a reader that lets control messages pile up beyond the bound is closed") {
    const auto seen = std::make_shared<Seen>();
    ServerOptions options;
    options.limits.control_bytes = 1'000'000;
    options.limits.transfer_time = 100ms;
    const Server server = started(with_echo(seen), options);
    RawSocket reader(server.port(), 4096);
    REQUIRE(reader.send("GET /socket HTTP/1.1\r\n" + upgrade_fields + "\r\n"));
    const auto socket = seen->opened();
    const Bytes message = make_bytes(std::string(100'000, 'c'));
    REQUIRE(comes_true([&] { return !socket->send_control(message); }));
    REQUIRE(seen->ended().code == 1013);
    REQUIRE(HttpClient(client_of(server)).send({"GET", "/hello", {}, {}}));
}

TEST_CASE("whoever goes on sending after the farewell is not heard, and cut off") {
    const auto seen = std::make_shared<Seen>();
    ServerOptions options;
    options.limits.transfer_time = 10min;
    const Server server = started(with_echo(seen), options);
    WebSocketClient flood = connected(client_of(server));
    seen->opened()->close(1008, "enough");
    std::size_t sent = 0;
    while (sent < 1'000'000'000 && flood.send(std::string(1000, 'x'))) ++sent;
    REQUIRE(seen->ended().code == 1008);
    REQUIRE(seen->read([](Seen& s) { return s.messages.size(); }) <= 1);  // one that was read already
}

TEST_CASE("a client that shows no sign of life is let go, one that answers pings is kept") {
    const auto seen = std::make_shared<Seen>();
    ServerOptions options;
    options.limits.idle_time = 2s;
    const Server server = started(with_echo(seen), options);
    WebSocketClient lively = connected(client_of(server));
    seen->opened();
    RawSocket dead(server.port());
    REQUIRE(dead.send("GET /socket HTTP/1.1\r\n" + upgrade_fields + "\r\n"));
    dead.read_all();
    REQUIRE(dead.closed());
    REQUIRE(lively.send("here"));
    REQUIRE(received(lively) == "here");
}

TEST_CASE("frames that break the protocol end the connection alone") {
    const auto seen = std::make_shared<Seen>();
    const Server server = started(with_echo(seen));
    using namespace std::string_literals;
    for (const std::string& frame : {"\x81\x02hi"s,              // not masked
                                     "\xf1\x80\0\0\0\0"s,        // reserved bits
                                     "\x83\x80\0\0\0\0"s,        // an unknown opcode
                                     "\x80\x80\0\0\0\0"s,        // goes on with nothing
                                     "\x81\x81\0\0\0\0\xff"s,    // no UTF-8
                                     "\x89\xfe\x01\0\0\0\0\0"s,  // a ping that is too long
                                     "\x82\xff\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0"s}) {
        RawSocket socket(server.port());
        REQUIRE(socket.send("GET /socket HTTP/1.1\r\n" + upgrade_fields + "\r\n"));
        socket.read_until([](const std::string& read) { return read.find("\r\n\r\n") != std::string::npos; });
        socket.send(frame);
        socket.read_all();
        REQUIRE(socket.closed());
    }
    WebSocketClient client = connected(client_of(server));
    REQUIRE(client.send("still here"));
    REQUIRE(received(client) == "still here");
}

TEST_CASE(
    "a server that stops says goodbye to WebSockets once what was queued is sent; the socket may outlive "
    "it") {
    const auto seen = std::make_shared<Seen>();
    std::optional<Server> server = started(with_echo(seen));
    WebSocketClient client = connected(client_of(*server));
    const auto socket = seen->opened();
    for (int k = 0; k < 100; ++k) REQUIRE(socket->send_control(make_bytes(std::to_string(k))));
    std::thread stopper([&] { server->stop(20s); });
    for (int k = 0; k < 100; ++k) REQUIRE(received(client) == std::to_string(k));
    REQUIRE_FALSE(client.receive(20s));
    stopper.join();
    REQUIRE(client.end()->code == 1001);
    REQUIRE(seen->ended().code == 1001);
    server.reset();
    REQUIRE_FALSE(socket->send_control(make_bytes("late")));
    socket->send_frame(make_bytes("late"));
    socket->close(1000, {});
}

TEST_CASE("a server that stops by force leaves no WebSocket behind") {
    const auto seen = std::make_shared<Seen>();
    std::optional<Server> server = started(with_echo(seen));
    RawSocket mute(server->port(), 4096);
    REQUIRE(mute.send("GET /socket HTTP/1.1\r\n" + upgrade_fields + "\r\n"));
    const auto socket = seen->opened();
    for (int k = 0; k < 20; ++k) socket->send_control(make_bytes(std::string(100'000, 'c')));
    server->stop(50ms);
    REQUIRE(seen->destroyed == 1);
}
