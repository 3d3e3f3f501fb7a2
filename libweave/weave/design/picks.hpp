#pragma once

#include <weave/block/block.hpp>
#include <weave/design/design.hpp>

#include <cstddef>
#include <vector>

namespace weave {

/// One weft insertion, resolved from the repeating plans of the design.
struct Pick {
    std::vector<std::uint32_t> feeders;  ///< indices into WeftPlan::feeders; none, one or two
    Direction direction = Direction::left_to_right;
    bool take_up = true;  ///< the cloth advances after this pick
    std::size_t row = 0;  ///< of the block, from 0; counts on through repeats
};

/// The weft insertion order: one entry per pick, from the first, of so many repeats of the cloth. Every
/// repeat starts the plans of the design anew; only shuttles that go back and forth go on from where they
/// stand.
std::vector<Pick> pick_table(const Design& design, const BlockGrid& cloth, std::size_t repeats = 1);
inline std::vector<Pick> pick_table(const Design& design, const Block& cloth, std::size_t repeats = 1) {
    return pick_table(design, cloth.grid(), repeats);
}

/// Yarn type and colour of one end or pick (the first feeder's; absent for a pick without weft).
const YarnType& yarn_of_end(const Design& design, std::size_t end);
Colour colour_of_end(const Design& design, std::size_t end);
const YarnType* yarn_of_pick(const Design& design, const Pick& pick);

}  // namespace weave
