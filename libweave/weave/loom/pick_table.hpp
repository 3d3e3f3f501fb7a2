#pragma once

#include <weave/design/picks.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// The loom's feeder (from 0) for each feeder of a design (an index into WeftPlan::feeders) that its picks
/// take.
using FeederMap = std::map<std::uint32_t, std::size_t>;

/// The same as a CSV text for people and mills: pick (from 1), row, feeder, direction, take-up, yarn, colour.
/// Names that a spreadsheet would take for a formula (they start with = + - @, tab or CR) get an apostrophe
/// in front. With `loom_feeders`, which must have every feeder that the picks take, a last column has the
/// feeders of the loom.
std::string pick_table_csv(const Design& design, const std::vector<Pick>& picks,
                           const FeederMap* loom_feeders = nullptr);

}  // namespace weave
