#pragma once

#include <weave/block/operations.hpp>

#include <QPoint>
#include <QRect>

#include <cstdint>
#include <functional>

namespace weave::studio {

// Painting of stencils. A place is a stack: x its column, y its row, row 0 at the bottom. Each function says
// which part it changed; places beyond the stencil are left alone.

QRect paint_place(StencilMap& map, QPoint place, std::uint16_t block);
/// A line of places without gaps, both ends included.
QRect paint_line(StencilMap& map, QPoint from, QPoint to, std::uint16_t block);
/// The rectangle with these corners, filled.
QRect paint_rectangle(StencilMap& map, QPoint corner, QPoint other, std::uint16_t block);
/// All places of the same block that hang together with this one by their sides.
QRect flood(StencilMap& map, QPoint place, std::uint16_t block);

/// The part of a stencil that a rectangle covers.
QRect within(const StencilMap& map, const QRect& part);
inline bool holds(const StencilMap& map, QPoint place) {
    return place.x() >= 0 && place.y() >= 0 && static_cast<std::size_t>(place.x()) < map.columns &&
           static_cast<std::size_t>(place.y()) < map.rows;
}
inline std::uint16_t& at(StencilMap& map, QPoint place) {
    return map
        .blocks[static_cast<std::size_t>(place.y()) * map.columns + static_cast<std::size_t>(place.x())];
}
inline std::uint16_t at(const StencilMap& map, QPoint place) {
    return map
        .blocks[static_cast<std::size_t>(place.y()) * map.columns + static_cast<std::size_t>(place.x())];
}

}  // namespace weave::studio
