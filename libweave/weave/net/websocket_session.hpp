#pragma once

#include <weave/net/connection.hpp>
#include <weave/net/outbox.hpp>
#include <weave/net/teardown.hpp>

#include <boost/beast/websocket/stream.hpp>

namespace weave::net {

/// A connection that has become a WebSocket. All of it runs on the connection's strand, the handler on
/// workers.
class WebSocketSession : public std::enable_shared_from_this<WebSocketSession> {
  public:
    using Upgrade = beast::http::request<beast::http::string_body>;

    WebSocketSession(std::shared_ptr<Connection> connection, std::size_t message_limit);

    /// Agrees to the upgrade and serves until either side ends it.
    asio::awaitable<void> run(const Upgrade& upgrade, std::unique_ptr<WebSocketHandler> handler);

  private:
    using Socket = beast::websocket::stream<Stream&>;

    void set_up(std::size_t message_limit);
    std::function<void()> waker();
    asio::awaitable<void> write_all();
    asio::awaitable<WebSocketEnd> read_all(WebSocketHandler& handler);
    asio::awaitable<bool> call(std::function<void()> what);
    [[nodiscard]] WebSocketEnd end_of(const error_code& error) const;

    std::shared_ptr<Connection> m_connection;
    Socket m_socket;
    asio::steady_timer m_wake, m_parted;  ///< there is something to send; nothing will be sent any more
    std::shared_ptr<Outbox> m_outbox;
};

}  // namespace weave::net
