#pragma once

#include <weave/block/block.hpp>
#include <weave/design/design.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
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
std::vector<Pick> pick_table(const Design& design, const Block& block, std::size_t repeats = 1);

/// The loom's feeder (from 0) for each feeder of a design (an index into WeftPlan::feeders) that its picks
/// take.
using FeederMap = std::map<std::uint32_t, std::size_t>;

/// The same as a CSV text for people and mills: pick (from 1), row, feeder, direction, take-up, yarn, colour.
/// Names that a spreadsheet would take for a formula (they start with = + - @, tab or CR) get an apostrophe
/// in front. With `loom_feeders`, which must have every feeder that the picks take, a last column has the
/// feeders of the loom.
std::string pick_table_csv(const Design& design, const std::vector<Pick>& picks,
                           const FeederMap* loom_feeders = nullptr);

/// Yarn type and colour of one end or pick (the first feeder's; absent for a pick without weft).
const YarnType& yarn_of_end(const Design& design, std::size_t end);
Colour colour_of_end(const Design& design, std::size_t end);
const YarnType* yarn_of_pick(const Design& design, const Pick& pick);

}  // namespace weave
