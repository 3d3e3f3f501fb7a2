#pragma once

#include "bench_measure.hpp"

namespace weave::program {

/// Everything that is measured of one structure. Nothing is thrown away when a run ends at its cap: what was
/// not reached is null, and ratios then are lower bounds. An error where it was interrupted (held by the caller).
Result<Json> measure_tradeoff(const Structure& structure, const BenchOptions& options);

/// The results of several structures as a table (Markdown) and as a plot of error against time (SVG).
std::string tradeoff_table(const Json& structures);
Result<std::string> tradeoff_plot(const Json& structures);

}  // namespace weave::program
