#pragma once

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <simd/link/worker_process.hpp>
#include <simd/slurm/job_folder.hpp>
#include <string>

namespace weave::simd {

/// Exit statuses of `simd job`, which a site sees.
enum class JobExit : int {
    done = 0,    ///< its result is there, or nobody wants one any more
    never = 70,  ///< it failed for good, or a newer copy has begun
    again = 75,  ///< asked to end, or something of the node failed: it goes on from its checkpoint
};

/// One attempt at a job on a node: a worker process, as the daemon would have it, fed from the job's folder. Asked to end by
/// SIGTERM it leaves a checkpoint; a job that is started again goes on from the newest that earlier attempts left.
class Attempt {
  public:
    /// What Slurm has given it, of this process's environment.
    struct Node {
        std::string name, gpus;
        std::size_t cpus = 1;
        std::uint64_t memory_bytes = 0;  ///< 0: no bound
    };
    static Node node_of_environment();

    Attempt(JobFolder folder, WorkOrder order, std::uint64_t number, Node node);

    /// Runs to its end, which is written into its folder. `program` is this one.
    JobExit run(const std::filesystem::path& program);

  private:
    using Clock = std::chrono::steady_clock;

    void take_checkpoint();
    void hear(const Json& message);
    void admit(const Json& plan);
    void look();
    void tell_worker(const Json& message);
    [[nodiscard]] std::optional<std::uint64_t> newer() const;
    JobExit finish(const std::string& how);
    JobExit hand_in();
    JobExit fail(Outcome outcome, Error error, bool is_the_nodes_fault = false);

    JobFolder m_folder;
    WorkOrder m_order;
    const std::uint64_t m_number;
    const Node m_node;
    AttemptNews m_news;
    std::optional<AttemptNews> m_told;
    std::optional<Error> m_failure;  ///< that the worker told of
    bool m_is_final = false, m_was_asked_to_end = false, m_is_stale = false, m_is_unwanted = false;
    std::optional<Stop> m_stop;
    std::optional<Json> m_done;
    Clock::time_point m_looked{};

    // Filled by the thread that listens to the worker.
    std::mutex m_mutex;
    std::condition_variable m_came;
    std::deque<Json> m_heard;
    std::optional<std::string> m_ended;
    std::unique_ptr<WorkerProcess> m_worker;  ///< last, so that it ends first
};

/// `simd job FILE`: does the job of an array that Slurm starts here, by SLURM_ARRAY_TASK_ID. The exit status of the process.
int run_job_of_array(const std::filesystem::path& file);

}  // namespace weave::simd
