#pragma once

#include <weave/net/certificate.hpp>
#include <weave/net/metrics.hpp>
#include <weave/net/router.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace weave::net {

/// What a server lets one client, and all of them, have of it.
struct ServerLimits {
    std::size_t connections = 1024;
    std::size_t connections_per_address = 256;  ///< of IPv6, per /64; over the Unix socket, per uid
    std::size_t requests_per_connection = 10000;
    std::size_t header_bytes = 16384;            ///< request line and header fields together
    std::size_t body_bytes_in_all = 256u << 20;  ///< of all requests being received or answered
    std::size_t waiting_requests = 256;          ///< for a worker; more are answered 503

    std::chrono::milliseconds header_time{
        10'000};  ///< from a request's first byte to the end of its head; TLS as well
    std::chrono::milliseconds idle_time{60'000};  ///< until the next request, or a WebSocket's sign of life
    std::chrono::milliseconds transfer_time{30'000};  ///< for a body, in or out, beside what its size needs …
    std::size_t slowest_bytes_per_second = 16384;     ///< … at this pace

    std::size_t linger_bytes = 64u << 20;  ///< of a request that was refused unread: read and dropped, so that the
                                           ///< client gets the answer …
    std::chrono::milliseconds linger_time{10'000};  ///< … for so long in all …
    std::chrono::milliseconds linger_pause{2'000};  ///< … and so long without a byte; then it is closed

    std::size_t websockets = 512;
    std::size_t control_messages = 1024;   ///< waiting on one WebSocket
    std::size_t control_bytes = 4u << 20;  ///< waiting on one WebSocket
};

/// How a server is set up.
struct ServerOptions {
    std::string address = "127.0.0.1";   ///< IPv4 or IPv6 to listen on; empty: no TCP
    std::uint16_t port = 0;              ///< 0: any free one
    std::filesystem::path unix_socket;   ///< to listen on as well, for its owner alone (0600); empty: none
    std::optional<TlsFiles> tls;         ///< none: plain HTTP; over the Unix socket it is plain always
    bool plain_beyond_loopback = false;  ///< without it plain HTTP is served on loopback alone
    std::vector<std::string> hosts;      ///< that a Host field may name, without port; empty: any. Over the
                                         ///< Unix socket `localhost` as well
    std::vector<std::string>
        origins;                 ///< `https://host:port` of pages that may open WebSockets, beside our own
    std::size_t workers = 4;     ///< threads that run handlers
    std::size_t io_threads = 1;  ///< threads that read and write
    ServerLimits limits;
    std::shared_ptr<Metrics> metrics;  ///< told of requests and connections, if given
};

/// Whether a server can listen there: it listens, and lets go at once. Errors: usage for an address that is none;
/// system where address or port cannot be had.
Status check_listening(const std::string& address, std::uint16_t port);

/// Whether a server can be known by these files. Errors name the one that is wrong.
Status check_tls(const TlsFiles& files);

/// An HTTP/1.1 and WebSocket server. Requests are read whole before a worker sees them, and answers are
/// written without one, so a slow client holds no worker. TLS is 1.2 or newer.
class Server {
  public:
    /// Listens and serves from now on. The Unix socket of a dead server is replaced. Errors: usage for an
    /// address or path that is none, or plain HTTP beyond loopback; bad_input for certificate or key; refused
    /// where another server listens on the Unix socket, or something else lies in its place; system where the
    /// port cannot be had.
    static Result<Server> start(Router router, ServerOptions options);

    Server(Server&&) noexcept;
    Server& operator=(Server&&) noexcept;
    /// Stops at once.
    ~Server();

    /// That of TCP; 0 without it.
    [[nodiscard]] std::uint16_t port() const;

    /// Takes nothing new, removes the Unix socket, lets what runs finish, says goodbye to WebSockets (1001),
    /// and after `patience` cuts off what is left. Waits for handlers that still run, however long they do.
    /// May be called again; not from a handler.
    void stop(std::chrono::milliseconds patience);

  private:
    class Running;
    explicit Server(std::unique_ptr<Running> running);
    std::unique_ptr<Running> m_running;
};

}  // namespace weave::net
