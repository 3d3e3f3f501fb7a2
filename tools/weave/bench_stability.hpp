#pragma once

#include "bench_measure.hpp"

#include <weave/sim/extremes.hpp>

namespace weave::program {

/// Runs one extreme: what it is, what must become of it, what did, and what is wrong with that (`fault`,
/// empty where it is good).
Json measure_extreme(const sim::Extreme& extreme, const BenchOptions& options);
/// All of them as a table (Markdown).
std::string stability_table(const Json& cases, const Json& machine);

}  // namespace weave::program
