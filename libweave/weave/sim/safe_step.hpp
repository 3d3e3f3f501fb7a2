#pragma once

#include <weave/sim/cloth.hpp>

namespace weave::sim {

/// A change of state that may be made at once.
struct SafeStep {
    double slope = 0;     ///< ∂E along it, N·mm; below 0 where it leads down
    double kept = 1;      ///< share of the slope that was asked for
    double farthest = 1;  ///< how many times the change could be made and yarns still not pass through one another
};

/// Shortens the cloth's change so that no yarns can pass through one another: as a whole, or only where it must be,
/// whichever keeps more of its slope. `farthest` is at most `most`.
WEAVE_ANYWHERE template <class Cloth>
WEAVE_CALLED WEAVE_HD SafeStep make_safe(Cloth& cloth, double most) {
    constexpr double least_kept = 0.2;  // a cut change that keeps less of its slope is worth little
    const double slope = cloth.dot(cloth.gradient, cloth.change), safe = cloth.safe_share(cloth.change, most);
    if (safe >= 1) return {slope, 1, safe};
    cloth.cut_from_change();
    cloth.shorten(cloth.cut);
    if (cloth.dot(cloth.gradient, cloth.cut) > least_kept * slope) {
        // What is left leads hardly down: points that it moves uphill stay where they are.
        cloth.stop_uphill(cloth.cut);
        cloth.shorten(cloth.cut);
    }
    cloth.scale(cloth.cut, cloth.safe_share(cloth.cut, 1));  // rounds of shortening come close, not always all the way
    const double kept = cloth.dot(cloth.gradient, cloth.cut);
    if (kept < safe * slope) {
        cloth.accept_cut();
        return {kept, kept / slope, 1};
    }
    cloth.scale(cloth.change, safe);
    return {safe * slope, safe, 1};
}

}  // namespace weave::sim
