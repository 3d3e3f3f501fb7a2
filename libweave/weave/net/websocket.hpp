#pragma once

#include <weave/net/message.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <variant>

namespace weave::net {

/// One message of a WebSocket.
struct WebSocketMessage {
    std::string bytes;
    bool binary = false;  ///< otherwise UTF-8 text
};

/// Why a WebSocket ended: by the service's own close, as it gave it, or by the other side's.
struct WebSocketEnd {
    std::uint16_t code = 1006;  ///< as RFC 6455 numbers them; 1006: the connection broke
    std::string reason;         ///< the other side's is hostile, at most 123 bytes
};

/// The server's end of an open WebSocket. Safe to use from any thread, and after the end, when sending does
/// nothing. Two lanes lead out, and no send ever waits for the client:
/// - control: kept in order and never dropped. A client that lets more pile up than the bound is closed with
/// 1013.
/// - frames: only the newest waits; one that is overtaken is counted as dropped. A control message goes
/// first.
class WebSocket {
  public:
    virtual ~WebSocket() = default;

    /// Queues a message that must arrive. False if the connection has ended or ends by this very message.
    virtual bool send_control(Bytes bytes, bool binary = false) = 0;
    /// Offers the newest frame (binary) in place of the one that still waits, if any.
    virtual void send_frame(Bytes bytes) = 0;
    /// Ends the connection once the control messages queued so far are sent. `reason` at most 123 bytes of
    /// UTF-8.
    virtual void close(std::uint16_t code, std::string reason) = 0;
    /// Bytes of control messages that wait to be sent.
    [[nodiscard]] virtual std::size_t waiting_bytes() const = 0;
    /// How many frames were overtaken so far.
    [[nodiscard]] virtual std::uint64_t dropped_frames() const = 0;
};

/// What the service does with one WebSocket. The calls come from workers, one after another, and may block:
/// the next message is read from the network only when the last one is dealt with. Where one throws, the
/// connection is closed with 1011. If the server has to stop by force, closed() may be left out: the
/// destructor is the last word.
class WebSocketHandler {
  public:
    virtual ~WebSocketHandler() = default;

    /// Once, before all others. The handler may keep the socket.
    virtual void opened(std::shared_ptr<WebSocket> socket) = 0;
    virtual void message(WebSocketMessage message) = 0;
    virtual void closed(const WebSocketEnd& end) = 0;
};

/// Who takes care of the new WebSocket, or the answer that refuses it.
using WebSocketAdmission = std::variant<std::unique_ptr<WebSocketHandler>, Response>;

}  // namespace weave::net
