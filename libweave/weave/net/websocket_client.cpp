#include <weave/net/websocket_client.hpp>

#include <weave/core/json.hpp>
#include <weave/core/text.hpp>
#include <weave/net/dial.hpp>
#include <weave/net/teardown.hpp>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

namespace weave::net {

namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;

constexpr std::size_t most_ahead = 16;
constexpr std::size_t write_buffer_bytes = 65536;
constexpr std::chrono::seconds silence_time{60};
constexpr Milliseconds parting_time{1'000};
constexpr std::size_t longest_reason = 1'000;  ///< bytes told of a server's reason to decline

/// Why the server does not become a WebSocket, with the reason of its answer (net::error_answer), if it has one.
Error declined(const websocket::response_type& response, const std::string& host) {
    const unsigned status = response.result_int();
    const bool passes = status >= 500 || status == 429;
    Error error{passes ? ErrorCode::system : ErrorCode::refused, "the server answers " + std::to_string(status), host};
    const auto body = parse_json(response.body());
    if (!body || !body->is_object()) return error;
    const Json cause = body->value("error", Json());
    if (!cause.is_object() || !cause.contains("message") || !cause.at("message").is_string()) return error;
    error.message += ": " + on_one_line(cause.at("message").get<std::string>().substr(0, longest_reason));
    return error;
}

/// How a connection ends on which the other side said no goodbye.
WebSocketEnd end_of(const error_code& error) {
    if (error == websocket::error::message_too_big) return {1009, {}};
    if (error == websocket::error::bad_frame_payload) return {1007, {}};
    if (error == websocket::condition::protocol_violation) return {1002, {}};
    return {};
}

}  // namespace

/// The connection and the thread that serves it. What the callers share with that thread is under the mutex;
/// the rest belongs to it.
class WebSocketClient::Running {
  public:
    explicit Running(ClientOptions options) : m_options(std::move(options)) {}
    ~Running() {
        asio::post(m_io, [this] { shut(); });
        if (m_thread.joinable()) m_thread.join();
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    Status connect(const std::string& target, const Headers& headers) {
        std::optional<Status> outcome;
        const auto run = [&]() -> asio::awaitable<void> { outcome = co_await agree(target, headers); };
        asio::co_spawn(m_io, run, asio::detached);
        while (!outcome && m_io.run_one() > 0) continue;  // not run(): an open WebSocket keeps a timer going
        if (!outcome) return system_fault("the connection failed", place_of(m_options));
        if (!*outcome) return *outcome;
        asio::co_spawn(
            m_io, [this] { return read_all(); }, asio::detached);
        asio::co_spawn(
            m_io, [this] { return write_all(); }, asio::detached);
        m_thread = std::thread([this] { m_io.run(); });
        return {};
    }

    Status send(std::string bytes, bool binary) {
        std::unique_lock lock(m_mutex);
        if (m_end) return ended();
        const std::uint64_t number = m_queued++;
        m_outgoing.push_back({std::move(bytes), binary});
        asio::post(m_io, [this] { m_wake_writer->cancel(); });
        const auto gone = [&] { return m_sent > number || m_end; };
        if (!m_changed.wait_for(lock, m_options.stall_time, gone)) return network_fault(m_options, {}, true);
        return m_sent > number ? Status() : Status(ended());
    }

    Result<std::optional<WebSocketMessage>> receive(Milliseconds patience) {
        std::unique_lock lock(m_mutex);
        m_changed.wait_for(lock, patience, [&] { return !m_incoming.empty() || m_end; });
        if (m_incoming.empty()) {
            if (m_end) return ended();
            return std::optional<WebSocketMessage>();
        }
        std::optional<WebSocketMessage> message = std::move(m_incoming.front());
        m_incoming.pop_front();
        asio::post(m_io, [this] { m_wake_reader->cancel(); });
        return message;
    }

    std::optional<WebSocketEnd> end() const {
        const std::lock_guard lock(m_mutex);
        return m_end;
    }

    void close(std::uint16_t code) {
        asio::post(m_io, [this, code] {
            if (!m_line->stream.socket().is_open()) return;
            m_line->deadline.set(m_line, parting_time);
            m_socket->async_close(websocket::close_code(code), [](error_code) {});
        });
        std::unique_lock lock(m_mutex);
        m_changed.wait_for(lock, 2 * parting_time, [&] { return m_end.has_value(); });
    }

  private:
    using Socket = websocket::stream<Stream&>;

    asio::awaitable<Status> agree(const std::string& target, const Headers& headers) {
        for (const auto& [name, value] : headers)
            if (!is_sendable(name, value)) co_return Error{ErrorCode::usage, "is no header field", name};
        auto dialled = co_await dial(m_options);
        if (!dialled) co_return std::move(dialled).error();
        m_line = std::move(*dialled);
        const asio::any_io_executor executor = m_line->stream.get_executor();
        m_wake_reader.emplace(executor, asio::steady_timer::time_point::max());
        m_wake_writer.emplace(executor, asio::steady_timer::time_point::max());
        m_socket.emplace(m_line->stream);
        set_up(headers);
        websocket::response_type response;
        const std::string host = host_field(m_options);
        const auto [error] = co_await m_socket->async_handshake(response, host, target, as_result);
        if (error == websocket::error::upgrade_declined)
            co_return declined(response, place_of(m_options));
        if (error) co_return network_fault(m_options, error, error == beast::error::timeout);
        co_return Status();
    }

    void set_up(const Headers& headers) {
        websocket::stream_base::timeout times{};
        times.handshake_timeout = m_options.connect_time;
        times.idle_timeout = silence_time;
        times.keep_alive_pings = true;
        m_socket->set_option(times);
        m_socket->read_message_max(m_options.most_body_bytes);
        m_socket->auto_fragment(false);
        m_socket->write_buffer_bytes(write_buffer_bytes);
        m_socket->set_option(websocket::stream_base::decorator([headers](websocket::request_type& request) {
            for (const auto& [name, value] : headers) request.insert(name, value);
        }));
    }

    asio::awaitable<void> read_all() {
        WebSocketEnd end;
        while (true) {
            while (is_ahead()) co_await m_wake_reader->async_wait(as_result);
            beast::flat_buffer buffer;
            const auto [error, size] = co_await m_socket->async_read(buffer, as_result);
            end = end_of(error);
            if (error) break;
            WebSocketMessage message{{static_cast<const char*>(buffer.cdata().data()), size},
                                     m_socket->got_binary()};
            const std::lock_guard lock(m_mutex);
            m_incoming.push_back(std::move(message));
            m_changed.notify_all();
        }
        const auto& reason = m_socket->reason();
        const bool said = reason.code != websocket::close_code::none;
        finish(said ? WebSocketEnd{reason.code, {reason.reason.data(), reason.reason.size()}} : end);
        leave();
    }

    asio::awaitable<void> write_all() {
        while (m_line->stream.socket().is_open()) {
            const std::optional<WebSocketMessage> next = next_outgoing();
            if (!next) {
                co_await m_wake_writer->async_wait(as_result);
                continue;
            }
            m_socket->binary(next->binary);
            const auto [error, size] = co_await m_socket->async_write(asio::buffer(next->bytes), as_result);
            if (error) break;
            const std::lock_guard lock(m_mutex);
            ++m_sent;
            m_changed.notify_all();
        }
        leave();
    }

    bool is_ahead() {
        const std::lock_guard lock(m_mutex);
        return m_incoming.size() >= most_ahead && m_line->stream.socket().is_open();
    }

    std::optional<WebSocketMessage> next_outgoing() {
        const std::lock_guard lock(m_mutex);
        if (m_outgoing.empty()) return {};
        WebSocketMessage next = std::move(m_outgoing.front());
        m_outgoing.pop_front();
        return next;
    }

    /// The connection has ended: lets everything go that still waits.
    void finish(WebSocketEnd end) {
        shut();
        const std::lock_guard lock(m_mutex);
        m_end = std::move(end);
        m_changed.notify_all();
    }

    /// The last of the two loops lets the WebSocket go: its timer would keep the thread for half a minute.
    void leave() {
        if (--m_loops == 0) m_socket.reset();
    }

    void shut() {
        if (!m_line) return;
        m_line->deadline.clear();
        m_line->stream.close();
        if (m_wake_reader) m_wake_reader->cancel();
        if (m_wake_writer) m_wake_writer->cancel();
    }

    [[nodiscard]] Error ended() const {
        return system_fault("the connection has ended (" + std::to_string(m_end->code) + ")",
                            place_of(m_options));
    }

    const ClientOptions m_options;
    asio::io_context m_io{1};
    std::shared_ptr<Dialled> m_line;
    std::optional<Socket> m_socket;
    int m_loops = 2;  ///< that use m_socket
    std::optional<asio::steady_timer> m_wake_reader, m_wake_writer;
    std::thread m_thread;

    mutable std::mutex m_mutex;
    std::condition_variable m_changed;
    std::deque<WebSocketMessage> m_incoming, m_outgoing;
    std::uint64_t m_queued = 0, m_sent = 0;
    std::optional<WebSocketEnd> m_end;
};

WebSocketClient::WebSocketClient(std::unique_ptr<Running> running) : m_running(std::move(running)) {}
WebSocketClient::WebSocketClient(WebSocketClient&&) noexcept = default;
WebSocketClient& WebSocketClient::operator=(WebSocketClient&&) noexcept = default;
WebSocketClient::~WebSocketClient() = default;

Result<WebSocketClient> WebSocketClient::connect(const ClientOptions& options, const std::string& target,
                                                 const Headers& headers) {
    auto running = std::make_unique<Running>(options);
    WEAVE_CHECK_OK(running->connect(target, headers));
    return WebSocketClient(std::move(running));
}

Status WebSocketClient::send(std::string bytes, bool binary) {
    return m_running->send(std::move(bytes), binary);
}

Result<std::optional<WebSocketMessage>> WebSocketClient::receive(std::chrono::milliseconds patience) {
    return m_running->receive(patience);
}

std::optional<WebSocketEnd> WebSocketClient::end() const {
    return m_running->end();
}

void WebSocketClient::close(std::uint16_t code) {
    m_running->close(code);
}

}  // namespace weave::net
