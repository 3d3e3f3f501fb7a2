#pragma once

// Whether a cloth of many repeats rests as its smallest repeat says: the whole of it relaxed from a start
// with noise.

#include <weave/sim/simulate.hpp>
#include <weave/sim/starts.hpp>

#include <cstdint>
#include <string>

namespace weave::sim {

/// Compares the yarns of a whole cloth with one another, each repeat with the first, and with the yarns that
/// were `copied` back from the smallest repeat; `reduced` is the plan of these. Members `between_repeats`,
/// `from_smallest_repeat` (greatest distance across a yarn in mm and radii, and where: `repeat` counts along
/// the ends and along the picks) and `broken`: repeats differ by more than `same_rest_radii`.
Json compared_repeats(const Plan& reduced, const Yarns& whole, const Yarns& copied);

struct WholeRun {
    Yarns yarns;    ///< of the whole cloth, relaxed without reduction
    Json symmetry;  ///< what its report, and that of the reduced run, holds as `symmetry` (YARNS.md)
};

/// Relaxes the whole cloth from the start that its smallest repeat has too, with noise (starts.hpp), and
/// compares its repeats. `reduced` is the plan of `copied` and must have several repeats; `whole` that of the
/// same cloth without reduction.
WholeRun relaxed_whole(const Design& design, const Plan& reduced, const Plan& whole,
                       const SimulationOptions& options, const Yarns& copied, std::uint64_t seed = 1);

/// A line about `symmetry` of a report, or nothing where it has none.
std::string symmetry_text(const Json& report);

}  // namespace weave::sim
