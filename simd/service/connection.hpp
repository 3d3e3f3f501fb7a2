#pragma once

#include <weave/net/websocket.hpp>

#include <cstddef>
#include <memory>
#include <simd/daemon/daemon.hpp>
#include <simd/service/visitors.hpp>
#include <string>

namespace weave::simd {

/// One WebSocket that speaks the protocol (wire/PROTOCOL.md): reads what comes, and hands it to the daemon.
class Connection final : public net::WebSocketHandler {
  public:
    Connection(Daemon& daemon, Doorkeeper& doorkeeper, Visitor visitor, std::string server)
        : m_daemon(daemon), m_doorkeeper(doorkeeper), m_visitor(std::move(visitor)), m_server(std::move(server)) {}
    ~Connection() override;

    void opened(std::shared_ptr<net::WebSocket> socket) override;
    void message(net::WebSocketMessage message) override;
    void closed(const net::WebSocketEnd&) override {}

  private:
    void take(net::WebSocketMessage message);
    void greet(const wire::ClientMessage& message);
    void not_understood(const std::string& text, const Error& error);

    Daemon& m_daemon;
    Doorkeeper& m_doorkeeper;
    const Visitor m_visitor;
    const std::string m_server;
    std::shared_ptr<Client> m_client;
    bool m_is_greeted = false, m_is_out = false;
    std::size_t m_not_understood = 0;
};

}  // namespace weave::simd
