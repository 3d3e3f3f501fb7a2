#pragma once

#include "command.hpp"

#include <weave/command/server_wish.hpp>
#include <weave/sim/simulate.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// What `weave simulate` is asked for, as it was written and as it is understood.
namespace weave::program {

/// The options of `weave simulate`.
struct SimulateWish {
    std::string file, out, fidelity = "standard", region, solver = "relax", backend = "auto", resume, save_design, start_from, checkpoint;
    std::vector<std::string> set, sweep, boundaries, pins, fields, flips;
    bool wraparound = false, explain = false, whole = false, symmetry = false;
    std::optional<double> residual, points, seconds, checkpoint_every;
    std::optional<std::size_t> steps, patience;
    std::size_t threads = 0, starts = 0;
    std::optional<std::uint64_t> seed;
    ServerWish server;                  ///< what computes instead of this program, if anything
    std::string evidence;               ///< file for what the server signs
    std::string no_plan_option;         ///< the first given that makes no difference to the plan
    std::string no_server_option;       ///< the first given that no server can do
};

/// What is to be done, understood.
struct SimulateTask {
    Design design;  ///< with the scene of this run
    std::string file_scene_sha256;  ///< of the scene as the file has it
    sim::SimulationRequest request;
    sim::SimulationOptions options;
    std::vector<Flip> flips;
    std::optional<sim::Plan> coarser;  ///< where options.coarser points to
};

Error usage_error(std::string message, std::string where);

/// What is wrong with the options before any file is read.
Status check_wish(const SimulateWish& wish);

/// Errors name the option, or the place in the scene.
Result<SimulateTask> understand(Cloth cloth, const SimulateWish& wish);

/// What is simulated; planning a large cloth takes its time, which is told.
Result<sim::Plan> plan_of(const Design& design, const Block& block, const sim::SimulationRequest& request, const std::string& file);

/// Flips of a part of the cloth lie in it.
Status check_flips_within(const sim::Plan& plan, const std::vector<Flip>& flips);

/// Which fidelity's points a run begins in; empty: its own. `reference` refines the rest that `standard` comes to, so that the
/// two can be compared, and is there sooner as a rule (docs/simulation.md).
std::string first_points(const SimulateWish& wish);

}  // namespace weave::program
