#pragma once

#include <weave/core/colour.hpp>

namespace weave {

/// The colour of a share from 0 to 1 (clamped) on the map known as viridis, whose lightness rises evenly, so
/// that equal steps look equal, also to colour-blind people and in grey: dark violet, blue, green, yellow.
Colour map_colour(double share);

}  // namespace weave
