#pragma once

#include <weave/block/flip.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace weave {

/// The cells whose stacks differ in two blocks, row by row; nothing where their rows, columns, picks or ends do.
std::optional<std::vector<std::size_t>> changed_cells(const Block& before, const Block& after);

/// The flips that make the crossings of the one block those of the other, in an order in which each can be made
/// alone. Nothing where rows, columns, picks or ends differ, or where they would be more than `most`.
std::optional<std::vector<Flip>> flips_between(const Block& before, const Block& after, std::size_t most);

}  // namespace weave
