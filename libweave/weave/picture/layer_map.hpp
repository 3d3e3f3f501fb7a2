#pragma once

#include <weave/picture/grid.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave {

/// What a layer's card shows at one stack.
enum class LayerPixel : std::uint8_t { none, lifted, weft_over };

/// How many layers a block has: the most yarns of one system in a stack.
std::size_t layer_count(const Block& block);

/// Layer `layer` (0 is the top one) of a stack: its weft and its warp, counted from the top of each system,
/// and which of them lies over the other. Where a stack has fewer yarns of one system, these are spread over
/// its layers evenly, so every weft level of an angle interlock meets the one warp. None where the stack has
/// no such layer.
LayerPixel layer_pixel(const Stack& stack, std::size_t layer);

/// The small cards of the layers view, in reading order; at most `most_layers`.
inline constexpr std::size_t most_layers = 16;
std::vector<Grid> layer_grids(const Block& block);

}  // namespace weave
