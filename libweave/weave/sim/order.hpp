#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/curve/spline.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave::sim {

/// A yarn's centreline with what finds its key points again.
struct Thread {
    const Spline& spline;
    double per_key = 1;  ///< parameter from one key point to the next
};

/// Where two yarns cross, seen from above.
struct CrossingSpot {
    double weft_at = 0, warp_at = 0;  ///< parameters of the two splines
    double height_mm = 0;             ///< of the weft above the warp
};

/// The crossing of two yarns nearest to their key points, at most three key points away; nothing where they do not
/// cross there.
std::optional<CrossingSpot> find_crossing(const Thread& weft, const Thread& warp, std::size_t weft_key, std::size_t warp_key);

/// The same for a crossing of planned curves, from its planned place on. `splines` as for lost_crossings().
std::optional<CrossingSpot> find_crossing(const ClothCurves& curves, const std::vector<Spline>& splines,
                                          const Crossing& crossing);

/// A crossing that does not lie as the card image says, or that was not found again.
struct LostCrossing {
    Crossing crossing;
    bool found = true;  ///< whether the yarns still cross near their planned place
};

/// Looks every crossing up in the relaxed yarns: where the projections of its two yarns cross, from the planned place
/// on, and which lies above; where cloth stands on edge or hangs over, which lies on which side where they are nearest.
/// `splines` has one entry for each yarn of `curves`; an empty one was left out, and so are its crossings.
std::vector<LostCrossing> lost_crossings(const ClothCurves& curves, const std::vector<Spline>& splines);

}  // namespace weave::sim
