#include <weave/net/server.hpp>

#include <weave/core/log.hpp>
#include <weave/net/connection.hpp>
#include <weave/net/unix_socket.hpp>

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/v6_only.hpp>
#include <boost/asio/strand.hpp>
#include <fcntl.h>
#include <openssl/ssl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <system_error>
#include <thread>

namespace weave::net {

namespace {

constexpr Milliseconds for_ever = std::chrono::hours(24 * 365);
constexpr Milliseconds breath{100};  // before the next try when the system has no more descriptors

Status load_files(asio::ssl::context& context, const TlsFiles& files) {
    error_code error;
    context.use_certificate_chain_file(files.certificate.string(), error);
    if (error) return bad_input("is no certificate: " + error.message(), files.certificate.string());
    context.use_private_key_file(files.key.string(), asio::ssl::context::pem, error);
    if (error) return bad_input("is no key to the certificate: " + error.message(), files.key.string());
    if (SSL_CTX_check_private_key(context.native_handle()) != 1)
        return bad_input("is the key to another certificate", files.key.string());
    struct stat facts {};
    if (::stat(files.key.c_str(), &facts) == 0 && (facts.st_mode & S_IROTH) != 0)
        log(LogLevel::warning, "every account of this machine can read the key " + files.key.string());
    return {};
}

Result<std::optional<asio::ssl::context>> tls_context(const std::optional<TlsFiles>& files) {
    std::optional<asio::ssl::context> context;
    if (!files) return context;
    context.emplace(asio::ssl::context::tls_server);
    SSL_CTX* const native = context->native_handle();
    const bool set = SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION) == 1 &&
                     SSL_CTX_set_cipher_list(native, "ECDHE+AESGCM:ECDHE+CHACHA20") == 1;
    if (!set) return system_fault("cannot set up TLS");
    SSL_CTX_set_options(native,
                        SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION | SSL_OP_CIPHER_SERVER_PREFERENCE);
    WEAVE_CHECK_OK(load_files(*context, *files));
    return context;
}

Result<asio::ip::address> address_of(const std::string& text) {
    error_code error;
    const asio::ip::address address = asio::ip::make_address(text, error);
    if (error) return Error{ErrorCode::usage, "is no address to listen on", text};
    return address;
}

/// An address and a port as people write them: `127.0.0.1:80`, `[::1]:80`.
std::string text_of(const Tcp::endpoint& endpoint) {
    const std::string address = endpoint.address().to_string();
    return (endpoint.address().is_v6() ? "[" + address + "]" : address) + ":" + std::to_string(endpoint.port());
}

/// Where to listen by TCP, if at all.
Result<std::optional<Tcp::endpoint>> endpoint_of(const ServerOptions& options) {
    if (options.address.empty() && !options.unix_socket.empty()) return std::optional<Tcp::endpoint>();
    WEAVE_TRY(const asio::ip::address address, address_of(options.address));
    if (!options.tls && !options.plain_beyond_loopback && !address.is_loopback())
        return Error{ErrorCode::usage, "plain HTTP is served on loopback alone; give a certificate",
                     options.address};
    return std::optional(Tcp::endpoint(address, options.port));
}

Status check_limits(const ServerOptions& options) {
    const ServerLimits& limits = options.limits;
    const bool sound = options.workers > 0 && options.io_threads > 0 && limits.header_bytes >= 512 &&
                       limits.header_bytes <= 1 << 20 && limits.slowest_bytes_per_second > 0;
    return sound ? Status() : Status(Error{ErrorCode::usage, "a server needs workers and sound limits", {}});
}

/// Keeps a socket from the programs that the service may start: one that held it would keep it open.
void close_on_exec(int socket) {
    const int flags = ::fcntl(socket, F_GETFD);
    if (flags >= 0) ::fcntl(socket, F_SETFD, flags | FD_CLOEXEC);
}

/// Where clients come in.
struct Door {
    explicit Door(const asio::any_io_executor& executor) : acceptor(executor), pause(executor) {}

    Status open_tcp(const Tcp::endpoint& endpoint) {
        error_code error;
        acceptor.open(endpoint.protocol(), error);
        if (!error) close_on_exec(acceptor.native_handle());
        if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
        if (!error && endpoint.address().is_v6()) acceptor.set_option(asio::ip::v6_only(false), error);
        if (!error) acceptor.bind(endpoint, error);
        if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
        if (!error) return {};
        return system_fault("cannot listen: " + error.message(), text_of(endpoint));
    }
    Status open_unix(const std::filesystem::path& path) {
        WEAVE_TRY(UnixListener opened, UnixListener::open(path));
        file.emplace(std::move(opened));
        error_code error;
        acceptor.assign(asio::generic::stream_protocol(AF_UNIX, 0), file->take_socket(), error);
        return error ? Status(system_fault("cannot listen: " + error.message(), path.string())) : Status();
    }
    void close() {
        if (file) file->remove_file();
        error_code ignored;
        acceptor.close(ignored);
        pause.cancel();
    }

    asio::basic_socket_acceptor<asio::generic::stream_protocol> acceptor;
    asio::steady_timer pause;
    std::optional<UnixListener> file;
};

}  // namespace

Status check_listening(const std::string& address, std::uint16_t port) {
    WEAVE_TRY(const asio::ip::address place, address_of(address));
    asio::io_context io;
    return Door(io.get_executor()).open_tcp(Tcp::endpoint(place, port));
}

Status check_tls(const TlsFiles& files) {
    WEAVE_CHECK_OK(tls_context(files));
    return {};
}

/// A server that listens: its threads and what they share.
class Server::Running {
  public:
    Running(Router router, ServerOptions options)
        : m_service(std::make_shared<Service>(std::move(router), std::move(options))) {}

    Status start(std::optional<asio::ssl::context> tls, const std::optional<Tcp::endpoint>& endpoint) {
        m_service->tls = std::move(tls);
        WEAVE_CHECK_OK(listen(endpoint));
        for (const auto& door : m_doors)
            asio::co_spawn(
                m_strand, [this, &door = *door] { return accept(door); }, asio::detached);
        for (std::size_t k = 0; k < m_service->options.io_threads; ++k)
            m_threads.emplace_back([this] { m_io.run(); });
        return {};
    }

    [[nodiscard]] std::uint16_t port() const { return m_port; }

    void stop(Milliseconds patience) {
        if (m_service->stopping.exchange(true)) return;
        asio::post(m_strand, [this] {
            for (const auto& door : m_doors) door->close();
        });
        m_service->for_each([](const std::shared_ptr<Connection>& connection) { connection->finish(); });
        if (!m_service->wait_until_empty(patience)) {
            m_service->pool.abandon();
            m_service->for_each([](const std::shared_ptr<Connection>& connection) { connection->cut(); });
            m_service->wait_until_empty(for_ever);
        }
        m_service->pool.join();
        m_work.reset();
        for (std::thread& thread : m_threads) thread.join();
        m_threads.clear();
    }

  private:
    Status listen(const std::optional<Tcp::endpoint>& endpoint) {
        if (endpoint) {
            Door& door = *m_doors.emplace_back(std::make_unique<Door>(m_strand));
            WEAVE_CHECK_OK(door.open_tcp(*endpoint));
            error_code error;
            m_port = tcp_endpoint(door.acceptor.local_endpoint(error)).port();
            if (error) return system_fault("cannot listen: " + error.message());
        }
        const std::filesystem::path& path = m_service->options.unix_socket;
        if (path.empty()) return {};
        return m_doors.emplace_back(std::make_unique<Door>(m_strand))->open_unix(path);
    }

    asio::awaitable<void> accept(Door& door) {
        while (door.acceptor.is_open()) {
            Endpoint peer;
            auto [error, socket] =
                co_await door.acceptor.async_accept(asio::make_strand(m_io), peer, as_result);
            if (!error) {
                take(std::move(socket), peer);
            } else if (door.acceptor.is_open()) {
                door.pause.expires_after(breath);
                co_await door.pause.async_wait(as_result);
            }
        }
    }

    void take(Socket socket, const Endpoint& endpoint) {
        close_on_exec(socket.native_handle());
        Peer peer = peer_of(endpoint, socket.native_handle());
        const asio::any_io_executor executor = socket.get_executor();
        const auto connection =
            std::make_shared<Connection>(m_service, std::move(socket), std::move(peer));
        if (!m_service->enter(connection, connection->address())) {
            m_service->count("weave_http_refused_connections_total",
                             "Connections beyond a limit, closed at once");
            return;
        }
        m_service->count("weave_http_connections_total", "Connections taken");
        asio::co_spawn(
            executor, [connection] { return connection->run(); },
            [service = m_service, connection](const std::exception_ptr&) {
                service->leave(connection, connection->address());
            });
    }

    std::shared_ptr<Service> m_service;
    asio::io_context m_io;
    asio::executor_work_guard<asio::io_context::executor_type> m_work = asio::make_work_guard(m_io);
    const asio::any_io_executor m_strand = asio::make_strand(m_io);  ///< of all doors
    std::vector<std::unique_ptr<Door>> m_doors;
    std::uint16_t m_port = 0;
    std::vector<std::thread> m_threads;
};

Server::Server(std::unique_ptr<Running> running) : m_running(std::move(running)) {}
Server::Server(Server&&) noexcept = default;

Server& Server::operator=(Server&& other) noexcept {
    if (this != &other) {
        stop(Milliseconds(0));
        m_running = std::move(other.m_running);
    }
    return *this;
}

Server::~Server() {
    stop(Milliseconds(0));
}

Result<Server> Server::start(Router router, ServerOptions options) {
    WEAVE_CHECK_OK(check_limits(options));
    WEAVE_TRY(const std::optional<Tcp::endpoint> endpoint, endpoint_of(options));
    WEAVE_TRY(auto tls, tls_context(options.tls));
    try {
        auto running = std::make_unique<Running>(std::move(router), std::move(options));
        if (Status started = running->start(std::move(tls), endpoint); !started) {
            running->stop(Milliseconds(0));
            return std::move(started).error();
        }
        return Server(std::move(running));
    } catch (const std::exception& caught) {
        return system_fault(std::string("cannot start: ") + caught.what());
    }
}

std::uint16_t Server::port() const {
    return m_running->port();
}

void Server::stop(Milliseconds patience) {
    if (m_running) m_running->stop(patience);
}

}  // namespace weave::net
