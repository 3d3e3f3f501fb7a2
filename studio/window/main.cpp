#include <studio/window/windows.hpp>

#include <studio/window/language.hpp>

#include <weave/core/log.hpp>

#include <QApplication>
#include <QCommandLineParser>
#include <QIcon>
#include <QLocale>

#include <algorithm>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string_view>

namespace {

/// What `studio` is called with. Qt takes its own options away first.
void describe(QCommandLineParser& words) {
    words.setApplicationDescription(QApplication::translate("main", "Draw multilayer cloth, see it relax, and send it to the loom."));
    words.addHelpOption();
    words.addVersionOption();
    words.addPositionalArgument("design", QApplication::translate("main", "Designs or cards to open"), "[FILE ...]");
}

/// Whether help or the version is asked for, which needs no display. What follows -- are files.
bool only_tells(int argc, char* argv[]) {
    const std::set<std::string_view> tells{"-h", "--help", "--help-all", "-v", "--version"};
    for (int k = 1; k < argc && std::string_view(argv[k]) != "--"; ++k)
        if (tells.contains(argv[k])) return true;
    return false;
}

/// Whether there is somewhere to open a window: without it Qt ends the program with SIGABRT.
bool has_display(int argc, char* argv[]) {
    for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"})
        if (const char* value = std::getenv(name); value != nullptr && *value != '\0') return true;
    return std::any_of(argv + 1, argv + argc, [](std::string_view word) { return word == "-platform" || word == "--platform"; });
}

void name_the_program() {
    QCoreApplication::setOrganizationName("weave");
    QCoreApplication::setApplicationName("studio");
    QCoreApplication::setApplicationVersion(WEAVE_VERSION);
}

int tell(int argc, char* argv[]) {
    QCoreApplication application(argc, argv);
    name_the_program();
    weave::studio::speak_language_of(QLocale());
    QCommandLineParser words;
    describe(words);
    words.process(application);  // which ends here
    return 0;
}

}  // namespace

int main(int argc, char* argv[]) {
    using namespace weave::studio;
    if (only_tells(argc, argv)) return tell(argc, argv);
    if (!has_display(argc, argv)) {
        constexpr int fault_of_the_system = 5;
        std::fputs("studio: there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set)\n", stderr);
        return fault_of_the_system;
    }
    QApplication application(argc, argv);
    std::setlocale(LC_NUMERIC, "C");  // documents have points in their numbers, whatever the desk's language
    name_the_program();
    QApplication::setDesktopFileName("weave-studio");
    Q_INIT_RESOURCE(window);
    speak_language_of(QLocale());
    QApplication::setWindowIcon(QIcon(":/studio/icon.svg"));
    weave::set_log_sink([](weave::LogLevel level, std::string_view message) {
        if (level == weave::LogLevel::warning) std::fprintf(stderr, "studio: %.*s\n", static_cast<int>(message.size()), message.data());
    });
    QCommandLineParser words;
    describe(words);
    if (!words.parse(QCoreApplication::arguments())) {
        constexpr int usage = 2;
        std::fprintf(stderr, "studio: %s\nTry 'studio --help'.\n", qUtf8Printable(words.errorText()));
        return usage;
    }

    Windows windows;
    windows.open(words.positionalArguments());
    windows.recover(Keeper::usual_folder());
    return QApplication::exec();
}
