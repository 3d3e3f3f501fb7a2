#pragma once

#include <weave/picture/page.hpp>

#include <string>

namespace weave {

/// The view that the subject asks for.
Result<std::string> draw_view(const Subject& subject);
/// The card image: black where the end is lifted, rulers, stack grid, pick-1 arrow.
Result<std::string> draw_card(const Subject& subject);
/// Colour and weave as seen on the face, or from behind on the back.
Result<std::string> draw_surface(const Subject& subject);
/// Lengths of the floats on face and back.
Result<std::string> draw_floats(const Subject& subject);
/// A card for every layer, the top one first.
Result<std::string> draw_layers(const Subject& subject);
/// A cut along a row (weft slice) or column (warp slice).
Result<std::string> draw_slice(const Subject& subject);
/// The yarns of the block drawn in space, and for small blocks their stacks in writing.
Result<std::string> draw_block(const Subject& subject);

}  // namespace weave
