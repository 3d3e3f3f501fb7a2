#pragma once

#include <weave/block/operations.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace weave {

/// Which part of a stencil stays where it is when its size changes.
enum class Keep : std::uint8_t { low, middle, high };

/// The stencil with another size, in stacks. `rows_kept` low keeps the bottom row at the bottom,
/// `columns_kept` low the left column at the left; an odd row or column more is added, or taken, at the top
/// and right. New stacks come from block `fill`. Errors: a size of 0, or one beyond what a card may have.
Result<StencilMap> resized(const StencilMap& map, std::size_t rows, std::size_t columns, Keep rows_kept,
                           Keep columns_kept, std::uint16_t fill);

/// The stencil with block numbers[k] wherever it named block k; all that it names must be in the list.
StencilMap with_blocks_renumbered(const StencilMap& map, std::span<const std::uint16_t> numbers);

/// How many stacks come from each of `blocks` blocks.
std::vector<std::size_t> stacks_of_blocks(const StencilMap& map, std::size_t blocks);

}  // namespace weave
