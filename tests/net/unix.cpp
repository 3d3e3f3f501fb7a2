#include "service.hpp"

#include <weave/net/websocket_client.hpp>

#include <algorithm>
#include <atomic>
#include <fcntl.h>
#include <fstream>
#include <mutex>
#include <set>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <thread>

using namespace weave;
using namespace weave::net;
using namespace weave::net::testing;

namespace {

/// A server on a Unix socket alone.
ServerOptions on(const std::filesystem::path& path) {
    ServerOptions options;
    options.address.clear();
    options.unix_socket = path;
    return options;
}

ClientOptions client_at(const std::filesystem::path& path) {
    ClientOptions options;
    options.unix_socket = path;
    return options;
}

Error refused_start(const ServerOptions& options) {
    auto server = Server::start(usual_routes(), options);
    REQUIRE_FALSE(server);
    return server.error();
}

/// Gives a route's request to the test.
Router telling(std::shared_ptr<Request> told) {
    Router router = usual_routes();
    const auto tell = [told](const Request& request) {
        *told = request;
        return text("told");
    };
    REQUIRE(router.add({"tell", "GET", "/tell", "Tells", 0, tell, {}}));
    return router;
}

class Greeter : public WebSocketHandler {
  public:
    explicit Greeter(std::string greeting) : m_greeting(std::move(greeting)) {}
    void opened(std::shared_ptr<WebSocket> socket) override {
        m_socket = std::move(socket);
        m_socket->send_control(make_bytes(m_greeting));
    }
    void message(WebSocketMessage message) override { m_socket->send_control(make_bytes(message.bytes)); }
    void closed(const WebSocketEnd&) override {}

  private:
    std::string m_greeting;
    std::shared_ptr<WebSocket> m_socket;
};

int mode_of(const std::filesystem::path& path) {
    struct stat facts {};
    REQUIRE(::lstat(path.c_str(), &facts) == 0);
    REQUIRE(S_ISSOCK(facts.st_mode));
    return static_cast<int>(facts.st_mode & 07777);
}

/// A socket bound to the path, as another program would have it.
class Bound {
  public:
    Bound(const std::filesystem::path& path, int kind, int backlog = -1)
        : m_socket(::socket(AF_UNIX, kind, 0)) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        path.native().copy(address.sun_path, sizeof address.sun_path - 1);
        REQUIRE(::bind(m_socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
        if (backlog >= 0) REQUIRE(::listen(m_socket, backlog) == 0);
    }
    ~Bound() { ::close(m_socket); }
    Bound(const Bound&) = delete;
    Bound& operator=(const Bound&) = delete;
    [[nodiscard]] int number() const { return m_socket; }

  private:
    int m_socket;
};

std::size_t open_descriptors() {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

}  // namespace

TEST_CASE("a request over a Unix socket is answered, and says whose it is") {
    const Folder folder;
    const auto path = folder.path / "s";
    const auto told = std::make_shared<Request>();
    const Server server = started(telling(told), on(path));
    REQUIRE(server.port() == 0);
    HttpClient client(client_at(path));
    REQUIRE(*client.send({"GET", "/hello", {}, {}}).value().body == "hello");
    REQUIRE(*client.send({"POST", "/echo", {}, "again"}).value().body == "again");
    const auto answered = client.send({"GET", "/tell", {}, {}});
    REQUIRE(answered.value().status == 200);
    REQUIRE(told->local);
    REQUIRE(told->uid == ::getuid());
    REQUIRE(told->peer == "local");
    REQUIRE_FALSE(told->secure);
}

TEST_CASE("a Unix socket beside TCP with TLS is plain, and TCP tells no uid") {
    const Folder folder;
    const auto path = folder.path / "s";
    REQUIRE(make_certificate(folder.tls(), {"localhost", "127.0.0.1"}));
    const auto told = std::make_shared<Request>();
    ServerOptions options = on(path);
    options.address = "127.0.0.1";
    options.tls = folder.tls();
    options.hosts = {"box.example", "127.0.0.1"};
    const Server server = started(telling(told), options);

    HttpClient local(client_at(path));
    const auto plain = local.send({"GET", "/tell", {}, {}});
    REQUIRE(plain.value().status == 200);
    REQUIRE(plain->headers.find("Strict-Transport-Security") == nullptr);
    REQUIRE(told->local);

    ClientOptions far = client_of(server);
    far.tls.emplace();
    far.tls->authorities = folder.tls().certificate;
    const auto secured = HttpClient(far).send({"GET", "/tell", {}, {}});
    REQUIRE(secured.value().status == 200);
    REQUIRE(secured->headers.find("Strict-Transport-Security") != nullptr);
    REQUIRE_FALSE(told->local);
    REQUIRE_FALSE(told->uid);
    REQUIRE(told->secure);
    REQUIRE(told->peer == "127.0.0.1");
}

TEST_CASE("Host is held to the list over a Unix socket too, but for localhost") {
    const Folder folder;
    ServerOptions options = on(folder.path / "s");
    options.hosts = {"box.example"};
    const Server server = started(usual_routes(), options);
    const auto asked = [&](const std::string& host) {
        const std::string request = "GET /hello HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n";
        return reply_to(options.unix_socket, request).substr(9, 3);
    };
    REQUIRE(asked("Host: localhost\r\n") == "200");
    REQUIRE(asked("Host: box.example:80\r\n") == "200");
    REQUIRE(asked("Host: other.example\r\n") == "421");
    REQUIRE(asked("") == "400");
}

TEST_CASE("a WebSocket over a Unix socket") {
    const Folder folder;
    const auto path = folder.path / "s";
    Router router;
    const auto admit = [](const Request& request) -> WebSocketAdmission {
        return std::make_unique<Greeter>(request.peer + " " + std::to_string(request.uid.value_or(0)));
    };
    REQUIRE(router.add({"socket", "GET", "/socket", "Repeats", 100'000, {}, admit}));
    Server server = started(std::move(router), on(path));
    auto client = WebSocketClient::connect(client_at(path), "/socket");
    REQUIRE(client);
    REQUIRE(client->receive(20s).value()->bytes == "local " + std::to_string(::getuid()));
    const std::string large(90'000, 'a');
    REQUIRE(client->send(large));
    REQUIRE(client->receive(20s).value()->bytes == large);
    server.stop(10s);
    REQUIRE_FALSE(client->receive(20s));
    REQUIRE(client->end()->code == 1001);
    const auto gone = WebSocketClient::connect(client_at(path), "/socket");
    REQUIRE(gone.error().where == "unix:" + path.string());
}

TEST_CASE("the socket is its owner's alone whatever the umask, and goes with the server") {
    const Folder folder;
    const auto path = folder.path / "s";
    const mode_t mask = GENERATE(0u, 022u, 0777u);
    const mode_t before = ::umask(mask);
    auto server = Server::start(usual_routes(), on(path));
    ::umask(before);
    REQUIRE(server);
    REQUIRE(mode_of(path) == 0600);
    REQUIRE(HttpClient(client_at(path)).send({"GET", "/hello", {}, {}}));
    server->stop(10s);
    REQUIRE_FALSE(std::filesystem::exists(path));
    REQUIRE(HttpClient(client_at(path)).send({"GET", "/hello", {}, {}}).error().code == ErrorCode::system);
    REQUIRE(std::filesystem::is_empty(folder.path));
}

TEST_CASE("the socket of a dead server is replaced, and nothing else is") {
    const Folder folder;
    const auto path = folder.path / "s";
    { const Bound dead(path, SOCK_STREAM, 5); }
    REQUIRE(std::filesystem::exists(path));
    {
        const Server server = started(usual_routes(), on(path));
        REQUIRE(HttpClient(client_at(path)).send({"GET", "/hello", {}, {}}));
        const Error living = refused_start(on(path));
        REQUIRE(living.code == ErrorCode::refused);
        REQUIRE(living.message == "another server listens there");
        REQUIRE(living.where == path.string());
        REQUIRE(HttpClient(client_at(path)).send({"GET", "/hello", {}, {}}));
    }
    REQUIRE_FALSE(std::filesystem::exists(path));

    std::ofstream(path) << "mine";
    REQUIRE(refused_start(on(path)).code == ErrorCode::refused);
    REQUIRE(std::filesystem::file_size(path) == 4);
    const auto link = folder.path / "link";
    std::filesystem::create_symlink(folder.path / "elsewhere", link);
    REQUIRE(refused_start(on(link)).code == ErrorCode::refused);
    REQUIRE(std::filesystem::is_symlink(link));
    const auto datagrams = folder.path / "d";
    const Bound other(datagrams, SOCK_DGRAM);
    REQUIRE(refused_start(on(datagrams)).code == ErrorCode::system);
    REQUIRE(std::filesystem::exists(datagrams));
}

TEST_CASE("a server whose queue is full lives, and a client waits for it") {
    const Folder folder;
    const auto path = folder.path / "s";
    const Bound busy(path, SOCK_STREAM, 0);
    const RawSocket first(path);
    REQUIRE(first.connected());
    REQUIRE(refused_start(on(path)).message == "another server listens there");
    ClientOptions options = client_at(path);
    options.connect_time = 200ms;
    REQUIRE(HttpClient(options).send({"GET", "/", {}, {}}).error().message.find("in time") !=
            std::string::npos);

    options.connect_time = 20s;
    std::thread server([&] {
        ::usleep(100'000);
        ::close(::accept(busy.number(), nullptr, nullptr));
        const int client = ::accept(busy.number(), nullptr, nullptr);
        char piece[4096];
        static_cast<void>(::recv(client, piece, sizeof piece, 0));
        const std::string words = "HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nlate";
        static_cast<void>(::send(client, words.data(), words.size(), MSG_NOSIGNAL));
        ::close(client);
    });
    const auto answered = HttpClient(options).send({"GET", "/", {}, {}});
    server.join();
    REQUIRE(answered);
    REQUIRE(*answered->body == "late");
}

TEST_CASE("of servers that start at once where a dead one was, one serves and the others say why not") {
    const Folder folder;
    const auto path = folder.path / "s";
    for (int round = 0; round < 400; ++round) {
        { const Bound dead(path, SOCK_STREAM, 5); }
        std::mutex mutex;
        std::vector<Server> serving;
        std::vector<Error> errors;
        std::vector<std::thread> starters;
        std::atomic<bool> go{false};
        for (int k = 0; k < 3; ++k)
            starters.emplace_back([&] {
                Router router;
                const auto greet = [](const Request&) { return text("hello"); };
                const Status added = router.add({"hello", "GET", "/hello", "Greets", 0, greet, {}});
                while (!go) continue;
                auto server = Server::start(std::move(router), on(path));
                const std::lock_guard lock(mutex);
                if (server && added)
                    serving.push_back(std::move(*server));
                else
                    errors.push_back(server.error());
            });
        go = true;
        for (std::thread& starter : starters) starter.join();
        REQUIRE(serving.size() == 1);
        for (const Error& error : errors) REQUIRE(error.message == "another server listens there");
        REQUIRE(HttpClient(client_at(path)).send({"GET", "/hello", {}, {}}));
    }
}

TEST_CASE("a file that took the place of the socket stays when the server stops") {
    const Folder folder;
    const auto path = folder.path / "s";
    Server server = started(usual_routes(), on(path));
    std::filesystem::remove(path);
    std::ofstream(path) << "mine";
    server.stop(10s);
    REQUIRE(std::filesystem::file_size(path) == 4);
}

TEST_CASE("places that no socket can have are refused in words") {
    const Folder folder;
    const Error long_one = refused_start(on("/tmp/" + std::string(103, 'a')));
    REQUIRE(long_one.code == ErrorCode::usage);
    REQUIRE(long_one.message == "the path of a socket may have 107 bytes, this one has 108");
    REQUIRE(
        HttpClient(client_at("/tmp/" + std::string(103, 'a'))).send({"GET", "/", {}, {}}).error().message ==
        long_one.message);
    REQUIRE(refused_start(on(std::string("/tmp/a\0b", 8))).code == ErrorCode::usage);
    REQUIRE(refused_start(on(folder.path / "none" / "s")).code == ErrorCode::system);
    REQUIRE(refused_start(on({})).code == ErrorCode::usage);  // neither TCP nor a socket
    ClientOptions secured = client_at(folder.path / "s");
    secured.tls.emplace();
    REQUIRE(HttpClient(secured).send({"GET", "/", {}, {}}).error().code == ErrorCode::usage);

    const auto longest = folder.path / std::string(107 - folder.path.native().size() - 1, 'a');
    const Server server = started(usual_routes(), on(longest));
    REQUIRE(HttpClient(client_at(longest)).send({"GET", "/hello", {}, {}}));
}

TEST_CASE("unix: and a path stand for a Unix socket") {
    const auto local = parse_origin("unix:/run/simd/s");
    REQUIRE(local);
    REQUIRE(local->unix_socket == "/run/simd/s");
    REQUIRE_FALSE(local->tls);
    CHECK(parse_origin("unix:run/s").value().unix_socket == "run/s");  // from the working folder on, which may lie deeper than a socket's name reaches
    for (const char* bad : {"unix:", "unix:/", "unix:run/", "unix:/run/", "unix:/a\nb", "UNIX:/a"}) {
        INFO(bad);
        REQUIRE_FALSE(parse_origin(bad));
    }
}

TEST_CASE("connections over a Unix socket are counted by uid") {
    const Folder folder;
    ServerOptions options = on(folder.path / "s");
    options.limits.connections_per_address = 2;
    const Server server = started(usual_routes(), options);
    const auto greeted = [&](RawSocket& socket) {
        socket.send("GET /hello HTTP/1.1\r\nHost: localhost\r\n\r\n");
        return socket.read_until([](const std::string& read) { return read.ends_with("hello"); });
    };
    RawSocket one(options.unix_socket), two(options.unix_socket), three(options.unix_socket);
    REQUIRE(greeted(one).starts_with("HTTP/1.1 200"));
    REQUIRE(greeted(two).starts_with("HTTP/1.1 200"));
    REQUIRE(greeted(three).empty());
    if (::getuid() != 0) return;  // only root can be somebody else

    std::filesystem::permissions(folder.path, std::filesystem::perms(0711));
    std::filesystem::permissions(options.unix_socket, std::filesystem::perms(0666));
    const pid_t child = ::fork();
    if (child == 0) {
        if (::setuid(65534) != 0) ::_exit(2);
        RawSocket other(options.unix_socket);
        ::_exit(greeted(other).starts_with("HTTP/1.1 200") ? 0 : 1);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    REQUIRE(WEXITSTATUS(status) == 0);
}

TEST_CASE("10,000 connections one after another leave no descriptor behind") {
    const Folder folder;
    const auto path = folder.path / "s";
    const Server server = started(usual_routes(), on(path));
    const std::size_t before = open_descriptors();
    for (int k = 0; k < 10'000; ++k) {
        HttpClient client(client_at(path));
        const auto answered = client.send({"GET", "/hello", {}, {}});
        if (!answered) FAIL("connection " << k << ": " << answered.error().message);
    }
    REQUIRE(comes_true([&] { return open_descriptors() <= before; }));
}

TEST_CASE("a program that the service starts inherits none of its sockets") {
    const Folder folder;
    const auto inherited = [] {
        std::size_t count = 0;
        for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
            const int number = std::stoi(entry.path().filename().string());
            struct stat facts {};
            const bool socket = ::fstat(number, &facts) == 0 && S_ISSOCK(facts.st_mode);
            if (socket && (::fcntl(number, F_GETFD) & FD_CLOEXEC) == 0) ++count;
        }
        return count;
    };
    const std::size_t before = inherited();
    ServerOptions options = on(folder.path / "s");
    options.address = "127.0.0.1";
    const Server server = started(usual_routes(), options);
    RawSocket near(options.unix_socket), far(server.port());
    const std::string hello = "GET /hello HTTP/1.1\r\nHost: localhost\r\n\r\n";
    for (RawSocket* client : {&near, &far}) {
        REQUIRE(client->send(hello));
        client->read_until([](const std::string& read) { return read.ends_with("hello"); });
    }
    REQUIRE(inherited() == before + 2);  // the test's own ends
}
