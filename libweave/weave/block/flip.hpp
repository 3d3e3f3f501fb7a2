#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <weave/block/block.hpp>

namespace weave {

/// What a flip came to. When it is not valid the stack is as it was and `in_the_way` names the yarns between the two
/// that would have to change sides as well.
struct FlippedStack {
    bool valid = false;
    Stack stack;
    std::vector<Slot> in_the_way;  ///< from the bottom up
};

/// Exchanges weft and warp of one stack (paper, Algorithm 1, with empty slots passed through): valid exactly when one
/// pixel of the card image can change alone. Empty slots stay where they are. Both numbers count within the stack,
/// which must hold them.
FlippedStack flip(const Stack& stack, std::size_t weft, std::size_t warp);

/// The block with the pixel of `pick` and `end` (from 0) inverted. Errors: a pick or end that the block does not have;
/// a flip that is not valid, with the yarns in the way named as people count them, from 1.
Result<Block> flip(const Block& block, std::size_t pick, std::size_t end);

}  // namespace weave
