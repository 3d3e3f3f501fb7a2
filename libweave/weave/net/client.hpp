#pragma once

#include <weave/net/message.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace weave::net {

/// How a client knows the server, over TLS, for the one it means. The host name is checked either way.
struct Trust {
    std::filesystem::path
        authorities;          ///< PEM file of certificates that may sign; empty: those of the system
    std::string fingerprint;  ///< SHA-256 of the server's certificate (64 hexadecimal digits); if given, it
                              ///< alone decides
};

/// Where a service is, and how patient to be with it.
struct ClientOptions {
    std::string host = "127.0.0.1";  ///< name or address, without brackets
    std::uint16_t port = 0;
    std::optional<Trust> tls;                        ///< none: plain
    std::filesystem::path unix_socket;               ///< in place of host and port; plain
    std::chrono::milliseconds connect_time{10'000};  ///< to reach the server, TLS included
    std::chrono::milliseconds answer_time{60'000};   ///< from a request to the head of its answer
    std::chrono::milliseconds stall_time{30'000};    ///< without a byte of a body coming or going
    std::size_t most_body_bytes = 64u << 20;  ///< of an answer kept in memory, or of one WebSocket message
};

/// `https://host:port`, `http://host:port` (an IPv6 address in brackets; a slash may follow) or
/// `unix:/path/of/socket` (`unix:socket`: in the working folder), as a person writes it, taken apart. Over TLS the
/// system's authorities are trusted. Errors: bad_input.
Result<ClientOptions> parse_origin(const std::string& origin);

/// Is told, at least ten times a second while a request is under way, how many bytes of its body are sent; false gives it up.
using Progress = std::function<bool(std::size_t sent)>;

/// What a client asks.
struct ClientRequest {
    std::string method = "GET";
    std::string target = "/";  ///< path and query, percent-encoded
    Headers headers;
    std::string body;
    Progress progress{};  ///< none: it goes on to its end
};

/// Takes the next piece of an answer's body; an error ends the transfer and is handed on.
using Sink = std::function<Status(std::string_view piece)>;

/// A blocking HTTP client that keeps its connection open between requests. For one thread at a time. An
/// answer with an error status is an answer. Errors: system when the server cannot be reached or falls
/// silent; refused when it is not the one that was meant; bad_input when it answers nonsense or more than it
/// may; refused when ClientRequest::progress gave the request up: nobody knows then whether the server did what was asked.
class HttpClient {
  public:
    explicit HttpClient(ClientOptions options);
    HttpClient(HttpClient&&) noexcept;
    HttpClient& operator=(HttpClient&&) noexcept;
    ~HttpClient();

    /// Asks and waits for the whole answer. A GET or HEAD whose kept connection turns out to be closed is
    /// sent again on a new one.
    Result<Response> send(const ClientRequest& request);
    /// The same, but the body of a 200 goes to `sink` piece by piece, without a bound; other answers come
    /// whole.
    Result<Response> send(const ClientRequest& request, const Sink& sink);

  private:
    class Connected;
    Result<Response> transfer(const ClientRequest& request, const Sink* sink);

    ClientOptions m_options;
    std::unique_ptr<Connected> m_connected;
};

}  // namespace weave::net
