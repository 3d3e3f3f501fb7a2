#include <loomlink/store/commit_queue.hpp>

#include <weave/core/log.hpp>

#include <algorithm>
#include <exception>
#include <loomlink/store/reach.hpp>
#include <loomlink/store/server.hpp>
#include <utility>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_together = 256;

/// A change is the caller's code: what it throws must not end the writer.
Status call(const std::function<Status(Writer&)>& change, Writer& writer) {
    try {
        return change(writer);
    } catch (const std::exception& trouble) {
        return system_fault(std::string("a change of the store failed: ") + trouble.what());
    } catch (...) {
        return system_fault("a change of the store failed");
    }
}

}  // namespace

/// The system may fail one change and take the others, as a server does whose disk is full.
Status CommitQueue::first_fault(const std::deque<Job*>& jobs) {
    for (const Job* job : jobs)
        if (!job->outcome && job->outcome.error().code == ErrorCode::system) return job->outcome;
    return {};
}

CommitQueue::CommitQueue(std::string place, std::unique_ptr<sql::Connection> connection, LogMark& mark)
    : m_place(std::move(place)), m_mark(mark), m_connection(std::move(connection)), m_thread([this] { work(); }) {}

CommitQueue::~CommitQueue() {
    {
        const std::lock_guard lock(m_mutex);
        m_ending = true;
    }
    m_wake.notify_one();
    m_thread.join();
}

Status CommitQueue::commit(const std::function<Status(Writer&)>& change) {
    Job job{&change, {}, false};
    std::unique_lock lock(m_mutex);
    m_waiting.push_back(&job);
    m_wake.notify_one();
    m_done.wait(lock, [&] { return job.done; });
    return std::move(job.outcome);
}

Status CommitQueue::last_write() const {
    const std::lock_guard lock(m_mutex);
    return m_last_write;
}

void CommitQueue::work() {
    std::unique_lock lock(m_mutex);
    while (true) {
        m_wake.wait(lock, [this] { return m_ending || !m_waiting.empty(); });
        if (m_waiting.empty()) return;
        const auto count = static_cast<std::ptrdiff_t>(std::min(m_waiting.size(), most_together));
        const std::deque<Job*> jobs(m_waiting.begin(), m_waiting.begin() + count);
        m_waiting.erase(m_waiting.begin(), m_waiting.begin() + count);
        lock.unlock();
        commit_all(jobs);
        lock.lock();
        for (Job* job : jobs) job->done = true;
        m_done.notify_all();
    }
}

void CommitQueue::commit_all(const std::deque<Job*>& jobs) {
    m_is_committing = false;
    Status status = m_connection ? Status() : reopen();
    if (status) status = run_all(jobs);
    const bool is_lost = !status && status.error().code == ErrorCode::system && !(m_connection && m_connection->is_usable());
    if (is_lost) status = lost_store(m_is_committing ? Lost::in_commit : Lost::before, status.error());
    {
        const std::lock_guard lock(m_mutex);
        m_last_write = status ? first_fault(jobs) : status;
    }
    if (status) return;
    // Nothing of the batch was stored, so nobody of it may believe so. Whose change was refused anyway keeps
    // the reason.
    for (Job* job : jobs)
        if (job->outcome || (is_lost && job->outcome.error().code == ErrorCode::system)) job->outcome = status;
    if (m_connection) m_connection->rollback();
    log(LogLevel::warning, "the store could not write: " + status.error().text());
    m_connection.reset();  // what a failed disk left in its cache is not to be trusted
}

Status CommitQueue::run_all(const std::deque<Job*>& jobs) {
    WEAVE_CHECK_OK(begin());
    for (Job* job : jobs) WEAVE_CHECK_OK(run_one(*job));
    WEAVE_TRY(const auto last, LogMark::newest(*m_connection));
    m_is_committing = true;
    WEAVE_CHECK_OK(m_connection->commit());
    m_mark.set(last);
    return {};
}

/// Nothing is lost by a second try where the server went away since the last commit.
Status CommitQueue::begin() {
    Status begun = m_connection->begin_write();
    if (begun || m_connection->is_usable()) return begun;
    WEAVE_CHECK_OK(reopen());
    return m_connection->begin_write();
}

/// Runs one change in a savepoint. An error is one that ends the whole batch; the change's own goes into its
/// outcome.
Status CommitQueue::run_one(Job& job) {
    WEAVE_CHECK_OK(m_connection->script("SAVEPOINT change"));
    Writer writer(*m_connection);
    job.outcome = call(*job.change, writer);
    if (!m_connection
             ->in_transaction())  // a full disk may roll back everything, this change's neighbours with it
        return job.outcome ? system_fault("the transaction was ended; nothing was stored") : Status(job.outcome.error());
    if (!job.outcome) WEAVE_CHECK_OK(m_connection->script("ROLLBACK TO change"));
    return m_connection->script("RELEASE change");
}

Status CommitQueue::reopen() {
    m_connection.reset();
    WEAVE_TRY(m_connection, open_writer(m_place, m_mark));
    return {};
}

}  // namespace weave::loomlink
