#pragma once

#include <weave/core/result.hpp>
#include <weave/sql/database.hpp>

#include <condition_variable>
#include <deque>
#include <functional>
#include <loomlink/store/log_mark.hpp>
#include <loomlink/store/writer.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace weave::loomlink {

/// The one thread that writes. Changes that wait while the disk works are committed together, each in a
/// savepoint of its own, so that one that is refused takes no other with it.
class CommitQueue {
  public:
    /// `mark`, which must outlive it, is kept at the last record that was committed.
    CommitQueue(std::string place, std::unique_ptr<sql::Connection> connection, LogMark& mark);
    /// Finishes what waits.
    ~CommitQueue();
    CommitQueue(const CommitQueue&) = delete;
    CommitQueue& operator=(const CommitQueue&) = delete;

    /// Answers once the change is on the disk, or is not stored at all; where the server went, as lost_store() says.
    Status commit(const std::function<Status(Writer&)>& change);

    /// How the disk took the last commit.
    [[nodiscard]] Status last_write() const;

  private:
    struct Job {
        const std::function<Status(Writer&)>* change;
        Status outcome;
        bool done = false;
    };

    void work();
    void commit_all(const std::deque<Job*>& jobs);
    static Status first_fault(const std::deque<Job*>& jobs);
    Status run_all(const std::deque<Job*>& jobs);
    Status run_one(Job& job);
    Status begin();
    Status reopen();

    std::string m_place;
    LogMark& m_mark;
    std::unique_ptr<sql::Connection> m_connection;
    mutable std::mutex m_mutex;
    std::condition_variable m_wake;  ///< the writer: there is work, or an end
    std::condition_variable m_done;  ///< those who wait for an answer
    std::deque<Job*> m_waiting;
    bool m_ending = false;
    bool m_is_committing = false;  ///< of the writer alone: all is asked for, but for the commit
    Status m_last_write;
    std::thread m_thread;
};

}  // namespace weave::loomlink
