#pragma once

#include <weave/command/service_config.hpp>
#include <weave/net/server.hpp>

#include <optional>
#include <string>
#include <vector>

namespace weave {

/// Whether a certificate can stand for these hosts. An error names the first that it cannot, as `hosts[0]`.
Status check_hosts(const std::vector<std::string>& hosts);

/// Whether what a service is told can be had, before anything is made: that address and port can be listened on, that a
/// certificate can stand for the hosts, that certificate and key can be read and go together, and that the key is private.
/// Errors name the member, and the file or place that it names.
Status check_service_places(const ServiceConfig& config);

/// Whether a Unix socket can be listened on: its file is made and removed again. Where the service makes its folder, and that is
/// still missing, its path alone is looked at. An error names the member `unix_socket`.
Status check_unix_socket(const std::filesystem::path& path, bool makes_folder);

/// What is served with: certificate and key of the configuration, or the service's own, which are made where they are
/// missing. Nothing where HTTP is plain, or no TCP is served.
Result<std::optional<net::TlsFiles>> tls_of(const net::TlsFiles& own, const ServiceConfig& config);

/// How the service's server is set up.
net::ServerOptions server_options(const ServiceConfig& config, const std::optional<net::TlsFiles>& tls);

}  // namespace weave
