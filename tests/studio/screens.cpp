#include <studio/window/main_window.hpp>

#include <QtTest>

#include <catch2/catch.hpp>
#include <cstdlib>

using namespace weave::studio;

namespace {

void keep(QWidget& window, const char* name) {
    QTest::qWait(400);
    const char* folder = std::getenv("WEAVE_SCREENS");
    window.grab().save(QString("%1/%2.png").arg(folder == nullptr ? "/tmp" : folder, name));
}

}  // namespace

TEST_CASE("screens", "[.screens]") {
    MainWindow window;
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
    QTest::qWait(1500);
    keep(window, "start");
    window.show_sample("pocket");
    keep(window, "pocket");
    window.findChild<QTabWidget*>()->setCurrentIndex(1);
    keep(window, "pocket-slice");
    window.show_sample("shoe-adult");
    QTest::qWait(1000);
    keep(window, "shoe");
}
