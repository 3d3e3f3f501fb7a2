#pragma once

#include <weave/picture/grid.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave {

/// How the weft of a layer lies at one stack: under the ends that go with it, over them, or with ends on both
/// sides. None where the stack has no such weft, it is loose on purpose, or only loose ends cross it.
enum class LayerPixel : std::uint8_t { none, lifted, weft_over, between };

/// How many layers a block has: the most wefts of a stack, loose ones included, so that wefts that only hold
/// a place keep the layers beside them apart.
std::size_t layer_count(const Block& block);

/// The layers of a stack, top first: the k-th is its k-th weft from the top, and the ends that go with it.
///
/// Loose yarns apart, wefts and ends are paired in their order from the bottom. Where their numbers differ,
/// each yarn of the more numerous system goes with one of the other, none of which stays alone, so that the
/// differences in height, in slots, add up to the least; where several pairings are as good, all of them
/// count. A stack with more than most_paired wefts or ends is not paired: none throughout.
std::vector<LayerPixel> layer_pixels(const Stack& stack);
inline constexpr std::size_t most_paired = 400;

/// The small cards of the layers view, in reading order; at most `most_layers`.
inline constexpr std::size_t most_layers = 16;
std::vector<Grid> layer_grids(const Block& block);

}  // namespace weave
