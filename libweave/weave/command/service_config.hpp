#pragma once

#include <weave/core/json_reader.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace weave {

/// What every service is told of how it serves; each adds members of its own. As a file: one JSON object with these members,
/// each of which may be missing, and no others. Paths count from the file's folder.
struct ServiceConfig {
    std::string address = "127.0.0.1";  ///< `address`: to listen on; 0.0.0.0 for all of IPv4, :: for all
    std::uint16_t port = 0;             ///< `port`; 0: any free one
    std::vector<std::string> hosts;     ///< `hosts`: names and addresses that clients use; they stand in a self-made
                                        ///< certificate. None: this machine's, and localhost
    std::filesystem::path certificate;  ///< `certificate`: PEM; none: a self-made one in the service's folder
    std::filesystem::path key;          ///< `key`: PEM
    bool plain = false;                 ///< `plain`: HTTP without TLS, on loopback alone
    std::size_t workers = 4;            ///< `workers`: threads that answer
};

/// Reads these members; what is missing stays as it is. Paths count from `folder`.
void read_service(JsonReader& reader, const std::filesystem::path& folder, ServiceConfig& config);

/// A member that is a path, counted from `folder`. Missing: empty.
std::filesystem::path path_member(JsonReader& reader, const std::string& key, const std::filesystem::path& folder);

/// What no single member shows. Errors name a member.
Status check_service(const ServiceConfig& config);

/// The host names and addresses that clients use: `hosts`, or the name of this machine and localhost, and the address
/// listened on.
std::vector<std::string> client_hosts(const ServiceConfig& config);

/// Where clients come to: `https://loom.mill:8443`.
std::string origin_of(const ServiceConfig& config, std::uint16_t port);

}  // namespace weave
