#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <simd/store/records.hpp>
#include <string>
#include <vector>

namespace weave::sql {
class Connection;
}

namespace weave::simd {

/// The text of an answer that tells the number of what was made.
using AnswerOf = std::function<std::string(Number made)>;

/// What must outlive the daemon, in one SQLite file. Safe from any thread. Each call is one transaction and
/// durable when it returns, power loss included.
///
/// Errors: system where the disk or the file fails; usage for what does not exist, or cannot follow on what
/// is there. A call that failed has changed nothing, or (the disk failed while it flushed) all of it: so each
/// call may be made again, and what is there already is not done twice. The next call after a failure of the
/// disk opens the file anew.
class Store {
  public:
    /// Opens the store, or makes it where there is none. Jobs that ran when the daemon died are waiting
    /// again. Refused: a file of another program or of a newer version; system: another daemon has it open.
    static Result<std::unique_ptr<Store>> open(const std::filesystem::path& path);
    ~Store();
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;

    /// @name Answers. The first to a request of a person stays; of each person the newest 1,000 are kept.
    /// @{
    Status remember(const std::string& person, const std::string& request, const std::string& answer);
    Result<std::optional<std::string>> answer_of(const std::string& person, const std::string& request);
    /// @}

    /// @name Sessions
    /// @{
    /// Makes a session, numbered from 1 on, and remembers the answer with it. A request that was answered
    /// before makes nothing.
    Result<Made> add_session(const NewSession& session, const AnswerOf& answer);
    Status change_session(Number session, const SessionState& state);
    /// All that are not forgotten, in the order of their numbers.
    Result<std::vector<KeptSession>> sessions();
    Result<SessionTask> task_of_session(Number session);
    /// Forgets it with its events and its journal. Its number is not given again.
    Status forget_session(Number session);
    /// @}

    /// @name Events. Their `seq` is 1, 2, 3 … within a session; after one that is `ended` comes no other.
    /// @{
    /// Adds events, and the steps at which changes of the journal took effect. Those of them that are kept
    /// already, with the same text, are passed over; a change keeps its step for good, and that its flip was told.
    Status add_events(Number session, const std::vector<Event>& events, const std::vector<Dated>& dated);
    /// Those after `seq` that are kept, in order, `most` at most.
    Result<std::vector<Event>> events_after(Number session, Number seq, std::size_t most);
    /// Up to `seq` all is dealt with: drops it, but for the newest layout, the newest phase, and `ended`.
    Status acknowledge(Number session, Number seq);
    /// @}

    /// @name The journal of a session
    /// @{
    /// Adds a change of which it is not known yet when it takes effect, numbered from 1 on within its
    /// session, and remembers the answer with it for the session's person. A request that was answered before
    /// adds nothing.
    Result<Made> add_change(Number session, const std::string& request, const std::string& change,
                            const AnswerOf& answer);
    Result<std::vector<KeptChange>> changes(Number session);
    /// @}

    /// @name Jobs
    /// @{
    /// Makes a job that waits, numbered from 1 on, and remembers the answer with it. A request that was
    /// answered before makes nothing.
    Result<Made> add_job(const NewJob& job, const AnswerOf& answer);
    /// A job that waits runs now, and has one attempt more.
    Status start_job(Number job);
    /// How far a job that runs is. Kept in memory alone until it ends: after a crash it begins with nothing.
    void job_progress(Number job, Number step, std::optional<double> residual);
    /// Ends a job that waits or runs, for good.
    Status end_job(Number job, const JobEnd& end);
    Result<JobTask> task_of_job(Number job);
    /// All that are not forgotten, in the order of their numbers.
    Result<std::vector<KeptJob>> jobs();
    /// Forgets a job that has ended. Its number is not given again.
    Status forget_job(Number job);
    /// @}

    /// @name Jobs that Slurm has
    /// @{
    /// By what this store is known in the queue of a cluster: 16 hexadecimal digits.
    Result<std::string> cluster_id();
    /// Makes a submission of jobs that have not ended, at places 0, 1, 2 … of its array, in place of an earlier one that had
    /// any of them.
    Result<Number> add_submission(const std::vector<Number>& jobs);
    /// Slurm has told the number of its array.
    Status name_submission(Number submission, Number slurm_id);
    /// Those that have jobs, in the order of their numbers.
    Result<std::vector<KeptSubmission>> submissions();
    /// Lets this attempt at a job count from now on, and none before it. Refused: a later one counts already.
    Status note_attempt(Number job, Number attempt);
    /// @}

    /// How the last call that wrote ended, for who watches over the machine.
    Status last_write();

  private:
    struct Progress {
        Number step = 0;
        std::optional<double> residual;
    };
    using Change = std::function<Status(sql::Connection&)>;

    explicit Store(std::filesystem::path path);
    /// One transaction that writes; none of it stays if `change` fails.
    Status write(const Change& change);
    /// Something that only reads.
    Status read(const Change& ask);
    Status connect(bool may_make);
    Result<sql::Connection*> connection();
    Status settled(Status outcome);

    const std::filesystem::path m_path;
    std::mutex m_mutex;
    std::unique_ptr<sql::Connection> m_connection;  ///< none after the disk failed
    std::map<Number, Progress> m_progress;          ///< of jobs that run
    bool m_failure_told = false;                    ///< in the log, since it last worked
    std::optional<Error> m_trouble;                 ///< of the disk, at the last call that wrote
};

}  // namespace weave::simd
