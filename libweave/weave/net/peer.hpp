#pragma once

#include <weave/net/stream.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace weave::net {

/// Who is at the other end of a connection.
struct Peer {
    std::string shown;  ///< as Request::peer
    std::string key;    ///< under which connections of one client are counted
    bool local = false;
    std::optional<std::uint32_t> uid;  ///< of the process that connected over a Unix socket
};

/// The peer of a socket that was accepted from `endpoint`.
Peer peer_of(const Endpoint& endpoint, int socket);

/// The same address as one of TCP. Only for one of IPv4 or IPv6.
Tcp::endpoint tcp_endpoint(const Endpoint& endpoint);

}  // namespace weave::net
