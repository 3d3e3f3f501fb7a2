#pragma once

#include <weave/ranks/checkpoint.hpp>
#include <weave/ranks/comm.hpp>
#include <weave/ranks/cut.hpp>
#include <weave/sim/plan_in_stretches.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace weave::ranks {

struct SplitOptions {
    std::optional<double> residual;       ///< instead of the plan's
    std::size_t most_iterations = 20000;  ///< of the whole run, those before a checkpoint included
    double most_seconds = 1e30;           ///< of this run, without those before a checkpoint
    std::size_t threads = 1;              ///< of each rank
    std::size_t points_a_block = usual_points;
    std::filesystem::path checkpoints;    ///< the folder for them, which all ranks see; empty: none
    double checkpoint_every_s = 120;
    /// Called on every rank after each step; a rank that answers false ends the run on all.
    std::function<bool(const sim::Progress&)> watch;
    /// Told on the first rank of what does not end the run: a checkpoint gone on from, written, or one that could not be.
    std::function<void(const std::string&)> note;
    /// Told on the first rank of the step of the newest checkpoint.
    std::function<void(std::size_t)> saved;
};

/// Relaxes a plan by all ranks together, as simulate() does by one, and writes its yarns to `out`, on the first rank. Gives the
/// report, on all ranks the same. Between legs, of a fixed number of steps, the solver remembers nothing, so that a run that goes
/// on from a checkpoint comes to the bits of one that was left alone, by whatever number of ranks. No rank holds the points of
/// more than its blocks and their guests. Errors, the same on all
/// ranks: what is not computed so (cut_plan()), ranks that were given other designs or options, a checkpoint of another run, a folder
/// for checkpoints that not all see, `out` that cannot be written.
Result<Json> simulate_split(Comm& comm, const Design& design, sim::PlanInStretches plan, const SplitOptions& options, const std::filesystem::path& out);

/// What a run would be: blocks, and of each rank its `blocks`, its `points` and the `peak_bytes` that it took to plan. The same on
/// all ranks. Errors: what is not computed so.
Result<Json> explain_split(Comm& comm, const Design& design, const sim::PlanInStretches& plan, std::size_t points_a_block = usual_points);

}  // namespace weave::ranks
