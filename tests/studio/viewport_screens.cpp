#include "screen_file.hpp"

#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/simulate.hpp>
#include <studio/support/viewport_samples.hpp>
#include <studio/viewport/viewer_panel.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::studio;

TEST_CASE("pictures of the viewer to look at", "[.screens]") {
    const Design design = find_sample("angle-interlock-b")->make();
    const BlockPtr block = evaluate(design)->block;
    const auto curves = cloth_curves(design, *block);
    REQUIRE(curves);
    auto planned = TubeModel::planned(design, *curves);
    REQUIRE(planned);
    sim::SimulationRequest request;
    request.fidelity = sim::Fidelity::draft;
    const auto plan = sim::make_plan(design, *block, request);
    REQUIRE(plan);
    const auto yarns = std::make_shared<const Yarns>(sim::simulate(design, *plan, {}));
    Viewport viewport;
    viewport.set_animated(false);
    viewport.resize(900, 640);
    viewport.set_caption("angle-interlock-b: whole cloth");
    viewport.set_model(std::make_shared<TubeModel>(*planned));
    viewport.show();
    REQUIRE(QTest::qWaitForWindowExposed(&viewport));
    const auto save = [&](const char* name) {
        QTest::qWait(300);
        viewport.yarns_on_screen().save(test::screen_file(QString("viewer-%1.png").arg(name)));
    };
    save("planned");
    auto relaxed = std::make_shared<TubeModel>(*TubeModel::relaxed(yarns, ColourBy::contact));
    viewport.set_model(relaxed);
    save("contact");
    relaxed->set_colour(ColourBy::yarn);
    viewport.set_model(relaxed);
    viewport.turn_to(StandardView::face);
    save("face");
    viewport.turn_to(StandardView::corner);
    const Box box = viewport.shown_box();
    viewport.set_clip(Plane{{-1, 0, 0}, -box.centre().x()});
    viewport.point_out({{System::warp, 2}});
    save("clip");
    viewport.set_clip({});
    viewport.set_attach_mode(true);
    QTest::mouseMove(&viewport, QPoint(450, 300));
    save("attach");
    viewport.set_attach_mode(false);
    viewport.set_locked(true);
    viewport.set_model(nullptr);
    save("empty");
}

TEST_CASE("a picture of the panel to look at", "[.screens]") {
    ViewerPanel panel;
    panel.resize(1150, 700);
    panel.show();
    REQUIRE(QTest::qWaitForWindowExposed(&panel));
    panel.viewport()->set_animated(false);
    panel.set_relaxed(test::sample_yarns());
    panel.set_mode(ViewerPanel::Mode::relaxed);
    panel.set_colour(ColourBy::strain);
    REQUIRE(QTest::qWaitFor([&] { return panel.viewport()->model() != nullptr; }));
    panel.viewport()->set_locked(true);
    panel.viewport()->set_caption("angle-interlock-b: whole cloth");
    panel.grab().save(test::screen_file("viewer-panel.png"));
}
