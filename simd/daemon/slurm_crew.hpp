#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <simd/daemon/slurm_arrays.hpp>
#include <simd/daemon/task.hpp>
#include <simd/slurm/job_folder.hpp>
#include <simd/slurm/slurm.hpp>
#include <simd/store/store.hpp>
#include <string>
#include <thread>
#include <vector>

namespace weave::simd {

/// The jobs that Slurm has: handed over together, watched in its queue and in the folder that all nodes share, and their results
/// brought home. The store says which attempt at a job counts; queue and results say how it stands, and never the accounting. Slurm
/// may forget a job, run it twice or not answer for a while: a job that has left the queue without a result is told as ended, to be
/// handed over again; of two copies the later one counts. Tasks are told as by the crew of this machine.
/// Its owner has the lock for every call but those that say otherwise.
class SlurmCrew {
  public:
    using Clock = std::chrono::steady_clock;

    struct Rules {
        SlurmWishes wishes;
        std::filesystem::path shared;   ///< the folder that all nodes share with this machine
        std::filesystem::path program;  ///< this program, as nodes have it
        std::filesystem::path home;     ///< where results go, into a folder for each job
        std::string backend = "auto";
        std::chrono::seconds watch{5};  ///< from one look to the next
        std::chrono::seconds checkpoint{120};
        std::size_t jobs_at_once = 1000;  ///< that Slurm has; no array is longer
    };

    SlurmCrew(std::mutex& lock, Store& store, const Rules& rules);
    /// Stops watching; jobs go on in Slurm. Without the lock.
    ~SlurmCrew();
    SlurmCrew(const SlurmCrew&) = delete;
    SlurmCrew& operator=(const SlurmCrew&) = delete;

    /// Takes up what the store says Slurm has; resume() gives those jobs their tasks. Errors: the folder cannot be had, or is
    /// another daemon's.
    Status take_up();
    /// Begins to watch.
    void work();

    /// Has a job that waits handed over soon, together with others. The task must outlive it here, or leave.
    void hand_over(Task& task, std::uint64_t job, const std::string& person);
    /// Whether Slurm has this job since an earlier life of the daemon; its task is told of it from now on.
    bool resume(Task& task, std::uint64_t job, const std::string& person);
    /// Has its copies end with the yarns as they lie, which the task is told as `done`; as ended, where that takes too long.
    void stop(std::uint64_t job);
    /// The job is over, or starts anew: what of it is in Slurm is ended, and its folder goes away. The task is told nothing more.
    void leave(std::uint64_t job);
    /// The task is no more, but its job goes on in Slurm.
    void part(const Task& task);

    [[nodiscard]] std::size_t room() const;
    [[nodiscard]] std::size_t size() const;
    /// Where a job is, for people: `Slurm 4711_3: running on n1`; empty where it is not here.
    [[nodiscard]] std::string place_of(std::uint64_t job) const;
    /// What keeps looks, or the handing over of those that wait, from going well. Without the lock.
    [[nodiscard]] Status trouble() const;

  private:
    struct Entry {
        Task* task = nullptr;
        std::string person;
        bool is_in_array = false;  ///< else it waits to be handed over
        std::uint64_t attempt = 0;        ///< the newest that is known to have begun
        std::optional<QueuedJob> queued;  ///< as the queue had it last
        AttemptNews news;
        bool has_begun = false;  ///< which the task was told
        std::size_t gone = 0;    ///< looks in a row that did not find it in the queue
        std::optional<Clock::time_point> stopped;
        std::set<std::string> avoided;    ///< nodes whose fault an end was
        std::set<std::uint64_t> refused;  ///< stale attempts whose results were turned down
        /// To be handed over.
        [[nodiscard]] bool waits_here() const { return task != nullptr && !is_in_array; }
    };
    /// What a look at its folder finds out of a job.
    struct Found {
        std::uint64_t job = 0, attempt = 0;
        bool is_stopped = false;
        std::set<std::uint64_t> refused;
        std::optional<AttemptNews> news;
        std::optional<AttemptEnd> end;  ///< of the newest attempt; of one that is done the yarns are at home
    };

    void watch();
    // Without the lock.
    Status take_folder();
    void hand_in();
    Status hand_in(const std::string& person, const std::set<std::string>& avoided, const std::vector<std::uint64_t>& jobs);
    [[nodiscard]] Status has_room() const;
    Status give(std::uint64_t job);
    void look();
    Status look_at_folder(Found& found);
    void refuse_stale(Found& found);
    Status bring_home(const Found& found);
    void clear_away();
    void note(Status& trouble, Status status);
    // With the lock.
    [[nodiscard]] bool has_new_jobs(Clock::time_point now) const;
    [[nodiscard]] std::vector<Found> to_look_at(const std::optional<SlurmArrays::Look>& queue);
    void apply(const Found& found, const std::optional<SlurmArrays::Look>& queue);
    void tell(Entry& entry, const Found& found);
    void tell_end(std::uint64_t job, WorkerEnd end);

    std::mutex& m_lock;
    Store& m_store;
    const Rules m_rules;
    const SharedFolder m_shared;
    std::atomic<bool> m_ends{false};
    const Slurm m_slurm{m_ends};
    SlurmArrays m_arrays;             ///< only its thread's, once that works
    std::map<std::uint64_t, std::uint64_t> m_resumable;  ///< the newest attempts at jobs of an earlier life
    std::map<std::uint64_t, Entry> m_entries;  ///< by job
    std::vector<std::uint64_t> m_left;         ///< jobs that the arrays are still to drop
    Clock::time_point m_first_new{}, m_last_new{};  ///< of those that wait to be handed over
    Clock::time_point m_not_before{};               ///< the next try at handing over, after one that failed
    bool m_hurries = false;                    ///< to the next look
    std::condition_variable m_news;
    mutable std::mutex m_trouble_lock;
    Status m_queue_trouble, m_handing_trouble, m_disk_trouble;
    std::thread m_thread;  ///< last, when all else is there
};

}  // namespace weave::simd
