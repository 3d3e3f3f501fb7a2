#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <simd/slurm/job_folder.hpp>
#include <simd/slurm/slurm.hpp>
#include <simd/store/store.hpp>
#include <string>
#include <vector>

namespace weave::simd {

/// The arrays of jobs that were given to Slurm, and what its queue tells of them. An array is in the store before sbatch is
/// called, and in the queue it has a name that only this store gives: so none is submitted twice because a call or the daemon died in
/// between, and what is in the queue under such a name without being wanted is cancelled. For one thread.
class SlurmArrays {
  public:
    struct Rules {
        SlurmWishes wishes;
        SharedFolder shared;
        std::filesystem::path program;  ///< this program, as nodes have it
    };

    SlurmArrays(Store& store, const Slurm& slurm, Rules rules) : m_store(store), m_slurm(slurm), m_rules(std::move(rules)) {}

    /// Takes up what the store has of earlier lives. Errors: the store's.
    Status take_up();
    /// Gives jobs of a person, whose folders are there, a place in a new array; the next look submits it. Errors: the store's.
    Status add(const std::string& person, const std::set<std::string>& avoided, const std::vector<std::uint64_t>& jobs);
    /// What of a job is in Slurm is no longer wanted.
    void drop(std::uint64_t job);

    struct Look {
        std::map<std::uint64_t, QueuedJob> jobs;  ///< as the queue has them, those that ended lately too
        std::set<std::uint64_t> missing;          ///< that ought to be there, and are not, or have ended
    };
    /// One look at the queue for all jobs; then submits what is not there yet, cancels what is not wanted, and lets go on what
    /// Slurm holds without need. Errors: Slurm does not answer, and nothing was done.
    Result<Look> look();
    /// Jobs that were dropped, and of which the last look saw nothing alive any more; told once.
    std::vector<std::uint64_t> take_gone();
    /// What keeps arrays from being submitted; nothing once they are, or nobody wants them any more.
    [[nodiscard]] const Status& refusal() const { return m_refusal; }

  private:
    using Clock = std::chrono::steady_clock;
    using Place = std::pair<std::uint64_t, std::uint64_t>;  ///< array and place in it

    struct Array {
        std::optional<std::uint64_t> slurm_id;
        std::string person;
        std::set<std::string> avoided;
        std::map<std::uint64_t, std::uint64_t> jobs;  ///< by place
        std::optional<Clock::time_point> refused;     ///< when Slurm did not want it last
    };

    [[nodiscard]] std::string name_of(std::uint64_t array) const { return "simd-" + m_id + "-" + std::to_string(array); }
    [[nodiscard]] std::optional<std::uint64_t> array_named(const std::string& name) const;
    void recognise(const std::vector<QueuedJob>& lines);
    void sort_in(const QueuedJob& line, std::uint64_t array, Look& look, std::vector<std::string>& unwanted);
    void submit(std::uint64_t number, Array& array);
    [[nodiscard]] Result<std::uint64_t> try_to_submit(std::uint64_t number, const Array& array) const;
    void clear_away() const;
    void let_go_on(const QueuedJob& job);
    void try_to(Status status);
    void name(std::uint64_t number, Array& array, std::uint64_t slurm_id);

    Store& m_store;
    const Slurm& m_slurm;
    const Rules m_rules;
    std::string m_id;  ///< of the store
    std::map<std::uint64_t, Array> m_arrays;
    std::map<std::uint64_t, Place> m_places;  ///< of jobs that are wanted
    std::map<Place, std::uint64_t> m_dropped;
    std::set<Place> m_dropped_alive;          ///< as the last look saw
    std::vector<std::uint64_t> m_gone;
    Status m_refusal;
};

}  // namespace weave::simd
