#pragma once

#include <chrono>
#include <loomlink/commands/command.hpp>
#include <loomlink/commands/puller.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

/// Signs in again where the session has ended; nothing where it is known that nobody can.
using SignInAgain = std::function<Status(wire::MillClient&)>;

/// Keeps a loom's folder as the server says, for ever: pulls whenever the server tells of a change, and every
/// so often besides, so that a lost message does no harm. Outages are told once and waited out. Each pull
/// that changed something is an answer of its own. Ends only where the first pull fails for another reason
/// than the network: then the call is wrong.
Status watch_loom(wire::MillClient& client, const PullWish& wish, std::chrono::seconds every,
                  const SignInAgain& sign_in_again, CommandOutcome& outcome);

/// Pulls once; where the session has ended, signs in again first.
Result<PullReport> pull_signed_in(wire::MillClient& client, const PullWish& wish, const SignInAgain& sign_in_again);

}  // namespace weave::loomlink
