#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/curve/spline.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave::sim {

/// A crossing that does not lie as the card image says, or that was not found again.
struct LostCrossing {
    Crossing crossing;
    bool found = true;  ///< whether the yarns still cross near their planned place
};

/// Where a crossing is in relaxed yarns.
struct FoundCrossing {
    double weft_at = 0, warp_at = 0;  ///< parameters of the splines, in segments
    double height_mm = 0;             ///< of the weft above the warp there
};

/// Looks one crossing up, from its planned place on; nothing where the yarns no longer cross near it.
std::optional<FoundCrossing> find_crossing(const ClothCurves& curves, const std::vector<Spline>& splines,
                                           const Crossing& crossing);

/// Looks every crossing up in the relaxed yarns: where the projections of its two yarns cross, from the planned place
/// on, and which lies above. `splines` has one entry for each yarn of `curves`; an empty one was left out, and so are
/// its crossings.
std::vector<LostCrossing> lost_crossings(const ClothCurves& curves, const std::vector<Spline>& splines);

}  // namespace weave::sim
