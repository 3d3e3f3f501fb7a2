#pragma once

#include <weave/core/result.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <simd/link/link.hpp>
#include <string>
#include <sys/types.h>
#include <thread>

namespace weave::simd {

/// A process that works for the daemon, and the thread that listens to it.
class WorkerProcess {
  public:
    /// What its thread calls: each message as it comes, and at last, once, how the process ended, in words.
    struct Listener {
        std::function<void(LinkMessage)> message;
        std::function<void(std::string how)> ended;
    };

    /// Starts `program worker` with nothing but its link and standard error, and gives it its order. Errors: system.
    static Result<std::unique_ptr<WorkerProcess>> start(const std::filesystem::path& program, Json order, Listener listener);
    /// Kills it if it still runs, and waits for its thread: not to be called from the listener.
    ~WorkerProcess();
    WorkerProcess(const WorkerProcess&) = delete;
    WorkerProcess& operator=(const WorkerProcess&) = delete;

    [[nodiscard]] Link& link() { return m_link; }
    [[nodiscard]] pid_t id() const { return m_id; }
    /// Since it last said a word, or was started.
    [[nodiscard]] std::chrono::steady_clock::duration silent_for(std::chrono::steady_clock::time_point now) const { return now - m_heard.load(); }
    /// Ends it at once; the listener is told.
    void kill();
    /// Memory that it has in use, bytes; 0 where the system does not say.
    [[nodiscard]] std::uint64_t memory_bytes() const;

  private:
    WorkerProcess(pid_t id, Descriptor link, Json order, Listener listener);
    void listen(const Json& order);

    pid_t m_id;
    int m_handle = -1;  ///< a pidfd: its number is never given to another process
    Link m_link;
    Listener m_listener;
    std::atomic<std::chrono::steady_clock::time_point> m_heard = std::chrono::steady_clock::now();
    std::thread m_thread;
};

}  // namespace weave::simd
