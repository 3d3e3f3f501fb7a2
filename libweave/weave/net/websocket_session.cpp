#include <weave/net/websocket_session.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/beast/websocket/error.hpp>

namespace weave::net {

namespace {

namespace websocket = beast::websocket;

constexpr int send_buffer_bytes = 256 << 10;  // what the kernel holds back is old by the time it is read
constexpr Milliseconds parting_time{2'000};   // beside what the size of the queue asks

}  // namespace

WebSocketSession::WebSocketSession(std::shared_ptr<Connection> connection, std::size_t message_limit)
    : m_connection(std::move(connection)),
      m_socket(m_connection->m_stream),
      m_wake(m_connection->m_stream.get_executor(), asio::steady_timer::time_point::max()),
      m_parted(m_connection->m_stream.get_executor(), asio::steady_timer::time_point::max()) {
    set_up(message_limit);
}

void WebSocketSession::set_up(std::size_t message_limit) {
    const ServerLimits& limits = m_connection->m_service->options.limits;
    websocket::stream_base::timeout times{};
    times.handshake_timeout = limits.header_time;
    times.idle_timeout = limits.idle_time;
    times.keep_alive_pings = true;
    m_socket.set_option(times);
    m_socket.read_message_max(message_limit);
    m_socket.auto_fragment(false);
    error_code ignored;
    m_connection->m_stream.socket().set_option(asio::socket_base::send_buffer_size(send_buffer_bytes),
                                               ignored);
}

/// What the outbox calls, from any thread, when there is something to send.
std::function<void()> WebSocketSession::waker() {
    return [weak = weak_from_this(), executor = m_socket.get_executor()] {
        asio::post(executor, [weak] {
            const auto self = weak.lock();
            if (!self) return;
            self->m_wake.cancel();
            const auto bytes = self->m_outbox->bytes_before_farewell();
            if (bytes && self->m_connection->m_stream.socket().is_open())  // it may be stuck in a write
                self->m_connection->m_deadline.set(self->m_connection,
                                                   parting_time + self->m_connection->time_for(*bytes));
        });
    };
}

asio::awaitable<void> WebSocketSession::run(const Upgrade& upgrade,
                                            std::unique_ptr<WebSocketHandler> handler) {
    const auto [error] = co_await m_socket.async_accept(upgrade, as_result);
    if (error) co_return;
    const ServerLimits& limits = m_connection->m_service->options.limits;
    m_outbox = std::make_shared<Outbox>(limits.control_messages, limits.control_bytes, waker());
    m_connection->m_goodbye = [outbox = m_outbox] { outbox->close(1001, "the service stops"); };
    asio::co_spawn(
        m_socket.get_executor(), [self = shared_from_this()] { return self->write_all(); }, asio::detached);
    if (m_connection->m_service->stopping) m_connection->m_goodbye();

    WebSocketHandler& served = *handler;
    WebSocketEnd end{1001, {}};
    const std::function<void()> open = [&] { served.opened(m_outbox); };
    if (co_await call(open)) end = co_await read_all(served);
    m_connection->m_goodbye = nullptr;
    m_outbox->end();
    m_wake.cancel();
    m_connection->m_stream.close();
    const std::function<void()> part = [&] {
        served.closed(end);
        handler.reset();
    };
    co_await call(part);
}

/// Runs one call to the handler on a worker; false if the server gives up waiting for workers.
asio::awaitable<bool> WebSocketSession::call(std::function<void()> what) {
    const std::function<void()> guarded = [&] {
        try {
            what();
        } catch (...) {
            log(LogLevel::warning, "a WebSocket's handler failed: " + on_one_line(caught_message()));
            m_outbox->close(1011, "a fault of the service");
        }
    };
    co_return co_await on_worker(m_connection->m_service->pool, guarded, true);
}

asio::awaitable<WebSocketEnd> WebSocketSession::read_all(WebSocketHandler& handler) {
    while (true) {
        beast::flat_buffer buffer;
        const auto [error, size] = co_await m_socket.async_read(buffer, as_result);
        if (error) co_return end_of(error);
        if (const auto farewell = m_outbox->farewell()) {  // nobody hears it any more: a flood is not even read
            co_await m_parted.async_wait(as_result);
            co_return *farewell;
        }
        const char* const begin = static_cast<const char*>(buffer.cdata().data());
        WebSocketMessage message{std::string(begin, size), m_socket.got_binary()};
        const std::function<void()> hand_over = [&] { handler.message(std::move(message)); };
        if (!co_await call(hand_over)) co_return WebSocketEnd{1001, {}};
    }
}

asio::awaitable<void> WebSocketSession::write_all() {
    while (true) {
        const Outbox::Next next = m_outbox->take();
        if (next.bytes) {
            m_socket.binary(next.binary);
            const auto [error, size] = co_await m_socket.async_write(asio::buffer(*next.bytes), as_result);
            if (error) break;
        } else if (next.farewell) {
            websocket::close_reason reason(next.farewell->code);
            reason.reason.assign(next.farewell->reason.data(), next.farewell->reason.size());
            co_await m_socket.async_close(reason, as_result);
            break;
        } else {
            if (!m_connection->m_stream.socket().is_open()) break;
            co_await m_wake.async_wait(as_result);
        }
    }
    m_connection->m_stream.close();
    m_parted.expires_at(asio::steady_timer::time_point::min());  // also for who waits only later
}

WebSocketEnd WebSocketSession::end_of(const error_code& error) const {
    if (const auto ours = m_outbox->farewell()) return *ours;  // whatever the other side made of it
    if (error == websocket::error::message_too_big || error == websocket::error::buffer_overflow)
        return {1009, {}};
    if (error != websocket::error::closed) return {};
    const websocket::close_reason& reason = m_socket.reason();
    return {reason.code, std::string(reason.reason.data(), reason.reason.size())};
}

}  // namespace weave::net
