#pragma once

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

/// Fetches the evidence that a job's end tells of: a signed document about these yarns; whose key it is, is for those to
/// check who file it. Errors: refused where the server signed none; bad_input where its document is another; those of
/// the download.
Result<std::string> fetch_evidence(wire::Follower& follower, const wire::JobEnded& ended);

/// `job 12`
std::string name_of(std::uint64_t job);

}  // namespace weave::program
