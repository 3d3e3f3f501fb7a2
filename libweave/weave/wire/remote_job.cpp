#include <weave/wire/remote_job.hpp>

#include <utility>

namespace weave::wire {

namespace {

using namespace std::chrono_literals;

/// Without a word of the job for so long, the server is asked whether it still has it.
constexpr auto longest_silence = 30s;
/// How long a person who ends a run waits for a server that is away.
constexpr auto cancel_patience = 15s;

}  // namespace

std::string name_of(std::uint64_t job) {
    return "job " + std::to_string(job);
}

Result<JobList> jobs_of(Follower& follower) {
    return answer_of<JobList>(follower.ask(ListJobs{new_request_id()}, answer_patience));
}

Status check_signs(Follower& follower) {
    WEAVE_TRY(const JobList jobs, jobs_of(follower));
    if (jobs.signs) return {};
    return Error{ErrorCode::refused, "the server has no key to sign evidence with", follower.place().name};
}

bool has_yarns(const JobEnded& ended) {
    return ended.phase != JobPhase::failed && !ended.report.empty();
}

Error reason_of(const JobEnded& ended) {
    if (ended.error) return *ended.error;
    if (ended.phase == JobPhase::cancelled) return invalid("was cancelled before it began: there are no yarns", name_of(ended.job));
    return system_fault("ended without yarns and without a reason", name_of(ended.job));
}

Status check_signed(const Follower& follower, const JobEnded& ended) {
    if (ended.evidence) return {};
    const bool is_done = ended.phase == JobPhase::done;
    return Error{ErrorCode::refused, is_done ? "the server had no key to sign evidence with" : "only of a job that is done there is evidence",
                 follower.place().name + ": " + name_of(ended.job)};
}

Result<RemoteEvidence> fetch_evidence(Follower& follower, const JobEnded& ended) {
    const std::string where = follower.place().name + ": " + name_of(ended.job);
    WEAVE_CHECK_OK(check_signed(follower, ended));
    WEAVE_TRY(std::string bytes, follower.download(job_evidence(ended.job), most_evidence));
    if (canonical_json(*ended.evidence) != bytes) return bad_input("its evidence is another than was told", where);
    auto evidence = read_evidence(bytes);
    if (!evidence) return std::move(evidence).error().in(where);
    WEAVE_TRY(SimulationStatement statement, read_simulation(evidence->statement));
    const auto yarns = ended.report.find("yarns_sha256");
    if (yarns == ended.report.end() || hash_hex(statement.result_sha256) != *yarns) return bad_input("its evidence is of other yarns", where);
    return RemoteEvidence{std::move(bytes), std::move(*evidence), std::move(statement)};
}

Result<JobEnded> JobWatch::to_its_end() {
    while (true) {
        if (!m_cancelled && m_ears.wants_cancel()) {
            WEAVE_CHECK_OK(cancel());
        }
        WEAVE_TRY(auto received, m_follower.receive(200ms));
        notice_return();
        auto* message = received ? std::get_if<ServerMessage>(&*received) : nullptr;
        if (message != nullptr && is_end(*message)) return std::get<JobEnded>(std::move(*message));
        if (message != nullptr) hear(*message);
        if (Clock::now() - m_heard > longest_silence) {
            WEAVE_CHECK_OK(look());
        }
    }
}

bool JobWatch::is_end(const ServerMessage& message) const {
    const auto* ended = std::get_if<JobEnded>(&message);
    return ended != nullptr && ended->job == m_job;
}

void JobWatch::hear(const ServerMessage& message) {
    const auto* progress = std::get_if<JobProgress>(&message);
    if (progress != nullptr && progress->state.job == m_job) hear(progress->state);
}

void JobWatch::hear(const JobState& state) {
    m_heard = Clock::now();
    if (!m_cancelled) m_ears.hear(state);
}

Status JobWatch::cancel() {
    m_cancelled = true;
    const auto answer = m_follower.ask(Cancel{new_request_id(), m_job}, cancel_patience);
    if (!answer) return answer.error();
    return std::holds_alternative<Refused>(*answer) ? look() : Status();  // it has ended, or is not there any more
}

/// Another client of the same person may have dealt with the end of the job.
Status JobWatch::look() {
    m_heard = Clock::now();
    auto list = jobs_of(m_follower);
    if (!list) return m_follower.trouble() ? Status() : Status(std::move(list).error());
    for (const JobState& state : list->jobs) {
        if (state.job == m_job) return hear(state), Status();
    }
    m_lost = true;
    return Error{ErrorCode::refused, "the server does not have it any more: it lost it, or the end was dealt with elsewhere", name_of(m_job)};
}

/// Connected again, it sees whether the job is still there.
void JobWatch::notice_return() {
    const bool troubled = m_follower.trouble().has_value();
    if (!troubled && m_troubled) m_heard = {};
    m_troubled = troubled;
}

}  // namespace weave::wire
