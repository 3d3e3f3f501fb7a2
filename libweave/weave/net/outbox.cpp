#include <weave/net/outbox.hpp>

#include <cassert>

namespace weave::net {

Outbox::Outbox(std::size_t most_messages, std::size_t most_bytes, std::function<void()> wake)
    : m_most_messages(most_messages), m_most_bytes(most_bytes), m_wake(std::move(wake)) {}

bool Outbox::send_control(Bytes bytes, bool binary) {
    assert(bytes);
    const std::lock_guard lock(m_mutex);
    if (!m_wake || m_farewell) return false;
    if (m_control.size() >= m_most_messages || bytes->size() > m_most_bytes - m_control_bytes) {
        m_control.clear();  // what has a gap is no longer worth sending
        m_control_bytes = 0;
        m_frame = nullptr;
        say_farewell(1013, "too slow");
        return false;
    }
    m_control_bytes += bytes->size();
    m_control.push_back({std::move(bytes), binary, {}});
    m_wake();
    return true;
}

void Outbox::send_frame(Bytes bytes) {
    assert(bytes);
    const std::lock_guard lock(m_mutex);
    if (!m_wake || m_farewell) return;
    if (m_frame) ++m_dropped;
    m_frame = std::move(bytes);
    m_wake();
}

void Outbox::close(std::uint16_t code, std::string reason) {
    const std::lock_guard lock(m_mutex);
    if (m_wake && !m_farewell) say_farewell(code, std::move(reason));
}

std::size_t Outbox::waiting_bytes() const {
    const std::lock_guard lock(m_mutex);
    return m_control_bytes;
}

std::uint64_t Outbox::dropped_frames() const {
    const std::lock_guard lock(m_mutex);
    return m_dropped;
}

Outbox::Next Outbox::take() {
    const std::lock_guard lock(m_mutex);
    if (!m_control.empty()) {
        Next next = std::move(m_control.front());
        m_control.pop_front();
        m_control_bytes -= next.bytes->size();
        return next;
    }
    if (m_frame) return {std::exchange(m_frame, nullptr), true, {}};
    return {nullptr, false, m_farewell};
}

std::optional<std::size_t> Outbox::bytes_before_farewell() const {
    const std::lock_guard lock(m_mutex);
    if (!m_farewell) return {};
    return m_control_bytes + (m_frame ? m_frame->size() : 0);
}

std::optional<WebSocketEnd> Outbox::farewell() const {
    const std::lock_guard lock(m_mutex);
    return m_farewell;
}

void Outbox::end() {
    const std::lock_guard lock(m_mutex);
    m_wake = nullptr;
    m_control.clear();
    m_control_bytes = 0;
    m_frame = nullptr;
}

void Outbox::say_farewell(std::uint16_t code, std::string reason) {
    assert(reason.size() <= 123);
    m_farewell = WebSocketEnd{code, std::move(reason)};
    m_wake();
}

}  // namespace weave::net
