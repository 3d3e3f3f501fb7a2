#pragma once

#include "bench_measure.hpp"

namespace weave::program {

/// The terms whose saving is measured, as `weave simulate --explain` names them where it does.
std::vector<std::string> saving_names();
/// Refuses a name that is none of them.
Status check_saving(const std::string& name);

/// What a scene does not need is left out; each saving with and without it, in turns in one run. A saving
/// without `fault` changed no result beyond its tolerance. An error where it was interrupted (held by the
/// caller).
Result<Json> measure_saving(const std::string& name, const BenchOptions& options);
std::string savings_table(const Json& savings, const Json& machine);

}  // namespace weave::program
