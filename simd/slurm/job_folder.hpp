#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <simd/link/work_order.hpp>
#include <string>
#include <vector>

namespace weave::simd {

/// How copies of a job that run somewhere are to end.
enum class Stop : std::uint8_t {
    with_yarns,  ///< it was cancelled: with its yarns as they lie
    at_once,     ///< it is over, or forgotten
};

/// How an attempt at a job ended.
enum class Outcome : std::uint8_t {
    done,   ///< its result is there
    again,  ///< the same may go well at another time, or on another node
    never,  ///< the same would happen again
};

/// An attempt's last word, which stands in its folder from then on.
struct AttemptEnd {
    Outcome outcome = Outcome::done;
    std::string input_sha256;          ///< of what it was given
    std::string node;
    bool was_stopped = false;          ///< with its yarns as they lay
    bool is_the_nodes_fault = false;   ///< of `again`: better elsewhere
    std::uint64_t step = 0;
    std::optional<Error> error;        ///< of `again` and `never`
    Json report = Json::object();      ///< of `done`; with `yarns_sha256`
};

/// What an attempt tells while it goes on.
struct AttemptNews {
    std::string node, gpus;            ///< where; the numbers of its GPUs there, or empty
    std::size_t points = 0;            ///< 0: it still plans
    std::uint64_t step = 0;
    double residual = 0, goal = 0;
    std::optional<std::uint64_t> lost;
    std::string trouble;               ///< with its last checkpoint; empty: none
    bool operator==(const AttemptNews&) const = default;
};

/// A job in the folder that the daemon shares with all nodes: its order, and what attempts at it leave. An attempt is one start
/// of its program on one node; each writes into a folder of its own that no other writes into, so that a copy which was given
/// up for lost, and goes on, harms nothing. The number of the newest is the fencing token. No clock is looked at.
/// Errors name the file. What is read may have been written by anybody who can write there.
class JobFolder {
  public:
    explicit JobFolder(std::filesystem::path path) : m_path(std::move(path)) {}

    /// Makes the folder with its order, if it is not there.
    [[nodiscard]] Status give(const WorkOrder& order) const;
    [[nodiscard]] Result<WorkOrder> order() const;
    /// Whether it was taken away since.
    [[nodiscard]] bool is_gone() const;
    void ask_to_stop(Stop stop) const;
    [[nodiscard]] std::optional<Stop> stop() const;

    /// Begins an attempt: its number, which no other has, from 1. Errors: the disk's.
    [[nodiscard]] Result<std::uint64_t> begin_attempt() const;
    /// The number of the newest; 0: none has begun.
    [[nodiscard]] Result<std::uint64_t> newest_attempt() const;
    [[nodiscard]] std::filesystem::path attempt(std::uint64_t number) const;

    void tell(std::uint64_t attempt, const AttemptNews& news) const;
    [[nodiscard]] std::optional<AttemptNews> news(std::uint64_t attempt) const;
    [[nodiscard]] Status end(std::uint64_t attempt, const AttemptEnd& end) const;
    /// Its end is not to be taken for one any more.
    void refuse(std::uint64_t attempt) const;
    /// Nothing where it has not ended.
    [[nodiscard]] Result<std::optional<AttemptEnd>> end_of(std::uint64_t attempt) const;

  private:
    std::filesystem::path m_path;
};

/// Stands for all that a job's result depends on: its document, its simulation and its flips.
std::string input_sha256(const WorkOrder& order);

/// Where things lie in the folder that the daemon shares with all nodes.
struct SharedFolder {
    std::filesystem::path path;
    [[nodiscard]] std::filesystem::path owner() const { return path / "owner"; }
    [[nodiscard]] std::filesystem::path script() const { return path / "run"; }
    [[nodiscard]] std::filesystem::path jobs() const { return path / "jobs"; }
    [[nodiscard]] JobFolder job(std::uint64_t number) const { return JobFolder(jobs() / std::to_string(number)); }
    [[nodiscard]] std::filesystem::path arrays() const { return path / "arrays"; }
    [[nodiscard]] std::filesystem::path array(std::uint64_t submission) const { return arrays() / (std::to_string(submission) + ".json"); }
};

/// The jobs of an array by their places, as its program finds them.
Status write_array(const std::filesystem::path& file, const std::vector<std::pair<std::uint64_t, std::uint64_t>>& jobs_by_place);
/// The number of the job at a place. Errors: bad input.
Result<std::uint64_t> job_at(const std::filesystem::path& file, std::uint64_t place);

}  // namespace weave::simd
