// What the studio says, one and many, and in which language.

#include <studio/panels/design_tree.hpp>
#include <studio/window/language.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::studio;

TEST_CASE("language: one flip is one, and more are more, whatever the desk speaks") {
    const Flip flip{0, 0, true};
    const auto says = [&](std::size_t flips) { return made_by(Node{PresetLeaf{{"plain", {}}}, std::vector<Flip>(flips, flip)}); };
    CHECK(says(1).endsWith(", 1 flip"));
    CHECK(says(2).endsWith(", 2 flips"));
    for (QTranslator* words : QCoreApplication::instance()->findChildren<QTranslator*>()) delete words;
    CHECK_FALSE(says(1).endsWith(", 1 flip"));
    speak_language_of(QLocale("sq_AL"));  // of which there is no file
    CHECK(says(1).endsWith(", 1 flip"));
}

TEST_CASE("language: a file for the language of the desk is taken where there is one") {
    const QTemporaryDir folder;
    REQUIRE(QFile::copy(":/translations/studio_en.qm", folder.filePath("studio_sq.qm")));
    speak_language_of(QLocale("sq_AL"), folder.path());
    const auto all = QCoreApplication::instance()->findChildren<QTranslator*>();
    const auto taken = std::find_if(all.begin(), all.end(), [](const QTranslator* words) { return words->filePath().endsWith("studio_sq.qm"); });
    REQUIRE(taken != all.end());
    QCoreApplication::removeTranslator(*taken);
}
