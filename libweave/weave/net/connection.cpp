#include <weave/net/connection.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>
#include <weave/net/target.hpp>
#include <weave/net/websocket_session.hpp>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <ctime>
#include <exception>
#include <vector>

namespace weave::net {

namespace {

namespace http = beast::http;
using Clock = std::chrono::steady_clock;

constexpr std::size_t small_body = 16384;  // copied behind its head, to leave in one piece
constexpr std::size_t linger_piece = 64 << 10;  // on the heap, while it lasts
constexpr int retry_seconds = 2;
constexpr std::string_view local_host = "localhost";  // a Unix socket has no name of its own

/// Adds to a counter while it lives.
class Share {
  public:
    Share(std::atomic<std::size_t>& whole, std::size_t amount) : m_whole(whole), m_amount(amount) {
        m_sum = m_whole += amount;
    }
    ~Share() { m_whole -= m_amount; }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;
    [[nodiscard]] bool within(std::size_t limit) const { return m_sum <= limit; }

  private:
    std::atomic<std::size_t>& m_whole;
    std::size_t m_amount, m_sum;
};

/// An error of the transport itself.
Response trouble(int status, std::string message, ErrorCode code = ErrorCode::bad_input) {
    return error_answer({code, std::move(message), {}}, status);
}

Response busy() {
    Response response = trouble(503, "the service is busy; try again in a moment", ErrorCode::system);
    response.headers.add("Retry-After", std::to_string(retry_seconds));
    return response;
}

bool has_token(std::string_view list, std::string_view token) {
    return http::token_list(beast::string_view(list.data(), list.size()))
        .exists({token.data(), token.size()});
}

}  // namespace

std::string caught_message() {
    try {
        throw;
    } catch (const std::exception& caught) {
        return caught.what();
    } catch (...) {
        return "something that is no std::exception was thrown";
    }
}

asio::awaitable<bool> on_worker(WorkerPool& pool, std::function<void()> work, bool force) {
    const asio::any_io_executor executor = co_await asio::this_coro::executor;
    bool done = false;
    co_await asio::async_initiate<decltype(asio::use_awaitable), void(error_code)>(
        [&](auto handler) {
            auto resume = std::make_shared<decltype(handler)>(std::move(handler));
            WorkerPool::Task task = [&done, &work, executor, resume](bool wanted) {
                if (wanted) work();
                done = wanted;
                asio::post(executor, [resume] { (*resume)(error_code()); });
            };
            if (force)
                pool.post(std::move(task));
            else if (!pool.offer(std::move(task)))
                asio::post(executor, [resume] { (*resume)(error_code()); });
        },
        asio::use_awaitable);
    co_return done;
}

Service::Service(Router router_, ServerOptions options_)
    : router(std::move(router_)),
      options(std::move(options_)),
      pool(options.workers, options.limits.waiting_requests) {}

bool Service::enter(const std::shared_ptr<Connection>& connection, const std::string& address) {
    const std::lock_guard lock(m_mutex);
    if (stopping || m_open.size() >= options.limits.connections) return false;
    std::size_t& of_address = m_per_address[address];
    if (of_address >= options.limits.connections_per_address) return false;
    ++of_address;
    m_open.insert(connection);
    return true;
}

void Service::leave(const std::shared_ptr<Connection>& connection, const std::string& address) {
    const std::lock_guard lock(m_mutex);
    m_open.erase(connection);
    const auto of_address = m_per_address.find(address);
    if (--of_address->second == 0) m_per_address.erase(of_address);
    if (m_open.empty()) m_left.notify_all();
}

void Service::for_each(const std::function<void(const std::shared_ptr<Connection>&)>& use) {
    const std::lock_guard lock(m_mutex);
    for (const auto& connection : m_open) use(connection);
}

bool Service::wait_until_empty(Milliseconds patience) {
    std::unique_lock lock(m_mutex);
    return m_left.wait_for(lock, patience, [&] { return m_open.empty(); });
}

void Service::count(const char* name, const char* help, const Labels& labels) const {
    if (options.metrics) options.metrics->counter(name, help, labels).add();
}

Connection::Connection(std::shared_ptr<Service> service, Socket socket, Peer peer)
    : m_service(std::move(service)),
      m_stream(std::move(socket)),
      m_deadline(m_stream),
      m_buffer(m_service->options.limits.header_bytes),
      m_peer(std::move(peer)) {}

void Connection::finish() {
    asio::post(m_stream.get_executor(), [self = shared_from_this()] {
        if (self->m_goodbye)
            self->m_goodbye();
        else if (self->m_idle)
            self->m_stream.close();
    });
}

void Connection::cut() {
    asio::post(m_stream.get_executor(), [self = shared_from_this()] { self->m_stream.close(); });
}

Milliseconds Connection::time_for(std::uint64_t bytes) const {
    return Milliseconds(bytes * 1000 / m_service->options.limits.slowest_bytes_per_second);
}

Milliseconds Connection::transfer_time(std::uint64_t bytes) const {
    return m_service->options.limits.transfer_time + time_for(bytes);
}

asio::awaitable<void> Connection::run() {
    error_code ignored;
    m_stream.socket().set_option(Tcp::no_delay(true), ignored);
    try {
        const bool secured = co_await secure();
        if (secured) co_await serve();
    } catch (...) {
        log(LogLevel::warning, "a connection failed: " + on_one_line(caught_message()));
    }
    m_deadline.clear();
    m_stream.close();
}

asio::awaitable<bool> Connection::secure() {
    if (!uses_tls()) co_return true;
    m_deadline.set(shared_from_this(), m_service->options.limits.header_time);
    auto& tls = m_stream.add_tls(*m_service->tls);
    const auto [error] = co_await tls.async_handshake(asio::ssl::stream_base::server, as_result);
    co_return !error;
}

asio::awaitable<void> Connection::serve() {
    while (true) {
        const bool more = co_await serve_one();
        if (!more) break;
    }
}

/// Reads until the end of a head; its size with the empty line, 0 if the connection ended, npos if it is too
/// long.
asio::awaitable<std::size_t> Connection::find_head() {
    const ServerLimits& limits = m_service->options.limits;
    m_idle = m_buffer.size() == 0;
    if (m_idle && m_service->stopping) co_return 0;
    m_deadline.set(shared_from_this(), m_idle ? limits.idle_time : limits.header_time);
    std::size_t searched = 0;
    while (true) {
        const std::string_view text(static_cast<const char*>(m_buffer.cdata().data()), m_buffer.size());
        const std::size_t end = text.find("\r\n\r\n", searched < 3 ? 0 : searched - 3);
        if (end != std::string_view::npos) co_return end + 4;
        searched = text.size();
        if (searched >= limits.header_bytes) co_return std::string_view::npos;
        const auto room = m_buffer.prepare(std::min<std::size_t>(limits.header_bytes - searched, 4096));
        const auto [error, size] = co_await m_stream.async_read_some(room, as_result);
        if (error) co_return 0;
        m_buffer.commit(size);
        if (m_idle) m_deadline.set(shared_from_this(), limits.header_time);
        m_idle = false;
    }
}

asio::awaitable<bool> Connection::serve_one() {
    const std::size_t head_size = co_await find_head();
    m_idle = false;
    if (head_size == 0) co_return false;
    const auto begun = Clock::now();
    Incoming incoming;
    Parser parser;
    std::optional<Response> response;
    if (head_size == std::string_view::npos)
        response = trouble(431, "the header is too long");
    else
        response = understand(head_size, parser, incoming);
    const bool understood = !response;
    const bool may_go_on =
        incoming.wants_keep_alive && ++m_requests < m_service->options.limits.requests_per_connection;
    incoming.keep_alive = may_go_on && !incoming.framing.has_body();
    if (understood && incoming.match.route->admission) {
        const bool more = co_await open_websocket(parser, incoming, begun);
        co_return more;
    }
    const Share share(m_service->body_bytes, understood ? incoming.body_bytes() : 0);
    const bool has_room = share.within(m_service->options.limits.body_bytes_in_all);
    if (understood) response = co_await answer(parser, incoming, has_room, may_go_on);
    if (!response) co_return false;
    const bool keep = co_await write(std::move(*response), incoming, begun);
    co_return keep;
}

/// Has a request answered; nothing if the connection ended meanwhile.
asio::awaitable<std::optional<Response>> Connection::answer(Parser& parser, Incoming& incoming, bool has_room,
                                                            bool may_go_on) {
    if (!has_room) co_return busy();
    if (incoming.framing.has_body()) {
        std::optional<Response> failed = co_await read_body(parser, incoming);
        if (failed || !m_body_read) co_return failed;
        incoming.keep_alive = may_go_on;
    }
    m_deadline.clear();
    co_return co_await handle(incoming);
}

/// Takes the head apart; the answer to what cannot be served.
std::optional<Response> Connection::understand(std::size_t head_size, Parser& parser, Incoming& incoming) {
    const std::string_view head(static_cast<const char*>(m_buffer.cdata().data()), head_size);
    if (const Status status = check_head(head); !status) return trouble(400, status.error().message);
    parser.header_limit(static_cast<std::uint32_t>(m_service->options.limits.header_bytes));
    parser.body_limit(boost::none);  // checked here, by route
    error_code error;
    parser.put(asio::buffer(head), error);
    if (error == http::error::bad_version) return trouble(505, "HTTP/1.0 and 1.1 are spoken here");
    if (error || !parser.is_header_done()) return trouble(400, "the request is malformed");
    m_buffer.consume(head_size);

    incoming.version_1_0 = parser.get().version() == 10;
    Request& request = incoming.request;
    request.method = std::string(parser.get().method_string());
    request.peer = m_peer.shown;
    request.local = m_peer.local;
    request.uid = m_peer.uid;
    request.secure = uses_tls();
    for (const auto& field : parser.get())
        request.headers.add(std::string(field.name_string()), std::string(field.value()));
    const auto target = parser.get().target();
    return check(std::string_view(target.data(), target.size()), incoming);
}

std::optional<Response> Connection::check(std::string_view target_text, Incoming& incoming) const {
    Request& request = incoming.request;
    const auto framing = framing_of(request.headers, incoming.version_1_0);
    if (!framing) return trouble(400, framing.error().message);
    incoming.framing = *framing;
    const auto host = host_of(request.headers, incoming.version_1_0);
    if (!host) return trouble(400, host.error().message);
    incoming.wants_keep_alive =
        !incoming.version_1_0 && !has_token(request.headers.get("Connection"), "close");
    const auto& hosts = m_service->options.hosts;
    const bool named = hosts.empty() || std::find(hosts.begin(), hosts.end(), *host) != hosts.end();
    if (!named && !(m_peer.local && *host == local_host))
        return trouble(421, "this service does not go by that name", ErrorCode::refused);
    auto target = parse_target(target_text);
    if (!target) return trouble(400, target.error().message);
    request.path = std::move(target->path);
    request.query = std::move(target->query);
    return find_route(incoming);
}

std::optional<Response> Connection::find_route(Incoming& incoming) const {
    Request& request = incoming.request;
    incoming.match = m_service->router.match(request.method, request.path);
    if (incoming.match.route == nullptr && incoming.match.allowed.empty())
        return trouble(404, "there is nothing at this address", ErrorCode::usage);
    if (incoming.match.route == nullptr) {
        std::string allowed;
        for (const std::string& method : incoming.match.allowed)
            allowed += (allowed.empty() ? "" : ", ") + method;
        Response response = trouble(405, "this address does not take that method", ErrorCode::usage);
        response.headers.add("Allow", allowed);
        return response;
    }
    request.places = incoming.match.places;
    const std::string* const expected = request.headers.find("Expect");
    if (expected != nullptr && !equal_without_case(*expected, "100-continue"))
        return trouble(417, "that expectation cannot be met");
    incoming.expects_continue = expected != nullptr && !incoming.version_1_0;
    const Route& route = *incoming.match.route;
    const std::size_t limit = route.handler ? route.body_limit : 0;
    if (incoming.framing.length > limit || (incoming.framing.chunked && limit == 0))
        return trouble(413, "the body is larger than " + std::to_string(limit) + " bytes");
    return {};
}

/// Reads the body; an answer where it is not fit to be read, and m_body_read false if the connection ended.
asio::awaitable<std::optional<Response>> Connection::read_body(Parser& parser, Incoming& incoming) {
    m_body_read = false;
    const std::size_t limit = incoming.match.route->body_limit;
    parser.body_limit(limit);
    m_deadline.set(shared_from_this(), transfer_time(incoming.body_bytes()));
    if (incoming.expects_continue && m_buffer.size() == 0) {
        static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
        const auto [failed, written] = co_await asio::async_write(m_stream, asio::buffer(go_on), as_result);
        if (failed) co_return std::nullopt;
    }
    const auto [error, size] = co_await http::async_read(m_stream, m_buffer, parser, as_result);
    if (error == http::error::body_limit)
        co_return trouble(413, "the body is larger than " + std::to_string(limit) + " bytes");
    const bool malformed =
        error && error.category() == http::make_error_code(http::error::bad_chunk).category();
    if (malformed && error != http::error::partial_message && error != http::error::end_of_stream)
        co_return trouble(400, "the body is malformed");
    if (error) co_return std::nullopt;
    incoming.request.body = std::move(parser.get().body());
    m_body_read = true;
    co_return std::nullopt;
}

asio::awaitable<Response> Connection::handle(const Incoming& incoming) {
    const Request& request = incoming.request;
    Response response;
    const std::function<void()> work = [&] {
        try {
            response = incoming.match.route->handler(request);
        } catch (...) {
            response = error_answer(system_fault(caught_message(), incoming.match.route->name));
        }
    };
    const bool worked = co_await on_worker(m_service->pool, work);
    if (!worked) co_return busy();
    const bool reads = request.method == "GET" || request.method == "HEAD";
    if (reads && response.status == 200 && holds_already(request, response.headers.get("ETag"))) {
        response.status = 304;
        response.body = nullptr;
    }
    co_return sendable(std::move(response));
}

/// The answer to a request for a WebSocket that cannot become one.
std::optional<Response> Connection::refused_upgrade(const Parser& parser, const Incoming& incoming) const {
    const Request& request = incoming.request;
    const auto& origins = m_service->options.origins;
    const std::string* const origin = request.headers.find("Origin");
    const bool known =
        origin != nullptr && std::find(origins.begin(), origins.end(), *origin) != origins.end();
    if (!known && !from_own_pages(request))
        return trouble(403, "a page from elsewhere may not open this", ErrorCode::refused);
    if (!beast::websocket::is_upgrade(parser.get()) || request.headers.get("Sec-WebSocket-Version") != "13") {
        Response response = trouble(426, "this address speaks WebSocket, version 13", ErrorCode::usage);
        response.headers.add("Upgrade", "websocket");
        response.headers.add("Sec-WebSocket-Version", "13");
        return response;
    }
    if (request.headers.get("Sec-WebSocket-Key").size() != 24 || m_buffer.size() != 0)
        return trouble(400, "the request for a WebSocket is malformed");
    return {};
}

asio::awaitable<bool> Connection::open_websocket(const Parser& parser, const Incoming& incoming,
                                                 Clock::time_point begun) {
    std::optional<Response> refusal = refused_upgrade(parser, incoming);
    const Share share(m_service->websockets, 1);
    if (!refusal && !share.within(m_service->options.limits.websockets)) refusal = busy();
    std::unique_ptr<WebSocketHandler> handler;
    const std::function<void()> work = [&] {
        try {
            WebSocketAdmission admission = incoming.match.route->admission(incoming.request);
            if (auto* const answer = std::get_if<Response>(&admission))
                refusal = std::move(*answer);
            else
                handler = std::move(std::get<0>(admission));
        } catch (...) {
            refusal = error_answer(system_fault(caught_message(), incoming.match.route->name));
        }
    };
    m_deadline.clear();
    if (!refusal) {
        const bool worked = co_await on_worker(m_service->pool, work);
        if (!worked) refusal = busy();
    }
    if (refusal) co_return co_await write(sendable(std::move(*refusal)), incoming, begun);
    tell(incoming, 101, begun);
    const auto session =
        std::make_shared<WebSocketSession>(shared_from_this(), incoming.match.route->body_limit);
    co_await session->run(parser.get(), std::move(handler));
    co_return false;
}

/// Sends an answer; whether the connection may serve another request.
asio::awaitable<bool> Connection::write(Response response, const Incoming& incoming,
                                        Clock::time_point begun) {
    tell(incoming, response.status, begun);
    const bool keep_alive = incoming.keep_alive && !m_service->stopping;
    std::string head =
        written_head(response, {uses_tls(), keep_alive, http_date(std::time(nullptr))});
    if (incoming.request.method == "HEAD") response.body = nullptr;
    if (response.body && response.body->size() <= small_body) {
        head += *response.body;
        response.body = nullptr;
    }
    const std::size_t body_size = response.body ? response.body->size() : 0;
    m_deadline.set(shared_from_this(), transfer_time(head.size() + body_size));
    const std::array<asio::const_buffer, 2> pieces{
        asio::buffer(head), response.body ? asio::buffer(*response.body) : asio::const_buffer()};
    const auto [error, size] = co_await asio::async_write(m_stream, pieces, as_result);
    if (!error && !keep_alive) co_await linger();
    co_return !error && keep_alive;
}

/// Says that no more is coming, and reads on for a while: closed at once, a client that is still sending
/// would lose the answer. What comes is dropped unread, within bounds of bytes and of time.
asio::awaitable<void> Connection::linger() {
    const ServerLimits& limits = m_service->options.limits;
    const auto end = Clock::now() + limits.linger_time;
    const auto wait_on = [&] {
        const auto left = std::chrono::duration_cast<Milliseconds>(end - Clock::now());
        m_deadline.set(shared_from_this(), std::min(limits.linger_pause, left));
    };
    wait_on();
    if (m_stream.tls() != nullptr) co_await m_stream.tls()->async_shutdown(as_result);
    error_code ignored;
    m_stream.socket().shutdown(Tcp::socket::shutdown_send, ignored);
    std::vector<char> nowhere(linger_piece);
    for (std::size_t read = 0; read < limits.linger_bytes && !m_service->stopping;) {
        wait_on();
        const auto [error, size] =
            co_await m_stream.socket().async_read_some(asio::buffer(nowhere), as_result);
        if (error) break;
        read += size;
    }
}

void Connection::tell(const Incoming& incoming, int status, Clock::time_point begun) const {
    if (!m_service->options.metrics) return;
    const std::string route = incoming.match.route != nullptr ? incoming.match.route->name : "none";
    const std::string kind = std::to_string(status / 100) + "xx";
    m_service->count("weave_http_requests_total", "Requests answered, by route and kind of status",
                     {{"route", route}, {"status", kind}});
    m_service->options.metrics
        ->histogram("weave_http_request_seconds", "Time from a request's head to the start of its answer",
                    {{"route", route}})
        .observe(std::chrono::duration<double>(Clock::now() - begun).count());
}

}  // namespace weave::net
