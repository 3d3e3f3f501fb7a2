#pragma once

#include <weave/net/websocket.hpp>

#include <deque>
#include <functional>
#include <mutex>
#include <optional>

namespace weave::net {

/// What waits to be sent on a WebSocket: the two lanes, apart from the connection, so that the service may
/// keep it after the connection, and the whole server, are gone.
class Outbox final : public WebSocket {
  public:
    /// How the sending goes on.
    struct Next {
        Bytes bytes;  ///< a message to send, or null
        bool binary = false;
        std::optional<WebSocketEnd> farewell;  ///< without bytes: close now
    };

    /// `wake` is called, with the outbox locked, when there is something new to take; it must not call back.
    Outbox(std::size_t most_messages, std::size_t most_bytes, std::function<void()> wake);

    bool send_control(Bytes bytes, bool binary) override;
    void send_frame(Bytes bytes) override;
    void close(std::uint16_t code, std::string reason) override;
    [[nodiscard]] std::size_t waiting_bytes() const override;
    [[nodiscard]] std::uint64_t dropped_frames() const override;

    /// Takes what is to be sent next: control messages, then the frame, then the farewell.
    Next take();
    /// Whether, and behind how many bytes, a farewell waits.
    [[nodiscard]] std::optional<std::size_t> bytes_before_farewell() const;
    /// The farewell, if one was said.
    [[nodiscard]] std::optional<WebSocketEnd> farewell() const;
    /// The connection is gone: nothing more is taken in, and `wake` is let go.
    void end();

  private:
    void say_farewell(std::uint16_t code, std::string reason);

    const std::size_t m_most_messages, m_most_bytes;
    mutable std::mutex m_mutex;
    std::function<void()> m_wake;  ///< null: ended
    std::deque<Next> m_control;
    std::size_t m_control_bytes = 0;
    Bytes m_frame;
    std::uint64_t m_dropped = 0;
    std::optional<WebSocketEnd> m_farewell;
};

}  // namespace weave::net
