#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace weave::net {

/// Threads that do what may block. A task is told whether to work (true) or only to hand over (false), as
/// after abandon(): every task that was taken runs once, so that whoever waits for it goes on.
class WorkerPool {
  public:
    using Task = std::function<void(bool work)>;

    WorkerPool(std::size_t workers, std::size_t most_waiting);
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// Takes a task unless `most_waiting` of them wait already.
    [[nodiscard]] bool offer(Task task);
    /// Takes a task whatever waits: for callers that have a bound of their own.
    void post(Task task);
    /// From now on tasks do no work. Those that run are finished.
    void abandon();
    /// Ends the threads once nothing waits any more.
    void join();
    [[nodiscard]] std::size_t waiting() const;

  private:
    void work();

    const std::size_t m_most_waiting;
    mutable std::mutex m_mutex;
    std::condition_variable m_changed;
    std::deque<Task> m_tasks;
    bool m_abandoned = false;
    bool m_ending = false;
    std::vector<std::thread> m_threads;
};

}  // namespace weave::net
