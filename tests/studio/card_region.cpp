// Regions of the card, chosen and changed by mouse and keys.

#include <weave/block/card_part.hpp>
#include <weave/block/card_wish.hpp>
#include <weave/samples/samples.hpp>

#include <studio/editors/card_clipboard.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/editors/card_region.hpp>
#include <studio/window/main_window.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

#include <support/temporary_folder.hpp>
#include "support/hands.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace weave::studio {

std::ostream& operator<<(std::ostream& out, const GridRegion& region) {
    return out << region.rows << " x " << region.columns << " from " << region.first.row << ", " << region.first.column;
}

}  // namespace weave::studio

namespace {

/// A card editor in a window, with the design that it shows.
struct RegionDesk {
    explicit RegionDesk(const char* sample) : document(find_sample(sample)->make(), {}, true, folder.path) {
        editor.resize(900, 640);
        QObject::connect(&editor, &CardEditor::told, &editor, [this](const QString& words) { said = words; });
        editor.show_document(&document);
        editor.show();
        REQUIRE(QTest::qWaitForWindowExposed(&editor));
        QApplication::setActiveWindow(&editor);
        canvas.setFocus();
        settle();
    }
    void settle() {
        REQUIRE(until([&] { return document.shown_is_current(); }));
        QCoreApplication::processEvents();
    }
    [[nodiscard]] QPoint at(std::size_t row, std::size_t column) { return canvas.mapping().box({row, column}).center().toPoint(); }
    void drag(const GridCell& from, const GridCell& to) {
        QTest::mousePress(&canvas, Qt::LeftButton, {}, at(from.row, from.column));
        QTest::mouseMove(&canvas, at(to.row, to.column));
        QTest::mouseRelease(&canvas, Qt::LeftButton, {}, at(to.row, to.column));
    }
    void choose(const GridCell& from, const GridCell& to) {
        QTest::keyClick(&canvas, Qt::Key_S);
        drag(from, to);
        REQUIRE(canvas.region());
    }
    void key(int key, Qt::KeyboardModifiers modifiers = {}) { QTest::keyClick(&canvas, static_cast<Qt::Key>(key), modifiers); }
    /// Chooses an entry of the menu of the region.
    void change(const QString& entry) {
        with_menu([&] { click(editor.findChild<QToolButton*>("region-menu")); }, entry);
    }
    [[nodiscard]] int steps() const { return document.undo_stack().index(); }
    void wait_for_step(int count) {
        REQUIRE(until([&] { return steps() == count; }));
        settle();
    }
    [[nodiscard]] CardImage card() { return document.shown().block->card_image(); }

    weave::testing::TemporaryFolder folder;
    Document document;
    CardEditor editor;
    GridCanvas& canvas = editor.canvas();
    QString said;
};

/// Plain weave, which two picks and two ends in one stack cannot have.
CardImage checks(std::size_t picks, std::size_t ends) {
    CardImage part(picks, ends);
    for (std::size_t pick = 0; pick < picks; ++pick) {
        for (std::size_t end = 0; end < ends; ++end) part.set(pick, end, (pick + end) % 2 == 0);
    }
    return part;
}

/// The card with a wish made true as far as it can be.
CardImage after(const Block& block, std::size_t pick, std::size_t end, const CardImage& pixels) {
    return apply_flips(block, grant(block, {pick, end, pixels}).flips).block.card_image();
}

}  // namespace

TEST_CASE("card region: a rectangle is drawn with the tool Choose, told, and let go") {
    RegionDesk desk("sateen-8");
    click(desk.editor.findChildren<QToolButton*>()[0]);
    CHECK(desk.canvas.tool() == GridTool::choose);
    desk.canvas.setFocus();
    desk.drag({2, 1}, {6, 5});
    CHECK(desk.canvas.region() == GridRegion{{2, 1}, 5, 5});
    CHECK(desk.said.contains("picks 3–7, ends 2–6"));
    CHECK(desk.canvas.cursor_cell() == GridCell{6, 5});
    CHECK(desk.steps() == 0);
    desk.key(Qt::Key_Escape);
    CHECK_FALSE(desk.canvas.region());
    desk.drag({6, 5}, {2, 1});  // from any corner
    CHECK(desk.canvas.region() == GridRegion{{2, 1}, 5, 5});
    QTest::mouseClick(&desk.canvas, Qt::LeftButton, {}, desk.at(0, 0));
    CHECK_FALSE(desk.canvas.region());
    CHECK(desk.canvas.cursor_cell() == GridCell{0, 0});
    desk.key(Qt::Key_D);
    QTest::mouseClick(&desk.canvas, Qt::LeftButton, {}, desk.at(0, 0));
    CHECK(desk.steps() == 1);
}

TEST_CASE("card region: Shift and the arrows draw it from the cursor, Ctrl+A chooses all") {
    RegionDesk desk("sateen-8");
    desk.key(Qt::Key_S);
    desk.key(Qt::Key_Home);
    desk.key(Qt::Key_Up);
    desk.key(Qt::Key_Up, Qt::ShiftModifier);
    desk.key(Qt::Key_Right, Qt::ShiftModifier);
    desk.key(Qt::Key_Right, Qt::ShiftModifier);
    CHECK(desk.canvas.region() == GridRegion{{1, 0}, 2, 3});
    desk.key(Qt::Key_Left, Qt::ShiftModifier);
    desk.key(Qt::Key_Down, Qt::ShiftModifier);
    desk.key(Qt::Key_Down, Qt::ShiftModifier);  // over the corner at which it began
    CHECK(desk.canvas.region() == GridRegion{{0, 0}, 2, 2});
    desk.key(Qt::Key_Up);  // walks on without it
    CHECK(desk.canvas.region() == GridRegion{{0, 0}, 2, 2});
    desk.key(Qt::Key_Right, Qt::ShiftModifier);
    CHECK(desk.canvas.region() == GridRegion{{1, 1}, 1, 2});
    desk.key(Qt::Key_A, Qt::ControlModifier);
    CHECK(desk.canvas.region() == GridRegion{{0, 0}, 8, 8});
    CHECK(desk.said.contains("picks 1–8, ends 1–8"));
}

TEST_CASE("card region: a copy floats, is moved, and put down as one step without a jump of view") {
    RegionDesk desk("sateen-8");
    const CardImage before = desk.card();
    desk.canvas.zoom_by(1.1);
    desk.choose({0, 0}, {2, 3});
    desk.key(Qt::Key_C, Qt::ControlModifier);
    CHECK(desk.said.contains("3 picks × 4 ends"));
    const QRectF frame = desk.canvas.mapping().frame();
    desk.key(Qt::Key_V, Qt::ControlModifier);
    CHECK(desk.canvas.floating_region() == GridRegion{{0, 0}, 3, 4});
    desk.key(Qt::Key_Up);
    desk.key(Qt::Key_Up);
    desk.key(Qt::Key_Right);
    CHECK(desk.canvas.floating_region() == GridRegion{{2, 1}, 3, 4});
    CHECK(desk.steps() == 0);
    desk.key(Qt::Key_Return);
    desk.wait_for_step(1);
    CHECK(desk.document.undo_stack().undoText() == "Paste on picks 3–5, ends 2–5");
    CHECK(desk.canvas.region() == GridRegion{{2, 1}, 3, 4});
    CHECK(part_of(desk.card(), 2, 1, 3, 4) == part_of(before, 0, 0, 3, 4));
    desk.document.undo();
    desk.settle();
    CHECK(desk.card() == before);
    CHECK(desk.canvas.mapping().frame() == frame);
}

TEST_CASE("card region: the mouse moves what floats, a press beside it puts it down, Esc drops it") {
    RegionDesk desk("sateen-8");
    const BlockPtr block = desk.document.shown().block;
    const CardImage before = desk.card();
    desk.choose({0, 0}, {1, 2});
    desk.key(Qt::Key_D, Qt::ControlModifier);
    desk.drag({1, 1}, {5, 4});
    CHECK(desk.canvas.floating_region() == GridRegion{{4, 3}, 2, 3});
    desk.key(Qt::Key_Escape);
    CHECK_FALSE(desk.canvas.floating_region());
    desk.choose({0, 0}, {1, 2});
    desk.key(Qt::Key_D, Qt::ControlModifier);
    desk.drag({0, 0}, {7, 7});  // what has no room is not put down
    CHECK(desk.canvas.floating_region() == GridRegion{{7, 7}, 1, 1});
    desk.drag({7, 7}, {6, 5});
    CHECK(desk.canvas.floating_region() == GridRegion{{6, 5}, 2, 3});
    CHECK(desk.steps() == 0);
    QTest::mouseClick(&desk.canvas, Qt::LeftButton, {}, desk.at(2, 2));
    desk.wait_for_step(1);
    CHECK(desk.card() == after(*block, 6, 5, part_of(before, 0, 0, 2, 3)));
    CHECK_FALSE(desk.canvas.floating_region());
}

TEST_CASE("card region: Ctrl+D again puts down what floats and goes on with it") {
    RegionDesk desk("sateen-8");
    desk.choose({0, 0}, {1, 1});
    desk.key(Qt::Key_D, Qt::ControlModifier);
    desk.key(Qt::Key_Up, Qt::ShiftModifier);
    REQUIRE(desk.canvas.floating_region() == GridRegion{{7, 0}, 1, 2});
    desk.key(Qt::Key_Down);
    desk.key(Qt::Key_D, Qt::ControlModifier);
    desk.key(Qt::Key_Down);
    desk.key(Qt::Key_Down);
    desk.key(Qt::Key_Return);
    desk.wait_for_step(2);
    const CardImage card = desk.card();
    CHECK(part_of(card, 6, 0, 2, 2) == part_of(card, 0, 0, 2, 2));
    CHECK(part_of(card, 4, 0, 2, 2) == part_of(card, 0, 0, 2, 2));
}

TEST_CASE("card region: a copy goes to another design, and as a picture to other programs") {
    RegionDesk first("sateen-8");
    first.choose({1, 2}, {3, 6});
    first.key(Qt::Key_C, Qt::ControlModifier);
    const CardImage part = part_of(first.card(), 1, 2, 3, 5);
    CHECK(part_on_clipboard().value() == part);
    const QImage seen = QGuiApplication::clipboard()->image();
    REQUIRE(seen.size() == QSize(5, 3));
    for (int pick = 0; pick < 3; ++pick) {
        for (int end = 0; end < 5; ++end)
            CHECK((qGray(seen.pixel(end, 2 - pick)) > 128) == part.weft_over(static_cast<std::size_t>(pick), static_cast<std::size_t>(end)));
    }
    RegionDesk other("basket");
    QTest::mouseClick(&other.canvas, Qt::LeftButton, Qt::ControlModifier, other.at(1, 0));
    other.key(Qt::Key_V, Qt::ControlModifier);
    CHECK(other.canvas.floating_region() == GridRegion{{1, 0}, 3, 4});  // as much as there is room for
    other.key(Qt::Key_Return);
    other.wait_for_step(1);
    CHECK(part_of(other.card(), 1, 0, 3, 4) == part_of(part, 0, 0, 3, 4));
}

TEST_CASE("card region: all, none, inverted, mirrored, filled with what was copied") {
    RegionDesk desk("sateen-8");
    const CardImage before = desk.card();
    desk.choose({0, 0}, {1, 2});
    desk.key(Qt::Key_C, Qt::ControlModifier);
    desk.choose({1, 1}, {5, 7});
    const CardImage part = part_of(before, 1, 1, 5, 7);
    const std::pair<QString, CardImage> changes[] = {{"Lift all ends", one_sided(5, 7, false)}, {"Lift no end", one_sided(5, 7, true)}, {"Invert", inverted(part)},
                                                     {"Mirror left and right", mirrored_across(part)}, {"Mirror top and bottom", mirrored_along(part)},
                                                     {"Fill with what was copied", part_of(part_of(before, 0, 0, 2, 3), 0, 0, 5, 7)}};
    for (const auto& [entry, wish] : changes) {
        INFO(entry.toStdString());
        desk.change(entry);
        desk.wait_for_step(1);
        CHECK(part_of(desk.card(), 1, 1, 5, 7) == wish);
        desk.document.undo();
        desk.settle();
        CHECK(desk.card() == before);
    }
}

TEST_CASE("card region: what is asked for at once is done one after the other") {
    RegionDesk desk("sateen-8");
    desk.choose({0, 0}, {7, 3});
    for (const char* each : {"lift-all", "invert"}) desk.editor.findChild<QAction*>(each)->trigger();
    desk.wait_for_step(2);
    CHECK(part_of(desk.card(), 0, 0, 8, 4) == one_sided(8, 4, true));
}

TEST_CASE("card region: in several layers it changes what can be, marks and tells the rest, in one step") {
    RegionDesk desk("pocket");
    const BlockPtr block = desk.document.shown().block;
    const CardImage before = block->card_image(), wish = checks(12, 10);
    const GrantedWish granted = grant(*block, {21, 5, wish});
    REQUIRE_FALSE(granted.refused.empty());
    REQUIRE_FALSE(granted.flips.empty());
    REQUIRE(put_on_clipboard(checks(2, 2)));
    desk.choose({21, 5}, {32, 14});
    desk.change("Fill with what was copied");
    desk.wait_for_step(1);
    CHECK(desk.card() == after(*block, 21, 5, wish));
    REQUIRE(desk.canvas.refused().size() == granted.refused.size());
    CHECK(desk.canvas.refused().front() == GridCell{granted.refused[0].pick, granted.refused[0].end});
    CHECK(desk.said.startsWith(QString("%1 of %2 crossings stay as they are").arg(granted.refused.size()).arg(granted.refused.size() + granted.flips.size())));
    CHECK(desk.said.toStdString().find(granted.reason) != std::string::npos);
    CHECK(desk.document.shown().lost_flips.empty());
    desk.document.undo();
    desk.settle();
    CHECK(desk.card() == before);
    desk.document.redo();
    desk.settle();
    CHECK(desk.card() == after(*block, 21, 5, wish));
    QToolTip::hideText();
}

TEST_CASE("card region: what floats shows beforehand where it cannot be") {
    RegionDesk desk("pocket");
    const BlockPtr block = desk.document.shown().block;
    REQUIRE(put_on_clipboard(checks(6, 6)));
    desk.choose({21, 5}, {21, 6});
    desk.key(Qt::Key_V, Qt::ControlModifier);
    const auto refused_at = [&](std::size_t pick, std::size_t end) {
        std::vector<GridCell> cells;
        for (const Flip& one : grant(*block, {pick, end, checks(6, 6)}).refused) cells.push_back({one.pick, one.end});
        return cells;
    };
    REQUIRE_FALSE(refused_at(21, 5).empty());
    REQUIRE(refused_at(21, 5) != refused_at(23, 5));
    CHECK(until([&] { return desk.canvas.floating_refused() == refused_at(21, 5); }));
    desk.key(Qt::Key_Up);
    desk.key(Qt::Key_Up);
    CHECK(until([&] { return desk.canvas.floating_refused() == refused_at(23, 5); }));
    CHECK(until([&] { return desk.said.contains(QString("%1 cannot").arg(refused_at(23, 5).size())); }));
    CHECK(desk.steps() == 0);
}

TEST_CASE("card region: over the seam of two repeats it goes on at the first pick and end") {
    RegionDesk desk("sateen-8");
    for (QSpinBox* box : desk.editor.findChildren<QSpinBox*>()) box->setValue(2);
    QCoreApplication::processEvents();
    const CardImage before = desk.card();
    desk.choose({6, 7}, {9, 15});
    CHECK(desk.canvas.region() == GridRegion{{6, 7}, 4, 8});  // no more than a repeat
    CHECK(desk.said.contains("picks 7–2, ends 8–7"));
    desk.change("Mirror top and bottom");
    desk.wait_for_step(1);
    CHECK(part_of(desk.card(), 6, 7, 4, 8) == mirrored_along(part_of(before, 6, 7, 4, 8)));
}

TEST_CASE("card region: where a square is no crossing nothing is chosen, and the tool says why") {
    RegionDesk desk("pocket");
    desk.choose({2, 2}, {5, 5});
    QAction* choose = desk.editor.findChild<QAction*>("choose-tool");
    CHECK(choose->isEnabled());
    for (const CardMode mode : {CardMode::layer, CardMode::face, CardMode::back_floats}) {
        desk.editor.show_mode(mode);
        REQUIRE(until([&] { return desk.canvas.mapping().rows() == desk.document.shown().block->rows(); }));
        CHECK_FALSE(desk.canvas.region());
        CHECK_FALSE(choose->isEnabled());
        CHECK(choose->toolTip().contains("only there is a square one crossing"));
        desk.key(Qt::Key_S);
        desk.key(Qt::Key_A, Qt::ControlModifier);
        desk.drag({1, 1}, {3, 3});
        CHECK_FALSE(desk.canvas.region());
        desk.editor.show_mode(CardMode::card);
        CHECK(choose->isEnabled());
        CHECK_FALSE(choose->toolTip().contains("only there"));
    }
}

TEST_CASE("card region: of a full-size shoe a part is changed, the whole is refused with a reason") {
    RegionDesk desk("shoe-adult");
    const BlockPtr block = desk.document.shown().block;
    desk.key(Qt::Key_A, Qt::ControlModifier);
    REQUIRE(desk.canvas.region()->rows == block->picks());
    desk.editor.findChild<QAction*>("lift-all")->trigger();
    CHECK(desk.said.contains("too many at once"));
    desk.key(Qt::Key_C, Qt::ControlModifier);
    CHECK(desk.said.contains("too many at once"));
    CHECK(desk.steps() == 0);
    desk.drag({1000, 1000}, {1400, 1600});
    const GridRegion region = *desk.canvas.region();
    REQUIRE(region.rows * region.columns > 10000);
    desk.editor.findChild<QAction*>("lift-none")->trigger();
    desk.wait_for_step(1);
    CHECK(desk.card() == after(*block, region.first.row, region.first.column, one_sided(region.rows, region.columns, true)));
    QToolTip::hideText();
}

TEST_CASE("card region: the keys of the clipboard act on it where it is chosen on the card, else on blocks") {
    MainWindow window;
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
    QApplication::setActiveWindow(&window);
    window.show_sample("sateen-8");
    Document& document = *window.document();
    REQUIRE(until([&] { return document.shown_is_current() && document.shown().card; }));
    window.findChild<QTabWidget*>("editors")->setCurrentIndex(0);
    auto& canvas = *window.findChild<GridCanvas*>("card");
    canvas.setFocus();
    REQUIRE(until([&] { return canvas.hasFocus(); }));
    const std::size_t blocks = document.design().blocks.size();
    QTest::keyClick(&canvas, Qt::Key_C, Qt::ControlModifier);
    CHECK(QGuiApplication::clipboard()->mimeData()->hasFormat("application/x-weave-design"));
    QTest::keyClick(&canvas, Qt::Key_V, Qt::ControlModifier);
    CHECK(document.design().blocks.size() == blocks + 1);
    document.undo();
    REQUIRE(until([&] { return document.shown_is_current() && document.shown().card; }));
    QCoreApplication::processEvents();

    QTest::keyClick(&canvas, Qt::Key_A, Qt::ControlModifier);
    REQUIRE(canvas.region());
    QTest::keyClick(&canvas, Qt::Key_X, Qt::ControlModifier);
    CHECK(document.design().blocks.size() == blocks);
    CHECK_FALSE(clipboard_has_part());
    QTest::keyClick(&canvas, Qt::Key_C, Qt::ControlModifier);
    CHECK(clipboard_has_part());
    QTest::keyClick(&canvas, Qt::Key_V, Qt::ControlModifier);
    CHECK(canvas.floating_region());
    QTest::keyClick(&canvas, Qt::Key_Escape);
    QTest::keyClick(&canvas, Qt::Key_A, Qt::ControlModifier);
    QTest::keyClick(&canvas, Qt::Key_D, Qt::ControlModifier);
    CHECK(canvas.floating_region());
    QTest::keyClick(&canvas, Qt::Key_Escape);
    CHECK(document.design().blocks.size() == blocks);
    CHECK(document.undo_stack().index() == 0);
    QTest::keyClick(&canvas, Qt::Key_D, Qt::ControlModifier);  // nothing is chosen any more
    CHECK(document.design().blocks.size() == blocks + 1);
}
