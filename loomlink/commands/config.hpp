#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// How loomlink serves. As a file: one JSON object with these members, each of which may be missing, and no
/// others.
struct ServeConfig {
    std::string site = "mill";          ///< `site`: name of the site; counts when it is made
    std::string address = "127.0.0.1";  ///< `address`: to listen on; 0.0.0.0 for all of IPv4, :: for all
    std::uint16_t port = 8443;          ///< `port`; 0: any free one
    std::vector<std::string> hosts;     ///< `hosts`: names and addresses that clients use; they stand in a
                                        ///< self-made certificate. None: this machine's, and localhost
    std::filesystem::path certificate;  ///< `certificate`: PEM; relative to the configuration's folder
    std::filesystem::path key;          ///< `key`: PEM
    bool plain = false;                 ///< `plain`: HTTP without TLS, on loopback alone
    std::size_t workers = 4;            ///< `workers`: threads that answer
    std::filesystem::path heads;        ///< `heads`: a file in a second place that keeps every signed head of
                                        ///< the log; relative to the configuration's folder. None: kept by
                                        ///< the looms alone
};

/// Reads a configuration. Errors name the member: unknown ones too, a certificate without a key, `plain` with
/// a certificate.
Result<ServeConfig> parse_config(std::string_view text);

/// Reads a configuration file; errors name it. Its relative paths count from its folder.
Result<ServeConfig> load_config(const std::filesystem::path& file);

/// What no single member shows. Errors name a member.
Status check_config(const ServeConfig& config);

/// The host names and addresses that clients use: `hosts`, or localhost and the name of this machine, and the
/// address listened on.
std::vector<std::string> client_hosts(const ServeConfig& config);

}  // namespace weave::loomlink
