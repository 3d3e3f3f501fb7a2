#include <studio/editors/grid_canvas.hpp>

#include <QContextMenuEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <studio/editors/own_keys.hpp>

namespace weave::studio {

namespace {

constexpr double cells_with_lines = 6;  ///< pixels from which each square has its lines

}  // namespace

const QColor GridCanvas::cursor_colour(0x00, 0x72, 0xb2), GridCanvas::refusal_colour(0xd5, 0x5e, 0x00);

GridCanvas::GridCanvas(QWidget* parent) : QWidget(parent) {
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setMinimumSize(160, 120);
}

void GridCanvas::show_picture(CellPicture picture, int times_rows, int times_columns) {
    m_picture = std::move(picture);
    if (m_picture.is_empty()) return update();  // what comes next may be of the same size
    const std::size_t rows = m_picture.rows() * static_cast<std::size_t>(times_rows), columns = m_picture.columns() * static_cast<std::size_t>(times_columns);
    if (rows != m_mapping.rows() || columns != m_mapping.columns()) {
        m_mapping.set_grid(rows, columns);
        m_mapping.fit();
        m_refused.clear();
    }
    if (m_region && (m_region->last().row >= rows || m_region->last().column >= columns)) set_region(std::nullopt);
    if (m_floating_first.row >= rows || m_floating_first.column >= columns) end_floating(false);
    if (m_cursor && (m_cursor->row >= rows || m_cursor->column >= columns)) m_cursor.reset();
    update();
}

void GridCanvas::begin_anew() {
    m_cursor.reset();
    m_hovered.reset();
    m_refused.clear();
    m_stroke.clear();
    let_go();
    fit();
}

void GridCanvas::set_labels(GridLabels labels) {
    m_rulers.set(std::move(labels), m_picture.rows(), m_picture.columns());
    lay_out();
}

void GridCanvas::lay_out() {
    m_mapping.set_room(m_rulers.room_in(*this, m_mapping.corner()));
    update();
}

void GridCanvas::set_corner(Corner corner) {
    m_mapping.set_corner(corner);
    lay_out();
}

void GridCanvas::set_empty_text(const QString& text) {
    m_empty_text = text;
    update();
}

void GridCanvas::set_cursor_cell(std::optional<GridCell> cell) {
    m_cursor = cell;
    if (m_cursor) m_mapping.show(*m_cursor);
    update();
}

void GridCanvas::mark_refused(std::vector<GridCell> cells) {
    m_refused = std::move(cells);
    update();
}

void GridCanvas::zoom_by(double factor) {
    m_mapping.zoom(factor, m_cursor ? m_mapping.box(*m_cursor).center() : m_mapping.room().center());
    update();
}

void GridCanvas::fit() {
    m_mapping.fit();
    update();
}

// ---- Painting ----

void GridCanvas::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), palette().color(QPalette::Window));
    if (m_picture.is_empty()) {
        painter.setPen(palette().color(QPalette::PlaceholderText));
        painter.drawText(rect().adjusted(24, 24, -24, -24), Qt::AlignCenter | Qt::TextWordWrap, m_empty_text);
        return;
    }
    painter.save();
    painter.setClipRect(m_mapping.room());
    const CellPicture::Seen seen = m_picture.seen(m_mapping, devicePixelRatioF());
    painter.drawImage(seen.place, seen.image);
    paint_lines(painter);
    paint_region(painter);
    paint_marks(painter);
    painter.restore();
    m_rulers.paint(painter, *this, m_mapping);
}

void GridCanvas::paint_lines(QPainter& painter) const {
    const GridSpan span = m_mapping.seen();
    const QRectF grid = m_mapping.frame();
    const bool all = m_mapping.cell() >= cells_with_lines;
    const QPen fine(QColor(128, 128, 128, 110), 1), heavy(cursor_colour, m_mapping.cell() >= 12 ? 2 : 1);
    const auto lines = [&](bool heavy_ones) {
        painter.setPen(heavy_ones ? heavy : fine);
        for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
            if (m_rulers.labels().row_begins(row) == heavy_ones) painter.drawLine(QPointF(grid.left(), m_mapping.y_of(static_cast<double>(row))), QPointF(grid.right(), m_mapping.y_of(static_cast<double>(row))));
        }
        for (std::size_t column = span.first_column; column <= span.last_column; ++column) {
            if (m_rulers.labels().column_begins(column) == heavy_ones) painter.drawLine(QPointF(m_mapping.x_of(static_cast<double>(column)), grid.top()), QPointF(m_mapping.x_of(static_cast<double>(column)), grid.bottom()));
        }
    };
    if (all) lines(false);
    if (m_mapping.cell() >= cells_with_lines / 2) lines(true);
    painter.setPen(QPen(palette().color(QPalette::WindowText), 1));
    painter.drawRect(grid);
    if (m_picture.rows() == m_mapping.rows() && m_picture.columns() == m_mapping.columns()) return;
    painter.setPen(QPen(refusal_colour, 2, Qt::DashLine));  // where the cloth begins again
    for (std::size_t row = m_picture.rows(); row < m_mapping.rows(); row += m_picture.rows())
        painter.drawLine(QPointF(grid.left(), m_mapping.y_of(static_cast<double>(row))), QPointF(grid.right(), m_mapping.y_of(static_cast<double>(row))));
    for (std::size_t column = m_picture.columns(); column < m_mapping.columns(); column += m_picture.columns())
        painter.drawLine(QPointF(m_mapping.x_of(static_cast<double>(column)), grid.top()), QPointF(m_mapping.x_of(static_cast<double>(column)), grid.bottom()));
}

void GridCanvas::paint_marks(QPainter& painter) const {
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setBrush(Qt::NoBrush);
    const auto ring = [&](const GridCell& cell, const QColor& colour, double width) {
        QRectF box = m_mapping.box(cell);
        if (box.width() < 8) box.adjust(-(8 - box.width()) / 2, -(8 - box.width()) / 2, (8 - box.width()) / 2, (8 - box.width()) / 2);
        painter.setPen(QPen(Qt::white, width + 2));
        painter.drawRect(box);
        painter.setPen(QPen(colour, width));
        painter.drawRect(box);
    };
    if (m_hovered && m_mapping.cell() >= 3) {
        painter.fillRect(QRectF(m_mapping.frame().left(), m_mapping.box(*m_hovered).top(), m_mapping.frame().width(), m_mapping.cell()), QColor(0x56, 0xb4, 0xe9, 40));
        painter.fillRect(QRectF(m_mapping.box(*m_hovered).left(), m_mapping.frame().top(), m_mapping.cell(), m_mapping.frame().height()), QColor(0x56, 0xb4, 0xe9, 40));
    }
    for (const GridCell& cell : m_stroke) painter.fillRect(m_mapping.box(cell), QColor(0x56, 0xb4, 0xe9, 170));
    if (m_cursor) ring(*m_cursor, cursor_colour, 2);
    for (const auto* cells : {&m_refused, &m_floating_refused}) {
        for (const GridCell& cell : *cells) {
            const QRectF box = m_mapping.box(cell);
            if (!box.intersects(m_mapping.room())) continue;
            ring(cell, refusal_colour, 3);
            painter.drawLine(box.topLeft(), box.bottomRight());
            painter.drawLine(box.bottomLeft(), box.topRight());
        }
    }
}

// ---- Mouse and keys ----

void GridCanvas::resizeEvent(QResizeEvent*) {
    lay_out();
}

void GridCanvas::mousePressEvent(QMouseEvent* event) {
    m_refused.clear();
    update();
    if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && event->modifiers() & Qt::ShiftModifier)) {
        m_moved_from = event->position();
        setCursor(Qt::ClosedHandCursor);
        return;
    }
    if (event->button() != Qt::LeftButton || m_picture.is_empty()) return;
    const auto cell = m_mapping.cell_at(event->position());
    if (floating_region()) return grasp_floating(cell);
    const bool only_goes = !m_can_stroke || event->modifiers() & Qt::ControlModifier;
    if (m_tool == GridTool::choose && !only_goes) return begin_choosing(cell, event->position());
    if (!cell) return;
    if (only_goes) return go_to(*cell);
    if (is_far()) {
        set_cursor_cell(cell);
        return too_far(*cell);
    }
    m_stroke = {*cell};
    update();
}

/// Follows the mouse however fast it goes: all cells on the way from the last one.
void GridCanvas::stroke_to(const GridCell& cell) {
    const GridCell from = m_stroke.back();
    const auto rows = static_cast<std::ptrdiff_t>(cell.row) - static_cast<std::ptrdiff_t>(from.row);
    const auto columns = static_cast<std::ptrdiff_t>(cell.column) - static_cast<std::ptrdiff_t>(from.column);
    const std::ptrdiff_t steps = std::max(std::abs(rows), std::abs(columns));
    for (std::ptrdiff_t step = 1; step <= steps; ++step) {
        const auto at = [&](std::size_t begin, std::ptrdiff_t way) {
            return static_cast<std::size_t>(static_cast<double>(begin) + std::round(static_cast<double>(way * step) / static_cast<double>(steps)));
        };
        const GridCell next{at(from.row, rows), at(from.column, columns)};
        if (std::find(m_stroke.begin(), m_stroke.end(), next) == m_stroke.end()) m_stroke.push_back(next);
    }
}

void GridCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (m_moved_from) {
        m_mapping.move(event->position() - *m_moved_from);
        m_moved_from = event->position();
        update();
        return;
    }
    const auto cell = m_picture.is_empty() ? std::nullopt : m_mapping.cell_at(event->position());
    if (cell != m_hovered) {
        m_hovered = cell;
        Q_EMIT hovered(cell);
        update();
    }
    if (m_grip) return drag_floating(event->position());
    if (m_chosen_from) return choose_to(event->position());
    if (!m_stroke.empty() && cell) {
        stroke_to(*cell);
        update();
    }
}

void GridCanvas::mouseReleaseEvent(QMouseEvent* event) {
    if (m_moved_from && event->buttons() == Qt::NoButton) {
        m_moved_from.reset();
        setCursor(m_tool == GridTool::choose ? Qt::CrossCursor : Qt::ArrowCursor);
        return;
    }
    if (event->button() != Qt::LeftButton) return;
    m_grip.reset();
    if (m_chosen_from) return end_choosing();
    if (m_stroke.empty()) return;
    const std::vector<GridCell> stroke = std::move(m_stroke);
    m_stroke.clear();
    m_cursor = stroke.back();
    update();
    Q_EMIT stroked(stroke);
}

void GridCanvas::leaveEvent(QEvent*) {
    m_hovered.reset();
    Q_EMIT hovered(std::nullopt);
    update();
}

void GridCanvas::wheelEvent(QWheelEvent* event) {
    if (event->modifiers() & Qt::ShiftModifier) {
        const QPoint by = event->angleDelta();
        m_mapping.move(QPointF(by.y(), by.x()) / 2);
    } else {
        m_mapping.zoom(std::pow(1.0015, event->angleDelta().y()), event->position());
    }
    update();
    event->accept();
}

void GridCanvas::go_to(const GridCell& cell) {
    set_cursor_cell(cell);
    Q_EMIT chosen(cell);
}

/// So many squares up and to the right, as they are seen, as far as there are any.
GridCell GridCanvas::walked(GridCell from, int rows, int columns) const {
    const auto moved = [](std::size_t at, int by, std::size_t count) {
        return static_cast<std::size_t>(std::clamp(static_cast<std::int64_t>(at) + by, std::int64_t{0}, static_cast<std::int64_t>(count) - 1));
    };
    return {moved(from.row, m_mapping.rows_go_up() ? rows : -rows, m_mapping.rows()), moved(from.column, m_mapping.columns_go_right() ? columns : -columns, m_mapping.columns())};
}

void GridCanvas::walk(int rows, int columns, bool is_shifted) {
    if (m_picture.is_empty()) return;
    const int far = is_shifted ? 8 : 1;
    if (floating_region()) return move_floating(walked(m_floating_first, rows * far, columns * far));
    if (is_shifted && m_tool == GridTool::choose) return extend(rows, columns);
    go_to(m_cursor ? walked(*m_cursor, rows * far, columns * far) : GridCell{});
}

/// Puts down what floats, else flips where the cursor is.
void GridCanvas::enter() {
    if (floating_region()) return end_floating(true);
    if (m_cursor && m_can_stroke && m_tool == GridTool::stroke) is_far() ? too_far(*m_cursor) : stroked({*m_cursor});
}

bool GridCanvas::event(QEvent* event) {
    return claims_key(*this, *event) || QWidget::event(event);
}

void GridCanvas::keyPressEvent(QKeyEvent* event) {
    if (QAction* own = action_of(*this, *event)) return own->trigger();
    const bool is_shifted = event->modifiers() & Qt::ShiftModifier;
    m_refused.clear();
    update();
    switch (event->key()) {
        case Qt::Key_Up:
            return walk(1, 0, is_shifted);
        case Qt::Key_Down:
            return walk(-1, 0, is_shifted);
        case Qt::Key_Left:
            return walk(0, -1, is_shifted);
        case Qt::Key_Right:
            return walk(0, 1, is_shifted);
        case Qt::Key_Home:
            return go_to({0, 0});
        case Qt::Key_Return:
        case Qt::Key_Enter:
            return enter();
        case Qt::Key_Escape:
            if (floating_region()) return end_floating(false);
            if (m_region) return set_region(std::nullopt);
            [[fallthrough]];
        default:
            QWidget::keyPressEvent(event);
    }
}

void GridCanvas::contextMenuEvent(QContextMenuEvent* event) {
    const auto cell = event->reason() == QContextMenuEvent::Keyboard ? m_cursor : m_mapping.cell_at(event->pos());
    if (!cell || m_picture.is_empty()) return;
    set_cursor_cell(cell);
    Q_EMIT menu_wanted(*cell, event->reason() == QContextMenuEvent::Keyboard ? mapToGlobal(m_mapping.box(*cell).center().toPoint()) : event->globalPos());
}

}  // namespace weave::studio
