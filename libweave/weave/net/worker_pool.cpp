#include <weave/net/worker_pool.hpp>

namespace weave::net {

WorkerPool::WorkerPool(std::size_t workers, std::size_t most_waiting) : m_most_waiting(most_waiting) {
    for (std::size_t k = 0; k < workers; ++k) m_threads.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
    abandon();
    join();
}

bool WorkerPool::offer(Task task) {
    {
        const std::lock_guard lock(m_mutex);
        if (m_tasks.size() >= m_most_waiting) return false;
        m_tasks.push_back(std::move(task));
    }
    m_changed.notify_one();
    return true;
}

void WorkerPool::post(Task task) {
    {
        const std::lock_guard lock(m_mutex);
        m_tasks.push_back(std::move(task));
    }
    m_changed.notify_one();
}

void WorkerPool::abandon() {
    const std::lock_guard lock(m_mutex);
    m_abandoned = true;
}

void WorkerPool::join() {
    {
        const std::lock_guard lock(m_mutex);
        m_ending = true;
    }
    m_changed.notify_all();
    for (std::thread& thread : m_threads)
        if (thread.joinable()) thread.join();
}

std::size_t WorkerPool::waiting() const {
    const std::lock_guard lock(m_mutex);
    return m_tasks.size();
}

void WorkerPool::work() {
    std::unique_lock lock(m_mutex);
    while (true) {
        m_changed.wait(lock, [&] { return !m_tasks.empty() || m_ending; });
        if (m_tasks.empty()) return;
        Task task = std::move(m_tasks.front());
        m_tasks.pop_front();
        const bool work = !m_abandoned;
        lock.unlock();
        task(work);
        task = nullptr;  // what it held goes while nobody waits for the lock
        lock.lock();
    }
}

}  // namespace weave::net
