#include <studio/editors/slice_canvas.hpp>

#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>

namespace weave::studio {

SliceCanvas::SliceCanvas(QWidget* parent) : QWidget(parent), m_bubble(this) {
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setMinimumSize(fontMetrics().averageCharWidth() * 40, fontMetrics().height() * 10);
    m_view.set_unit(fontMetrics().height());
}

QSize SliceCanvas::sizeHint() const {
    return {fontMetrics().averageCharWidth() * 110, fontMetrics().height() * 26};
}

QPoint SliceCanvas::place_of(std::size_t position, double level) const {
    return m_view.at(static_cast<double>(position), level).toPoint();
}

QRectF SliceCanvas::ruler() const {
    const double high = fontMetrics().height() * 2.5;
    return {0, height() - high, static_cast<double>(width()), high};
}

QRectF SliceCanvas::space() const {
    return {0, 0, static_cast<double>(width()), height() - ruler().height()};
}

void SliceCanvas::set_scene(SliceScene scene) {
    m_scene = std::move(scene);
    if (!m_fitted && m_scene.all_positions > 0 && isVisible()) {
        m_fitted = true;
        m_view.fit(m_scene, space());
    }
    update();
}

void SliceCanvas::fit() {
    m_fitted = true;
    m_view.fit(m_scene, space());
    view_moved();
}

void SliceCanvas::view_moved() {
    m_view.keep_in(m_scene, space());
    lay_out();
    update();
    Q_EMIT moved();
}

void SliceCanvas::zoom_by(double factor) {
    m_view.zoom_by(factor, space().center());
    view_moved();
}

void SliceCanvas::go_to(std::size_t position) {
    const double was = m_view.at(static_cast<double>(position), 0).x();
    m_view.move_by({m_view.across() * (position == 0 ? 2.2 : 1) - was, 0});
    view_moved();
}

void SliceCanvas::centre_on(std::size_t position) {
    if (const auto [first, count] = seen(); first == 0 && count >= m_scene.all_positions) return;
    m_view.move_by({space().center().x() - m_view.at(static_cast<double>(position), 0).x(), 0});
    view_moved();
}

std::pair<std::size_t, std::size_t> SliceCanvas::seen() const {
    if (m_scene.all_positions == 0) return {0, 0};
    const double last = static_cast<double>(m_scene.all_positions) - 1;
    const double from = std::clamp(std::floor(m_view.position_at(0)), 0.0, last);
    const double to = std::clamp(std::ceil(m_view.position_at(width())), from, last);
    return {static_cast<std::size_t>(from), static_cast<std::size_t>(to - from) + 1};
}

void SliceCanvas::reveal(const SliceYarnId& yarn) {
    if (const SceneDot* dot = yarn.path ? nullptr : dot_of(m_scene, yarn)) {
        m_view.reveal(static_cast<double>(yarn.position), static_cast<double>(dot->level), space());
    } else if (const ScenePath* path = yarn.path ? path_of(m_scene, yarn.number) : nullptr) {
        const std::size_t position = m_marks.path_place.value_or(path->first);
        m_view.reveal(static_cast<double>(position),
                      static_cast<double>(path->level_at(position).value_or(0)), space());
    }
    view_moved();
}

QPoint SliceCanvas::place_of_marks() const {
    for (const SliceYarnId& yarn : m_marks.selected) {
        if (const SceneDot* dot = yarn.path ? nullptr : dot_of(m_scene, yarn))
            return place_of(yarn.position, static_cast<double>(dot->level));
        if (const ScenePath* path = yarn.path ? path_of(m_scene, yarn.number) : nullptr) {
            const std::size_t position = m_marks.path_place.value_or(path->first);
            return place_of(position, static_cast<double>(path->level_at(position).value_or(0)));
        }
    }
    return space().center().toPoint();
}

void SliceCanvas::tell(const QString& words) {
    if (!m_bubble.isVisible()) Q_EMIT status(words);
}

void SliceCanvas::refuse(const QString& why, QPoint place) {
    QString words = why;
    if (!words.isEmpty()) words[0] = words[0].toUpper();
    m_bubble.say(words, place);
    Q_EMIT status(words);
}

void SliceCanvas::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), palette().color(QPalette::Base));
    paint_slice(painter, m_view, m_scene, m_marks, space(), palette());
    if (m_scene.all_positions > 0) paint_ruler(painter, m_view, m_scene, m_marks, ruler(), palette());
    if (const QString words = empty_words(); !words.isEmpty()) {
        painter.setPen(palette().color(QPalette::PlaceholderText));
        painter.drawText(space(), Qt::AlignCenter | Qt::TextWordWrap, words);
    }
    if (!hasFocus()) return;
    painter.setPen(QPen(QColor(chosen_ink), 2));
    painter.drawRect(rect().adjusted(1, 1, -1, -1));
}

void SliceCanvas::resizeEvent(QResizeEvent*) {
    if (!m_fitted && m_scene.all_positions > 0) {
        m_fitted = isVisible();
        m_view.fit(m_scene, space());
    }
    view_moved();
}

void SliceCanvas::wheelEvent(QWheelEvent* event) {
    const QPoint turn = event->angleDelta();
    if (event->modifiers().testFlag(Qt::ShiftModifier) || std::abs(turn.x()) > std::abs(turn.y())) {
        const int way = turn.x() != 0 ? turn.x() : turn.y();
        m_view.move_by({way / 120.0 * m_view.across() * 2, 0});
    } else {
        m_view.zoom_by(std::pow(1.0015, turn.y()), event->position());
    }
    view_moved();
    event->accept();
}

void SliceCanvas::begin_panning(QPointF place) {
    m_panning = place;
    setCursor(Qt::ClosedHandCursor);
}

void SliceCanvas::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::MiddleButton) begin_panning(event->position());
}

void SliceCanvas::mouseMoveEvent(QMouseEvent* event) {
    if (m_panning) {
        m_view.move_by(event->position() - *m_panning);
        m_panning = event->position();
        return view_moved();
    }
    m_marks.hovered = yarn_at(m_view, m_scene, event->position());
    hover(event->position(), m_marks.hovered);
    update();
}

void SliceCanvas::mouseReleaseEvent(QMouseEvent*) {
    if (!m_panning) return;
    m_panning.reset();
    unsetCursor();
}

void SliceCanvas::leaveEvent(QEvent*) {
    m_marks.hovered.reset();
    m_marks.crossing.reset();
    m_marks.dot_preview.reset();
    update();
    Q_EMIT status({});
}

}  // namespace weave::studio
