#pragma once

#include <weave/block/slice.hpp>
#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <string_view>
#include <vector>

namespace weave {

/// Slices as people write them: a line for each position along a slice, bottom first, as parse_slice_position() reads it
/// (`T0 P0 (T1) P1`); a blank line between two slices; `#` begins a remark. `dots`: weft for slices along the warp. Errors name
/// the line; more slices than a design has room for are one.
Result<std::vector<Slice>> read_slices(std::string_view text, System dots);

/// Slices side by side as a design, each a block that can be drawn on: slices along the warp from the first column on, slices
/// along the weft from the first row on (paper, section 3). At least one slice.
Design design_of_slices(std::vector<Slice> slices);

}  // namespace weave
