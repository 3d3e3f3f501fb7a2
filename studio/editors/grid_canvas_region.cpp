// Regions of a grid: how they are chosen, and what floats over them.

#include <studio/editors/grid_canvas.hpp>

#include <QApplication>
#include <QPainter>

#include <algorithm>
#include <utility>

namespace weave::studio {

void GridCanvas::set_tool(GridTool tool) {
    if (tool != GridTool::choose) end_floating(false);
    if (std::exchange(m_tool, tool) == tool) return;
    setCursor(tool == GridTool::choose ? Qt::CrossCursor : Qt::ArrowCursor);
    Q_EMIT tool_changed();
}

// ---- Choosing ----

void GridCanvas::set_region(const std::optional<GridRegion>& region) {
    if (m_region == region) return;
    m_region = region;
    update();
    Q_EMIT region_changed();
}

void GridCanvas::choose_all() {
    if (m_picture.is_empty()) return;
    end_floating(false);
    set_tool(GridTool::choose);
    m_anchor = {};
    set_region(GridRegion{{}, m_picture.rows(), m_picture.columns()});
}

void GridCanvas::let_go() {
    end_floating(false);
    set_region(std::nullopt);
}

/// The corner of the region that moves while it is drawn.
GridCell GridCanvas::far_corner() const {
    const GridCell first = m_region->first, last = m_region->last();
    return {m_anchor.row == first.row ? last.row : first.row, m_anchor.column == first.column ? last.column : first.column};
}

void GridCanvas::begin_choosing(const std::optional<GridCell>& cell, const QPointF& place) {
    set_region(std::nullopt);
    if (!cell) return;
    m_anchor = *cell;
    m_chosen_from = place;
}

void GridCanvas::choose_to(const QPointF& place) {
    const GridCell cell = m_mapping.nearest_cell(place);
    if (!m_region && cell == m_anchor && (place - *m_chosen_from).manhattanLength() < QApplication::startDragDistance()) return;
    set_region(region_between(m_anchor, cell, {m_picture.rows(), m_picture.columns()}));
    m_mapping.show(cell);
}

/// A press that drew nothing goes there, as any other.
void GridCanvas::end_choosing() {
    m_chosen_from.reset();
    go_to(m_region ? far_corner() : m_anchor);
}

void GridCanvas::extend(int rows, int columns) {
    const GridCell cursor = m_cursor.value_or(GridCell{});
    if (!m_region || far_corner() != cursor) m_anchor = cursor;
    set_region(region_between(m_anchor, walked(cursor, rows, columns), {m_picture.rows(), m_picture.columns()}));
    go_to(far_corner());
}

// ---- Floating ----

std::optional<GridRegion> GridCanvas::floating_region() const {
    if (m_floating.is_empty() || m_picture.is_empty()) return std::nullopt;
    return GridRegion{m_floating_first, std::min({m_floating.rows(), m_mapping.rows() - m_floating_first.row, m_picture.rows()}),
                      std::min({m_floating.columns(), m_mapping.columns() - m_floating_first.column, m_picture.columns()})};
}

void GridCanvas::show_floating(const QImage& picture, GridCell first) {
    set_region(std::nullopt);
    m_floating = CellPicture(picture);
    m_mapping.show(first);
    move_floating(first);
}

void GridCanvas::mark_floating(std::vector<GridCell> refused) {
    m_floating_refused = std::move(refused);
    update();
}

void GridCanvas::move_floating(const GridCell& first) {
    m_floating_first = first;
    m_floating_refused.clear();
    update();
    Q_EMIT floating_moved();
}

/// A press on what floats takes hold of it, one beside it puts it down.
void GridCanvas::grasp_floating(const std::optional<GridCell>& cell) {
    if (!cell || !floating_region()->holds(*cell)) return end_floating(true);
    m_grip = GridSize{cell->row - m_floating_first.row, cell->column - m_floating_first.column};
}

void GridCanvas::drag_floating(const QPointF& place) {
    const GridCell cell = m_mapping.nearest_cell(place);
    const GridCell first{cell.row - std::min(cell.row, m_grip->rows), cell.column - std::min(cell.column, m_grip->columns)};
    if (first != m_floating_first) move_floating(first);
}

void GridCanvas::end_floating(bool is_put_down) {
    if (m_floating.is_empty()) return;
    const auto region = floating_region();
    m_grip.reset();
    m_floating = {};
    m_floating_first = {};
    m_floating_refused.clear();
    m_anchor = region ? region->first : GridCell{};
    if (is_put_down) set_region(region);
    update();
    Q_EMIT floating_ended(is_put_down);
}

// ---- Painting ----

/// Framed so that it is seen on black, on white, and on both.
void GridCanvas::paint_region(QPainter& painter) const {
    const auto floating = floating_region();
    if (!floating && !m_region) return;
    const QRectF box = box_of(floating ? *floating : *m_region, m_mapping);
    if (floating) {
        painter.save();
        painter.setClipRect(box, Qt::IntersectClip);
        const CellPicture::Seen seen = m_floating.seen(m_mapping.of_part(m_floating_first, {m_floating.rows(), m_floating.columns()}), devicePixelRatioF());
        painter.drawImage(seen.place, seen.image);
        painter.restore();
    } else {
        painter.fillRect(box, QColor(0x56, 0xb4, 0xe9, 70));
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(Qt::white, 5));
    painter.drawRect(box);
    painter.setPen(QPen(floating ? refusal_colour : cursor_colour, 3, Qt::DashLine));
    painter.drawRect(box);
}

}  // namespace weave::studio
