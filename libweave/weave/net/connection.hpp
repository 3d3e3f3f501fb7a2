#pragma once

#include <weave/net/heads.hpp>
#include <weave/net/peer.hpp>
#include <weave/net/server.hpp>
#include <weave/net/stream.hpp>
#include <weave/net/worker_pool.hpp>

#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>

namespace weave::net {

namespace beast = boost::beast;

class Connection;

/// What all connections of a server share.
struct Service {
    Service(Router router_, ServerOptions options_);

    const Router router;
    const ServerOptions options;
    WorkerPool pool;
    std::optional<asio::ssl::context> tls;
    std::atomic<bool> stopping{false};
    std::atomic<std::size_t> body_bytes{0};
    std::atomic<std::size_t> websockets{0};

    /// Adds an open connection, unless there are too many of its address or in all.
    bool enter(const std::shared_ptr<Connection>& connection, const std::string& address);
    void leave(const std::shared_ptr<Connection>& connection, const std::string& address);
    /// Runs `use` for each open connection.
    void for_each(const std::function<void(const std::shared_ptr<Connection>&)>& use);
    /// Waits until no connection is open; false when the time is over.
    bool wait_until_empty(Milliseconds patience);

    void count(const char* name, const char* help, const Labels& labels = {}) const;

  private:
    std::mutex m_mutex;
    std::condition_variable m_left;
    std::set<std::shared_ptr<Connection>> m_open;
    std::map<std::string, std::size_t> m_per_address;
};

/// One client: reads its requests one after another and has them answered. All of it runs on the connection's
/// strand.
class Connection : public std::enable_shared_from_this<Connection> {
  public:
    Connection(std::shared_ptr<Service> service, Socket socket, Peer peer);

    /// The key under which connections of one client are counted.
    [[nodiscard]] const std::string& address() const { return m_peer.key; }
    /// Serves the client until either side ends it.
    asio::awaitable<void> run();
    /// Ends the connection as soon as it has nothing to answer. From any thread.
    void finish();
    /// Ends it now. From any thread.
    void cut();

  private:
    friend class WebSocketSession;
    using Parser = beast::http::request_parser<beast::http::string_body>;

    using Moment = std::chrono::steady_clock::time_point;

    /// A request on its way in.
    struct Incoming {
        Request request;
        RouteMatch match;
        Framing framing;
        bool version_1_0 = false;
        bool expects_continue = false;
        bool wants_keep_alive = false;
        bool keep_alive = false;  ///< set once all of the request is read
        /// What its body may take of memory.
        [[nodiscard]] std::size_t body_bytes() const {
            return framing.chunked ? match.route->body_limit : framing.length;
        }
    };

    asio::awaitable<bool> secure();
    asio::awaitable<void> serve();
    asio::awaitable<bool> serve_one();
    asio::awaitable<std::size_t> find_head();
    std::optional<Response> understand(std::size_t head_size, Parser& parser, Incoming& incoming);
    std::optional<Response> check(std::string_view target, Incoming& incoming) const;
    std::optional<Response> find_route(Incoming& incoming) const;
    asio::awaitable<std::optional<Response>> answer(Parser& parser, Incoming& incoming, bool has_room,
                                                    bool may_go_on);
    asio::awaitable<std::optional<Response>> read_body(Parser& parser, Incoming& incoming);
    asio::awaitable<Response> handle(const Incoming& incoming);
    [[nodiscard]] std::optional<Response> refused_upgrade(const Parser& parser,
                                                          const Incoming& incoming) const;
    asio::awaitable<bool> open_websocket(const Parser& parser, const Incoming& incoming, Moment begun);
    asio::awaitable<bool> write(Response response, const Incoming& incoming, Moment begun);
    asio::awaitable<void> linger();
    [[nodiscard]] bool uses_tls() const { return m_service->tls && !m_peer.local; }
    /// What so many bytes need at the slowest pace that is served.
    [[nodiscard]] Milliseconds time_for(std::uint64_t bytes) const;
    [[nodiscard]] Milliseconds transfer_time(std::uint64_t bytes) const;
    void tell(const Incoming& incoming, int status, Moment begun) const;

    std::shared_ptr<Service> m_service;
    Stream m_stream;
    Deadline m_deadline;
    beast::flat_buffer m_buffer;
    Peer m_peer;
    bool m_idle = false;  ///< waits for a request
    bool m_body_read = false;
    std::size_t m_requests = 0;
    std::function<void()> m_goodbye;  ///< while it is a WebSocket: closes it in good order
};

/// What the exception being handled says. Only inside a catch.
std::string caught_message();

/// Waits, on the coroutine's executor, until a worker has done `work`; false if the pool took or did it not.
/// `force` takes a place in the queue whatever waits there.
asio::awaitable<bool> on_worker(WorkerPool& pool, std::function<void()> work, bool force = false);

}  // namespace weave::net
