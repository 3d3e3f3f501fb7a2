#include <studio/editors/stencil_raster.hpp>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace weave::studio {

QRect within(const StencilMap& map, const QRect& part) {
    return part.intersected(QRect(0, 0, static_cast<int>(map.columns), static_cast<int>(map.rows)));
}

QRect paint_place(StencilMap& map, QPoint place, std::uint16_t block) {
    if (!holds(map, place) || at(map, place) == block) return {};
    at(map, place) = block;
    return {place, QSize(1, 1)};
}

QRect paint_line(StencilMap& map, QPoint from, QPoint to, std::uint16_t block) {
    const int across = std::abs(to.x() - from.x()), up = -std::abs(to.y() - from.y());
    const int step_x = from.x() < to.x() ? 1 : -1, step_y = from.y() < to.y() ? 1 : -1;
    QRect changed;
    for (int error = across + up;;) {  // Bresenham's line
        changed |= paint_place(map, from, block);
        if (from == to) return changed;
        const int twice = 2 * error;
        if (twice >= up) {
            error += up;
            from.rx() += step_x;
        }
        if (twice <= across) {
            error += across;
            from.ry() += step_y;
        }
    }
}

QRect paint_rectangle(StencilMap& map, QPoint corner, QPoint other, std::uint16_t block) {
    const QRect wish(QPoint(std::min(corner.x(), other.x()), std::min(corner.y(), other.y())),
                     QPoint(std::max(corner.x(), other.x()), std::max(corner.y(), other.y())));
    const QRect part = within(map, wish);
    for (int row = part.top(); row <= part.bottom(); ++row) {
        const auto first =
            map.blocks.begin() + static_cast<std::ptrdiff_t>(row) * static_cast<std::ptrdiff_t>(map.columns);
        std::fill(first + part.left(), first + part.right() + 1, block);
    }
    return part;
}

QRect flood(StencilMap& map, QPoint place, std::uint16_t block) {
    if (!holds(map, place) || at(map, place) == block) return {};
    const std::uint16_t old = at(map, place);
    const int columns = static_cast<int>(map.columns), rows = static_cast<int>(map.rows);
    QRect changed;
    std::vector<QPoint> seeds{place};
    while (!seeds.empty()) {
        const QPoint seed = seeds.back();
        seeds.pop_back();
        if (at(map, seed) != old) continue;
        int left = seed.x(), right = seed.x();
        while (left > 0 && at(map, QPoint(left - 1, seed.y())) == old) --left;
        while (right + 1 < columns && at(map, QPoint(right + 1, seed.y())) == old) ++right;
        changed |= paint_rectangle(map, {left, seed.y()}, {right, seed.y()}, block);
        for (const int row : {seed.y() - 1, seed.y() + 1}) {
            if (row < 0 || row >= rows) continue;
            for (int column = left; column <= right; ++column) {  // one seed for each run
                const bool begins = column == left || at(map, QPoint(column - 1, row)) != old;
                if (begins && at(map, QPoint(column, row)) == old) seeds.emplace_back(column, row);
            }
        }
    }
    return changed;
}

}  // namespace weave::studio
