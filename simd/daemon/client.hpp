#pragma once

#include <weave/net/websocket.hpp>
#include <weave/wire/message.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace weave::simd {

/// A connection, as the daemon sees it: somebody who is told of a session and of his or her jobs. Safe from any thread.
class Client {
  public:
    using Clock = std::chrono::steady_clock;

    /// `may_stay`: whether its right to be here lasts; null: it does not end. Asked under the daemon's lock.
    Client(std::string person, std::function<bool()> may_stay, std::shared_ptr<net::WebSocket> socket)
        : m_person(std::move(person)), m_may_stay(std::move(may_stay)), m_socket(std::move(socket)) {}

    [[nodiscard]] const std::string& person() const { return m_person; }
    [[nodiscard]] bool may_stay() const { return !m_may_stay || m_may_stay(); }
    [[nodiscard]] Clock::time_point opened() const { return m_opened; }

    /// Queues a message that must arrive.
    void tell(const wire::ServerMessage& message);
    /// The same of one that is written already.
    void tell(net::Bytes text) { m_socket->send_control(std::move(text)); }
    /// Offers a frame, which waits for the connection or is overtaken; `is_last` ones whatever the pace.
    void show(const net::Bytes& frame, bool is_last);
    void close(std::uint16_t code, std::string reason) { m_socket->close(code, std::move(reason)); }
    /// The same, because it costs others their time (1008).
    void throw_out(std::string reason) {
        m_is_thrown_out = true;
        close(1008, std::move(reason));
    }
    [[nodiscard]] bool is_thrown_out() const { return m_is_thrown_out; }

    /// Whether so much waits for it already that what is not urgent had better wait here.
    [[nodiscard]] bool is_full() const;
    void want_frames(double most_per_second);
    [[nodiscard]] double frames_per_second() const;
    [[nodiscard]] std::uint64_t dropped_frames() const { return m_socket->dropped_frames(); }

    /// The session that it is attached to; 0: none. Only the daemon sets it.
    std::uint64_t session = 0;
    /// How often in a row it asked for too much in a short time. Only the daemon uses it.
    std::size_t impatient = 0;
    /// Jobs whose end it is still to be told. Only the daemon uses it.
    std::deque<std::uint64_t> untold_jobs;
    /// Has said hello. Only the daemon sets it.
    bool is_greeted = false;

  private:
    const std::string m_person;
    const std::function<bool()> m_may_stay;
    const Clock::time_point m_opened = Clock::now();
    const std::shared_ptr<net::WebSocket> m_socket;
    std::atomic<bool> m_is_thrown_out{false};
    mutable std::mutex m_mutex;
    double m_frames_per_second = 30;
    Clock::time_point m_next_due{};  ///< the next frame
};

}  // namespace weave::simd
