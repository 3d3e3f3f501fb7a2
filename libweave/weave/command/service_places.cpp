#include <weave/command/service_places.hpp>

#include <weave/core/log.hpp>
#include <weave/core/text.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/net/certificate.hpp>
#include <weave/net/unix_socket.hpp>

#include <utility>

namespace weave {

namespace {

/// The error of what a member names. In a configuration it is no fault of the call.
Status at_member(const std::string& member, Status status) {
    if (status) return status;
    Error error = std::move(status).error().in(member);
    if (error.code == ErrorCode::usage) error.code = ErrorCode::bad_input;
    return error;
}

Status check_certificate(const net::TlsFiles& files) {
    if (const auto read = net::read_certificate(files.certificate); !read) return at_member("certificate", read.error());
    WEAVE_CHECK_OK(at_member("key", check_private_file(files.key)));
    const Status known = net::check_tls(files);
    if (known) return {};
    return at_member(known.error().where == files.certificate.string() ? "certificate" : "key", known);
}

/// At any port first, to tell an address that is not this machine's from a port that is taken.
Status check_place(const std::string& address, std::uint16_t port) {
    WEAVE_CHECK_OK(at_member("address", net::check_listening(address, 0)));
    return at_member("port", net::check_listening(address, port));
}

}  // namespace

Status check_hosts(const std::vector<std::string>& hosts) {
    for (std::size_t k = 0; k < hosts.size(); ++k)
        if (!net::can_be_certified(hosts[k]))
            return bad_input("'" + on_one_line(hosts[k]) + "' is neither a host name nor an address", indexed("hosts", k));
    return {};
}

Status check_service_places(const ServiceConfig& config) {
    WEAVE_CHECK_OK(check_hosts(config.hosts));
    if (!config.certificate.empty()) WEAVE_CHECK_OK(check_certificate({config.certificate, config.key}));
    return config.address.empty() ? Status() : check_place(config.address, config.port);
}

Status check_unix_socket(const std::filesystem::path& path, bool makes_folder) {
    if (const auto address = net::unix_address(path); !address) return at_member("unix_socket", address.error());
    std::error_code trouble;
    if (makes_folder && !std::filesystem::exists(path.parent_path(), trouble)) return {};
    const auto listener = net::UnixListener::open(path);
    return listener ? Status() : at_member("unix_socket", listener.error());
}

Result<std::optional<net::TlsFiles>> tls_of(const net::TlsFiles& own, const ServiceConfig& config) {
    if (config.plain || config.address.empty()) return std::optional<net::TlsFiles>();
    if (!config.certificate.empty()) return std::optional(net::TlsFiles{config.certificate, config.key});
    std::error_code trouble;
    if (!std::filesystem::exists(own.certificate, trouble)) {
        WEAVE_TRY(const auto made, net::make_certificate(own, client_hosts(config)));
        log(LogLevel::info, "made a certificate, SHA-256 " + made.fingerprint);
    }
    return std::optional(own);
}

net::ServerOptions server_options(const ServiceConfig& config, const std::optional<net::TlsFiles>& tls) {
    net::ServerOptions options;
    options.address = config.address;
    options.port = config.port;
    options.tls = tls;
    options.hosts = config.plain ? client_hosts(config) : config.hosts;  // a page must not reach what has no certificate by a name of its own
    options.workers = config.workers;
    return options;
}

}  // namespace weave
