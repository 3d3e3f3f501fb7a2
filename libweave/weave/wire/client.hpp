#pragma once

#include <weave/net/websocket_client.hpp>
#include <weave/wire/frame.hpp>
#include <weave/wire/message.hpp>
#include <weave/wire/place.hpp>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace weave::wire {

/// What comes from a server.
using Received = std::variant<ServerMessage, Frame>;

/// A new id of a request, which nobody has chosen before.
std::string new_request_id();

/// The id of a message that is answered; empty where it has none.
std::string request_id(const ClientMessage& message);

/// The id of the request that a message answers; empty where it answers none.
std::string answered_id(const ServerMessage& message);

/// One connection to a simd, which has agreed on the protocol. Blocking, for one thread; or one that sends and one that
/// receives, where neither asks. Errors of kind system may pass with another connection, others do not:
/// refused where the server does not permit it (no valid token, 1008), bad_input where it does not keep to the protocol
/// or speaks another version.
class Client {
  public:
    /// Connects and says hello as `name`, such as `weave 0.1`. Waits for the answer as long as ClientOptions::answer_time.
    static Result<Client> connect(const ServerPlace& place, const std::string& name);

    [[nodiscard]] const Welcome& welcome() const { return m_welcome; }

    /// Errors besides: usage for a message that no server takes, with its place, such as `simulation.residual`.
    Status send(const ClientMessage& message);
    /// The next message or frame; nothing if none comes in time.
    Result<std::optional<Received>> receive(std::chrono::milliseconds patience);
    /// Sends a message that has an id, and waits for its answer, which may be Refused. What else comes meanwhile is kept
    /// for receive(), of frames the newest. Errors besides: system where none comes in time.
    Result<ServerMessage> ask(const ClientMessage& message, std::chrono::milliseconds patience);
    /// Says goodbye.
    void close();

  private:
    Client(net::WebSocketClient socket, std::string place) : m_socket(std::move(socket)), m_place(std::move(place)) {}
    Status greet(const std::string& name, std::chrono::milliseconds patience);
    Result<std::optional<Received>> receive_new(std::chrono::milliseconds patience);
    Result<Received> read(const net::WebSocketMessage& message) const;
    Status keep(Received received);
    [[nodiscard]] Error ended() const;

    net::WebSocketClient m_socket;
    std::string m_place;  ///< for messages
    Welcome m_welcome;
    std::deque<Received> m_kept;
};

/// An answer of the type that was asked for. Errors: what a refusal says; bad_input for an answer of another type.
template <class Answer>
Result<Answer> answer_of(Result<ServerMessage> answer) {
    if (!answer) return std::move(answer).error();
    if (auto* wanted = std::get_if<Answer>(&*answer)) return std::move(*wanted);
    if (auto* refused = std::get_if<Refused>(&*answer)) return std::move(refused->error);
    return bad_input("the server gives another answer than was asked for");
}

/// Files that a server hands out beside messages, as their targets.
std::string session_yarns(std::uint64_t session);
std::string job_yarns(std::uint64_t job);
std::string job_evidence(std::uint64_t job);

/// The bytes of such a file. Errors: as Client's; bad_input where it is longer than `most` bytes.
Result<std::string> download(const ServerPlace& place, const std::string& target, std::uint64_t most);

}  // namespace weave::wire
