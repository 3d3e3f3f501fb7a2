#pragma once

#include <studio/editors/grid_mapping.hpp>

#include <cstddef>

namespace weave::studio {

/// A rectangle of squares of a grid.
struct GridRegion {
    GridCell first;  ///< nearest to the corner
    std::size_t rows = 1, columns = 1;

    [[nodiscard]] bool holds(const GridCell& cell) const {
        return cell.row >= first.row && cell.row < first.row + rows && cell.column >= first.column && cell.column < first.column + columns;
    }
    [[nodiscard]] GridCell last() const { return {first.row + rows - 1, first.column + columns - 1}; }
    friend bool operator==(const GridRegion&, const GridRegion&) = default;
};

/// The region from one cell to another; where that is larger than `most`, as much of it as begins at `anchor`.
GridRegion region_between(const GridCell& anchor, const GridCell& other, const GridSize& most);

/// Where it lies in the window.
QRectF box_of(const GridRegion& region, const GridMapping& mapping);

}  // namespace weave::studio
