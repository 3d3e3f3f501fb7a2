#pragma once

#include <loomlink/workflow/evidence.hpp>
#include <string_view>

namespace weave::loomlink {

/// What the answer of `weave simulate --json` says, as a statement to be signed now; `site` is left empty. A
/// part of a cloth becomes one region of it. The solver's version is that of this program, which is installed
/// with `weave`. Errors (bad_input) name the member.
Result<SimulationStatement> statement_of_result(std::string_view report);

}  // namespace weave::loomlink
