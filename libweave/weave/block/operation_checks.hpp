#pragma once

#include <weave/block/block.hpp>
#include <weave/block/operations.hpp>

#include <cstddef>
#include <span>
#include <string>

namespace weave {

/// The grid of a block and its height: all that attach() needs to say whether two blocks fit.
struct GridAndHeight {
    const BlockGrid& grid;
    std::size_t height = 0;
};

/// What attach() refuses of blocks so large, before their stacks are looked at.
Status check_attach(GridAndHeight block, GridAndHeight other, Face face,
                    std::span<const std::string> names = {});

/// What renumber_row() or renumber_column() refuses of a block of this grid.
Status check_renumber(const BlockGrid& grid, System system, std::size_t line,
                      std::span<const std::size_t> order);

}  // namespace weave
