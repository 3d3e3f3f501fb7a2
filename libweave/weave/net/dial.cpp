#include <weave/net/dial.hpp>

#include <weave/core/sha256.hpp>
#include <weave/net/unix_socket.hpp>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <cerrno>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>
#include <sys/socket.h>

namespace weave::net {

namespace {

constexpr Milliseconds full_queue_pause{10};

Error not_the_one(const ClientOptions& options, const std::string& why) {
    return {ErrorCode::refused, why, place_of(options)};
}

bool is_address(const std::string& host) {
    error_code error;
    asio::ip::make_address(host, error);
    return !error;
}

Result<asio::ssl::context> tls_context(const ClientOptions& options) {
    asio::ssl::context context(asio::ssl::context::tls_client);
    SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
    error_code error;
    if (!options.tls->fingerprint.empty()) {
        context.set_verify_mode(asio::ssl::verify_none, error);  // checked once it is here: see check_pinned
        return context;
    }
    context.set_verify_mode(asio::ssl::verify_peer, error);
    if (options.tls->authorities.empty())
        context.set_default_verify_paths(error);
    else
        context.load_verify_file(options.tls->authorities.string(), error);
    if (error)
        return bad_input("holds no certificates: " + error.message(), options.tls->authorities.string());
    return context;
}

/// Has the handshake check the host, whatever signed the certificate.
bool expect_host(SSL* tls, const std::string& host) {
    X509_VERIFY_PARAM* const expected = SSL_get0_param(tls);
    if (is_address(host)) return X509_VERIFY_PARAM_set1_ip_asc(expected, host.c_str()) == 1;
    return SSL_ctrl(tls, SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
                    const_cast<char*>(host.c_str())) == 1 &&
           X509_VERIFY_PARAM_set1_host(expected, host.c_str(), host.size()) == 1;
}

std::string fingerprint_of(X509* certificate) {
    unsigned char* der = nullptr;
    const int size = i2d_X509(certificate, &der);
    if (size <= 0) return {};
    std::string digest = sha256_hex({reinterpret_cast<const char*>(der), static_cast<std::size_t>(size)});
    OPENSSL_free(der);
    return digest;
}

/// Holds the certificate of a finished handshake to the pinned fingerprint, and to the host.
Status check_pinned(SSL* tls, const ClientOptions& options) {
    const std::unique_ptr<X509, decltype(&X509_free)> certificate(SSL_get1_peer_certificate(tls), X509_free);
    std::string pinned = options.tls->fingerprint;
    std::transform(pinned.begin(), pinned.end(), pinned.begin(),
                   [](char c) { return c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c; });
    const std::string shown = certificate ? fingerprint_of(certificate.get()) : "none";
    if (shown != pinned)
        return not_the_one(options, "the server shows another certificate than the one that was asked for: its fingerprint is " + shown +
                                        ", not " + pinned + "; ask whoever runs it which is right");
    const std::string& host = options.host;
    const bool fits = is_address(host)
                          ? X509_check_ip_asc(certificate.get(), host.c_str(), 0) == 1
                          : X509_check_host(certificate.get(), host.c_str(), host.size(), 0, nullptr) == 1;
    if (!fits) return not_the_one(options, "the server's certificate is for another host");
    if (X509_cmp_current_time(X509_get0_notAfter(certificate.get())) < 0)
        return not_the_one(options, "the server's certificate has run out");
    return {};
}

/// Tries the addresses of the host one after another.
asio::awaitable<Status> connect(Dialled& dialled, const ClientOptions& options) {
    Tcp::resolver resolver(dialled.stream.get_executor());
    const auto [unknown, found] =
        co_await resolver.async_resolve(options.host, std::to_string(options.port), as_result);
    if (unknown) co_return network_fault(options, unknown, dialled.deadline.passed());
    error_code last = asio::error::host_not_found;
    for (const auto& place : found) {
        if (dialled.deadline.passed()) break;
        dialled.stream.close();
        const auto [error] =
            co_await dialled.stream.socket().async_connect(Endpoint(place.endpoint()), as_result);
        last = error;
        if (!error) break;
    }
    const bool late = dialled.deadline.passed();
    if (last || late) co_return network_fault(options, last, late);
    error_code ignored;
    dialled.stream.socket().set_option(Tcp::no_delay(true), ignored);
    co_return Status();
}

/// Connects to a Unix socket. The system says EAGAIN where a TCP socket would wait, while the server's queue
/// is full, and Asio takes a later look at such a socket for success: so it is asked here, again and again.
asio::awaitable<Status> connect_local(Dialled& dialled, const ClientOptions& options) {
    const auto address = unix_address(options.unix_socket);
    if (!address) co_return address.error();
    Socket& socket = dialled.stream.socket();
    asio::steady_timer pause(dialled.stream.get_executor());
    error_code error;
    socket.open(asio::generic::stream_protocol(AF_UNIX, 0), error);
    if (!error) socket.native_non_blocking(true, error);
    while (!error && !dialled.deadline.passed()) {
        const auto* const place = reinterpret_cast<const sockaddr*>(&*address);
        if (::connect(socket.native_handle(), place, sizeof *address) == 0) co_return Status();
        if (errno != EAGAIN && errno != EINTR) error.assign(errno, boost::system::system_category());
        if (error) break;
        pause.expires_after(full_queue_pause);
        co_await pause.async_wait(as_result);
    }
    co_return network_fault(options, error, dialled.deadline.passed());
}

asio::awaitable<Status> secure(Dialled& dialled, const ClientOptions& options) {
    auto context = tls_context(options);
    if (!context) co_return std::move(context).error();
    dialled.tls.emplace(std::move(*context));
    auto& tls = dialled.stream.add_tls(*dialled.tls);
    if (!expect_host(tls.native_handle(), options.host)) co_return bad_input("is no host name", options.host);
    const auto [error] = co_await tls.async_handshake(asio::ssl::stream_base::client, as_result);
    if (error) {
        const long verdict = SSL_get_verify_result(tls.native_handle());
        const bool distrusted = options.tls->fingerprint.empty() && verdict != X509_V_OK;
        if (distrusted)
            co_return not_the_one(options, std::string("the server's certificate is not trusted: ") +
                                               X509_verify_cert_error_string(verdict) +
                                               "; if it is the right one, give its SHA-256 (--fingerprint)");
        co_return network_fault(options, error, dialled.deadline.passed());
    }
    if (options.tls->fingerprint.empty()) co_return Status();
    co_return check_pinned(tls.native_handle(), options);
}

}  // namespace

std::string place_of(const ClientOptions& options) {
    return options.unix_socket.empty() ? host_field(options) : "unix:" + options.unix_socket.string();
}

std::string host_field(const ClientOptions& options) {
    if (!options.unix_socket.empty()) return "localhost";
    const bool bracketed = options.host.find(':') != std::string::npos;
    const std::string host = bracketed ? "[" + options.host + "]" : options.host;
    const std::uint16_t usual = options.tls ? 443 : 80;
    return options.port == usual ? host : host + ":" + std::to_string(options.port);
}

Error network_fault(const ClientOptions& options, const error_code& error, bool late) {
    const std::string why = late ? "it did not answer in time" : error.message();
    return system_fault("cannot talk to the server: " + why, place_of(options));
}

asio::awaitable<Result<std::shared_ptr<Dialled>>> dial(const ClientOptions& options) {
    const bool local = !options.unix_socket.empty();
    if (local && options.tls)
        co_return Error{ErrorCode::usage, "TLS is not spoken over a Unix socket", place_of(options)};
    const asio::any_io_executor executor = co_await asio::this_coro::executor;
    auto dialled = std::make_shared<Dialled>(executor);
    dialled->deadline.set(dialled, options.connect_time);
    Status connected;
    if (local)
        connected = co_await connect_local(*dialled, options);
    else
        connected = co_await connect(*dialled, options);
    if (connected && options.tls) connected = co_await secure(*dialled, options);
    dialled->deadline.clear();
    if (!connected) co_return std::move(connected).error();
    co_return dialled;
}

}  // namespace weave::net
