#include <studio/window/main_window.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

using namespace weave::studio;

TEST_CASE("a window comes up") {
    MainWindow window;
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
}
