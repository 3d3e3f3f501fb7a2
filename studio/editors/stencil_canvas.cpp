#include <studio/editors/stencil_canvas.hpp>

#include <studio/editors/own_keys.hpp>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

namespace weave::studio {

StencilCanvas::StencilCanvas(QWidget* parent)
    : QWidget(parent), m_map(std::make_shared<StencilMap>()), m_before(m_map), m_bubble(this) {
    setObjectName("stencil_canvas");
    setAccessibleName(tr("Picture of the stencil"));
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setMinimumSize(fontMetrics().averageCharWidth() * 40, fontMetrics().height() * 12);
}

QSize StencilCanvas::sizeHint() const {
    return {fontMetrics().averageCharWidth() * 90, fontMetrics().height() * 30};
}

void StencilCanvas::show_map(std::shared_ptr<const StencilMap> map, const std::vector<QColor>& colours) {
    const bool same_size =
        m_image.width() == static_cast<int>(map->columns) && m_image.height() == static_cast<int>(map->rows);
    const bool same = map == m_before && colours == m_colours && !m_image.isNull();
    if (same && !m_begin) return;  // what was told of last, shown again
    m_begin.reset();
    m_last.reset();
    m_before = map;
    if (same_size && colours == m_colours) return take_rows(*map);
    m_map = std::make_shared<StencilMap>(*map);
    m_colours = colours;
    if (!same_size)
        m_image = QImage(static_cast<int>(map->columns), static_cast<int>(map->rows), QImage::Format_RGB32);
    changed(QRect(0, 0, m_image.width(), m_image.height()));
    if (!same_size) {
        m_cursor.reset();
        m_rulers.set(plain_labels(tr("rows of stacks"), tr("columns of stacks")), map->rows, map->columns);
        m_mapping.set_room(m_rulers.room_in(*this, m_mapping.corner()));
        m_mapping.set_grid(map->rows, map->columns);
        fit();
    }
}

void StencilCanvas::set_tool(StencilTool tool) {
    give_up_stroke();
    m_tool = tool;
    setCursor(tool == StencilTool::choose ? Qt::PointingHandCursor : Qt::CrossCursor);
}

/// Takes over the rows that differ, which after an undo are few.
void StencilCanvas::take_rows(const StencilMap& map) {
    for (std::size_t row = 0; row < map.rows; ++row) {
        if (std::ranges::equal(map.row(row), m_map->row(row))) continue;
        std::ranges::copy(map.row(row),
                          m_map->blocks.begin() + static_cast<std::ptrdiff_t>(row * map.columns));
        changed(QRect(0, static_cast<int>(row), m_image.width(), 1));
    }
}

/// Brings the image and the screen up to date with a part of the map.
void StencilCanvas::changed(const QRect& stacks) {
    const QRect part = within(*m_map, stacks);
    if (part.isEmpty()) return;
    std::vector<QRgb> inks;
    for (const QColor& colour : m_colours) inks.push_back(colour.rgb());
    for (int row = part.top(); row <= part.bottom(); ++row) {
        auto* line = reinterpret_cast<QRgb*>(m_image.scanLine(m_image.height() - 1 - row));
        for (int column = part.left(); column <= part.right(); ++column) {
            const std::uint16_t block = at(*m_map, QPoint(column, row));
            line[column] = block < inks.size() ? inks[block] : qRgb(255, 255, 255);
        }
    }
    update(square_of(part).toAlignedRect().adjusted(-2, -2, 2, 2));
}

void StencilCanvas::fit() {
    m_mapping.fit();
    update();
}

void StencilCanvas::resizeEvent(QResizeEvent*) {
    m_mapping.set_room(m_rulers.room_in(*this, m_mapping.corner()));
}

QPoint StencilCanvas::stack_at(QPointF place) const {
    const QRectF frame = m_mapping.frame();
    return {static_cast<int>(std::floor((place.x() - frame.left()) / m_mapping.cell())),
            static_cast<int>(std::floor((frame.bottom() - place.y()) / m_mapping.cell()))};
}

QRectF StencilCanvas::square_of(const QRect& stacks) const {
    const QRectF frame = m_mapping.frame();
    const double cell = m_mapping.cell();
    return {frame.left() + stacks.left() * cell, frame.bottom() - (stacks.bottom() + 1) * cell, stacks.width() * cell,
            stacks.height() * cell};
}

QPoint StencilCanvas::place_of(QPoint stack) const {
    return square_of(QRect(stack, QSize(1, 1))).center().toPoint();
}

void StencilCanvas::zoom_by(double factor, QPointF fixed) {
    m_mapping.zoom(factor, fixed);
    update();
}

void StencilCanvas::wheelEvent(QWheelEvent* event) {
    const QPoint turn = event->angleDelta();
    if (event->modifiers().testFlag(Qt::ShiftModifier) || turn.x() != 0) {
        m_mapping.move(QPointF(turn.x() != 0 ? turn.x() : turn.y(), 0));
        update();
    } else {
        zoom_by(std::pow(1.0015, turn.y()), event->position());
    }
    event->accept();
}

void StencilCanvas::refuse(const QString& why, QPoint place) {
    QString words = why;
    if (!words.isEmpty()) words[0] = words[0].toUpper();
    m_bubble.say(words, place);
    Q_EMIT status(words);
}

// ---- drawing

void StencilCanvas::paintEvent(QPaintEvent* event) {
    QPainter painter(this);
    painter.fillRect(rect(), palette().color(QPalette::Window));
    if (m_image.isNull()) return;
    painter.save();
    painter.setClipRect(m_mapping.room());
    draw_picture(painter, event->rect());
    draw_grid(painter);
    draw_wish(painter);
    painter.setPen(palette().color(QPalette::WindowText));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(m_mapping.frame().adjusted(-1, -1, 0, 0));
    painter.restore();
    m_rulers.paint(painter, *this, m_mapping);
}

/// Only the pixels that are seen are scaled: a large picture costs no more than a small one.
void StencilCanvas::draw_picture(QPainter& painter, const QRect& part) const {
    const GridSpan span = m_mapping.seen();
    const QRect seen(QPoint(static_cast<int>(span.first_column), static_cast<int>(span.first_row)),
                     QPoint(static_cast<int>(span.last_column) - 1, static_cast<int>(span.last_row) - 1));
    const QRect stacks =
        seen.intersected(QRect(stack_at(part.bottomLeft()), stack_at(part.topRight())).adjusted(-1, -1, 1, 1));
    if (stacks.isEmpty()) return;
    painter.setRenderHint(QPainter::SmoothPixmapTransform, m_mapping.cell() < 1);
    painter.drawImage(square_of(stacks), m_image,
                      QRect(stacks.left(), m_image.height() - 1 - stacks.bottom(), stacks.width(), stacks.height()));
}

void StencilCanvas::draw_grid(QPainter& painter) const {
    if (m_mapping.cell() < 6) return;
    const GridSpan span = m_mapping.seen();
    const QRectF frame = m_mapping.frame();
    const auto ink = [](std::size_t line) { return QColor(0, 0, 0, line % 10 == 0 ? 110 : 45); };
    for (std::size_t column = span.first_column; column <= span.last_column; ++column) {
        const double x = m_mapping.x_of(static_cast<double>(column));
        painter.setPen(ink(column));
        painter.drawLine(QPointF(x, frame.top()), QPointF(x, frame.bottom()));
    }
    for (std::size_t row = span.first_row; row <= span.last_row; ++row) {
        const double y = m_mapping.y_of(static_cast<double>(row));
        painter.setPen(ink(row));
        painter.drawLine(QPointF(frame.left(), y), QPointF(frame.right(), y));
    }
}

/// The line or rectangle that a release would paint, and the stack that is pointed at.
void StencilCanvas::draw_wish(QPainter& painter) const {
    const QColor ink = m_block < m_colours.size() ? m_colours[m_block] : QColor(Qt::black);
    if (m_begin && m_last && (m_tool == StencilTool::line || m_tool == StencilTool::rectangle)) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(ink);
        if (m_tool == StencilTool::rectangle) {
            painter.drawRect(square_of(QRect(*m_begin, *m_last).normalized()));
        } else {
            painter.setPen(QPen(ink, std::max(2.0, m_mapping.cell()), Qt::SolidLine, Qt::SquareCap));
            painter.drawLine(place_of(*m_begin), place_of(*m_last));
        }
    }
    if (!m_cursor || !holds(*m_map, *m_cursor) || m_mapping.cell() < 3) return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(Qt::white, 3));
    painter.drawRect(square_of(QRect(*m_cursor, QSize(1, 1))));
    painter.setPen(QPen(Qt::black, 1));
    painter.drawRect(square_of(QRect(*m_cursor, QSize(1, 1))));
}

// ---- strokes

QString StencilCanvas::name_of(std::uint16_t block) const {
    return block < m_names.size() ? m_names[block] : tr("block %1").arg(block);
}

void StencilCanvas::tell(QPoint stack) {
    if (m_bubble.isVisible()) return;  // what it says stands in the status line too
    if (!holds(*m_map, stack)) return Q_EMIT status({});
    Q_EMIT status(
        tr("row %1, column %2: %3").arg(stack.y() + 1).arg(stack.x() + 1).arg(name_of(at(*m_map, stack))));
}

/// The pointer goes beyond the picture too, where there is nothing to choose.
void StencilCanvas::choose(QPoint stack) {
    if (holds(*m_map, stack)) Q_EMIT block_chosen(at(*m_map, stack));
}

void StencilCanvas::begin_stroke(QPoint stack) {
    if (!m_obstacle.isEmpty()) return refuse(m_obstacle, place_of(stack));
    if (!holds(*m_map, stack) && m_tool != StencilTool::line && m_tool != StencilTool::rectangle)
        return refuse(tr("here is no stack; the picture's size can be changed above"), place_of(stack));
    m_begin = m_last = stack;
    m_stroke_changed = false;
    if (m_tool == StencilTool::pencil) lead_stroke(stack);
    if (m_tool != StencilTool::flood) return;
    const QRect part = flood(*m_map, stack, m_block);
    m_stroke_changed = !part.isEmpty();
    changed(part);
}

void StencilCanvas::lead_stroke(QPoint stack) {
    if (m_tool == StencilTool::pencil) {
        const QRect part = paint_line(*m_map, *m_last, stack, m_block);
        m_stroke_changed = m_stroke_changed || !part.isEmpty();
        changed(part);
    } else if (m_tool != StencilTool::flood) {
        update();
    }
    m_last = stack;
}

void StencilCanvas::end_stroke() {
    QRect part;
    if (m_tool == StencilTool::line) part = paint_line(*m_map, *m_begin, *m_last, m_block);
    if (m_tool == StencilTool::rectangle) part = paint_rectangle(*m_map, *m_begin, *m_last, m_block);
    m_begin.reset();
    m_last.reset();
    changed(part);
    update();
    if (m_cursor) tell(*m_cursor);  // which may be of another block now
    if ((!m_stroke_changed && part.isEmpty()) || m_map->blocks == m_before->blocks) return;
    const QString words[] = {tr("Paint with %1"), tr("Line of %1"), tr("Rectangle of %1"), tr("Fill with %1"),
                             QString()};
    m_before = std::make_shared<const StencilMap>(*m_map);
    Q_EMIT painted(m_before, words[static_cast<int>(m_tool)].arg(name_of(m_block)));
}

void StencilCanvas::give_up_stroke() {
    if (!m_begin) return;
    m_begin.reset();
    m_last.reset();
    take_rows(*m_before);
    if (m_cursor) tell(*m_cursor);
    update();
}

void StencilCanvas::mousePressEvent(QMouseEvent* event) {
    const QPoint stack = stack_at(event->position());
    if (event->button() == Qt::MiddleButton) {
        m_panning = event->position();
    } else if (event->button() == Qt::LeftButton && m_tool == StencilTool::choose) {
        choose(stack);
    } else if (event->button() == Qt::LeftButton && !m_image.isNull()) {
        begin_stroke(stack);
    } else if (event->button() == Qt::RightButton) {
        choose(stack);
    }
}

void StencilCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (m_panning) {
        m_mapping.move(event->position() - *m_panning);
        m_panning = event->position();
        return update();
    }
    const QPoint stack = stack_at(event->position());
    if (m_begin) lead_stroke(stack);
    if (m_cursor != stack) {
        for (const auto& place : {m_cursor, std::optional(stack)}) {
            if (place) update(square_of(QRect(*place, QSize(1, 1))).toAlignedRect().adjusted(-3, -3, 3, 3));
        }
        m_cursor = stack;
        tell(stack);
    }
}

void StencilCanvas::mouseReleaseEvent(QMouseEvent* event) {
    m_panning.reset();
    if (m_begin && event->button() == Qt::LeftButton) end_stroke();
}

void StencilCanvas::leaveEvent(QEvent*) {
    m_cursor.reset();
    update();
    Q_EMIT status({});
}

bool StencilCanvas::event(QEvent* event) {
    return claims_key(*this, *event) || claims_key(*event, {Qt::Key_Space}) || QWidget::event(event);
}

/// Arrows lead the cursor, Space or Enter paints at it: a line or rectangle begins with one and ends with the
/// next.
void StencilCanvas::keyPressEvent(QKeyEvent* event) {
    if (QAction* own = action_of(*this, *event)) return own->trigger();
    if (m_image.isNull()) return QWidget::keyPressEvent(event);
    QPoint cursor = m_cursor.value_or(QPoint(0, 0));
    const int step = event->modifiers().testFlag(Qt::ShiftModifier) ? 10 : 1;
    switch (event->key()) {
        case Qt::Key_Left:
            cursor.rx() -= step;
            break;
        case Qt::Key_Right:
            cursor.rx() += step;
            break;
        case Qt::Key_Up:
            cursor.ry() += step;
            break;
        case Qt::Key_Down:
            cursor.ry() -= step;
            break;
        case Qt::Key_Space:
        case Qt::Key_Return:
        case Qt::Key_Enter: {
            if (m_tool == StencilTool::choose) return choose(cursor);
            const bool two = m_tool == StencilTool::line || m_tool == StencilTool::rectangle;
            if (!m_begin)
                begin_stroke(cursor);
            else if (two)
                return end_stroke();
            if (m_begin && !two) end_stroke();
            return;
        }
        case Qt::Key_Escape:
            if (!m_begin) return QWidget::keyPressEvent(event);
            return give_up_stroke();
        default:
            return QWidget::keyPressEvent(event);
    }
    m_cursor = QPoint(std::clamp(cursor.x(), 0, m_image.width() - 1),
                      std::clamp(cursor.y(), 0, m_image.height() - 1));
    if (m_begin) lead_stroke(*m_cursor);
    tell(*m_cursor);
    update();
}

}  // namespace weave::studio
