#include <studio/support/offscreen_gl.hpp>
#include <studio/support/viewport_samples.hpp>
#include <studio/viewport/overlay.hpp>
#include <studio/viewport/viewer_panel.hpp>

#include <weave/picture/tube_render.hpp>

#include <QApplication>
#include <QLabel>
#include <QOpenGLFramebufferObject>
#include <QPainter>
#include <QSignalSpy>
#include <QTemporaryDir>
#include <QToolBar>
#include <QToolButton>
#include <QToolTip>
#include <QtTest>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

class Shot {
  public:
    explicit Shot(std::shared_ptr<TubeModel> model) {
        viewport.set_animated(false);
        viewport.resize(600, 500);
        viewport.set_model(std::move(model));
        viewport.show();
        REQUIRE(QTest::qWaitForWindowExposed(&viewport));
        viewport.setFocus();
        viewport.turn_to(StandardView::face);
    }
    [[nodiscard]] QPoint at(const Vec3& place) const {
        const Projected seen =
            viewport.camera().project(place, {double(viewport.width()), double(viewport.height())});
        return {static_cast<int>(std::lround(seen.x)), static_cast<int>(std::lround(seen.y))};
    }
    void click(const Vec3& place) { QTest::mouseClick(&viewport, Qt::LeftButton, {}, at(place)); }
    void drag(const QPoint& from, const QPoint& by, Qt::MouseButton button = Qt::LeftButton,
              Qt::KeyboardModifiers modifiers = {}) {
        QTest::mousePress(&viewport, button, modifiers, from);
        for (const double share : {0.5, 1.0}) {
            const QPointF place = QPointF(from) + QPointF(by) * share;
            QMouseEvent move(QEvent::MouseMove, place, viewport.mapToGlobal(place), Qt::NoButton, button,
                             modifiers);
            QApplication::sendEvent(&viewport, &move);
        }
        QTest::mouseRelease(&viewport, button, modifiers, from + by);
    }
    void wheel(const QPoint& place, int steps) {
        QWheelEvent event(place, viewport.mapToGlobal(place), {}, QPoint(0, 120 * steps), Qt::NoButton,
                          Qt::NoModifier, Qt::NoScrollPhase, false);
        QApplication::sendEvent(&viewport, &event);
    }
    Viewport viewport;
};

/// The overlay lies over the picture of OpenGL, which is grabbed without it.
QColor pixel(Viewport& viewport, const QPoint& at) {
    return viewport.yarns_on_screen().pixelColor(at);
}

}  // namespace

TEST_CASE("a drag turns the view, middle and Shift move it, and none is a click") {
    Shot shot(model_of(crossed_yarns()));
    QSignalSpy clicks(&shot.viewport, &Viewport::yarn_clicked);
    const QPoint on_yarn = shot.at({5, 5, 1});
    const Camera before = shot.viewport.camera();
    shot.drag(on_yarn, {60, 30});
    CHECK(shot.viewport.camera().azimuth_deg != before.azimuth_deg);
    CHECK(shot.viewport.camera().centre == before.centre);
    const Camera turned = shot.viewport.camera();
    shot.drag(on_yarn, {60, 30}, Qt::MiddleButton);
    CHECK(shot.viewport.camera().azimuth_deg == turned.azimuth_deg);
    CHECK((shot.viewport.camera().centre - turned.centre).norm() > 0.1);
    const Camera moved = shot.viewport.camera();
    shot.drag(on_yarn, {-60, 30}, Qt::LeftButton, Qt::ShiftModifier);
    CHECK(shot.viewport.camera().azimuth_deg == turned.azimuth_deg);
    CHECK((shot.viewport.camera().centre - moved.centre).norm() > 0.1);
    CHECK(clicks.isEmpty());
}

TEST_CASE("a press that moves less than a drag is a click and leaves the view alone") {
    Shot shot(model_of(crossed_yarns()));
    QSignalSpy clicks(&shot.viewport, &Viewport::yarn_clicked);
    const Camera before = shot.viewport.camera();
    const int less = QApplication::startDragDistance() - 1;
    shot.drag(shot.at({2, 5, 1}), {less, 0});
    CHECK(shot.viewport.camera() == before);
    REQUIRE(clicks.size() == 1);
    CHECK(clicks[0][0].value<weave::System>() == weave::System::warp);
    CHECK(clicks[0][1].value<std::size_t>() == 11);
    CHECK((clicks[0][2].value<Vec3>() - Vec3(2, 5, 1.5)).norm() < 0.3);
    shot.drag(shot.at({2, 5, 1}), {less + 1, 0});
    CHECK(shot.viewport.camera() != before);
    CHECK(clicks.size() == 1);
}

TEST_CASE("a locked view stays, whatever the mouse and the keys do, and still takes clicks") {
    Shot shot(model_of(crossed_yarns()));
    QSignalSpy clicks(&shot.viewport, &Viewport::yarn_clicked);
    const Camera before = shot.viewport.camera();
    QTest::keyClick(&shot.viewport, Qt::Key_L);
    REQUIRE(shot.viewport.is_locked());
    shot.drag({300, 250}, {80, 50});
    shot.drag({300, 250}, {80, 50}, Qt::MiddleButton);
    shot.wheel({200, 200}, 3);
    for (const int key :
         {Qt::Key_1, Qt::Key_5, Qt::Key_F, Qt::Key_Plus, Qt::Key_Minus, Qt::Key_Left, Qt::Key_Up})
        QTest::keyClick(&shot.viewport, static_cast<Qt::Key>(key));
    QTest::keyClick(&shot.viewport, Qt::Key_Left, Qt::AltModifier);
    QTest::mouseClick(&shot.viewport, Qt::LeftButton, {}, shot.viewport.cube().place().center().toPoint());
    shot.viewport.set_perspective(true);
    CHECK(shot.viewport.camera() == before);
    shot.click({2, 5, 1});
    CHECK(clicks.size() == 1);
    QTest::keyClick(&shot.viewport, Qt::Key_L);
    QTest::keyClick(&shot.viewport, Qt::Key_5);
    CHECK(shot.viewport.camera() != before);
}

TEST_CASE("keys choose views, zoom and go back and on") {
    Shot shot(model_of(crossed_yarns()));
    for (int k = 0; k < static_cast<int>(standard_views); ++k) {
        QTest::keyClick(&shot.viewport, static_cast<Qt::Key>(Qt::Key_1 + k));
        CHECK(view_of(shot.viewport.camera()) == static_cast<StandardView>(k));
    }
    const Camera last = shot.viewport.camera();
    QTest::keyClick(&shot.viewport, Qt::Key_Plus);
    CHECK(shot.viewport.camera().height_mm < last.height_mm);
    QTest::keyClick(&shot.viewport, Qt::Key_Left, Qt::AltModifier);
    CHECK(shot.viewport.camera() == last);
    QTest::keyClick(&shot.viewport, Qt::Key_Left, Qt::AltModifier);
    CHECK(view_of(shot.viewport.camera()) == StandardView::corner);
    QTest::keyClick(&shot.viewport, Qt::Key_Right, Qt::AltModifier);
    CHECK(shot.viewport.camera() == last);
    QTest::keyClick(&shot.viewport, Qt::Key_Minus);
    QTest::keyClick(&shot.viewport, Qt::Key_F);
    CHECK(shot.viewport.camera().height_mm == Approx(last.height_mm));
    shot.wheel({100, 100}, 2);
    CHECK(shot.viewport.camera().height_mm < last.height_mm);
}

TEST_CASE("a click on a side of the cube looks from there") {
    Shot shot(model_of(crossed_yarns()));
    QTest::keyClick(&shot.viewport, Qt::Key_5);
    const OrientationCube& cube = shot.viewport.cube();
    std::optional<QPoint> pick_side;
    for (double y = cube.place().top(); y < cube.place().bottom(); y += 2) {
        for (double x = cube.place().left(); x < cube.place().right(); x += 2) {
            if (cube.at({x, y}, shot.viewport.camera()) == Face::minus_x) pick_side = QPoint(int(x), int(y));
        }
    }
    REQUIRE(pick_side);
    QTest::mouseClick(&shot.viewport, Qt::LeftButton, {}, *pick_side);
    CHECK(view_of(shot.viewport.camera()) == StandardView::weft_side);
}

TEST_CASE("the mouse over a yarn names it") {
    Shot shot(model_of(crossed_yarns()));
    QTest::mouseMove(&shot.viewport, shot.at({2, 8, 1}));
    REQUIRE(QTest::qWaitFor([&] { return shot.viewport.hovered_yarn().has_value(); }));
    CHECK(*shot.viewport.hovered_yarn() == 2);
    CHECK(QTest::qWaitFor([] { return QToolTip::text() == "end 13 · beam 1"; }));
    QTest::mouseMove(&shot.viewport, shot.at({2, 2, 1}));
    CHECK(QTest::qWaitFor([&] { return !shot.viewport.hovered_yarn().has_value(); }));
}

TEST_CASE("two yarns clicked one after the other tell their crossing; Esc lets the first go") {
    Shot shot(model_of(crossed_yarns()));
    QSignalSpy crossings(&shot.viewport, &Viewport::crossing_clicked);
    shot.click({2, 5, 1});
    REQUIRE(shot.viewport.held_yarn() == std::optional<std::uint32_t>(1));
    CHECK(shot.viewport.hint().contains("Esc"));
    QTest::keyClick(&shot.viewport, Qt::Key_Escape);
    CHECK_FALSE(shot.viewport.held_yarn());
    shot.click({2, 5, 1});
    shot.click({5, 2, 0});
    REQUIRE(crossings.size() == 1);
    CHECK(crossings[0][0].value<std::size_t>() == 6);
    CHECK(crossings[0][1].value<std::size_t>() == 11);
    CHECK_FALSE(shot.viewport.held_yarn());
    // Two ends never cross: the second is held instead.
    shot.click({2, 5, 1});
    shot.click({2, 8, 1});
    CHECK(crossings.size() == 1);
    CHECK(shot.viewport.held_yarn() == std::optional<std::uint32_t>(2));
    CHECK(shot.viewport.hint().contains("do not cross"));
    shot.click({5, 2, 0});
    REQUIRE(crossings.size() == 2);
    CHECK(crossings[1][1].value<std::size_t>() == 12);
    // One click on the crossing itself is enough.
    shot.click({5, 5, 1});
    REQUIRE(crossings.size() == 3);
    CHECK(crossings[2][1].value<std::size_t>() == 11);
    shot.click({2, 2, 0});  // beside all yarns
    CHECK(crossings.size() == 3);
}

TEST_CASE("in attach mode a click tells the face of the block") {
    Shot shot(model_of(crossed_yarns()));
    QSignalSpy faces(&shot.viewport, &Viewport::face_clicked), yarns(&shot.viewport, &Viewport::yarn_clicked);
    shot.click({5, 5, 1});
    CHECK(faces.isEmpty());
    CHECK(yarns.size() == 1);
    shot.viewport.set_attach_mode(true);
    shot.click({5, 5, 1});
    QTest::keyClick(&shot.viewport, Qt::Key_4);
    shot.click(shot.viewport.shown_box().centre());
    REQUIRE(faces.size() == 2);
    CHECK(faces[0][0].value<weave::Face>() == Face::plus_z);
    CHECK(faces[1][0].value<weave::Face>() == Face::minus_x);
    CHECK(yarns.size() == 1);
    QTest::keyClick(&shot.viewport, Qt::Key_Escape);
    CHECK_FALSE(shot.viewport.attach_mode());
}

TEST_CASE(
    "yarns are drawn where they are, what is cut away is gone, and what is cut is filled with a dark rim") {
    Shot shot(model_of(crossed_yarns()));
    Viewport& viewport = shot.viewport;
    const auto reddish = [](const QColor& colour) { return colour.red() > colour.blue() + 40; };
    const auto bluish = [](const QColor& colour) { return colour.blue() > colour.red() + 40; };
    CHECK(reddish(pixel(viewport, shot.at({5, 5, 1}))));
    CHECK(bluish(pixel(viewport, shot.at({5, 2, 0}))));
    const QColor ground = pixel(viewport, shot.at({2, 2, 0}));
    CHECK_FALSE((reddish(ground) || bluish(ground)));
    const QColor whole = pixel(viewport, shot.at({2, 5, 1}));
    viewport.set_clip(Plane{{0, 0, 1}, 1});  // along the axes of the ends: a flat strip
    const QColor cut = pixel(viewport, shot.at({2, 5, 1}));
    CHECK(reddish(cut));
    CHECK(cut != whole);
    const QColor rim = pixel(viewport, shot.at({2, 5.45, 1}));
    CHECK(rim.lightness() < 70);
    viewport.set_clip(Plane{{0, 0, 1}, 0.4});  // the ends are gone
    CHECK(bluish(pixel(viewport, shot.at({5, 5, 0.4}))));
    CHECK_FALSE(reddish(pixel(viewport, shot.at({2, 5, 1}))));
    viewport.set_clip({});
    CHECK(pixel(viewport, shot.at({2, 5, 1})) == whole);
}

TEST_CASE("yarns that are pointed out stand out and the others pale, until Esc or a click lets them go") {
    Shot shot(model_of(crossed_yarns()));
    const QPoint end = shot.at({2, 5, 1}), other = shot.at({2, 8, 1});
    const QColor before = pixel(shot.viewport, other);
    const std::vector<YarnName> pointed_out{{weave::System::warp, 11}};
    shot.viewport.point_out(pointed_out);
    CHECK(pixel(shot.viewport, other).saturation() < before.saturation() / 2);
    CHECK(pixel(shot.viewport, end).saturation() > before.saturation() / 2);
    CHECK(shot.viewport.hint() == "end 12; Esc to let go");
    QTest::keyClick(&shot.viewport, Qt::Key_Escape);
    CHECK(pixel(shot.viewport, other) == before);
    CHECK(shot.viewport.hint().isEmpty());
    shot.viewport.point_out(pointed_out);
    QTest::mouseClick(&shot.viewport, Qt::LeftButton, {}, QPoint(2, 2));
    CHECK(shot.viewport.pointed_out().empty());
}

TEST_CASE("OpenGL draws what the processor draws") {
    const auto yarns = sample_yarns();
    const bool apart = GENERATE(true, false);  // into a picture of its own, or straight into the window
    CAPTURE(apart);
    for (const bool perspective : {false, true}) {
        ClothView view;
        view.perspective = perspective;
        TubeCamera camera(view.azimuth_deg, view.elevation_deg);
        auto scene = make_scene(*yarns, view, camera);
        REQUIRE(scene);
        constexpr int wide = 500, high = 400;
        // With perspective as our own camera does it: the eye as far away as 1.7 heights of the picture.
        camera.fit(perspective
                       ? Rectangle{-0.5 * wide / (1.7 * high), -0.5 / 1.7, wide / (1.7 * high), 1 / 1.7}
                       : box_of(*scene, camera),
                   perspective ? Rectangle{0, 0, wide, high} : Rectangle{20, 20, wide - 40, high - 40});
        const auto expected = render(*scene, camera, wide, high);

        Viewport viewport(nullptr, apart);
        viewport.set_animated(false);
        viewport.resize(wide, high);
        viewport.set_model(model_of(yarns));
        viewport.show();
        REQUIRE(QTest::qWaitForWindowExposed(&viewport));
        REQUIRE(viewport.size() == QSize(wide, high));
        // The same view: moved so that the box's middle lies where the other camera has it.
        const Vec3 centre = viewport.shown_box().centre(), seen = camera.to_camera(centre);
        const Rectangle at = camera.on_screen(camera.box_of(seen, 1e-9));
        Camera own = viewport.camera();
        own.perspective = perspective;
        own.azimuth_deg = view.azimuth_deg;
        own.elevation_deg = view.elevation_deg;
        own.centre = centre;
        own.height_mm = perspective ? seen.z() / 1.7 : high / camera.pixels_per_unit();
        own.pan(at.x - wide / 2.0, at.y - high / 2.0, {wide, high});
        viewport.set_camera(own);
        const QImage drawn = viewport.yarns_on_screen();
        std::size_t differ = 0, yarn = 0, colour_differs = 0;
        for (int y = 0; y < high; ++y) {
            for (int x = 0; x < wide; ++x) {
                const std::uint32_t there = expected[std::size_t(y) * wide + std::size_t(x)];
                const QColor here = drawn.pixelColor(x, y), other = QColor::fromRgb(there);
                const bool is_ground = here.saturation() < 12 && here.lightness() > 222;
                yarn += there != 0xffffff ? 1U : 0U;
                differ += is_ground != (there == 0xffffff) ? 1U : 0U;
                if (!is_ground && there != 0xffffff && here.saturation() > 90 && other.saturation() > 90)
                    colour_differs += std::abs(here.hsvHue() - other.hsvHue()) > 40 ? 1U : 0U;
            }
        }
        INFO(yarn << " pixels of yarn, " << differ << " differ in outline, " << colour_differs
                  << " in colour");
        REQUIRE(yarn > 20'000);
        CHECK(double(differ) < 0.03 * double(yarn));
        CHECK(double(colour_differs) < 0.02 * double(yarn));
    }
}

TEST_CASE("the picture outlives another parent, and goes without yarns") {
    const bool apart = GENERATE(true, false);
    CAPTURE(apart);
    QWidget first, second;
    first.resize(400, 300);
    second.resize(400, 300);
    auto* const viewport = new Viewport(&first, apart);
    viewport->set_animated(false);
    viewport->resize(400, 300);
    viewport->set_model(model_of(crossed_yarns()));
    viewport->turn_to(StandardView::face);
    first.show();
    REQUIRE(QTest::qWaitForWindowExposed(&first));
    const QImage before = viewport->yarns_on_screen();
    second.show();
    REQUIRE(QTest::qWaitForWindowExposed(&second));
    viewport->setParent(&second);
    viewport->show();
    REQUIRE(QTest::qWaitFor([&] { return viewport->painter().has_started(); }));
    CHECK(viewport->trouble().isEmpty());
    CHECK(viewport->yarns_on_screen() == before);
    const QImage whole = viewport->grab().toImage();
    CHECK(whole.pixelColor(200, 150) == before.pixelColor(200, 150));
    viewport->set_model(nullptr);
    const QImage empty = viewport->grab().toImage();
    CHECK(empty != before);
    int dark = 0;
    for (int x = 0; x < empty.width(); ++x)
        for (int y = 0; y < empty.height(); ++y) dark += empty.pixelColor(x, y).lightness() < 90 ? 1 : 0;
    CHECK(dark > 50);  // words
}

TEST_CASE("the panel makes models aside, keeps its state as JSON and takes pictures") {
    ViewerPanel panel;
    panel.viewport()->set_animated(false);
    panel.resize(1000, 600);
    panel.show();
    REQUIRE(QTest::qWaitForWindowExposed(&panel));
    QSignalSpy shown(&panel, &ViewerPanel::model_shown);
    panel.set_planned(std::make_shared<const Design>(sample_design()),
                      std::make_shared<const ClothCurves>(sample_curves()));
    REQUIRE(QTest::qWaitFor([&] { return panel.viewport()->model() != nullptr; }));
    panel.set_relaxed(sample_yarns());
    panel.set_mode(ViewerPanel::Mode::relaxed);
    panel.set_colour(ColourBy::contact);
    REQUIRE(QTest::qWaitFor([&] {
        return panel.viewport()->model() != nullptr &&
               panel.viewport()->model()->colour() == ColourBy::contact;
    }));
    REQUIRE(panel.set_state(parse_json(R"({"repeat":[2,3],"locked":true})").value()));
    CHECK(panel.viewport()->shown().repeat == std::array<std::size_t, 2>{2, 3});
    const Json state = panel.state();
    CHECK(state["colour"] == "contact");
    CHECK(state["mode"] == "relaxed");
    ViewerPanel other;
    REQUIRE(other.set_state(state));
    CHECK(other.state() == state);
    CHECK_FALSE(other.set_state(parse_json(R"({"camera":{"height_mm":-1}})").value()));
    QImage picture;
    QObject::connect(&panel, &ViewerPanel::picture_taken, [&](const QImage& taken) { picture = taken; });
    panel.menu_actions().back()->trigger();
    CHECK(picture.width() == 2 * panel.viewport()->width());
    // A live frame of the relaxed yarns; others are refused.
    std::vector<std::vector<Vec3>> control;
    for (const SimulatedYarn& yarn : sample_yarns()->yarns) control.push_back(yarn.spline.control);
    CHECK(panel.set_points(control));
    control.pop_back();
    CHECK_FALSE(panel.set_points(control));
    panel.set_relaxed(nullptr);
    CHECK(QTest::qWaitFor([&] { return panel.viewport()->model() == nullptr; }));
}

TEST_CASE("a hint goes on in the next line where the cube leaves too little room") {
    QImage image(400, 300, QImage::Format_RGB32);
    image.fill(Qt::black);
    constexpr int right = 200;
    {
        QPainter painter(&image);
        Overlay overlay(painter, image.rect(), QApplication::palette());
        overlay.hint("these two do not cross; click a yarn that crosses this one; Esc to let go", right);
    }
    int furthest = 0, lowest = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            if (image.pixelColor(x, y) != Qt::black) furthest = std::max(furthest, x), lowest = std::max(lowest, y);
    CHECK(furthest > right / 2);
    CHECK(furthest <= right);
    CHECK(lowest > 3 * QFontMetrics(QApplication::font()).height());
}

TEST_CASE("cloth that cannot be shown is not said to be still to come") {
    ViewerPanel panel;
    panel.set_mode(ViewerPanel::Mode::relaxed);
    CHECK(panel.viewport()->empty_words().startsWith("Nothing to show yet"));
    auto yarns = std::make_shared<Yarns>(*sample_yarns());
    yarns->yarns.front().strain.pop_back();
    panel.set_relaxed(yarns);
    CHECK(QTest::qWaitFor([&] { return panel.viewport()->empty_words().startsWith("This cloth cannot be shown: A yarn has not"); }));
    panel.set_relaxed(nullptr);
    CHECK(panel.viewport()->empty_words().startsWith("Nothing to show yet"));
}

TEST_CASE("every tool of the panel has a name and a tip") {
    ViewerPanel panel;
    auto* const tools = panel.findChild<QToolBar*>();
    REQUIRE(tools != nullptr);
    for (const QAction* action : tools->actions()) {
        const QWidget* const widget = tools->widgetForAction(const_cast<QAction*>(action));
        if (action->isSeparator() || widget == nullptr || widget->inherits("QLabel")) continue;
        INFO(widget->metaObject()->className());
        CHECK_FALSE(widget->accessibleName().isEmpty());
        CHECK_FALSE((widget->toolTip() + action->toolTip()).isEmpty());
    }
}

TEST_CASE("without OpenGL the panel says so in words and goes on") {
    ViewerPanel panel(nullptr, "this display has OpenGL 2.1, and 3.3 is needed");
    panel.resize(600, 400);
    panel.show();
    REQUIRE(QTest::qWaitForWindowExposed(&panel));
    bool says = false;
    for (const QLabel* label : panel.findChildren<QLabel*>())
        says = says || (label->isVisible() && label->text().contains("2.1"));
    CHECK(says);
    CHECK_FALSE(panel.viewport()->isVisible());
    panel.set_relaxed(sample_yarns());
    panel.set_mode(ViewerPanel::Mode::relaxed);
    CHECK(QTest::qWaitFor([&] { return panel.viewport()->model() != nullptr; }));
}

TEST_CASE("the shaders see what the processor's own finder sees, cut or whole, in both kinds of view") {
    const test::OffscreenGl gl;
    TubePainter painter;
    REQUIRE(painter.start().isEmpty());
    const auto model = model_of(sample_yarns());
    painter.set_model(model.get());
    QOpenGLFramebufferObject target(400, 300);
    for (const bool perspective : {false, true}) {
        for (const bool cut : {false, true}) {
            TubeFrame frame;
            frame.size = {400, 300};
            frame.shown.repeat = {2, 1};
            frame.camera.perspective = perspective;
            frame.camera.fit(box_of(*model, {2, 1}), frame.size);
            if (cut) frame.shown.clip = Plane{{-1, 0, 0}, -model->box().centre().x()};
            QImage images[2];
            for (const bool processor : {false, true}) {
                painter.find_by_processor(processor);
                painter.draw(frame, target.handle());
                images[processor ? 1 : 0] = target.toImage().convertToFormat(QImage::Format_RGB32);
            }
            int differ = 0, yarn = 0;
            for (int y = 0; y < 300; ++y) {
                for (int x = 0; x < 400; ++x) {
                    const QColor a = images[0].pixelColor(x, y), b = images[1].pixelColor(x, y);
                    yarn += a.lightness() < 215 ? 1 : 0;
                    differ += std::abs(a.red() - b.red()) + std::abs(a.green() - b.green()) +
                                          std::abs(a.blue() - b.blue()) >
                                      24
                                  ? 1
                                  : 0;
                }
            }
            INFO((perspective ? "perspective" : "parallel")
                 << (cut ? ", cut: " : ": ") << differ << " of " << yarn << " pixels differ");
            CHECK(yarn > 10'000);
            CHECK(differ < 0.005 * yarn);
        }
    }
    painter.release();
}
