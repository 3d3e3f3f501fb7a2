// Files and the window: opened, saved, asked about when it closes, and changed by somebody else meanwhile.

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/samples/samples.hpp>

#include <studio/editors/card_editor.hpp>
#include <studio/panels/message_bar.hpp>
#include <studio/window/main_window.hpp>
#include <studio/window/windows.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

#include <support/temporary_folder.hpp>
#include "support/desk.hpp"
#include "support/hands.hpp"
#include "support/slow_share.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

TEST_CASE("a broken or foreign file opens with a message and changes nothing") {
    const weave::testing::TemporaryFolder folder;
    Desk shown("twill-2-2");
    const auto refuse = [&](const std::string& path, const char* words) {
        shown.find<MessageBar>("messages").clear();
        shown.window.open_file(QString::fromStdString(path));
        REQUIRE(until([&] { return !shown.said().isEmpty(); }));
        CHECK(shown.said().toStdString().find(words) != std::string::npos);
        CHECK(shown.document().design() == find_sample("twill-2-2")->make());
    };
    refuse(file_of(folder, "a.weave", "{\"format\": 7"), "a.weave");
    refuse(file_of(folder, "b.weave", "not a design"), "b.weave: is no design, WIF file or picture of a card");
    refuse(file_of(folder, "c.wif", "[WIF]\nVersion=9\n"), "c.wif");
    refuse(file_of(folder, "d.png", std::string("\x89PNG\r\n\x1a\n", 8)), "d.png");
    refuse("/nowhere/e.weave", "e.weave");
    refuse(file_of(folder, "f.ep", "a mill's old card"), "f.ep: is a file of a loom's controller, which is read as its loom's profile says: weave import FILE --loom");
}

TEST_CASE("a design is saved under its name, and comes back as it was") {
    const weave::testing::TemporaryFolder folder;
    Desk shown("pocket");
    const QString path = QString::fromStdString((folder.path / "mine.weave").string());
    auto& canvas = shown.find<CardEditor>().canvas();
    for (std::size_t end = 0; shown.document().undo_stack().count() == 0 && end < 50; ++end)
        QTest::mouseClick(&canvas, Qt::LeftButton, {}, canvas.mapping().box({3, end}).center().toPoint());
    REQUIRE(shown.document().is_modified());
    CHECK(shown.window.isWindowModified());
    shown.document().save(path);
    REQUIRE(until([&] { return shown.document().path() == path; }));
    CHECK_FALSE(shown.window.isWindowModified());
    const auto read = load_design(path.toStdString());
    REQUIRE(read);
    CHECK(*read == shown.document().design());
}

TEST_CASE("closing with unsaved changes asks, and to stay is to stay") {
    Desk shown("twill-2-2");
    REQUIRE(shown.document().perform({"title", {SetTitle{"changed", ""}}}));
    const auto answer = [&](const QString& text, bool closes) {
        bool went = false;
        with_dialog([&] { went = shown.window.may_close(); }, [&](QDialog& dialog) { press(dialog, text); });
        CHECK(went == closes);
    };
    answer("Stay", false);
    answer("Close without saving", true);
}

TEST_CASE("closing waits for a save that is under way, and asks again where it failed") {
    const weave::testing::TemporaryFolder folder;
    Desk shown("twill-2-2");
    SlowShare share(folder.path);
    REQUIRE(shown.document().perform({"title", {SetTitle{"changed", ""}}}));
    shown.document().save(QString::fromStdString(share.path().string()));  // nothing goes on before it answers
    REQUIRE(shown.document().perform({"title", {SetTitle{"changed again", ""}}}));
    shown.document().save("/nowhere/at/all.weave");
    QTimer::singleShot(0, &shown.window, [&] { share.answer(); });
    bool went = true;
    with_dialog([&] { went = shown.window.may_close(); }, [&](QDialog& dialog) {
        CHECK(shown.said().contains("/nowhere/at/all.weave"));
        press(dialog, "Stay");
    });
    CHECK_FALSE(went);
    CHECK(shown.document().design().title == "changed again");
}

TEST_CASE("closing waits for a save that is under way, and needs no answer where it came to pass") {
    const weave::testing::TemporaryFolder folder;
    Desk shown("twill-2-2");
    SlowShare share(folder.path);
    REQUIRE(shown.document().perform({"title", {SetTitle{"changed", ""}}}));
    shown.document().save(QString::fromStdString(share.path().string()));
    QTimer::singleShot(0, &shown.window, [&] { share.answer(); });
    CHECK(shown.window.may_close());
    CHECK_FALSE(shown.document().is_saving());
}

TEST_CASE("a file that somebody else changed is saved over only by one who says so") {
    const weave::testing::TemporaryFolder folder;
    const std::string path = file_of(folder, "mine.weave", write_document(find_sample("twill-2-2")->make()));
    Desk shown;
    shown.window.open_file(QString::fromStdString(path));
    REQUIRE(until([&] { return shown.window.document() != nullptr; }));
    REQUIRE(shown.document().perform({"title", {SetTitle{"mine", ""}}}));
    file_of(folder, "mine.weave", write_document(find_sample("pocket")->make()));
    const auto answer = [&](const QString& text) {
        with_dialog([&] { choose(shown.window, {"File", "Save"}); until([&] { return !shown.document().is_saving(); }); }, [&](QDialog& dialog) { press(dialog, text); });
        REQUIRE(until([&] { return !shown.document().is_saving(); }));
    };
    answer("Do not save");
    CHECK(shown.document().is_modified());
    CHECK(*load_design(path) == find_sample("pocket")->make());
    answer("Save over it");
    CHECK_FALSE(shown.document().is_modified());
    CHECK(load_design(path)->title == "mine");
}

TEST_CASE("a file that was asked for waits until a question is answered") {
    const weave::testing::TemporaryFolder folder;
    const std::string path = (folder.path / "twill.weave").string();
    REQUIRE(write_file(path, write_document(find_sample("twill-2-2")->make())));
    Desk shown("plain");
    shown.window.open_file(QString::fromStdString(path));
    with_dialog([&] { choose(shown.window, {"Block", "Repeat the block shown …"}); },
                [&](QDialog& dialog) {
                    QTest::qWait(500);  // the file is read meanwhile
                    CHECK(shown.document().design() == find_sample("plain")->make());
                    press(dialog, QDialogButtonBox::Cancel);
                });
    CHECK(until([&] { return shown.document().design() == find_sample("twill-2-2")->make(); }));
}
