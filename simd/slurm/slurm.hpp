#pragma once

#include <weave/core/result.hpp>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave::simd {

/// What every job asks Slurm for. Words are Slurm's own; empty or 0: what the site has set.
struct SlurmWishes {
    std::string partition, account, qos;
    std::string gres;             ///< `gpu:1`, say
    std::size_t cpus = 1;         ///< threads that compute
    std::size_t memory_mib = 0;
    std::size_t minutes = 0;      ///< after which Slurm asks it to end
};

/// Jobs that go to Slurm together.
struct SlurmArray {
    std::string name;                  ///< by which they are found again in the queue
    std::string person;                ///< whose they are, for the site's eyes
    std::vector<std::uint64_t> places;  ///< numbers in the array, ascending, not empty
    std::vector<std::string> avoided;  ///< nodes that are not to have them
    std::vector<std::string> command;  ///< what each of them runs; the node has the same files
    std::filesystem::path script;      ///< runs the command that it is given
    std::filesystem::path log;         ///< for what they tell, a name with Slurm's %a in it
};

/// A job in the queue, as squeue tells it.
struct QueuedJob {
    std::uint64_t array = 0, place = 0;
    std::string name, state, node, reason;  ///< state: PENDING, RUNNING …
    /// By which Slurm knows it: `4711_3`.
    [[nodiscard]] std::string id() const { return std::to_string(array) + "_" + std::to_string(place); }
    /// Waits, runs or is about to end; all else is an end.
    [[nodiscard]] bool is_alive() const;
};

/// What the programs of Slurm are asked for: each call runs one of them, and no shell. For one thread.
/// Errors (system): the program is not there, Slurm does not answer or does not want it, in its own words.
class Slurm {
  public:
    /// Once `gives_up` is true every call ends at once.
    explicit Slurm(const std::atomic<bool>& gives_up) : m_gives_up(gives_up) {}

    /// The number of the array that was made. After an error it may be there all the same: look for its name.
    Result<std::uint64_t> submit(const SlurmArray& array, const SlurmWishes& wishes) const;
    /// All jobs of this user, with those that ended lately.
    [[nodiscard]] Result<std::vector<QueuedJob>> queue() const;
    [[nodiscard]] Status cancel(const std::vector<std::string>& ids) const;
    /// Lets a job go on that Slurm holds.
    [[nodiscard]] Status release(const std::string& id) const;
    /// Lets a job begin that was put back, and would wait for two minutes.
    [[nodiscard]] Status start_now(const std::string& id) const;

  private:
    [[nodiscard]] Result<std::string> ask(const std::vector<std::string>& words) const;
    const std::atomic<bool>& m_gives_up;
};

/// `0-2,5` for 0, 1, 2, 5.
std::string ranges_text(const std::vector<std::uint64_t>& places);
/// Lines as queue() asks for them; those of other forms are passed over.
std::vector<QueuedJob> parse_queue(std::string_view text);
/// `sbatch --parsable` tells `4711` or `4711;cluster`.
std::optional<std::uint64_t> parse_submitted(std::string_view text);

}  // namespace weave::simd
