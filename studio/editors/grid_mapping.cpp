#include <studio/editors/grid_mapping.hpp>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

/// A length along the grid as a number of cells.
double cells(std::size_t count) {
    return static_cast<double>(count);
}

std::size_t clamped(double cell, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(cell, 0.0, cells(count)));
}

}  // namespace

void GridMapping::set_grid(std::size_t rows, std::size_t columns) {
    m_rows = std::max<std::size_t>(rows, 1);
    m_columns = std::max<std::size_t>(columns, 1);
    m_is_fitted ? fit() : keep_in_sight();
}

void GridMapping::set_room(const QRectF& room) {
    m_room = room;
    m_is_fitted ? fit() : keep_in_sight();
}

QRectF GridMapping::frame() const {
    return {m_left_top, QSizeF(cells(m_columns) * m_cell, cells(m_rows) * m_cell)};
}

void GridMapping::fit() {
    const double most = std::min(m_room.width() / cells(m_columns), m_room.height() / cells(m_rows));
    m_cell = std::clamp(most * 0.96, smallest_cell, largest_cell / 2);
    if (m_cell > 1) m_cell = std::floor(m_cell);
    m_left_top = m_room.center() - QPointF(cells(m_columns) * m_cell, cells(m_rows) * m_cell) / 2;
    m_is_fitted = true;
}

void GridMapping::zoom(double factor, const QPointF& fixed) {
    const double old = m_cell;
    m_cell = std::clamp(m_cell * factor, smallest_cell, largest_cell);
    m_left_top = fixed - (fixed - m_left_top) * (m_cell / old);
    m_is_fitted = false;
    keep_in_sight();
}

void GridMapping::move(const QPointF& by) {
    m_left_top += by;
    m_is_fitted = false;
    keep_in_sight();
}

void GridMapping::show(const GridCell& cell) {
    if (m_is_fitted) return;  // all is seen
    const QRectF place = box(cell).adjusted(-m_cell, -m_cell, m_cell, m_cell);
    QPointF by;
    if (place.left() < m_room.left()) by.setX(m_room.left() - place.left());
    if (place.right() > m_room.right()) by.setX(m_room.right() - place.right());
    if (place.top() < m_room.top()) by.setY(m_room.top() - place.top());
    if (place.bottom() > m_room.bottom()) by.setY(m_room.bottom() - place.bottom());
    if (!by.isNull()) move(by);
}

/// A quarter of the room, or all of a smaller grid, stays covered.
void GridMapping::keep_in_sight() {
    const QRectF grid = frame();
    const double wide = std::min(grid.width(), m_room.width() / 4), high = std::min(grid.height(), m_room.height() / 4);
    m_left_top.setX(std::clamp(m_left_top.x(), m_room.left() + wide - grid.width(), m_room.right() - wide));
    m_left_top.setY(std::clamp(m_left_top.y(), m_room.top() + high - grid.height(), m_room.bottom() - high));
}

double GridMapping::y_of(double row) const {
    const QRectF grid = frame();
    return rows_go_up() ? grid.bottom() - row * m_cell : grid.top() + row * m_cell;
}

double GridMapping::x_of(double column) const {
    const QRectF grid = frame();
    return columns_go_right() ? grid.left() + column * m_cell : grid.right() - column * m_cell;
}

QRectF GridMapping::box(const GridCell& cell) const {
    const double x = columns_go_right() ? x_of(cells(cell.column)) : x_of(cells(cell.column + 1));
    const double y = rows_go_up() ? y_of(cells(cell.row + 1)) : y_of(cells(cell.row));
    return {x, y, m_cell, m_cell};
}

std::optional<GridCell> GridMapping::cell_at(const QPointF& place) const {
    const QRectF grid = frame();
    const double column = columns_go_right() ? (place.x() - grid.left()) / m_cell : (grid.right() - place.x()) / m_cell;
    const double row = rows_go_up() ? (grid.bottom() - place.y()) / m_cell : (place.y() - grid.top()) / m_cell;
    if (!m_room.contains(place) || column < 0 || row < 0 || column >= cells(m_columns) || row >= cells(m_rows)) return std::nullopt;
    return GridCell{static_cast<std::size_t>(row), static_cast<std::size_t>(column)};
}

GridCell GridMapping::nearest_cell(const QPointF& place) const {
    const GridSpan span = seen();
    const auto within = [](double cell, std::size_t first, std::size_t last) {
        return static_cast<std::size_t>(std::clamp(std::floor(cell), cells(first), cells(std::max(last, first + 1) - 1)));
    };
    const QRectF grid = frame();
    const double column = columns_go_right() ? (place.x() - grid.left()) / m_cell : (grid.right() - place.x()) / m_cell;
    const double row = rows_go_up() ? (grid.bottom() - place.y()) / m_cell : (place.y() - grid.top()) / m_cell;
    return {within(row, span.first_row, span.last_row), within(column, span.first_column, span.last_column)};
}

GridMapping GridMapping::of_part(const GridCell& first, const GridSize& size) const {
    GridMapping part = *this;
    part.m_rows = size.rows;
    part.m_columns = size.columns;
    part.m_left_top = QPointF(columns_go_right() ? x_of(cells(first.column)) : x_of(cells(first.column + size.columns)),
                              rows_go_up() ? y_of(cells(first.row + size.rows)) : y_of(cells(first.row)));
    return part;
}

GridSpan GridMapping::seen() const {
    const QRectF grid = frame();
    const double left = (m_room.left() - grid.left()) / m_cell, right = (m_room.right() - grid.left()) / m_cell;
    const double top = (m_room.top() - grid.top()) / m_cell, bottom = (m_room.bottom() - grid.top()) / m_cell;
    GridSpan span;
    if (columns_go_right()) {
        span.first_column = clamped(std::floor(left), m_columns), span.last_column = clamped(std::ceil(right), m_columns);
    } else {
        span.first_column = clamped(std::floor(cells(m_columns) - right), m_columns);
        span.last_column = clamped(std::ceil(cells(m_columns) - left), m_columns);
    }
    if (rows_go_up()) {
        span.first_row = clamped(std::floor(cells(m_rows) - bottom), m_rows), span.last_row = clamped(std::ceil(cells(m_rows) - top), m_rows);
    } else {
        span.first_row = clamped(std::floor(top), m_rows), span.last_row = clamped(std::ceil(bottom), m_rows);
    }
    return span;
}

}  // namespace weave::studio
