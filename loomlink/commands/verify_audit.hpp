#pragma once

#include <loomlink/commands/command.hpp>

namespace weave::loomlink {

/// `audit verify`, which needs no server.
void add_audit_verify(CLI::App& audit, CommandOutcome& outcome);

}  // namespace weave::loomlink
