#include <weave/net/peer.hpp>

#include <algorithm>
#include <cstring>
#include <sys/socket.h>

namespace weave::net {

namespace {

/// The key under which connections are counted: the address, of IPv6 the network that one customer is given.
std::string address_key(const asio::ip::address& address) {
    if (!address.is_v6()) return address.to_string();
    if (address.to_v6().is_v4_mapped())
        return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).to_string();
    auto bytes = address.to_v6().to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), static_cast<unsigned char>(0));
    return asio::ip::address_v6(bytes).to_string() + "/64";
}

std::optional<std::uint32_t> uid_behind(int socket) {
    ucred found{};
    socklen_t size = sizeof found;
    if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &found, &size) != 0) return {};
    return found.uid;
}

}  // namespace

Peer peer_of(const Endpoint& endpoint, int socket) {
    if (endpoint.protocol().family() == AF_UNIX) {
        const auto uid = uid_behind(socket);
        return {"local", uid ? "uid " + std::to_string(*uid) : "local", true, uid};
    }
    const asio::ip::address address = tcp_endpoint(endpoint).address();
    return {address.to_string(), address_key(address), false, {}};
}

Tcp::endpoint tcp_endpoint(const Endpoint& endpoint) {
    Tcp::endpoint address;
    std::memcpy(address.data(), endpoint.data(), std::min(endpoint.size(), address.capacity()));
    address.resize(endpoint.size());
    return address;
}

}  // namespace weave::net
