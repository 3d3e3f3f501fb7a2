#pragma once

#include <loomlink/commands/command.hpp>

namespace weave::loomlink {

/// `user bootstrap`, on the machine of the site, while it is not served.
void add_user_bootstrap(CLI::App& user, CommandOutcome& outcome);

}  // namespace weave::loomlink
