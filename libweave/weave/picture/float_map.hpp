#pragma once

#include <weave/picture/grid.hpp>
#include <weave/picture/look.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave {

/// For every place of a surface the length of the float that is seen there: over how many stacks in a row the
/// same yarn stays on top. Floats end at the edges of the cloth. Negative for warps, positive for wefts, 0
/// where nothing is seen.
std::vector<std::int32_t> float_lengths(const Surface& surface);

/// The colour of a float length, as float_lengths counts it: blues for wefts, oranges for warps, darker when
/// longer.
Colour float_colour(std::int32_t length);

/// The two grids of the float picture, face left and back right.
struct FloatGrids {
    Grid face, back;
};
FloatGrids float_grids(const Block& block);

}  // namespace weave
