#pragma once

#include <weave/net/client.hpp>
#include <weave/net/websocket.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace weave::net {

/// A blocking WebSocket client. One thread may receive while others send. It answers pings by itself, and
/// reads at most 16 messages ahead of receive(): a program that takes nothing for a minute loses the
/// connection.
class WebSocketClient {
  public:
    /// Connects and has the server agree. Errors as HttpClient's; where the server declines, refused with its
    /// status and reason, or system where that may pass (5xx, 429).
    static Result<WebSocketClient> connect(const ClientOptions& options, const std::string& target,
                                           const Headers& headers = {});

    WebSocketClient(WebSocketClient&&) noexcept;
    WebSocketClient& operator=(WebSocketClient&&) noexcept;
    /// Closes at once.
    ~WebSocketClient();

    /// Sends one message and waits until the network has taken it. Errors (system): the connection has ended,
    /// or takes nothing for ClientOptions::stall_time.
    Status send(std::string bytes, bool binary = false);
    /// The next message; nothing if none comes in time. Errors (system): the connection has ended and all
    /// that came before is taken.
    Result<std::optional<WebSocketMessage>> receive(std::chrono::milliseconds patience);
    /// How the connection ended; nothing while it lasts. What was not to be read ends it as well: 1009 for a
    /// message that is too long, 1007 for text that is no UTF-8, 1002 for what is no WebSocket.
    [[nodiscard]] std::optional<WebSocketEnd> end() const;
    /// Says goodbye with this code and waits for the server's, up to a second.
    void close(std::uint16_t code = 1000);

  private:
    class Running;
    explicit WebSocketClient(std::unique_ptr<Running> running);
    std::unique_ptr<Running> m_running;
};

}  // namespace weave::net
