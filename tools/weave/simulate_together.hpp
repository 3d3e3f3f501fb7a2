#pragma once

#include "command.hpp"
#include "simulate_wish.hpp"

/// `weave simulate` where mpirun started several of it: they relax one cloth together (weave/ranks).
namespace weave::program {

/// Where mpirun started several processes, all but the first are silent from now on: what is wrong with the words or the design all
/// find alike.
void let_one_speak();

/// What only several processes do.
Status check_alone(const SimulateWish& wish);

/// Plans, relaxes and tells; the first process writes the file. What is wrong for all of them, one tells.
Status simulate_together(CommandOutcome& outcome, const SimulateWish& wish);

}  // namespace weave::program
