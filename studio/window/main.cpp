#include <studio/window/windows.hpp>

#include <studio/window/language.hpp>

#include <weave/core/log.hpp>

#include <QApplication>
#include <QCommandLineParser>
#include <QIcon>
#include <QLocale>

#include <clocale>
#include <cstdio>

int main(int argc, char* argv[]) {
    using namespace weave::studio;
    QApplication application(argc, argv);
    std::setlocale(LC_NUMERIC, "C");  // documents have points in their numbers, whatever the desk's language
    QApplication::setOrganizationName("weave");
    QApplication::setApplicationName("studio");
    QApplication::setApplicationVersion(WEAVE_VERSION);
    QApplication::setDesktopFileName("weave-studio");
    Q_INIT_RESOURCE(window);
    speak_language_of(QLocale());
    QApplication::setWindowIcon(QIcon(":/studio/icon.svg"));
    weave::set_log_sink([](weave::LogLevel level, std::string_view message) {
        if (level == weave::LogLevel::warning) std::fprintf(stderr, "studio: %.*s\n", static_cast<int>(message.size()), message.data());
    });
    QCommandLineParser words;
    words.setApplicationDescription(QApplication::translate("main", "Draw multilayer cloth, see it relax, and send it to the loom."));
    words.addHelpOption();
    words.addVersionOption();
    words.addPositionalArgument("design", QApplication::translate("main", "Designs or cards to open"), "[FILE ...]");
    words.process(application);

    Windows windows;
    windows.open(words.positionalArguments());
    windows.recover(Keeper::usual_folder());
    return QApplication::exec();
}
