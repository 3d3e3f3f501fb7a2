// Pictures of the window for the guide (tests/studio/guide).

#include <studio/panels/design_tree.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/main_window.hpp>

#include <QtTest>

#include <catch2/catch.hpp>
#include <cstdlib>

#include "support/hands.hpp"

using namespace weave::studio;
using namespace weave::studio::test;

namespace {

void keep(QWidget& window, const char* name) {
    QTest::qWait(1500);  // pictures, not what is tested: long enough for all that is drawn in the background
    const char* folder = std::getenv("WEAVE_SCREENS");
    window.grab().toImage().convertToFormat(QImage::Format_RGB888).save(QString("%1/%2.png").arg(folder == nullptr ? "/tmp" : folder, name), "PNG", 0);
}

}  // namespace

TEST_CASE("screens of the guide", "[.screens]") {
    MainWindow window;
    window.resize(1600, 1000);
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
    keep(window, "start");
    window.show_sample("pocket");
    keep(window, "pocket");
    auto* editors = window.findChild<QTabWidget*>("editors");
    editors->setCurrentIndex(1);
    keep(window, "section");
    window.findChild<QDockWidget*>("submit-dock")->raise();
    keep(window, "submit");
    window.show_sample("shoe-adult");
    editors->setCurrentIndex(0);
    keep(window, "shoe");
}
