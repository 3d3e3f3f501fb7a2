#include <weave/command/service_config.hpp>

#include <weave/net/certificate.hpp>

#include <algorithm>
#include <array>
#include <unistd.h>

namespace weave {

namespace {

constexpr std::size_t most_hosts = 32, longest_address = 64, longest_path = 4096;

bool is_everywhere(const std::string& address) {
    return address == "0.0.0.0" || address == "::";
}

bool is_loopback(const std::string& address) {
    return address == "::1" || address.starts_with("127.");
}

}  // namespace

std::filesystem::path path_member(JsonReader& reader, const std::string& key, const std::filesystem::path& folder) {
    const std::filesystem::path path = reader.text(key, std::string(), longest_path);
    return path.empty() ? path : folder / path;  // an absolute `path` stands alone
}

void read_service(JsonReader& reader, const std::filesystem::path& folder, ServiceConfig& config) {
    config.address = reader.text("address", config.address, longest_address);
    config.port = static_cast<std::uint16_t>(reader.integer("port", 0, 65535, config.port));
    config.hosts = reader.texts("hosts", most_hosts);
    config.certificate = path_member(reader, "certificate", folder);
    config.key = path_member(reader, "key", folder);
    config.plain = reader.boolean("plain", config.plain);
    config.workers = static_cast<std::size_t>(reader.integer("workers", 1, 64, static_cast<std::int64_t>(config.workers)));
}

Status check_service(const ServiceConfig& config) {
    if (config.certificate.empty() != config.key.empty())
        return bad_input("certificate and key go together", config.key.empty() ? "key" : "certificate");
    if (config.plain && !config.certificate.empty())
        return bad_input("goes with no certificate: HTTP without TLS needs none", "plain");
    if (config.plain && !config.address.empty() && !is_loopback(config.address))
        return bad_input("without TLS it serves this machine alone: 127.0.0.1 or ::1", "address");
    return {};
}

std::vector<std::string> client_hosts(const ServiceConfig& config) {
    std::vector<std::string> hosts = config.hosts;
    if (hosts.empty()) {
        std::array<char, 256> name{};
        const bool named = ::gethostname(name.data(), name.size() - 1) == 0 && net::can_be_certified(name.data());
        if (named) hosts.emplace_back(name.data());  // a machine may have a name that is no host's
        hosts.insert(hosts.end(), {"localhost", "127.0.0.1", "::1"});
    }
    const bool listed = std::ranges::find(hosts, config.address) != hosts.end();
    if (!listed && !config.address.empty() && !is_everywhere(config.address)) hosts.push_back(config.address);
    return hosts;
}

std::string origin_of(const ServiceConfig& config, std::uint16_t port) {
    std::string host = config.plain ? config.address : client_hosts(config).front();
    if (host.find(':') != std::string::npos) host = "[" + host + "]";
    return (config.plain ? "http://" : "https://") + host + ":" + std::to_string(port);
}

}  // namespace weave
