#pragma once

#include <weave/block/card_image.hpp>
#include <weave/core/result.hpp>

#include <cstddef>
#include <string>

namespace weave::loomlink {

/// A part of a card as the page asks for it: `x` ends from the left, `y` picks from the top, where the last
/// pick lies; `scale` × `scale` crossings share a pixel.
struct CardPart {
    std::size_t x = 0, y = 0, width = 1, height = 1;
    std::size_t scale = 1;
};

/// A tile has at most so many pixels along a side.
inline constexpr std::size_t longest_tile_side = 2048;

/// The part as PNG: black where the end is lifted, white where the weft lies over it, grey by their share
/// where crossings share a pixel. Errors (bad_input): a part beyond the card, a tile that would be too large.
Result<std::string> draw_card_part(const CardImage& card, const CardPart& part);

}  // namespace weave::loomlink
