#pragma once

#include "bench_measure.hpp"

namespace weave::program {

/// Everything that is measured of one structure. Nothing is thrown away when a run ends at its cap: what was
/// not reached is null, and ratios then are lower bounds. An error where it was interrupted (held by the
/// caller).
Result<Json> measure_tradeoff(const Structure& structure, const BenchOptions& options);

inline constexpr const char* fidelities[]{"draft", "standard", "reference"};
/// Where the run begins that gives what `weave simulate` gives: `plan`, of a reference `standard`.
const char* asked_start(std::string_view fidelity);
/// Whether the reference of a structure came to rest, so that errors against it say something.
bool is_measured(const Json& structure);
/// Whether the run is what `weave simulate` gives.
bool is_as_asked(const Json& run);
/// The errors of a run where it reached its goal; else null.
const Json* error_at_goal(const Json& run);
/// The greater of both crimp errors, percentage points.
double crimp_error(const Json& error);

/// The results of several structures as tables (Markdown).
std::string tradeoff_table(const Json& structures);
enum class PlottedError : std::uint8_t { crimp, thickness };
/// Error against seconds, a panel a structure whose reference came to rest (SVG).
Result<std::string> tradeoff_plot(const Json& structures, PlottedError plotted);

}  // namespace weave::program
