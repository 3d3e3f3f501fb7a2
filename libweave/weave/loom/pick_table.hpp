#pragma once

#include <weave/design/picks.hpp>

#include <string>
#include <vector>

namespace weave {

/// The pick table as a CSV text for people and mills: pick (from 1), row, feeder, direction, take-up, yarn,
/// colour. Names that a spreadsheet would take for a formula (they start with = + - @, tab or CR) get an
/// apostrophe in front.
std::string pick_table_csv(const Design& design, const std::vector<Pick>& picks);

}  // namespace weave
