#include <studio/editors/stencil_canvas.hpp>

#include <studio/editors/own_keys.hpp>

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

constexpr double least_zoom = 0.05, most_zoom = 96;

}  // namespace

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
        m_fitted = false;
        fit();
    }
}

void StencilCanvas::set_tool(StencilTool tool) {
    give_up_stroke();
    m_tool = tool;
    setCursor(tool == StencilTool::pick ? Qt::PointingHandCursor : Qt::CrossCursor);
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
    m_fitted = m_fitted || isVisible();
    if (m_image.isNull()) return;
    const double room = fontMetrics().height();
    const double wide = (width() - 2 * room) / m_image.width(),
                 high = (height() - 2 * room) / m_image.height();
    m_zoom = std::clamp(std::min({wide, high, 48.0}), least_zoom, most_zoom);
    if (m_zoom > 1) m_zoom = std::floor(m_zoom);  // whole pixels, so that all stacks are equally large
    m_origin = {std::floor((width() - m_zoom * m_image.width()) / 2),
                std::floor((height() - m_zoom * m_image.height()) / 2)};
    update();
}

void StencilCanvas::resizeEvent(QResizeEvent*) {
    if (!m_fitted) fit();
}

QPoint StencilCanvas::stack_at(QPointF place) const {
    const QPointF inside = (place - m_origin) / m_zoom;
    return {static_cast<int>(std::floor(inside.x())),
            m_image.height() - 1 - static_cast<int>(std::floor(inside.y()))};
}

QRectF StencilCanvas::square_of(const QRect& stacks) const {
    return {m_origin.x() + stacks.left() * m_zoom,
            m_origin.y() + (m_image.height() - 1 - stacks.bottom()) * m_zoom, stacks.width() * m_zoom,
            stacks.height() * m_zoom};
}

QPoint StencilCanvas::place_of(QPoint stack) const {
    return square_of(QRect(stack, QSize(1, 1))).center().toPoint();
}

void StencilCanvas::zoom_by(double factor, QPointF fixed) {
    const double zoom = std::clamp(m_zoom * factor, least_zoom, most_zoom);
    m_origin = fixed - (fixed - m_origin) * (zoom / m_zoom);
    m_zoom = zoom;
    update();
}

void StencilCanvas::wheelEvent(QWheelEvent* event) {
    const QPoint turn = event->angleDelta();
    if (event->modifiers().testFlag(Qt::ShiftModifier) || turn.x() != 0) {
        m_origin.rx() += turn.x() != 0 ? turn.x() : turn.y();
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
    const QRectF part = event->rect();
    painter.fillRect(part, QColor(0xec, 0xee, 0xf0));
    if (m_image.isNull()) return;
    // Only the pixels that are seen are scaled: a large picture costs no more than a small one.
    const QRectF seen = part.adjusted(-m_zoom, -m_zoom, m_zoom, m_zoom);
    const QPointF low = (seen.topLeft() - m_origin) / m_zoom, high = (seen.bottomRight() - m_origin) / m_zoom;
    const QRect pixels =
        QRect(QPoint(static_cast<int>(std::floor(low.x())), static_cast<int>(std::floor(low.y()))),
              QPoint(static_cast<int>(std::ceil(high.x())), static_cast<int>(std::ceil(high.y()))))
            .intersected(m_image.rect());
    if (!pixels.isEmpty()) {
        const QRectF target(m_origin + QPointF(pixels.topLeft()) * m_zoom, QSizeF(pixels.size()) * m_zoom);
        painter.setRenderHint(QPainter::SmoothPixmapTransform, m_zoom < 1);
        painter.drawImage(target, m_image, pixels);
    }
    draw_grid(painter, part);
    draw_wish(painter);
    painter.setPen(QColor(0x59, 0x59, 0x59));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(square_of(QRect(0, 0, m_image.width(), m_image.height())).adjusted(-1, -1, 0, 0));
}

void StencilCanvas::draw_grid(QPainter& painter, const QRectF& part) const {
    if (m_zoom < 6) return;
    const QRectF all = square_of(QRect(0, 0, m_image.width(), m_image.height())).intersected(part);
    if (all.isEmpty()) return;
    const auto lines = [&](bool upright) {
        const double begin = upright ? m_origin.x() : m_origin.y(), from = upright ? all.left() : all.top(),
                     to = upright ? all.right() : all.bottom();
        for (double k = std::ceil((from - begin) / m_zoom); begin + k * m_zoom <= to; ++k) {
            const double at = begin + k * m_zoom;
            const int count = upright ? static_cast<int>(k) : m_image.height() - static_cast<int>(k);
            painter.setPen(count % 10 == 0 ? QColor(0, 0, 0, 110) : QColor(0, 0, 0, 45));
            upright ? painter.drawLine(QPointF(at, all.top()), QPointF(at, all.bottom()))
                    : painter.drawLine(QPointF(all.left(), at), QPointF(all.right(), at));
        }
    };
    lines(true);
    lines(false);
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
            painter.setPen(QPen(ink, std::max(2.0, m_zoom), Qt::SolidLine, Qt::SquareCap));
            painter.drawLine(place_of(*m_begin), place_of(*m_last));
        }
    }
    if (!m_cursor || !holds(*m_map, *m_cursor) || m_zoom < 3) return;
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
    update();
}

void StencilCanvas::mousePressEvent(QMouseEvent* event) {
    const QPoint stack = stack_at(event->position());
    if (event->button() == Qt::MiddleButton) {
        m_panning = event->position();
    } else if (event->button() == Qt::LeftButton && m_tool == StencilTool::pick) {
        if (holds(*m_map, stack)) Q_EMIT block_picked(at(*m_map, stack));
    } else if (event->button() == Qt::LeftButton && !m_image.isNull()) {
        begin_stroke(stack);
    } else if (event->button() == Qt::RightButton && holds(*m_map, stack)) {
        Q_EMIT block_picked(at(*m_map, stack));
    }
}

void StencilCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (m_panning) {
        m_origin += event->position() - *m_panning;
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
    return claims_key(*this, *event) || QWidget::event(event);
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
            if (m_tool == StencilTool::pick) return Q_EMIT block_picked(at(*m_map, cursor));
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
