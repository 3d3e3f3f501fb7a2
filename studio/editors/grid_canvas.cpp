#include <studio/editors/grid_canvas.hpp>

#include <QContextMenuEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace weave::studio {

namespace {

constexpr double cells_with_lines = 6;  ///< pixels from which each square has its lines
const QColor cursor_colour(0x00, 0x72, 0xb2), refusal_colour(0xd5, 0x5e, 0x00);

}  // namespace

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
    if (m_cursor && (m_cursor->row >= rows || m_cursor->column >= columns)) m_cursor.reset();
    update();
}

void GridCanvas::begin_anew() {
    m_cursor.reset();
    m_hovered.reset();
    m_refused.clear();
    m_stroke.clear();
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
    for (const GridCell& cell : m_refused) {
        ring(cell, refusal_colour, 3);
        const QRectF box = m_mapping.box(cell);
        painter.drawLine(box.topLeft(), box.bottomRight());
        painter.drawLine(box.bottomLeft(), box.topRight());
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
    if (event->button() != Qt::LeftButton) return;
    const auto cell = m_mapping.cell_at(event->position());
    if (!cell || m_picture.is_empty()) return;
    if (!m_can_stroke || event->modifiers() & Qt::ControlModifier) {
        set_cursor_cell(cell);
        Q_EMIT chosen(*cell);
        return;
    }
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
    if (!m_stroke.empty() && cell) {
        stroke_to(*cell);
        update();
    }
}

void GridCanvas::mouseReleaseEvent(QMouseEvent* event) {
    if (m_moved_from && event->buttons() == Qt::NoButton) {
        m_moved_from.reset();
        unsetCursor();
        return;
    }
    if (event->button() != Qt::LeftButton || m_stroke.empty()) return;
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

void GridCanvas::walk(int rows, int columns) {
    if (m_picture.is_empty()) return;
    const auto moved = [](std::size_t at, int by, std::size_t count) {
        return static_cast<std::size_t>(std::clamp(static_cast<std::int64_t>(at) + by, std::int64_t{0}, static_cast<std::int64_t>(count) - 1));
    };
    GridCell cell = m_cursor.value_or(GridCell{0, 0});
    if (m_cursor) {
        cell.row = moved(cell.row, m_mapping.rows_go_up() ? rows : -rows, m_mapping.rows());
        cell.column = moved(cell.column, m_mapping.columns_go_right() ? columns : -columns, m_mapping.columns());
    }
    set_cursor_cell(cell);
    Q_EMIT chosen(cell);
}

void GridCanvas::keyPressEvent(QKeyEvent* event) {
    const int far = event->modifiers() & Qt::ShiftModifier ? 8 : 1;
    m_refused.clear();
    update();
    switch (event->key()) {
        case Qt::Key_Up:
            return walk(far, 0);
        case Qt::Key_Down:
            return walk(-far, 0);
        case Qt::Key_Left:
            return walk(0, -far);
        case Qt::Key_Right:
            return walk(0, far);
        case Qt::Key_Home:
            set_cursor_cell(GridCell{0, 0});
            Q_EMIT chosen({0, 0});
            return;
        case Qt::Key_Return:
        case Qt::Key_Enter:
            if (m_cursor && m_can_stroke) is_far() ? too_far(*m_cursor) : stroked({*m_cursor});
            return;
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
