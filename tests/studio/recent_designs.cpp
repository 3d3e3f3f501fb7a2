// What is found again when the studio or a design is opened anew.

#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/samples/samples.hpp>

#include <studio/editors/card_editor.hpp>
#include <studio/panels/design_tree.hpp>
#include <studio/panels/yarns_panel.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/recent_designs.hpp>
#include <studio/window/start_page.hpp>

#include <support/temporary_folder.hpp>
#include "support/desk.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

/// A twill, and the cloth that repeats it.
Design repeated_twill() {
    Design design;
    design.root = "cloth";
    design.blocks["twill"] = std::make_shared<const Node>(Node{PresetLeaf{{"twill", {{"up", 2}, {"down", 2}}}}, {}});
    design.blocks["cloth"] = std::make_shared<const Node>(Node{TileOperation{"twill", 3, 3, 1}, {}});
    return design;
}

QString saved_in(const weave::testing::TemporaryFolder& folder, const char* name) {
    const std::filesystem::path path = folder.path / name;
    REQUIRE(save_design(repeated_twill(), path));
    return QString::fromStdString(path.string());
}

void open(Desk& desk, const QString& path) {
    desk.window.open_file(path);
    REQUIRE(until([&] { return desk.window.document() != nullptr && desk.document().path() == path; }));
    desk.settle();
    auto& viewer = desk.find<ViewerPanel>();
    viewer.viewport()->set_animated(false);
    REQUIRE(until([&] { return viewer.viewport()->model() != nullptr; }));
}

QComboBox& list_called(QWidget& parent, const QString& name) {
    for (QComboBox* box : parent.findChildren<QComboBox*>()) {
        if (box->accessibleName() == name) return *box;
    }
    FAIL("no list " << name.toStdString());
    return *parent.findChild<QComboBox*>();
}

QListWidget& recent(Desk& desk) {
    return desk.find<QListWidget>("recent");
}

/// The text of the entry for a file, once it was looked for.
QString entry_of(Desk& desk, const QString& path) {
    for (int k = 0; k < recent(desk).count(); ++k) {
        if (recent(desk).item(k)->data(Qt::UserRole).toString() == path) return recent(desk).item(k)->text();
    }
    return {};
}

bool has_picture(const QListWidgetItem& item) {
    const QImage image = item.icon().pixmap(40).toImage();
    return image.pixelColor(image.rect().center()).alpha() > 0;
}

}  // namespace

TEST_CASE("recent: a design is looked at as it was when it was closed, and is no other for it") {
    const weave::testing::TemporaryFolder folder;
    const QString path = saved_in(folder, "seen.weave");
    const std::string bytes = read_file(path.toStdString()).value();
    Json seen;
    {
        Desk desk;
        open(desk, path);
        auto& viewer = desk.find<ViewerPanel>();
        const Json fresh = viewer.state();
        click_item(desk.find<DesignTree>(), "twill");
        desk.settle();
        REQUIRE(until([&] { return viewer.viewport()->shown_box().size().x() < 6; }));
        desk.document().focus().go_to({2, 1});
        QTest::keyClick(viewer.viewport(), Qt::Key_3);
        choose_entry(&list_called(viewer, "Cut"), "Cut across the picks");
        choose_entry(&list_called(viewer, "Colour by"), "Warp and weft");
        QTest::keyClick(viewer.viewport(), Qt::Key_L);
        seen = viewer.state();
        CHECK(seen["camera"] != fresh["camera"]);
        CHECK(seen["cut"] != fresh["cut"]);
        CHECK(seen["locked"] == true);
        CHECK_FALSE(desk.document().is_modified());
        REQUIRE(desk.window.close());
    }
    Desk desk;
    open(desk, path);
    auto& viewer = desk.find<ViewerPanel>();
    CHECK(until([&] { return viewer.state() == seen; }));
    CHECK(viewer.state().dump() == seen.dump());
    CHECK(desk.document().shown_block() == "twill");
    REQUIRE(desk.document().focus().place());
    CHECK(desk.document().focus().place()->pick == 2);
    CHECK(desk.document().focus().place()->end == 1);
    CHECK_FALSE(desk.document().is_modified());
    CHECK(desk.document().undo_stack().count() == 0);
    CHECK(read_file(path.toStdString()).value() == bytes);
    // A design that nobody has looked at is not looked at as this one was.
    desk.window.show_sample("twill-2-2");
    CHECK_FALSE(viewer.viewport()->is_locked());
    CHECK(viewer.state()["cut"]["across"] == "none");
}

TEST_CASE("recent: docks, their sizes and the corner of pick 1 are found again") {
    int wide = 0;
    {
        Desk desk("twill-2-2");
        desk.window.resize(1900, 1100);
        QCoreApplication::processEvents();
        const int before = desk.find<QTabWidget>("editors").width();
        desk.find<QDockWidget>("findings-dock").close();
        desk.find<QDockWidget>("yarns-dock").raise();
        auto* work = desk.find<QTabWidget>("editors").parentWidget();
        auto& handle = *qobject_cast<QSplitter*>(work)->handle(1);
        const QPoint grip = handle.rect().center();
        QTest::mousePress(&handle, Qt::LeftButton, {}, grip);
        QTest::mouseMove(&handle, grip + QPoint(60, 0));
        QTest::mouseRelease(&handle, Qt::LeftButton, {}, grip + QPoint(60, 0));
        wide = desk.find<QTabWidget>("editors").width();
        CHECK(wide > before + 30);
        choose(desk.window, {"View", "Corner of pick 1 and end 1", "Top left"});
        REQUIRE(desk.window.close());
    }
    {
        Desk desk("twill-2-2");
        CHECK_FALSE(desk.find<QDockWidget>("findings-dock").isVisible());
        CHECK(until([&] { return desk.find<YarnsPanel>().isVisible(); }));
        CHECK(until([&] { return std::abs(desk.find<QTabWidget>("editors").width() - wide) < 12; }));
        CHECK(desk.find<CardEditor>().canvas().mapping().corner() == Corner::top_left);
        choose(desk.window, {"File", "New"});
        CHECK_FALSE(desk.find<QDockWidget>("blocks-dock").isVisible());
        desk.window.show_sample("twill-2-2");
        CHECK(desk.find<QDockWidget>("blocks-dock").isVisible());
        CHECK_FALSE(desk.find<QDockWidget>("findings-dock").isVisible());
    }
    for (const char* name : {"window", "work", "places", "corner"}) QSettings().setValue(name, QByteArray("no such thing"));
    Desk desk("twill-2-2");
    CHECK(desk.find<QDockWidget>("findings-dock").isVisible());
    CHECK(desk.find<CardEditor>().canvas().mapping().corner() == Corner::bottom_left);
}

TEST_CASE("recent: a view that cannot be read is left out") {
    const weave::testing::TemporaryFolder folder;
    const QString path = saved_in(folder, "odd.weave");
    recent_designs::note(path);
    const char* odd = GENERATE(R"({"block":"gone"})", R"({"block":"twill","place":[-1,"x"],"seen":{"camera":{"height_mm":-3}}})",
                               R"({"block":"twill","place":[900,900],"seen":7})", "[]", R"({"block":"cloth","seen":{"cut":{"across":"the sea","at":[]},"repeat":[1e9,-4]}})");
    INFO(odd);
    recent_designs::keep_view(path, parse_json(odd).value());
    Desk desk;
    open(desk, path);
    CHECK(desk.find<ViewerPanel>().viewport()->model() != nullptr);
    CHECK(desk.said().isEmpty());
}

TEST_CASE("recent: a design is in the list once it is saved, with its picture") {
    const weave::testing::TemporaryFolder folder;
    const QString path = saved_in(folder, "kept.weave"), nowhere = QString::fromStdString((folder.path / "no/such/folder/lost.weave").string());
    recent_designs::forget(path);
    Desk desk("twill-2-2");
    desk.document().save(nowhere);
    REQUIRE(until([&] { return !desk.document().is_saving(); }));
    desk.document().save(path, Keeper::Overwrite::anything);
    REQUIRE(until([&] { return !desk.document().is_saving(); }));
    CHECK_FALSE(recent_designs::paths().contains(nowhere));
    CHECK(recent_designs::paths().contains(path));
    REQUIRE(until([&] { return !recent_designs::picture(path).isNull(); }));
    choose(desk.window, {"File", "New"});
    REQUIRE(recent(desk).count() > 0);
    CHECK(entry_of(desk, path).startsWith("kept\n"));
    CHECK(until([&] { return has_picture(*recent(desk).item(0)); }));
    // What is not in the list leaves no picture behind.
    const QImage picture = recent_designs::picture(path);
    recent_designs::keep_picture(nowhere, picture);
    CHECK(recent_designs::picture(nowhere).isNull());
    recent_designs::forget(path);
    CHECK(recent_designs::picture(path).isNull());
}

TEST_CASE("recent: a file that is gone is missing, and leaves the list when one says so") {
    const weave::testing::TemporaryFolder folder;
    const QString path = saved_in(folder, "gone.weave"), other = saved_in(folder, "there.weave");
    recent_designs::note(other);
    recent_designs::note(path);
    std::filesystem::remove(path.toStdString());
    Desk desk;
    REQUIRE(until([&] { return entry_of(desk, path).startsWith("gone (missing)"); }));
    CHECK(entry_of(desk, other).startsWith("there\n"));
    QListWidget& list = recent(desk);
    REQUIRE(list.item(0)->data(Qt::UserRole).toString() == path);
    with_menu([&] { QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(list.item(0)).center()); }, "Remove from the list");
    CHECK(until([&] { return entry_of(desk, path).isEmpty(); }));
    CHECK_FALSE(recent_designs::paths().contains(path));
    CHECK(recent_designs::paths().contains(other));
}
