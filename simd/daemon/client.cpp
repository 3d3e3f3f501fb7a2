#include <simd/daemon/client.hpp>

namespace weave::simd {

void Client::tell(const wire::ServerMessage& message) {
    m_socket->send_control(net::make_bytes(wire::write_message(message)));
}

void Client::show(const net::Bytes& frame, bool is_last) {
    {
        const std::lock_guard lock(m_mutex);
        if (m_frames_per_second <= 0) return;
        const Clock::time_point now = Clock::now();
        // A little early is not too often: frames come at the pace of the fastest client.
        constexpr double early = 0.9;
        if (!is_last && std::chrono::duration<double>(now - m_last_shown).count() * m_frames_per_second < early) return;
        m_last_shown = now;
    }
    m_socket->send_frame(frame);
}

void Client::want_frames(double most_per_second) {
    const std::lock_guard lock(m_mutex);
    m_frames_per_second = most_per_second;
}

double Client::frames_per_second() const {
    const std::lock_guard lock(m_mutex);
    return m_frames_per_second;
}

}  // namespace weave::simd
