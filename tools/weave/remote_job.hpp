#pragma once

#include <weave/command/command_outcome.hpp>
#include <weave/sim/yarns.hpp>
#include <weave/wire/follower.hpp>

#include <chrono>
#include <cstdint>
#include <string>

/// What a job on a server leaves behind, checked: every byte of it comes from outside.
namespace weave::program {

/// How long a server may be away before a command that waits for it gives up; and how long it may take to answer.
inline constexpr std::chrono::minutes server_patience{10};
inline constexpr std::chrono::minutes answer_patience{2};

/// Connects as this program.
Result<wire::Follower> connected(const wire::ServerPlace& place);

/// The jobs that the server keeps for this person.
Result<wire::JobList> jobs_of(wire::Follower& follower);

/// Whether a server signs what a job finds, before it is given one. Refused where it has no key; one that speaks version 1 of the
/// protocol does not say, and is given the job.
Status check_signs(wire::Follower& follower);

/// The end of a job has been dealt with: the server may forget it. What keeps it from that is noted; its files are here.
void settle(CommandOutcome& outcome, wire::Follower& follower, std::uint64_t job);

/// Whether a job has yarns: it is done, or was cancelled after it had begun.
bool has_yarns(const wire::JobEnded& ended);

/// What a job that has no yarns ended with: the error of a failed one; invalid where it was cancelled before it began.
Error reason_of(const wire::JobEnded& ended);

/// The bytes of a job's .yarns file, and what they hold.
struct RemoteYarns {
    std::string bytes;
    Yarns yarns;
};

/// Fetches the yarns that a job's end tells of. Errors: bad_input for a report that is none, and for yarns that are not
/// those of the report; those of the download.
Result<RemoteYarns> fetch_yarns(wire::Follower& follower, const wire::JobEnded& ended);

/// Whether a job has evidence. Refused where it has none, with the reason.
Status check_signed(const wire::Follower& follower, const wire::JobEnded& ended);

/// Fetches the evidence that a job's end tells of: a signed document about these yarns; whose key it is, is for those to
/// check who file it. Errors: as check_signed; bad_input where its document is another; those of
/// the download.
Result<std::string> fetch_evidence(wire::Follower& follower, const wire::JobEnded& ended);

/// `job 12`
std::string name_of(std::uint64_t job);

}  // namespace weave::program
