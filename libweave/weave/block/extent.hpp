#pragma once

#include <weave/block/block.hpp>

#include <cstddef>

namespace weave {

/// How large a block is, and what its table of stacks holds.
struct Extent {
    std::size_t rows = 0, columns = 0, picks = 0, ends = 0, height = 0;
    std::size_t stacks = 0, slots = 0;  ///< different stacks, and the slots of all of them

    [[nodiscard]] std::size_t cells() const { return rows * columns; }
    /// What the block holds in memory, in units of 4 bytes: a row or column has its count and where it
    /// begins; a stack is an object of its own beside its slots.
    [[nodiscard]] std::size_t units() const { return 3 * (rows + columns) + cells() + 16 * stacks + slots; }
};

Extent extent_of(const Block& block);

}  // namespace weave
