#include "service.hpp"

#include <weave/core/log.hpp>

#include <atomic>
#include <thread>

using namespace weave;
using namespace weave::net;
using namespace weave::net::testing;

namespace {

const std::string hello = "GET /hello HTTP/1.1\r\nHost: x\r\n\r\n";
const std::string last_hello = "GET /hello HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";

std::string post(const std::string& path, const std::string& fields, const std::string& body) {
    return "POST " + path + " HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n" + body;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
        ++count;
    return count;
}

int status_of_reply(const std::string& reply) {
    return reply.starts_with("HTTP/1.1 ") ? std::atoi(reply.c_str() + 9) : 0;
}

/// A gate that handlers wait at.
struct Gate {
    std::atomic<bool> open{false};
    std::atomic<int> waiting{0};
    void pass() {
        ++waiting;
        while (!open) ::usleep(1000);
    }
};

Router with_gate(Gate& gate) {
    Router router = usual_routes();
    REQUIRE(router.add({"gate",
                        "GET",
                        "/gate",
                        "Waits",
                        0,
                        [&](const Request&) { return gate.pass(), text("through"); },
                        {}}));
    return router;
}

}  // namespace

TEST_CASE("requests are answered one after another on a connection, also when they come at once") {
    const Server server = started(usual_routes());
    const std::string reply =
        reply_to(server.port(), hello + post("/echo", "Content-Length: 3\r\n", "abc") + hello + last_hello);
    REQUIRE(count_of(reply, "HTTP/1.1 200 OK\r\n") == 4);
    REQUIRE(count_of(reply, "\r\n\r\nhello") == 3);
    REQUIRE(reply.find("\r\n\r\nabc") > reply.find("hello"));
    REQUIRE(count_of(reply, "X-Content-Type-Options: nosniff\r\n") == 4);
    REQUIRE(count_of(reply, "Connection: close\r\n") == 1);
}

TEST_CASE("bodies come by length and in chunks, and trailers count for nothing") {
    std::string seen;
    Router router;
    REQUIRE(router.add({"take",
                        "POST",
                        "/take",
                        "Takes",
                        100,
                        [&](const Request& request) {
                            seen = std::string(request.headers.get("X-Trailer"));
                            return text(request.body);
                        },
                        {}}));
    const Server server = started(std::move(router));
    const std::string chunked = post("/take", "Transfer-Encoding: chunked\r\n",
                                     "3;name=value\r\nabc\r\n2\r\nde\r\n0\r\nX-Trailer: planted\r\n\r\n");
    const std::string reply =
        reply_to(server.port(), chunked + post("/take", "Connection: close\r\nContent-Length: 2\r\n", "fg"));
    REQUIRE(reply.find("\r\n\r\nabcde") != std::string::npos);
    REQUIRE(reply.ends_with("\r\n\r\nfg"));
    REQUIRE(seen.empty());
}

TEST_CASE("HEAD has the head of GET and no body; what the client holds is not sent again") {
    Router router;
    REQUIRE(router.add({"file",
                        "GET",
                        "/file",
                        "Gives a file",
                        0,
                        [](const Request&) {
                            Response response = text("content");
                            response.headers.add("ETag", etag_of("abc"));
                            return response;
                        },
                        {}}));
    const Server server = started(std::move(router));
    const std::string head =
        reply_to(server.port(), "HEAD /file HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    REQUIRE(head.find("Content-Length: 7\r\n") != std::string::npos);
    REQUIRE(head.ends_with("\r\n\r\n"));
    const std::string held =
        reply_to(server.port(),
                 "GET /file HTTP/1.1\r\nHost: x\r\nIf-None-Match: \"abc\"\r\nConnection: close\r\n\r\n");
    REQUIRE(status_of_reply(held) == 304);
    REQUIRE(held.ends_with("\r\n\r\n"));
    REQUIRE(held.find("ETag: \"abc\"") != std::string::npos);
    const std::string other =
        reply_to(server.port(),
                 "GET /file HTTP/1.1\r\nHost: x\r\nIf-None-Match: \"abd\"\r\nConnection: close\r\n\r\n");
    REQUIRE(status_of_reply(other) == 200);
}

TEST_CASE("a client that asks whether to go on is told before its body is read") {
    const Server server = started(usual_routes());
    RawSocket socket(server.port());
    REQUIRE(
        socket.send(post("/echo", "Content-Length: 3\r\nExpect: 100-continue\r\nConnection: close\r\n", "")));
    socket.read_until(
        [](const std::string& read) { return read.find("100 Continue\r\n\r\n") != std::string::npos; });
    REQUIRE(socket.send("abc"));
    REQUIRE(socket.read_all().ends_with("\r\n\r\nabc"));
    const std::string large =
        reply_to(server.port(), post("/echo", "Content-Length: 1001\r\nExpect: 100-continue\r\n", ""));
    REQUIRE(status_of_reply(large) == 413);
    REQUIRE(status_of_reply(reply_to(server.port(),
                                     post("/echo", "Content-Length: 1\r\nExpect: magic\r\n", "a"))) == 417);
}

TEST_CASE("what is not there, not allowed or too large has its status") {
    const Server server = started(usual_routes());
    const auto status = [&](const std::string& bytes) {
        return status_of_reply(reply_to(server.port(), bytes));
    };
    const auto get = [&](const std::string& target) {
        return status("GET " + target + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    };
    REQUIRE(get("/nothing") == 404);
    REQUIRE(get("/echo") == 405);
    REQUIRE(reply_to(server.port(), "DELETE /hello HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
                .find("Allow: GET, HEAD\r\n") != std::string::npos);
    for (const char* target :
         {"/../hello", "/%2e%2e/hello", "//hello", "/hello%00", "*", "http://x/hello", "hello"}) {
        INFO(target);
        REQUIRE(get(target) == 400);
    }
    REQUIRE(status(post("/echo", "Content-Length: 1001\r\n", "")) == 413);
    REQUIRE(status(post("/echo", "Content-Length: 999999999999999999\r\n", "")) == 413);
    REQUIRE(status(post("/echo", "Transfer-Encoding: chunked\r\n",
                        "3e8\r\n" + std::string(1000, 'a') + "\r\n1\r\na\r\n0\r\n\r\n")) == 413);
    REQUIRE(status("GET /hello HTTP/1.1\r\nHost: x\r\nContent-Length: 1\r\n\r\na") == 413);
    REQUIRE(status("GET /hello HTTP/1.1\r\nHost: x\r\nX: " + std::string(20000, 'a') + "\r\n\r\n") == 431);
    REQUIRE(status("GET /hello HTTP/1.2\r\nHost: x\r\n\r\n") == 505);
    REQUIRE(status("GET /hello HTTP/1.0\r\n\r\n") == 200);
    REQUIRE(status(last_hello) == 200);
}

TEST_CASE("a client that sends far too much can send it, and hears that it is too much") {
    const Server server = started(usual_routes());
    constexpr std::size_t large = 20'000'000;  // more than sockets hold
    RawSocket socket(server.port());
    REQUIRE(socket.send(post("/echo", "Content-Length: " + std::to_string(large) + "\r\n", "")));
    REQUIRE(socket.send(std::string(large, 'a')));
    REQUIRE(status_of_reply(socket.read_all()) == 413);
}

TEST_CASE("what a refused client goes on sending is read for a while and to a size, not for ever") {
    ServerOptions options;
    options.limits.linger_bytes = 1'000'000;
    options.limits.linger_time = 500ms;
    const Server server = started(usual_routes(), options);
    RawSocket greedy(server.port());
    REQUIRE(greedy.send(post("/echo", "Content-Length: 1000000000\r\n", "")));
    REQUIRE_FALSE(greedy.send(std::string(50'000'000, 'a')));
    RawSocket slow(server.port());
    REQUIRE(slow.send(post("/echo", "Content-Length: 1000000000\r\n", "")));
    REQUIRE(comes_true([&] { return !slow.send("a"); }));  // a byte each 2 ms: far from the bound of bytes
}

TEST_CASE("bytes that another server could read as two requests are refused, and the connection with them") {
    const Server server = started(usual_routes());
    const std::string hidden = "GET /hello HTTP/1.1\r\nHost: x\r\n\r\n";
    const std::string chunks = "0\r\n\r\n" + hidden;
    for (const std::string& bytes : {
             post("/echo", "Content-Length: 0\r\nContent-Length: 38\r\n", hidden),
             post("/echo", "Content-Length: 0\r\nContent-Length: 0\r\n", hidden),
             post("/echo", "Content-Length: 0, 0\r\n", hidden),
             post("/echo", "Content-Length: +0\r\n", hidden),
             post("/echo", "Content-Length : 0\r\n", hidden),
             post("/echo", "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", chunks),
             post("/echo", "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n", chunks),
             post("/echo", "Transfer-Encoding: gzip\r\n", hidden),
             post("/echo", "Transfer-Encoding: chunked, identity\r\n", chunks),
             post("/echo",
                  "Transfer-Encoding: \x0b"
                  "chunked\r\n",
                  chunks),
             post("/echo", "Transfer-Encoding: chunked\r\nTransfer-Encoding: x\r\n", chunks),
             post("/echo", "Transfer-Encoding\r\n : chunked\r\n", chunks),
             post("/echo", "X: a\r\n Content-Length: 38\r\n", hidden),
             post("/echo", "X: a\nContent-Length: 38\r\n", hidden),
             post("/echo", "X: a\rContent-Length: 38\r\n", hidden),
             post("/echo", "Host: y\r\n", hidden),
             std::string("POST /echo HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n") + chunks,
             std::string("GET /hello HTTP/1.1\r\n\r\n") + hidden,
             std::string("\r\n") + hidden,
             std::string("GET /hello\r\n\r\n") + hidden,
             post("/echo", "Transfer-Encoding: chunked\r\n", "3\nabc\r\n0\r\n\r\n" + hidden),
             post("/echo", "Transfer-Encoding: chunked\r\n", "-3\r\nabc\r\n0\r\n\r\n" + hidden),
             post("/echo", "Transfer-Encoding: chunked\r\n", "3\r\nabcd\r\n0\r\n\r\n" + hidden),
             post("/echo", "Transfer-Encoding: chunked\r\n",
                  "fffffffffffffffff\r\nabc\r\n0\r\n\r\n" + hidden),
         }) {
        INFO(bytes);
        const std::string reply = reply_to(server.port(), bytes);
        REQUIRE(count_of(reply, "HTTP/1.1 ") == 1);
        REQUIRE(status_of_reply(reply) == 400);
    }
}

TEST_CASE("only hosts that are ours are answered, if we know them") {
    ServerOptions options;
    options.hosts = {"loom.example", "127.0.0.1"};
    const Server server = started(usual_routes(), options);
    const auto status = [&](const std::string& host) {
        return status_of_reply(reply_to(
            server.port(), "GET /hello HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n"));
    };
    REQUIRE(status("loom.example") == 200);
    REQUIRE(status("LOOM.example:1234") == 200);
    REQUIRE(status("evil.example") == 421);
    REQUIRE(status("loom.example.evil") == 421);
}

TEST_CASE("what a handler throws, or writes into a header, does not get out") {
    Router router;
    REQUIRE(router.add({"throw",
                        "GET",
                        "/throw",
                        "Throws",
                        0,
                        [](const Request&) -> Response { throw std::runtime_error("secret path"); },
                        {}}));
    REQUIRE(router.add(
        {"odd", "GET", "/odd", "Throws oddly", 0, [](const Request&) -> Response { throw 7; }, {}}));
    REQUIRE(router.add({"split",
                        "GET",
                        "/split/{x}",
                        "Splits",
                        0,
                        [](const Request& request) {
                            Response response = text("x");
                            response.headers.add("X-Split", request.place("x") + "\r\nSet-Cookie: a=b");
                            return response;
                        },
                        {}}));
    const Server server = started(std::move(router));
    for (const char* path : {"/throw", "/odd", "/split/a"}) {
        const std::string reply = reply_to(
            server.port(), "GET " + std::string(path) + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
        REQUIRE(status_of_reply(reply) == 500);
        REQUIRE(reply.find("secret") == std::string::npos);
        REQUIRE(reply.find("Set-Cookie") == std::string::npos);
    }
}

TEST_CASE("when all workers are busy and the queue is full, a client is told to come back") {
    Gate gate;
    ServerOptions options;
    options.workers = 1;
    options.limits.waiting_requests = 1;
    Server server = started(with_gate(gate), options);
    const std::string ask = "GET /gate HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n";
    RawSocket running(server.port());
    REQUIRE(running.send(ask));
    REQUIRE(comes_true([&] { return gate.waiting == 1; }));
    RawSocket first(server.port()), second(server.port());
    REQUIRE(first.send(ask));
    REQUIRE(second.send(ask));
    const auto answered = [&](RawSocket& socket) {
        return !socket.read_until([](const std::string& r) { return !r.empty(); }, 50ms).empty();
    };
    REQUIRE(comes_true([&] { return answered(first) || answered(second); }));
    gate.open = true;
    const std::string a = first.read_all(), b = second.read_all();
    REQUIRE(std::min(status_of_reply(a), status_of_reply(b)) == 200);
    REQUIRE(std::max(status_of_reply(a), status_of_reply(b)) == 503);
    REQUIRE((a + b).find("Retry-After: ") != std::string::npos);
    REQUIRE(status_of_reply(running.read_all()) == 200);
}

TEST_CASE("slow clients hold no worker, and are let go in time") {
    ServerOptions options;
    options.workers = 1;
    options.limits.header_time = 1500ms;
    options.limits.idle_time = 1500ms;
    options.limits.transfer_time = 1500ms;
    options.limits.slowest_bytes_per_second = 100'000'000;
    const Bytes large = make_bytes(std::string(64 << 20, 'x'));
    Router router = usual_routes();
    REQUIRE(router.add({"large",
                        "GET",
                        "/large",
                        "Gives much",
                        0,
                        [&](const Request&) { return answer(200, "application/octet-stream", large); },
                        {}}));
    const Server server = started(std::move(router), options);
    RawSocket silent(server.port()), half_head(server.port()), half_body(server.port()),
        no_reader(server.port(), 4096);
    REQUIRE(half_head.send("GET /hello HTTP/1.1\r\nHo"));
    REQUIRE(half_body.send(post("/echo", "Content-Length: 100\r\n", "abc")));
    REQUIRE(no_reader.send("GET /large HTTP/1.1\r\nHost: x\r\n\r\n"));
    for (int k = 0; k < 5; ++k) REQUIRE(status_of_reply(reply_to(server.port(), last_hello)) == 200);
    for (RawSocket* const socket : {&silent, &half_head, &half_body}) {
        REQUIRE(socket->read_all().empty());
        REQUIRE(socket->closed());
    }
    ::usleep(2'500'000);  // longer than the answer may take: transfer_time and two thirds of a second
    const std::string got = no_reader.read_all();
    REQUIRE(no_reader.closed());
    REQUIRE(got.size() < large->size());
    REQUIRE(large.use_count() == 1);  // no answer holds it any more
}

TEST_CASE("one byte at a time is no way around the limit of a head's time") {
    ServerOptions options;
    options.limits.header_time = 300ms;
    const Server server = started(usual_routes(), options);
    RawSocket socket(server.port());
    bool open = true;
    for (int k = 0; k < 2000 && open; ++k) {
        open = socket.send("G");
        ::usleep(5000);
    }
    REQUIRE_FALSE(open);
}

TEST_CASE("connections are bounded, for each address and in all") {
    const bool per_address = GENERATE(true, false);
    ServerOptions options;
    (per_address ? options.limits.connections_per_address : options.limits.connections) = 3;
    const Server server = started(usual_routes(), options);
    auto first = std::make_unique<RawSocket>(server.port());
    RawSocket second(server.port()), third(server.port());
    const auto greets = [](RawSocket& socket) {
        socket.send(hello);
        return status_of_reply(
                   socket.read_until([](const std::string& r) { return r.ends_with("hello"); })) == 200;
    };
    REQUIRE((greets(*first) && greets(second) && greets(third)));
    RawSocket fourth(server.port());
    fourth.send(hello);
    REQUIRE(fourth.read_all().empty());
    REQUIRE(fourth.closed());
    first.reset();
    REQUIRE(comes_true([&] { return status_of_reply(reply_to(server.port(), last_hello)) == 200; }));
}

TEST_CASE("a connection ends after its share of requests") {
    ServerOptions options;
    options.limits.requests_per_connection = 3;
    const Server server = started(usual_routes(), options);
    const std::string reply = reply_to(server.port(), hello + hello + hello + hello);
    REQUIRE(count_of(reply, "HTTP/1.1 200") == 3);
    REQUIRE(count_of(reply, "Connection: close") == 1);
}

TEST_CASE("bodies share a bound in memory") {
    ServerOptions options;
    options.limits.body_bytes_in_all = 1500;
    const Server server = started(usual_routes(), options);
    auto holder = std::make_unique<RawSocket>(server.port());
    REQUIRE(holder->send(post("/echo", "Content-Length: 1000\r\n", "a")));
    const std::string ask =
        post("/echo", "Connection: close\r\nContent-Length: 1000\r\n", std::string(1000, 'b'));
    REQUIRE(comes_true([&] { return status_of_reply(reply_to(server.port(), ask)) == 503; }));
    holder.reset();
    REQUIRE(comes_true([&] { return status_of_reply(reply_to(server.port(), ask)) == 200; }));
}

TEST_CASE("metrics tell requests by route and never by what a client made up") {
    ServerOptions options;
    options.metrics = std::make_shared<Metrics>();
    const Server server = started(usual_routes(), options);
    reply_to(server.port(), hello + last_hello);
    reply_to(server.port(), "GET /made/up HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
    reply_to(server.port(), "nonsense\r\n\r\n");
    const std::string text = options.metrics->text();
    REQUIRE(text.find("weave_http_requests_total{route=\"hello\",status=\"2xx\"} 2\n") != std::string::npos);
    REQUIRE(text.find("weave_http_requests_total{route=\"none\",status=\"4xx\"} 2\n") != std::string::npos);
    REQUIRE(text.find("weave_http_request_seconds_count{route=\"hello\"} 2\n") != std::string::npos);
    REQUIRE(text.find("made") == std::string::npos);
}

TEST_CASE("a server that stops finishes what runs, takes nothing new and lets idle connections go") {
    Gate gate;
    Server server = started(with_gate(gate));
    const std::uint16_t port = server.port();
    RawSocket idle(port), running(port);
    REQUIRE(idle.send(hello));
    idle.read_until([](const std::string& read) { return read.ends_with("hello"); });
    REQUIRE(running.send("GET /gate HTTP/1.1\r\nHost: x\r\n\r\n" + hello));
    REQUIRE(comes_true([&] { return gate.waiting == 1; }));
    std::thread stopper([&] { server.stop(60s); });
    REQUIRE(comes_true([&] { return !RawSocket(port).connected(); }));
    idle.read_all();
    REQUIRE(idle.closed());
    gate.open = true;
    const std::string reply = running.read_all();
    stopper.join();
    REQUIRE(count_of(reply, "HTTP/1.1 200") == 1);
    REQUIRE(reply.find("Connection: close") != std::string::npos);
    REQUIRE(reply.ends_with("through"));
}

TEST_CASE("a server that stops under load cuts off what does not end in time") {
    Gate gate;
    ServerOptions options;
    options.workers = 2;
    options.io_threads = 2;
    options.limits.header_time = 600s;
    Server server = started(with_gate(gate), options);
    std::vector<std::unique_ptr<RawSocket>> sockets;
    for (int k = 0; k < 40; ++k) {
        sockets.push_back(std::make_unique<RawSocket>(server.port()));
        sockets.back()->send(k % 2 == 0 ? "GET /gate HTTP/1.1\r\nHost: x\r\n\r\n" : "GET /hel");
    }
    REQUIRE(comes_true([&] { return gate.waiting == 2; }));
    std::thread opener([&] {
        ::usleep(500'000);
        gate.open = true;  // a handler is never cut off itself
    });
    server.stop(100ms);
    opener.join();
    for (const auto& socket : sockets) {
        socket->read_all();
        REQUIRE(socket->closed());
    }
    REQUIRE(gate.waiting == 2);  // what waited for a worker was not begun
}

TEST_CASE("a server that cannot be had says why") {
    const Server server = started(usual_routes());
    ServerOptions options;
    options.port = server.port();
    const auto taken = Server::start(usual_routes(), options);
    REQUIRE_FALSE(taken);
    REQUIRE(taken.error().code == ErrorCode::system);
    options.address = "0.0.0.0";
    REQUIRE(Server::start(usual_routes(), options).error().code == ErrorCode::usage);
    options.address = "localhost";
    REQUIRE(Server::start(usual_routes(), options).error().code == ErrorCode::usage);
    options = {};
    options.workers = 0;
    REQUIRE(Server::start(usual_routes(), options).error().code == ErrorCode::usage);
}
