#pragma once

#include "simulate_wish.hpp"

#include <weave/wire/follower.hpp>

namespace weave::program {

/// `weave simulate --on`: has a server relax what is asked for, and answers as a run on this machine would, with the
/// `job` and the `server` beside. `design` is as its file has it; `goal` the residual, for the line of progress.
/// Errors: what the server refuses, the plan's, a server that cannot be reached any more; the job is kept there then, and the
/// error says how to fetch it.
Status simulate_on(CommandOutcome& outcome, wire::Follower& follower, const Design& design, const SimulateTask& task,
                   const SimulateWish& wish, double goal);

/// `weave simulate --on --sweep`: hands over a job for each of these tasks, and answers with their numbers, each beside what its
/// run was set to. Errors: what the server refuses; the jobs that it took before stay, and are told.
Status sweep_on(CommandOutcome& outcome, wire::Follower& follower, const std::vector<SimulateTask>& tasks, const std::vector<std::vector<std::string>>& settings,
                const SimulateWish& wish);

}  // namespace weave::program
