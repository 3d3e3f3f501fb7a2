#include <studio/editors/grid_region.hpp>

#include <algorithm>

namespace weave::studio {

namespace {

/// The lines from one to another, no more than `most`, as the first of them and their number.
struct Lines {
    std::size_t first, count;
};
Lines lines_between(std::size_t anchor, std::size_t other, std::size_t most) {
    const std::size_t count = std::min(std::max(anchor, other) - std::min(anchor, other) + 1, most);
    return {other < anchor ? anchor + 1 - count : anchor, count};
}

}  // namespace

GridRegion region_between(const GridCell& anchor, const GridCell& other, const GridSize& most) {
    const Lines rows = lines_between(anchor.row, other.row, most.rows), columns = lines_between(anchor.column, other.column, most.columns);
    return {{rows.first, columns.first}, rows.count, columns.count};
}

QRectF box_of(const GridRegion& region, const GridMapping& mapping) {
    return mapping.box(region.first).united(mapping.box(region.last()));
}

}  // namespace weave::studio
