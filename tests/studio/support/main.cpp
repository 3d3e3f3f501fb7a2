#define CATCH_CONFIG_RUNNER
#include "display.hpp"

#include <catch2/catch.hpp>

#include <QApplication>
#include <QStandardPaths>

#include <clocale>

/// Tests of the studio run in real windows: on the display that there is, or on one of their own that nobody sees.
int main(int argc, char* argv[]) {
    weave::studio::test::Display display;
    QStandardPaths::setTestModeEnabled(true);
    int qt_arguments = 1;  // Catch's words are none of Qt's
    QApplication application(qt_arguments, argv);
    std::setlocale(LC_NUMERIC, "C");
    return Catch::Session().run(argc, argv);
}
