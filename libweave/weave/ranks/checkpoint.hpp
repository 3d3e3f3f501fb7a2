#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/ranks/comm.hpp>
#include <weave/ranks/cut.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace weave::ranks {

/// A run between two legs: where the points of this rank's blocks lie, and what was used up.
struct Stand {
    std::size_t iterations = 0, evaluations = 0;
    double seconds = 0;
    std::vector<double> state;  ///< three numbers a point, block after block
};

/// The checkpoints of a run in a folder that all ranks see. Each is a folder of its own, `step-N`, with a file of each rank, and
/// counts once `complete.json` is in it, which the first rank writes when all others are done; then older ones go. Blocks are
/// what files hold, so any number of ranks goes on from it.
class Checkpoints {
  public:
    /// `run`: what tells this run from any other: design, scene, plan.
    Checkpoints(std::filesystem::path folder, Json run) : m_folder(std::move(folder)), m_run(std::move(run)) {}

    /// Whether all ranks see the folder and can write there, for what is needed only after long work; makes it. All call it at once.
    Status try_out(Comm& comm) const;

    /// Writes one; all ranks call it at once. Where one of them cannot (its disk is full), none counts, and all get the error. One
    /// that is complete already stays as it is.
    Status write(Comm& comm, const Cut& cut, const std::vector<Part>& parts, const Stand& stand) const;

    /// The newest that is complete, if there is one; all ranks call it at once. Errors: it is of another run, or damaged.
    Result<std::optional<Stand>> newest(Comm& comm, const Cut& cut, const std::vector<Part>& parts) const;

  private:
    [[nodiscard]] std::filesystem::path place(std::size_t iterations) const;
    [[nodiscard]] bool is_complete(std::size_t step) const;
    void remove_others(std::size_t step) const;
    [[nodiscard]] Result<std::optional<std::size_t>> newest_step() const;
    Status write_own(const Comm& comm, const Cut& cut, const std::vector<Part>& parts, const Stand& stand) const;
    Result<Stand> read_own(const Comm& comm, const Cut& cut, const std::vector<Part>& parts, std::size_t step) const;

    std::filesystem::path m_folder;
    Json m_run;
};

}  // namespace weave::ranks
