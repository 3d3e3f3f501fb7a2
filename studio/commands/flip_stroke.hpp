#pragma once

#include <weave/core/result.hpp>
#include <weave/design/outline.hpp>

#include <studio/document/document.hpp>
#include <studio/document/edit_step.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace weave::studio {

/// A crossing that cannot have the side that was asked for, and why.
struct RefusedCrossing {
    CardPlace place;
    Error reason;
};

/// One side for several crossings of the block that is shown: the one that the first does not have. Those that have it already, and
/// those that cannot have it, are left.
struct FlippedStroke {
    EditStep step;
    std::size_t flipped = 0;
    std::vector<RefusedCrossing> refused;
};
FlippedStroke flip_stroke(const Document& document, std::span<const CardPlace> places);

}  // namespace weave::studio
