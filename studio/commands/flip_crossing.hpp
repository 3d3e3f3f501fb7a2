#pragma once

#include <weave/core/result.hpp>
#include <weave/design/outline.hpp>

#include <studio/document/document.hpp>
#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// The other side for one crossing of the block that is shown. Errors: no such crossing; a flip that is not valid, with the yarns in
/// the way.
Result<EditStep> flip_crossing(const Document& document, const CardPlace& place);

}  // namespace weave::studio
