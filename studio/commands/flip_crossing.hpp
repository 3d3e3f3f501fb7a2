#pragma once

#include <weave/core/result.hpp>
#include <weave/design/outline.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <studio/document/document.hpp>
#include <studio/document/edit_step.hpp>
#include <vector>

namespace weave::studio {

/// The other side for one crossing of the block that is shown. Errors: no such crossing; a flip that is not valid, with the yarns in
/// the way.
Result<EditStep> flip_crossing(const Document& document, const CardPlace& place);

/// A crossing that cannot have the side that was asked for, and why.
struct RefusedCrossing {
    CardPlace place;
    Error reason;
};

/// One side for several crossings of the block that is shown: the one that the first does not have. Those that have it already, and
/// those that cannot have it, are left.
struct FlippedCrossings {
    EditStep step;
    std::size_t flipped = 0;
    std::vector<RefusedCrossing> refused;
};
FlippedCrossings flip_crossings(const Document& document, std::span<const CardPlace> places);

}  // namespace weave::studio
