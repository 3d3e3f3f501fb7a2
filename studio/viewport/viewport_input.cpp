#include <studio/viewport/viewport.hpp>

#include <studio/viewport/words.hpp>

#include <QApplication>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QToolTip>
#include <QWheelEvent>

#include <cmath>

namespace weave::studio {

namespace {

constexpr double degrees_of_pixel = 0.4, degrees_of_key = 7.5, wheel_step = 1.2, key_zoom = 1.25;

}  // namespace

Ray Viewport::ray_at(const QPointF& place) const {
    return m_camera.ray(place.x(), place.y(), picture_size(),
                        2 * shown_box().size().norm() + 2 * m_camera.height_mm);
}

// ---- What is under the mouse ----

void Viewport::clear_hover() {
    QToolTip::hideText();
    m_cube_face.reset();
    m_block_face.reset();
    if (m_hovered) {
        m_hovered.reset();
        update_states();
    }
}

void Viewport::hover(const QPointF& place, const QPoint& global) {
    if (m_model == nullptr) return;
    const auto cube = m_cube.at(place, m_camera);
    std::optional<Face> face;
    std::optional<std::uint32_t> yarn;
    QString words;
    if (!cube && m_attach) {
        face = face_at(shown_box(), ray_at(place));
    } else if (!cube) {
        const auto found = hits(*m_model, m_shown, ray_at(place));
        if (!found.empty()) {
            yarn = found.front().yarn;
            words = yarn_words(*m_model, *yarn, found.front().place);
        }
    }
    if (cube != m_cube_face || face != m_block_face) m_sheet.update();
    m_cube_face = cube;
    m_block_face = face;
    setCursor(cube || face || yarn ? Qt::PointingHandCursor : Qt::ArrowCursor);
    if (words.isEmpty()) {
        QToolTip::hideText();
    } else {
        QToolTip::showText(global, words, this);
    }
    if (yarn == m_hovered) return;
    m_hovered = yarn;
    update_states();
}

// ---- Clicks ----

void Viewport::let_go() {
    m_missed = false;
    if (!m_held && m_pointed_out.empty()) return;
    m_held.reset();
    m_pointed_out.clear();
    update_states();
}

void Viewport::click(const QPointF& place) {
    if (m_model == nullptr) return;
    if (const auto face = m_cube.at(place, m_camera)) {
        if (m_locked) return;
        Camera camera = facing(*face, m_camera);
        camera.fit(shown_box(), picture_size());
        glide_to(camera);
        m_history.note(camera);
        return;
    }
    if (m_attach) {
        if (const auto face = face_at(shown_box(), ray_at(place))) Q_EMIT face_clicked(*face);
        return;
    }
    click_yarn(place);
}

void Viewport::click_yarn(const QPointF& place) {
    const Ray ray = ray_at(place);
    const auto found = hits(*m_model, m_shown, ray);
    if (found.empty()) {
        let_go();
        return;
    }
    const Hit& hit = found.front();
    std::optional<ModelCrossing> crossing;
    const bool is_second = m_held && *m_held != hit.yarn;
    if (is_second) crossing = m_model->crossing_of(*m_held, hit.yarn, hit.place);
    const bool missed = is_second && !crossing;
    if (!is_second && !m_held) crossing = crossing_at(*m_model, found, ray);
    m_pointed_out.clear();
    m_missed = missed;
    m_held = crossing ? std::nullopt : std::optional(hit.yarn);
    update_states();
    const ModelYarn yarn = m_model->yarns()[hit.yarn];
    const std::size_t number = m_model->number_at(hit.yarn, hit.place);
    const Vec3 at = hit.place;
    Q_EMIT yarn_clicked(yarn.system, number, at);
    if (crossing) Q_EMIT crossing_clicked(crossing->pick, crossing->end);
}

// ---- Mouse ----

void Viewport::mousePressEvent(QMouseEvent* event) {
    if (m_drag != Drag::none || (event->button() != Qt::LeftButton && event->button() != Qt::MiddleButton))
        return;
    m_drag = Drag::pressed;
    m_button = event->button();
    m_pressed = m_last = event->position();
}

void Viewport::mouseMoveEvent(QMouseEvent* event) {
    if (m_drag == Drag::none) {
        hover(event->position(), event->globalPosition().toPoint());
        return;
    }
    drag_to(event->position(), event->modifiers());
}

void Viewport::drag_to(const QPointF& place, Qt::KeyboardModifiers modifiers) {
    if (m_drag == Drag::pressed) {
        if ((place - m_pressed).manhattanLength() < QApplication::startDragDistance()) return;
        const bool pans = m_button == Qt::MiddleButton || modifiers.testFlag(Qt::ShiftModifier);
        m_drag = pans ? Drag::pan : Drag::orbit;
        m_last = m_pressed;
        clear_hover();
        if (!m_locked) {
            m_glide.stop();
            note_view();
            setCursor(pans ? Qt::ClosedHandCursor : Qt::SizeAllCursor);
        }
    }
    const QPointF way = place - m_last;
    m_last = place;
    if (m_locked || m_model == nullptr) return;
    Camera camera = m_camera;
    if (m_drag == Drag::orbit) {
        camera.orbit(way.x() * degrees_of_pixel, way.y() * degrees_of_pixel);
    } else {
        camera.pan(way.x(), way.y(), picture_size());
    }
    move_camera(camera);
}

void Viewport::mouseReleaseEvent(QMouseEvent* event) {
    if (m_drag == Drag::none || event->button() != m_button) return;
    const bool is_click = m_drag == Drag::pressed && m_button == Qt::LeftButton;
    const bool has_moved = m_drag != Drag::pressed;
    m_drag = Drag::none;
    setCursor(Qt::ArrowCursor);
    if (has_moved && !m_locked) note_view();
    if (is_click) click(event->position());
}

void Viewport::wheelEvent(QWheelEvent* event) {
    event->accept();
    if (m_locked || m_model == nullptr) return;
    const double steps = event->angleDelta().y() / 120.0;
    if (steps == 0) return;
    if (!m_settled.isActive() && m_glide.state() != QAbstractAnimation::Running) m_history.note(m_camera);
    m_glide.stop();
    Camera camera = m_camera;
    camera.zoom_at(event->position().x(), event->position().y(), std::pow(wheel_step, steps), picture_size());
    move_camera(camera);
    m_settled.start();  // many turns of the wheel are one move
}

void Viewport::leaveEvent(QEvent* event) {
    clear_hover();
    m_sheet.update();
    QWidget::leaveEvent(event);
}

// ---- Keys ----

bool Viewport::event(QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride) {
        auto* const key = static_cast<QKeyEvent*>(event);
        const bool plain = (key->modifiers() & ~(Qt::ShiftModifier | Qt::KeypadModifier)) == Qt::NoModifier;
        const bool one_to_six = key->key() >= Qt::Key_1 && key->key() <= Qt::Key_6;
        if ((plain &&
             (one_to_six || key->key() == Qt::Key_F || key->key() == Qt::Key_L ||
              key->key() == Qt::Key_Plus || key->key() == Qt::Key_Minus || key->key() == Qt::Key_Equal)) ||
            (plain && key->key() == Qt::Key_Escape && (m_held || m_attach || !m_pointed_out.empty())))
            event->accept();
    }
    return QWidget::event(event);
}

void Viewport::keyPressEvent(QKeyEvent* event) {
    if (!press_key(event)) QWidget::keyPressEvent(event);
}

bool Viewport::press_key(QKeyEvent* event) {
    const int key = event->key();
    if (event->modifiers().testFlag(Qt::AltModifier)) {
        if (key == Qt::Key_Left) view_back();
        if (key == Qt::Key_Right) view_on();
        return key == Qt::Key_Left || key == Qt::Key_Right;
    }
    if (event->modifiers().testFlag(Qt::ControlModifier)) return false;
    if (key >= Qt::Key_1 && key <= Qt::Key_6) {
        turn_to(static_cast<StandardView>(key - Qt::Key_1));
        return true;
    }
    switch (key) {
        case Qt::Key_F:
            fit();
            return true;
        case Qt::Key_L:
            set_locked(!m_locked);
            return true;
        case Qt::Key_Plus:
        case Qt::Key_Equal:
            zoom(key_zoom);
            return true;
        case Qt::Key_Minus:
            zoom(1 / key_zoom);
            return true;
        case Qt::Key_Escape:
            if (!m_held && !m_attach && m_pointed_out.empty()) return false;
            let_go();
            set_attach_mode(false);
            look_again();
            return true;
        default:
            return press_move_key(key, event->modifiers().testFlag(Qt::ShiftModifier));
    }
}

bool Viewport::press_move_key(int key, bool shift) {
    if (key != Qt::Key_Left && key != Qt::Key_Right && key != Qt::Key_Up && key != Qt::Key_Down) return false;
    if (m_locked || m_model == nullptr) return true;
    const double right = key == Qt::Key_Right ? 1 : key == Qt::Key_Left ? -1 : 0;
    const double down = key == Qt::Key_Down ? 1 : key == Qt::Key_Up ? -1 : 0;
    if (!m_settled.isActive()) m_history.note(m_camera);
    m_glide.stop();
    Camera camera = m_camera;
    if (shift) {
        camera.pan(right * height() / 12.0, down * height() / 12.0, picture_size());
    } else {
        camera.orbit(right * degrees_of_key, down * degrees_of_key);
    }
    move_camera(camera);
    m_settled.start();
    return true;
}

}  // namespace weave::studio
