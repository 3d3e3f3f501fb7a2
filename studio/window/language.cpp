#include <studio/window/language.hpp>

#include <QCoreApplication>
#include <QLibraryInfo>
#include <QTranslator>

#include <memory>

namespace weave::studio {

namespace {

/// The last one that is installed is asked first.
void install(const QLocale& locale, const QString& name, const QString& folder) {
    auto words = std::make_unique<QTranslator>(QCoreApplication::instance());
    if (words->load(locale, name, "_", folder)) QCoreApplication::installTranslator(words.release());
}

}  // namespace

void speak_language_of(const QLocale& locale, const QString& folder) {
    install(QLocale(QLocale::English), "studio", ":/translations");
    install(locale, "qtbase", QLibraryInfo::path(QLibraryInfo::TranslationsPath));
    install(locale, "studio", folder);
}

}  // namespace weave::studio
