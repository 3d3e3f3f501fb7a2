#pragma once

#include <algorithm>
#include <cstddef>

namespace weave {

/// Whether `is_so` holds of any of the four control points that draw the segment of a spline that begins at control point `begin`:
/// it, the one before and two after, round the seam of a periodic one, and the last of an open one for those beyond its ends.
template <class IsSo>
bool any_that_draws(std::size_t points, bool is_periodic, std::size_t begin, IsSo is_so) {
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t beyond = begin + k;  // one further than the point itself
        if (is_so(is_periodic ? (beyond + points - 1) % points : std::min(std::max<std::size_t>(beyond, 1) - 1, points - 1))) return true;
    }
    return false;
}

}  // namespace weave
