#include <simd/daemon/client.hpp>

#include <algorithm>

namespace weave::simd {

void Client::tell(const wire::ServerMessage& message) {
    m_socket->send_control(net::make_bytes(wire::write_message(message)));
}

void Client::show(const net::Bytes& frame, bool is_last) {
    {
        const std::lock_guard lock(m_mutex);
        if (m_frames_per_second <= 0) return;
        const Clock::time_point now = Clock::now();
        constexpr double longest_s = 1e6;
        const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(longest_s, 1 / m_frames_per_second)));
        // One that comes up to half a period early is shown, as the one before it may have come late; on average no more are than were asked for.
        if (!is_last && now + period / 2 < m_next_due) return;
        m_next_due = std::max(m_next_due, now) + period;
    }
    m_socket->send_frame(frame);
}

bool Client::is_full() const {
    constexpr std::size_t enough = std::size_t{1} << 20;  // a quarter of what closes a connection
    return m_socket->waiting_bytes() > enough;
}

void Client::want_frames(double most_per_second) {
    const std::lock_guard lock(m_mutex);
    m_frames_per_second = most_per_second;
    m_next_due = {};
}

double Client::frames_per_second() const {
    const std::lock_guard lock(m_mutex);
    return m_frames_per_second;
}

}  // namespace weave::simd
