#pragma once

#include <weave/command/service_config.hpp>
#include <weave/core/result.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace weave::loomlink {

/// How loomlink serves.
struct ServeConfig : ServiceConfig {
    ServeConfig() { port = 8443; }
    std::string site = "mill";    ///< `site`: name of the site; counts when it is made
    std::string store;    ///< `store`: connection string of a PostgreSQL database; counts when the site is made. None: a file
    std::string standby;  ///< `standby`: of a server that follows the database, to read from. None: all from the primary
    std::filesystem::path heads;  ///< `heads`: a file in a second place that keeps every signed head of the log.
                                  ///< None: kept by the looms alone
};

/// Reads a configuration. Errors name the member: unknown ones too, and what no single member shows. Paths count
/// from `folder`.
Result<ServeConfig> parse_config(std::string_view text, const std::filesystem::path& folder = {});

/// What no single member shows. Errors name a member.
Status check_config(const ServeConfig& config);

}  // namespace weave::loomlink
