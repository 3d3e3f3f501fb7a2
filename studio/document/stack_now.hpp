#pragma once

#include <weave/core/result.hpp>
#include <weave/design/outline.hpp>

#include <studio/document/document.hpp>

namespace weave::studio {

/// The stack of a crossing of the design as it stands, also while its block is still being made. Errors: no such crossing.
Result<PlacedStack> stack_now(const Document& document, const CardPlace& place);

/// Whether the weft lies over the warp at this crossing.
bool weft_over(const PlacedStack& at, const CardPlace& place);

}  // namespace weave::studio
