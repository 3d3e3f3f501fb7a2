#pragma once

#include <weave/core/descriptor.hpp>
#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <chrono>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace weave::simd {

/// One thing that the daemon and a worker say to one another.
struct LinkMessage {
    bool is_frame = false;  ///< then the bytes are a frame (wire/frame.hpp), else JSON
    std::string bytes;
};

/// One end of the socket between the daemon and a worker: messages in both directions, none lost while both live. Any thread
/// may send, one receives. Each message is its length (32 bits, little-endian), `c` (control) or `f` (frame), and its bytes.
class Link {
  public:
    explicit Link(Descriptor socket) : m_socket(std::move(socket)) {}
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;

    /// Two ends; neither outlives an exec() by itself. Errors: system.
    static Result<std::pair<Descriptor, Descriptor>> pair();

    /// Waits until the other side has taken it, up to a limit within which a living one would. Errors: the other side is gone
    /// or stuck.
    Status send(const Json& message);
    Status send_frame(std::string_view bytes);
    /// Does not wait: an other side that has left so much unread that this finds no room is given up.
    Status post(const Json& message);
    /// The next message, or nothing once the other side is gone. Errors: a message longer than any may be.
    Result<std::optional<LinkMessage>> receive();
    /// Ends what send and receive wait for, from any thread.
    void cut();
    /// Receives nothing any more; what is sent still arrives.
    void stop_receiving();

  private:
    Status send(char kind, std::string_view bytes, int flags);
    bool read_whole(char* into, std::size_t size);

    Descriptor m_socket;
    std::mutex m_sending;
};

/// No message is longer: a document with its journal, or a frame.
inline constexpr std::size_t most_link_bytes = std::size_t{128} << 20;
/// So long may sending take.
inline constexpr std::chrono::seconds link_patience{30};

}  // namespace weave::simd
