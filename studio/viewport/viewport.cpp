#include <studio/viewport/viewport.hpp>

#include <studio/viewport/overlay.hpp>
#include <studio/viewport/words.hpp>

#include <QElapsedTimer>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>
#include <QPainter>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

constexpr int rest_ms = 140, glide_ms = 150, settled_ms = 400;
/// Pictures in motion that take longer, or far less, than these are computed in fewer, or more, pixels.
constexpr double slow_ms = 45, quick_ms = 18, least_scale = 0.3;
constexpr Colour light_top{0xfc, 0xfd, 0xfe}, light_bottom{0xe6, 0xea, 0xee}, dark_top{0x2b, 0x30, 0x36},
    dark_bottom{0x1b, 0x1e, 0x22}, mark_on_light{0x00, 0x72, 0xb2}, mark_on_dark{0x56, 0xb4, 0xe9};

}  // namespace

OverlaySheet::OverlaySheet(Viewport& viewport) : QWidget(&viewport), m_viewport(viewport) {
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setAttribute(Qt::WA_NoSystemBackground);
    setFocusPolicy(Qt::NoFocus);
}

void OverlaySheet::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    m_viewport.paint_over(painter, rect(), true);
}

Viewport::Viewport(QWidget* parent, bool is_software)
    : QWidget(parent),
      m_canvas(make_yarn_canvas(is_software,
                                {[this] { start(); }, [this] { m_painter.release(); },
                                 [this](unsigned target) { draw(target); }},
                                this)),
      m_sheet(*this) {
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setMinimumSize(fontMetrics().height() * 8, fontMetrics().height() * 6);
    setAccessibleName(tr("3D view"));
    setAccessibleDescription(
        tr("The yarns of the block or the relaxed cloth. F fits, 1 to 6 choose views, arrows turn."));
    m_empty_title = tr("Nothing to show yet");
    m_empty_words = tr("As soon as a block has yarns, they are drawn here.");
    m_glide.setDuration(glide_ms);
    m_glide.setEasingCurve(QEasingCurve::InOutQuad);
    m_rest.setSingleShot(true);
    m_rest.setInterval(rest_ms);
    connect(&m_rest, &QTimer::timeout, this, [this] {
        m_moving = false;
        look_again();
    });
    m_settled.setSingleShot(true);
    m_settled.setInterval(settled_ms);
    connect(&m_settled, &QTimer::timeout, this, &Viewport::note_view);
}

Viewport::~Viewport() {
    m_glide.disconnect();
    if (!m_painter.has_started() || !m_canvas->has_context()) return;
    m_canvas->make_current();
    m_painter.release();
    m_canvas->done_current();
}

// ---- What is shown ----

void Viewport::set_model(std::shared_ptr<TubeModel> model) {
    const bool had_none = m_model == nullptr;
    m_painter.set_model(nullptr);  // before the old one goes
    m_model = std::move(model);
    m_painter.set_model(m_model.get());
    m_hovered.reset();
    m_held.reset();
    m_missed = false;
    if (m_model != nullptr) {
        set_repeat(m_shown.repeat);
        if (had_none && !m_locked) m_is_fitted = false;
        if (!m_is_fitted) fit();
    }
    update_states();
    look_again();
}

Status Viewport::update_points(const std::vector<std::vector<Vec3>>& control) {
    if (m_model == nullptr) return invalid("nothing is shown whose yarns could move");
    WEAVE_CHECK_OK(m_model->update(control));
    m_painter.touch_knots();
    set_moving();
    return {};
}

void Viewport::set_repeat(std::array<std::size_t, 2> repeat) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const bool repeats = m_model == nullptr || m_model->is_periodic()[axis];
        m_shown.repeat[axis] = repeats ? std::clamp<std::size_t>(repeat[axis], 1, most_repeats) : 1;
    }
    look_again();
}

void Viewport::set_clip(std::optional<Plane> clip) {
    m_shown.clip = std::move(clip);
    clear_hover();
    look_again();
}

Box Viewport::shown_box() const {
    return m_model == nullptr ? Box{} : box_of(*m_model, m_shown.repeat);
}

void Viewport::point_out(std::vector<YarnName> yarns) {
    let_go();
    m_pointed_out = std::move(yarns);
    update_states();
}

void Viewport::set_attach_mode(bool attach) {
    if (m_attach == attach) return;
    m_attach = attach;
    let_go();
    clear_hover();
    look_again();
    if (attach) setFocus();  // Esc is to end it, wherever the click left the keys
    Q_EMIT attach_mode_changed(attach);
}

void Viewport::set_caption(const QString& text) {
    m_caption = text;
    m_sheet.update();
}

void Viewport::set_empty_words(const QString& title, const QString& text) {
    m_empty_title = title;
    m_empty_words = text;
    m_sheet.update();
}

void Viewport::update_states() {
    if (m_model == nullptr) return;
    std::vector<std::uint8_t> states(m_model->yarns().size(), yarn_plain);
    bool any = false;
    const auto mark = [&](std::optional<std::uint32_t> yarn, YarnState state) {
        if (!yarn || *yarn >= states.size()) return;
        states[*yarn] = static_cast<std::uint8_t>(states[*yarn] | state);
        any = any || state == yarn_selected;
    };
    for (const YarnName& name : m_pointed_out) mark(m_model->find(name.system, name.number), yarn_selected);
    mark(m_held, yarn_selected);
    mark(m_hovered, yarn_hovered);
    if (any) {
        for (std::uint8_t& state : states) state = state == yarn_plain ? std::uint8_t{yarn_dimmed} : state;
    }
    m_painter.set_states(std::move(states));
    look_again();
}

// ---- The camera ----

PictureSize Viewport::picture_size() const {
    return {static_cast<double>(std::max(1, width())), static_cast<double>(std::max(1, height()))};
}

void Viewport::set_moving() {
    m_moving = m_animated;
    if (m_moving) m_rest.start();
    look_again();
}

void Viewport::move_camera(const Camera& camera) {
    if (camera == m_camera) return;
    m_camera = camera;
    m_is_fitted = true;
    set_moving();
    Q_EMIT camera_changed();
}

void Viewport::set_camera(const Camera& camera) {
    m_glide.stop();
    move_camera(camera);
    m_is_fitted = true;
    note_view();
}

void Viewport::glide_to(const Camera& camera) {
    m_glide.stop();
    m_glide.disconnect();
    if (!m_animated || !isVisible()) {
        move_camera(camera);
        return;
    }
    const Camera from = m_camera;
    connect(&m_glide, &QVariantAnimation::valueChanged, this, [this, from, camera](const QVariant& share) {
        move_camera(between(from, camera, share.toDouble()));
    });
    m_glide.setStartValue(0.0);
    m_glide.setEndValue(1.0);
    m_glide.start();
}

void Viewport::note_view() {
    m_settled.stop();
    m_history.note(m_camera);
}

void Viewport::fit() {
    if (m_locked || m_model == nullptr) return;
    const bool first = !m_is_fitted;
    Camera camera = m_camera;
    camera.fit(shown_box(), picture_size());
    if (first) {  // nobody has seen another view
        m_glide.stop();
        move_camera(camera);
        m_history.clear();
        m_is_fitted = true;
    } else {
        glide_to(camera);
    }
    m_history.note(camera);
}

void Viewport::turn_to(StandardView view) {
    if (m_locked || m_model == nullptr) return;
    Camera camera = m_camera;
    camera.turn_to(view);
    camera.fit(shown_box(), picture_size());
    glide_to(camera);
    m_history.note(camera);
}

void Viewport::zoom(double factor) {
    if (m_locked) return;
    Camera camera = m_camera;
    camera.zoom_at(width() / 2.0, height() / 2.0, factor, picture_size());
    glide_to(camera);
    m_history.note(camera);
}

void Viewport::set_perspective(bool perspective) {
    if (m_locked || perspective == m_camera.perspective) return;
    m_glide.stop();
    Camera camera = m_camera;
    camera.perspective = perspective;
    move_camera(camera);
    note_view();
}

void Viewport::view_back() {
    note_view();
    if (!m_locked && m_history.can_go_back()) glide_to(m_history.back());
}

void Viewport::view_on() {
    if (!m_locked && m_history.can_go_on()) glide_to(m_history.on());
}

void Viewport::set_locked(bool locked) {
    if (m_locked == locked) return;
    m_locked = locked;
    m_glide.stop();
    look_again();
    Q_EMIT locked_changed(locked);
}

// ---- Drawing ----

void Viewport::start() {
    m_trouble = m_painter.start();
    if (!m_trouble.isEmpty()) Q_EMIT trouble_found(m_trouble);
    m_painter.set_model(m_model.get());
    update_states();
}

/// The yarns and what is written over them.
void Viewport::look_again() {
    m_canvas->draw_again();
    m_sheet.update();
}

void Viewport::place_cube() {
    const double side = std::min({fontMetrics().height() * 6.5, width() * 0.3, height() * 0.32}),
                 rim = fontMetrics().height() * 0.5;
    m_cube.set_place({width() - side - rim, rim, side, side});
}

void Viewport::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    place_cube();
    m_canvas->widget().setGeometry(rect());
    m_sheet.setGeometry(rect());
    if (m_model != nullptr && !m_history.can_go_back() && !m_locked) {
        // Until somebody moves it the view stays fitted to the window.
        m_is_fitted = false;
        fit();
    }
}

TubeFrame Viewport::frame_of(double pixel_ratio) const {
    const bool dark = palette().color(QPalette::Window).lightness() < 128;
    TubeFrame frame;
    frame.camera = m_camera;
    frame.size = {std::round(width() * pixel_ratio), std::round(height() * pixel_ratio)};
    frame.shown = m_shown;
    frame.ground_top = dark ? dark_top : light_top;
    frame.ground_bottom = dark ? dark_bottom : light_bottom;
    frame.mark = dark ? mark_on_dark : mark_on_light;
    frame.mark_pixels = std::max(1.0, 2 * pixel_ratio);
    frame.hollows = true;
    return frame;
}

/// A processor that draws does so in fewer pixels while the camera moves, so many as it manages in time.
void Viewport::draw_yarns(const TubeFrame& frame, unsigned target) {
    QElapsedTimer timer;
    timer.start();
    m_painter.draw(frame, target);
    if (!m_painter.is_software() || !m_moving) return;
    QOpenGLContext::currentContext()->functions()->glFinish();
    const double ms = static_cast<double>(timer.nsecsElapsed()) / 1e6;
    if (ms > slow_ms)
        m_moving_scale = std::max(least_scale, m_moving_scale * std::max(0.6, std::sqrt(slow_ms / ms)));
    if (ms < quick_ms) m_moving_scale = std::min(1.0, m_moving_scale * 1.2);
}

void Viewport::draw(unsigned target) {
    auto* const context = QOpenGLContext::currentContext();
    if (m_model == nullptr || !m_trouble.isEmpty() || !m_painter.has_started()) {
        if (context == nullptr) return;
        const QColor ground = palette().color(QPalette::Window);
        context->functions()->glBindFramebuffer(GL_FRAMEBUFFER, target);
        context->functions()->glClearColor(ground.redF(), ground.greenF(), ground.blueF(), 1);
        context->functions()->glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        return;
    }
    TubeFrame frame = frame_of(devicePixelRatioF());
    if (m_painter.is_software()) {
        if (m_moving) frame.scale = m_moving_scale;
        frame.hollows = !m_moving;
    } else if (devicePixelRatioF() < 1.5) {
        frame.scale = 2;
    }
    draw_yarns(frame, target);
}

void Viewport::paint_over(QPainter& painter, const QRectF& area, bool for_screen) {
    Overlay overlay(painter, area, palette());
    if (!m_trouble.isEmpty()) {
        overlay.message(
            tr("The 3D view cannot be drawn"),
            tr("%1. Everything else works; the card and the slices show the cloth as well.").arg(m_trouble));
        return;
    }
    if (m_model == nullptr) {
        overlay.message(m_empty_title, m_empty_words);
        return;
    }
    if (m_attach && for_screen)
        overlay.box(shown_box(), m_camera, m_block_face,
                    m_block_face ? attach_words(*m_block_face) : QString());
    overlay.axes(m_camera);
    overlay.scale_bar(m_camera);
    overlay.caption(m_caption);
    const double rim = fontMetrics().height() * 0.6;
    overlay.legend(*m_model, for_screen ? m_cube.place().bottom() + rim : area.top() + rim);
    if (!for_screen) return;
    if (m_locked) overlay.padlock();
    overlay.hint(hint(), m_cube.place().left() - rim);
    m_cube.paint(painter, m_camera, palette(), m_cube_face);
}

namespace {

/// `pick 7 and end 12`, counted from 1.
QString yarn_names(const std::vector<YarnName>& yarns) {
    QStringList names;
    for (const YarnName& yarn : yarns)
        names << (yarn.system == System::weft ? Viewport::tr("pick %1") : Viewport::tr("end %1")).arg(yarn.number + 1);
    return names.join(Viewport::tr(" and "));
}

}  // namespace

QString Viewport::hint() const {
    if (m_attach) return tr("choose a side of the block; Esc to let go");
    if (m_missed) return tr("these two do not cross; click a yarn that crosses this one; Esc to let go");
    if (m_held) return tr("click the yarn that crosses it; Esc to let go");
    if (!m_pointed_out.empty()) return tr("%1; Esc to let go").arg(yarn_names(m_pointed_out));
    return {};
}

QImage Viewport::picture(int times) {
    if (m_model == nullptr || !m_painter.has_started() || !m_trouble.isEmpty()) return {};
    TubeFrame frame = frame_of(times);
    frame.scale = m_painter.is_software() ? 1 : 2;
    const bool was_marked = m_hovered.has_value();
    if (was_marked) clear_hover();  // what the mouse happens to be over
    m_canvas->make_current();
    QImage image;
    {
        QOpenGLFramebufferObject target(static_cast<int>(frame.size.width),
                                        static_cast<int>(frame.size.height));
        m_painter.draw(frame, target.handle());
        image = target.toImage().convertToFormat(QImage::Format_RGB32);
    }
    m_canvas->done_current();
    image.setDevicePixelRatio(times);
    QPainter painter(&image);
    painter.setFont(font());
    paint_over(painter, QRectF(0, 0, width(), height()), false);
    return image;
}

}  // namespace weave::studio
