#pragma once

#include <weave/wire/evidence.hpp>
#include <weave/wire/follower.hpp>

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

/// What becomes of a job on a simulation server, for whoever gave it: every byte of it comes from outside.
namespace weave::wire {

/// How long a server may take to answer.
inline constexpr std::chrono::minutes answer_patience{2};

/// `job 12`
std::string name_of(std::uint64_t job);

/// The jobs that the server keeps for this person.
Result<JobList> jobs_of(Follower& follower);

/// Whether a server signs what a job finds, before it is given one. Refused where it has no key; one that speaks version 1 of the
/// protocol does not say, and is given the job.
Status check_signs(Follower& follower);

/// Whether a job has yarns: it is done, or was cancelled after it had begun.
bool has_yarns(const JobEnded& ended);

/// What a job that has no yarns ended with: the error of a failed one; invalid where it was cancelled before it began.
Error reason_of(const JobEnded& ended);

/// Whether a job has evidence. Refused where it has none, with the reason.
Status check_signed(const Follower& follower, const JobEnded& ended);

/// The bytes of a signed document about a job's yarns, and what it says.
struct RemoteEvidence {
    std::string bytes;
    SignedEvidence evidence;
    SimulationStatement statement;
};

/// Fetches the evidence that a job's end tells of; whose key it is, is for those to check who file it. Errors: as
/// check_signed; bad_input where its document is another; those of the download.
Result<RemoteEvidence> fetch_evidence(Follower& follower, const JobEnded& ended);

/// Follows one job to its end.
class JobWatch {
  public:
    /// Whom it tells how far the job has come, and whom it asks whether the job is to be cancelled; several times a second.
    struct Ears {
        std::function<void(const JobState&)> hear;
        std::function<bool()> wants_cancel;
    };
    JobWatch(Follower& follower, std::uint64_t job, Ears ears) : m_follower(follower), m_job(job), m_ears(std::move(ears)) {}

    /// A job that is cancelled ends too, and tells so. Errors: those of the follower; refused where the server has it no more.
    Result<JobEnded> to_its_end();

    /// The server has no such job any more.
    [[nodiscard]] bool is_lost() const { return m_lost; }

  private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] bool is_end(const ServerMessage& message) const;
    void hear(const ServerMessage& message);
    void hear(const JobState& state);
    Status cancel();
    Status look();
    void notice_return();

    Follower& m_follower;
    std::uint64_t m_job;
    Ears m_ears;
    bool m_cancelled = false, m_troubled = false, m_lost = false;
    Clock::time_point m_heard = Clock::now();
};

}  // namespace weave::wire
