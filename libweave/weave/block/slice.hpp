#pragma once

#include <weave/block/block.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// One place of a slice, as it is drawn: empty, a yarn seen end-on, or the yarn whose path runs through the
/// slice.
struct SliceYarn {
    Slot yarn;              ///< numbers count within the position for dots, through the slice for paths
    bool disabled = false;  ///< a weft that is drawn but not woven: it becomes an empty slot
    friend bool operator==(const SliceYarn&, const SliceYarn&) = default;
};

/// A 2D cut through a weave (paper, section 3 and figure 5): at each position along the slice a column of
/// places from the bottom up. In a warp slice the wefts are dots and the warps run along it as paths (one
/// column of a block); in a weft slice the warps are dots and the wefts run along it (one row of a block).
struct Slice {
    System dots = System::weft;
    std::vector<std::vector<SliceYarn>> positions;
    friend bool operator==(const Slice&, const Slice&) = default;
};

/// The slice as a block of one column (dots are wefts) or one row (dots are warps). A disabled weft becomes
/// an empty slot in every stack of its row: a dot in its position, a path at all positions, wherever along
/// the slice it is disabled. It no longer counts in t, and the numbers of the others close up; spacing stays.
/// Warps cannot be disabled: an end runs through the whole cloth, whatever the slice shows of it. Errors name
/// the position.
Result<Block> to_block(const Slice& slice);

/// Column `column` of a block as a warp slice (dots are wefts), or row `row` as a weft slice.
Result<Slice> warp_slice(const Block& block, std::size_t column);
Result<Slice> weft_slice(const Block& block, std::size_t row);

/// Reads one position as people write it, bottom first: as in parse_stack, a disabled weft in brackets: `T0
/// P0 (T1) P1`. Dots count from 0 within the position, paths through the slice.
Result<std::vector<SliceYarn>> parse_slice_position(std::string_view text);
std::string to_text(const std::vector<SliceYarn>& position);

}  // namespace weave
