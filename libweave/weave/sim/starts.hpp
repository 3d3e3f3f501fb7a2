#pragma once

// How much a result owes to its start: the same cloth relaxed again from starts that differ a little.

#include <weave/sim/simulate.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace weave::sim {

/// By how much a perturbed start differs: each control point that may move goes this share of its yarn's
/// radius at most.
inline constexpr double start_noise_radii = 0.05;
/// Two results are one and the same rest as long as no yarn lies further away than this, in its radii.
inline constexpr double same_rest_radii = 0.1;

/// The plan's start, or another one, moved by noise. No yarns pass through one another on the way there, so
/// every crossing keeps its order: where yarns lie too close for the noise, there is less of it. The same seed
/// gives the same start.
StartState perturbed_start(const Plan& plan, const std::optional<StartState>& start, std::uint64_t seed,
                           std::size_t threads);

/// Relaxes `runs` times more, each from a perturbed start (seeds from `seed` on), without flips and coarser points, all at once where a
/// device can (backend.hpp), and compares with `first`, the yarns of the same plan and options. The JSON is what the report holds as `starts`
/// (YARNS.md): spread of crimp and thickness over all runs and the first, and how far the run furthest away
/// lies from the first. A watch that stops a run ends it all; runs that were stopped are left out, and `asked`
/// tells how many there should have been.
Json relaxed_again(const Design& design, const Plan& plan, const SimulationOptions& options,
                   const Yarns& first, std::size_t runs, std::uint64_t seed = 1);

/// A line about `starts` of a report, or nothing where it has none.
std::string starts_text(const Json& report);

}  // namespace weave::sim
