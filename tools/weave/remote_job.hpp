#pragma once

#include <weave/command/command_outcome.hpp>
#include <weave/sim/yarns.hpp>
#include <weave/wire/remote_job.hpp>

#include <chrono>
#include <cstdint>
#include <string>

/// What a job on a server leaves behind, checked: every byte of it comes from outside.
namespace weave::program {

/// How long a server may be away before a command that waits for it gives up.
inline constexpr std::chrono::minutes server_patience{10};

/// Connects as this program.
Result<wire::Follower> connected(const wire::ServerPlace& place);

/// The end of a job has been dealt with: the server may forget it. What keeps it from that is noted; its files are here.
void settle(CommandOutcome& outcome, wire::Follower& follower, std::uint64_t job);

/// The bytes of a job's .yarns file, and what they hold.
struct RemoteYarns {
    std::string bytes;
    Yarns yarns;
};

/// Fetches the yarns that a job's end tells of. Errors: bad_input for a report that is none, and for yarns that are not
/// those of the report; those of the download.
Result<RemoteYarns> fetch_yarns(wire::Follower& follower, const wire::JobEnded& ended);

}  // namespace weave::program
