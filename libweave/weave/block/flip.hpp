#pragma once

#include <weave/block/block.hpp>

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace weave {

/// What a flip came to. When it is not valid the stack is as it was and `in_the_way` names the yarns between
/// the two that would have to change sides as well.
struct FlippedStack {
    bool valid = false;
    Stack stack;
    std::vector<Slot> in_the_way;  ///< from the bottom up
};

/// Exchanges weft and warp of one stack (paper, Algorithm 1, with empty slots passed through): valid exactly
/// when one pixel of the card image can change alone. Empty slots stay where they are. Both numbers count
/// within the stack, which must hold them.
FlippedStack flip(const Stack& stack, std::size_t weft, std::size_t warp);

/// What one crossing is to be; pick and end from 0.
struct Flip {
    std::size_t pick = 0, end = 0;
    bool weft_over = false;
    friend bool operator==(const Flip&, const Flip&) = default;
};

/// A flip that could not be made, with the reason as a person reads it (picks and ends from 1).
struct RefusedFlip {
    Flip flip;
    std::string reason;
};

/// A block after flips, made one after the other; each is made, needed no change, or is listed as refused.
struct FlippedBlock {
    Block block;
    std::vector<RefusedFlip> refused;  ///< none whose crossing ends as it asked, or as a later one did
};
FlippedBlock apply_flips(Block block, std::span<const Flip> flips);

/// The same without a block, for who knows its grid and has the stacks that the flips ask for: `stacks`
/// holds, by the number of the cell, row by row, that of each crossing that there is, and has the flipped
/// ones in the end.
std::vector<RefusedFlip> flip_stacks(const BlockGrid& grid, std::span<const Flip> flips,
                                     std::map<std::size_t, Stack>& stacks);

/// The block with the pixel of `pick` and `end` (from 0) inverted. Errors: a pick or end that the block does
/// not have; a flip that is not valid, with the yarns in the way named as people count them, from 1.
Result<Block> flip(const Block& block, std::size_t pick, std::size_t end);

/// The error of it where there is no such crossing.
Error no_crossing(const BlockGrid& grid, std::size_t pick, std::size_t end);

/// One stack of a block, and the first pick and end of its cell.
struct PlacedStack {
    Stack stack;
    std::size_t first_pick = 0, first_end = 0;
};
/// The stack of a crossing that there is.
PlacedStack stack_at(const Block& block, std::size_t pick, std::size_t end);

/// The stack alone, flipped at a crossing that it holds; the numbers count through the block.
Result<Stack> flip(const PlacedStack& at, std::size_t pick, std::size_t end);

}  // namespace weave
