#pragma once

#include "command.hpp"
#include "simulate_wish.hpp"

/// `weave simulate` where mpirun started several of it: they relax one cloth together (weave/ranks).
namespace weave::program {

/// Whether they did; then all but the first are silent from now on.
bool runs_together();

/// What several processes do not do, and what one alone does not.
Status check_together(const SimulateWish& wish);

/// Relaxes and tells; the first process writes the file.
Status simulate_together(CommandOutcome& outcome, const Design& design, sim::Plan plan, const SimulateWish& wish);

}  // namespace weave::program
