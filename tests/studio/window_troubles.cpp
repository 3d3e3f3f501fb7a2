// The main window where something goes another way: Esc, a crash, files that cannot be opened, edits that are refused.

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/samples/samples.hpp>

#include <studio/commands/flip_crossing.hpp>
#include <studio/commands/tile_block.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/editors/slice_editor.hpp>
#include <studio/editors/stencil_dialogs.hpp>
#include <studio/editors/stencil_editor.hpp>
#include <studio/panels/design_tree.hpp>
#include <studio/panels/findings_panel.hpp>
#include <studio/panels/message_bar.hpp>
#include <studio/panels/order_text.hpp>
#include <studio/panels/rule_fixes.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/panels/yarns_panel.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/block_actions.hpp>
#include <studio/window/help_window.hpp>
#include <studio/window/main_window.hpp>
#include <studio/window/tutorial.hpp>
#include <studio/window/viewer_desk.hpp>
#include <studio/window/windows.hpp>

#include <QCommandLinkButton>
#include <QDialog>
#include <QSpinBox>
#include <QTreeWidgetItemIterator>
#include <QtTest>

#include <catch2/catch.hpp>

#include <support/temporary_folder.hpp>
#include "support/desk.hpp"
#include "support/hands.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

TEST_CASE("Esc ends Attach wherever the click left the keys and another block ends it too") {
    Desk shown("pocket");
    auto& viewer = shown.find<ViewerPanel>();
    QAction* attach = viewer.menu_actions()[1];
    for (QAction* other : shown.window.findChildren<QAction*>()) {  // of the menu and the tool bar of the window
        if (other == attach || !other->isCheckable() || !other->text().contains("ttach")) continue;
        shown.find<DesignTree>().setFocus();
        other->trigger();
        REQUIRE(viewer.viewport()->attach_mode());
        QTest::keyClick(shown.window.focusWidget(), Qt::Key_Escape);
        CHECK_FALSE(viewer.viewport()->attach_mode());
    }
    shown.find<DesignTree>().setFocus();
    attach->trigger();
    REQUIRE(viewer.viewport()->attach_mode());
    QTest::keyClick(shown.window.focusWidget(), Qt::Key_Escape);
    CHECK_FALSE(viewer.viewport()->attach_mode());
    CHECK_FALSE(attach->isChecked());
    attach->trigger();
    REQUIRE(viewer.viewport()->attach_mode());
    const std::string root = shown.document().design().root;
    for (const auto& [name, node] : shown.document().design().blocks)
        if (name != root) shown.document().focus().show_block(name);
    CHECK_FALSE(viewer.viewport()->attach_mode());
    attach->trigger();
    shown.window.show_sample("plain");
    CHECK_FALSE(viewer.viewport()->attach_mode());
}

TEST_CASE("every block of recovered work gets its picture") {
    for (int time = 0; time < 3; ++time) {
        const weave::testing::TemporaryFolder folder, copy;
        {
            Document left(find_sample("three-colour-stencil")->make(), {}, false, folder.path);
            REQUIRE(left.perform({"title", {SetTitle{"unsaved", ""}}}));
            left.undo();
            left.redo();
            for (int k = 0; k < 3000; ++k) REQUIRE(left.perform({"title", {SetTitle{"unsaved " + std::to_string(k), ""}}}));  // done again, they take longer than pictures
            left.keeper().flush();
            std::filesystem::copy(folder.path, copy.path, std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
            left.discard();
        }
        Windows windows;
        windows.open({});
        windows.recover(copy.path);
        MainWindow& window = *windows.all().front();
        REQUIRE(until([&] { return window.document() != nullptr; }));
        for (const auto& [name, node] : window.document()->design().blocks) {
            INFO(name);
            CHECK(until([&] { return !window.document()->thumbnail_of(name).isNull(); }));
        }
        const auto& tree = *window.findChild<DesignTree*>();
        for (QTreeWidgetItemIterator item(const_cast<DesignTree*>(&tree)); *item != nullptr; ++item) CHECK_FALSE((*item)->icon(0).isNull());
        window.document()->discard();
    }
}

TEST_CASE("files that cannot be opened are told in one window and the others have each their own") {
    const weave::testing::TemporaryFolder folder;
    const auto file = [&](const char* name, const std::string& bytes) {
        REQUIRE(write_file(folder.path / name, bytes));
        return QString::fromStdString((folder.path / name).string());
    };
    Windows windows;
    windows.open({file("a.weave", "{"), file("b.weave", write_document(find_sample("plain")->make())), file("c.weave", "no design"), "/nowhere/d.weave"});
    CHECK(windows.all().size() == 4);
    REQUIRE(until([&] { return windows.all().size() == 2; }));
    std::vector<QString> said;
    for (const auto& window : windows.all()) {
        REQUIRE(until([&] { return window->document() != nullptr || !window->findChild<MessageBar*>("messages")->words().isEmpty(); }));
        if (window->document() == nullptr) said.push_back(window->findChild<MessageBar*>("messages")->words());
    }
    REQUIRE(said.size() == 1);
    CHECK(said[0].count('\n') == 2);
    for (const char* name : {"a.weave", "c.weave", "d.weave"}) CHECK(said[0].contains(name));
    for (const auto& window : windows.all())
        if (window->document() != nullptr) window->document()->discard();
}

TEST_CASE("why an edit is refused is said until one is made and names no block that there is not") {
    Desk shown("twill-2-2");
    const auto repeat = [&](int along, int across, int high) {
        QTimer::singleShot(0, [=] {
            auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
            REQUIRE(dialog != nullptr);
            dialog->findChild<QSpinBox*>("along")->setValue(along);
            dialog->findChild<QSpinBox*>("across")->setValue(across);
            dialog->findChild<QSpinBox*>("high")->setValue(high);
            dialog->accept();
        });
        shown.document().findChild<BlockActions*>()->repeat(shown.document().shown_block());
    };
    const std::size_t blocks = shown.document().design().blocks.size();
    repeat(100000, 100000, 1000);
    CHECK_FALSE(shown.said().isEmpty());
    CHECK_FALSE(shown.said().contains("blocks."));
    CHECK(shown.document().design().blocks.size() == blocks);
    repeat(2, 2, 1);
    CHECK(shown.document().design().blocks.size() == blocks + 1);
    CHECK(shown.said().isEmpty());
    shown.window.warn("the disk is full");
    repeat(2, 1, 1);
    CHECK(shown.said() == "the disk is full");  // which no edit mends
}
