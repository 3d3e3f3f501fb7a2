#pragma once

#include <weave/net/client.hpp>
#include <weave/net/server.hpp>

#include <catch2/catch.hpp>

#include <arpa/inet.h>
#include <chrono>
#include <filesystem>
#include <netinet/in.h>
#include <poll.h>
#include <string>
#include <support/temporary_folder.hpp>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace weave::net::testing {

using namespace std::chrono_literals;

/// A socket to a port or a Unix socket of this machine, for bytes that no decent client sends.
class RawSocket {
  public:
    explicit RawSocket(std::uint16_t port, int receive_buffer = 0)
        : m_socket(::socket(AF_INET, SOCK_STREAM, 0)) {
        if (receive_buffer > 0)
            ::setsockopt(m_socket, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_port = htons(port);
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        m_connected = ::connect(m_socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
    }
    explicit RawSocket(const std::filesystem::path& path) : m_socket(::socket(AF_UNIX, SOCK_STREAM, 0)) {
        sockaddr_un place{};
        place.sun_family = AF_UNIX;
        path.native().copy(place.sun_path, sizeof place.sun_path - 1);
        m_connected = ::connect(m_socket, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
    }
    ~RawSocket() { ::close(m_socket); }
    RawSocket(const RawSocket&) = delete;
    RawSocket& operator=(const RawSocket&) = delete;

    [[nodiscard]] bool connected() const { return m_connected; }
    /// Sends all of it; false if the other side has closed.
    bool send(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(m_socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(sent));
        }
        return true;
    }
    void end_sending() { ::shutdown(m_socket, SHUT_WR); }
    /// What comes until the other side closes, or until `enough` says so, or the time is over.
    template <class Enough>
    std::string read_until(Enough enough, std::chrono::milliseconds patience = 20s) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!enough(m_read)) {
            const auto left =
                std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
            pollfd wait{m_socket, POLLIN, 0};
            if (left.count() <= 0 || ::poll(&wait, 1, static_cast<int>(left.count())) <= 0) break;
            char piece[4096];
            const ssize_t size = ::recv(m_socket, piece, sizeof piece, 0);
            m_closed = size <= 0;
            if (m_closed) break;
            m_read.append(piece, static_cast<std::size_t>(size));
        }
        return m_read;
    }
    std::string read_all(std::chrono::milliseconds patience = 20s) {
        return read_until([](const std::string&) { return false; }, patience);
    }
    /// Whether the other side has closed, as far as reading showed.
    [[nodiscard]] bool closed() const { return m_closed; }

  private:
    int m_socket;
    bool m_connected = false;
    bool m_closed = false;
    std::string m_read;
};

/// A folder that goes away with the test, and the files of a certificate in it.
struct Folder : weave::testing::TemporaryFolder {
    [[nodiscard]] TlsFiles tls() const { return {path / "server.pem", path / "server.key"}; }
};

inline Response text(std::string words) {
    return answer(200, "text/plain; charset=utf-8", make_bytes(std::move(words)));
}

/// Routes that most tests need: GET /hello and POST /echo of up to 1,000 bytes.
inline Router usual_routes() {
    Router router;
    REQUIRE(router.add(
        {"hello", "GET", "/hello", "Greets", 0, [](const Request&) { return text("hello"); }, {}}));
    REQUIRE(router.add({"echo",
                        "POST",
                        "/echo",
                        "Repeats",
                        1000,
                        [](const Request& request) { return text(request.body); },
                        {}}));
    return router;
}

inline Server started(Router router, ServerOptions options = {}) {
    auto server = Server::start(std::move(router), std::move(options));
    REQUIRE(server);
    return std::move(*server);
}

inline ClientOptions client_of(const Server& server) {
    ClientOptions options;
    options.port = server.port();
    return options;
}

/// What a server sends to these bytes until it closes.
template <class Place>
std::string reply_to(const Place& place, const std::string& bytes) {
    RawSocket socket(place);
    socket.send(bytes);
    return socket.read_all();
}

/// Waits until something holds; false if it does not within 20 s.
template <class Holds>
bool comes_true(Holds holds) {
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (!holds()) {
        if (std::chrono::steady_clock::now() > end) return false;
        ::usleep(2000);
    }
    return true;
}

}  // namespace weave::net::testing
