#pragma once

#include <weave/net/client.hpp>
#include <weave/net/stream.hpp>

#include <boost/asio/awaitable.hpp>
#include <memory>

namespace weave::net {

/// A client's open connection, with what it stands on.
struct Dialled {
    explicit Dialled(const asio::any_io_executor& executor)
        : stream(Socket(executor)), deadline(stream) {}
    std::optional<asio::ssl::context> tls;
    Stream stream;
    Deadline deadline;
};

/// Connects, and over TLS makes sure of the server. Errors as HttpClient tells them.
asio::awaitable<Result<std::shared_ptr<Dialled>>> dial(const ClientOptions& options);

/// The value of a Host header for that server.
std::string host_field(const ClientOptions& options);

/// The server as errors name it: its host, or `unix:/path/of/socket`.
std::string place_of(const ClientOptions& options);

/// An error of the network in words, or that the time was over.
Error network_fault(const ClientOptions& options, const error_code& error, bool late);

}  // namespace weave::net
