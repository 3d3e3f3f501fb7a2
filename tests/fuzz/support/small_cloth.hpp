#pragma once

#include <weave/design/evaluate.hpp>

#include <cstdint>
#include <optional>
#include <string_view>

namespace weave::fuzz {

/// A document may legally ask for a cloth of most_crossings; a fuzzer that weaves one in each run gets
/// nowhere.
inline constexpr std::uint64_t most_small_cells = 1 << 12, most_small_crossings = 1 << 16,
                               most_small_slots = 1 << 18;

/// The cloth of a design of which every block is known beforehand to come out small; nothing otherwise, or
/// where evaluating ends in an error.
std::optional<Evaluation> small_cloth(const Design& design);

/// Whether the runs of sequences and stencils in a text, such as `0*4194304`, add up to little memory.
bool runs_are_short(std::string_view text);

}  // namespace weave::fuzz
