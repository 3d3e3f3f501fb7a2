#define CATCH_CONFIG_RUNNER
#include "display.hpp"

#include <catch2/catch.hpp>

#include <QApplication>
#include <QDir>
#include <QFile>
#include <QTemporaryDir>

#include <clocale>
#include <studio/window/language.hpp>

#ifdef __SANITIZE_ADDRESS__
/// Drivers and plugins stay loaded to the end: what they keep is then still theirs, or has a name for leaks.txt.
extern "C" int dlclose(void*) {
    return 0;
}
#endif

/// Tests of the studio run in real windows: on the display that there is, or on one of their own that nobody sees.
int main(int argc, char* argv[]) {
    const weave::studio::test::Display display;
    // Settings, unsaved work and what else belongs to a person: of this run alone.
    const QTemporaryDir home;
    for (const char* kind : {"XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_CACHE_HOME", "XDG_RUNTIME_DIR"}) {
        QDir(home.path()).mkdir(kind);
        QFile::setPermissions(home.filePath(kind), QFile::ReadOwner | QFile::WriteOwner | QFile::ExeOwner);
        qputenv(kind, home.filePath(kind).toUtf8());
    }
    // No desktop's bus is asked for, nor started: to start one Qt forks beside its threads, where a sanitizer's locks may hang for ever.
    qputenv("DBUS_SESSION_BUS_ADDRESS", "disabled:");
    int qt_arguments = 1;  // Catch's words are none of Qt's
    QApplication application(qt_arguments, argv);
    QCoreApplication::setOrganizationName("weave");
    QCoreApplication::setApplicationName("studio-test");
    std::setlocale(LC_NUMERIC, "C");
    weave::studio::speak_language_of(QLocale(QLocale::English));
    return Catch::Session().run(argc, argv);
}
