#include "slice_case.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

/// Draws a path from the left over the dot of one position and under all others; all dots lie at one level.
void draw_over(OpenSliceEditor& open, std::size_t over, std::size_t positions) {
    const auto dot = static_cast<double>(level_of(open.slice(), SliceYarnId::dot(0, 0), 0).value());
    std::vector<QPoint> places;
    for (std::size_t k = 0; k < positions; ++k)
        places.push_back(open.canvas().place_of(k, dot + (k == over ? 1.0 : -1.0)));
    open.drag(places);
}

}  // namespace

TEST_CASE("slice: a 5-end satin is drawn by mouse, from nothing") {
    OpenSliceEditor open;
    REQUIRE(open.editor.findChild<QPushButton*>("begin")->isVisible());
    QTest::mouseClick(open.editor.findChild<QPushButton*>("begin"), Qt::LeftButton);
    REQUIRE(open.edits.size() == 1);
    REQUIRE_FALSE(open.editor.findChild<QPushButton*>("begin")->isVisible());
    open.key(Qt::Key_F);
    // The path that is there already is led over its dot, the others are drawn anew.
    QTest::mouseMove(&open.canvas(), open.canvas().place_of(2, 0));
    const QPoint up = open.canvas().place_of(0, 2), down = open.canvas().place_of(1, 0);
    open.drag({open.canvas().place_of(0, 0), up, down});
    REQUIRE(card_of(open.slice()) == Rows{"#", ".", ".", ".", "."});
    open.key(Qt::Key_A);
    REQUIRE(open.canvas().tool() == SliceTool::add_path);
    for (const std::size_t over : {2U, 4U, 1U, 3U}) draw_over(open, over, 5);
    REQUIRE(open.edits.size() == 6);
    REQUIRE(card_of(open.slice()) == Rows{"#....", "...#.", ".#...", "....#", "..#.."});
    REQUIRE(card_of(open.edits.back()) == card_of(open.slice()));
    REQUIRE(open.last_name() == "Add a warp");
}

TEST_CASE("slice: a path is routed through the gaps that the pointer passes, and previewed meanwhile") {
    OpenSliceEditor open(slice_of(System::weft, {"P0 T0 T1", "P0 T0 T1", "P0 T0 T1", "P0 T0 T1"}));
    SliceEditCanvas& canvas = open.canvas();
    QTest::mousePress(&canvas, Qt::LeftButton, Qt::NoModifier, canvas.place_of(0, 0));
    for (const QPoint place : {canvas.place_of(1, 1.5), canvas.place_of(2, 2.8)}) {
        QMouseEvent move(QEvent::MouseMove, place, canvas.mapToGlobal(place), Qt::NoButton, Qt::LeftButton,
                         Qt::NoModifier);
        QApplication::sendEvent(&canvas, &move);
    }
    REQUIRE(canvas.marks().preview.has_value());
    REQUIRE(canvas.marks().preview->levels[1] > 1);
    REQUIRE(canvas.marks().preview->levels[1] < 2);
    REQUIRE(canvas.marks().preview->levels[3] == 0);
    REQUIRE(open.edits.empty());
    QTest::mouseRelease(&canvas, Qt::LeftButton, Qt::NoModifier, canvas.place_of(2, 2.8));
    REQUIRE_FALSE(canvas.marks().preview.has_value());
    REQUIRE(open.edits.size() == 1);
    REQUIRE(open.names[0] == "Draw warp 1");
    std::vector<std::size_t> gaps;
    for (std::size_t k = 0; k < 4; ++k) gaps.push_back(gap_of(open.slice(), 0, k));
    REQUIRE(gaps == std::vector<std::size_t>{0, 1, 2, 0});
    REQUIRE(card_of(open.slice()) == Rows{".", ".", "#", ".", "#", "#", ".", "."});
    // A fast pointer leaves no position out.
    open.drag({canvas.place_of(0, double(level_of(open.slice(), SliceYarnId::run(0), 0).value())),
               canvas.place_of(3, 30)});
    for (std::size_t k = 1; k < 4; ++k) REQUIRE(gap_of(open.slice(), 0, k) == 2);
}

TEST_CASE("slice: Escape gives up a path that is being drawn") {
    OpenSliceEditor open(slice_of(System::weft, {"P0 T0", "P0 T0"}));
    SliceEditCanvas& canvas = open.canvas();
    QTest::mousePress(&canvas, Qt::LeftButton, Qt::NoModifier, canvas.place_of(0, 0));
    QMouseEvent move(QEvent::MouseMove, canvas.place_of(1, 3), canvas.mapToGlobal(canvas.place_of(1, 3)),
                     Qt::NoButton, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(&canvas, &move);
    REQUIRE(canvas.marks().preview.has_value());
    open.key(Qt::Key_Escape);
    REQUIRE_FALSE(canvas.marks().preview.has_value());
    QTest::mouseRelease(&canvas, Qt::LeftButton, Qt::NoModifier, canvas.place_of(1, 3));
    REQUIRE(open.edits.empty());
}

TEST_CASE("slice: wefts are chosen, disabled, renumbered, duplicated, moved and removed by keys") {
    OpenSliceEditor open(slice_of(System::weft, {"T0 P0 T1", "P0 T0 T1"}));
    open.key(Qt::Key_S);
    open.click(1, 2);
    REQUIRE(open.canvas().marks().selected == std::set{SliceYarnId::dot(1, 1)});
    REQUIRE(open.status == "weft 2 of position 2: pick 4 on the loom");
    open.key(Qt::Key_E);
    REQUIRE(open.last_name() == "Disable weft 2 of position 2");
    REQUIRE(card_of(open.slice()) == Rows{"#", ".", "."});
    REQUIRE(open.status == "weft 2 of position 2: disabled, not woven");
    open.key(Qt::Key_E);
    REQUIRE(card_of(open.slice()) == Rows{"#", ".", ".", "."});
    open.click(0, 0);
    open.key(Qt::Key_Right, Qt::ControlModifier);
    REQUIRE(card_of(open.slice()) == Rows{".", "#", ".", "."});
    REQUIRE(open.status == "weft 2 of position 1: pick 2 on the loom");
    open.key(Qt::Key_Right, Qt::ControlModifier);
    REQUIRE(open.bubble() == "Weft 2 of position 1 is the last of its position on the loom already");
    open.key(Qt::Key_Up);  // over the path
    REQUIRE(card_of(open.slice()) == Rows{".", ".", ".", "."});
    open.key(Qt::Key_D, Qt::ControlModifier);
    REQUIRE(dots_at(open.slice(), 0) == 3);
    open.key(Qt::Key_Right);
    REQUIRE(dots_at(open.slice(), 0) == 2);
    REQUIRE(dots_at(open.slice(), 1) == 3);
    open.key(Qt::Key_Delete);
    REQUIRE(dots_at(open.slice(), 1) == 2);
    const std::size_t before = open.edits.size();
    open.key(Qt::Key_Delete);
    REQUIRE(open.edits.size() == before);
    REQUIRE(open.bubble() == "No yarn is chosen; click on one first");
}

TEST_CASE("slice: several yarns are chosen with Shift, and go together; not all can") {
    OpenSliceEditor open(slice_of(System::weft, {"T0 P0", "P0 T0", "P0 T0"}));
    open.key(Qt::Key_S);
    open.click(0, 0);
    open.click(1, 1, Qt::ShiftModifier);
    REQUIRE(open.canvas().marks().selected.size() == 2);
    open.key(Qt::Key_Delete);
    REQUIRE(open.names == std::vector<QString>{"Remove 2 yarns"});
    REQUIRE(card_of(open.slice()) == Rows{"."});
    open.click(2, 1);
    open.key(Qt::Key_Delete);
    REQUIRE(open.edits.size() == 1);
    REQUIRE(open.bubble() ==
            "Weft 1 of position 3 cannot be removed: no weft would be woven any more; a slice needs at least "
            "one pick");
    REQUIRE(open.status == open.bubble());
    open.click(0, 1);  // the only path
    open.key(Qt::Key_E);
    REQUIRE(open.bubble().contains("only wefts can be disabled"));
}

TEST_CASE("slice: all of it can be done without a mouse") {
    OpenSliceEditor open(new_slice(System::weft, 3).value());
    open.canvas().setFocus();
    open.key(Qt::Key_P);  // the last yarn is the path
    REQUIRE(open.canvas().marks().selected == std::set{SliceYarnId::run(0)});
    open.key(Qt::Key_Left);
    open.key(Qt::Key_Left);
    open.key(Qt::Key_Right);
    open.key(Qt::Key_Up);
    REQUIRE(card_of(open.slice()) == Rows{".", "#", "."});
    open.key(Qt::Key_Insert);
    REQUIRE(card_of(open.slice()) == Rows{"..", "##", ".."});
    open.key(Qt::Key_Down);
    REQUIRE(card_of(open.slice()) == Rows{"..", "#.", ".."});
    open.key(Qt::Key_Down);
    REQUIRE(open.bubble() == "Warp 2 runs below every weft of position 2 already");
    open.key(Qt::Key_Insert, Qt::ShiftModifier);
    REQUIRE(open.slice().positions.size() == 4);
    open.key(Qt::Key_Delete, Qt::ShiftModifier);
    REQUIRE(open.slice().positions.size() == 3);
}

TEST_CASE("slice: a click adds a weft where it is wanted; beside the slice it says why not") {
    OpenSliceEditor open(slice_of(System::weft, {"T0 P0", "P0 T0"}));
    open.key(Qt::Key_W);
    open.click(0, 2);
    REQUIRE(card_of(open.slice()) == Rows{"#", ".", "."});
    QTest::mouseClick(&open.canvas(), Qt::LeftButton, Qt::NoModifier, open.canvas().place_of(2, 0));
    REQUIRE(open.bubble().startsWith("Here is no position"));
    REQUIRE(open.edits.size() == 1);
}

TEST_CASE("slice: in a weft slice the wefts run along, and one is disabled as a whole") {
    OpenSliceEditor open(slice_of(System::warp, {"T0 P0 T1", "P0 T0 T1"}));
    open.key(Qt::Key_S);
    open.click(1, 2);
    REQUIRE(open.status.startsWith("weft 2: pick 2 on the loom"));
    open.key(Qt::Key_E);
    REQUIRE(open.last_name() == "Disable weft 2");
    REQUIRE(card_of(open.slice()) == Rows{"#."});
    REQUIRE(open.canvas().action("add_path")->text() == "Add weft");
}

TEST_CASE("slice: in wraparound the turns of the weft are shown") {
    OpenSliceEditor open(slice_of(System::warp, {"T0 P0 T1", "T0 T1 P0", "T0 P0 T1"}));
    REQUIRE(open.canvas().scene().turns.empty());
    Design design;
    design.scene.weft_mode = WeftMode::wraparound;
    open.editor.set_design(design);
    REQUIRE_FALSE(open.canvas().scene().turns.empty());
    for (const ScenePath& path : open.canvas().scene().paths) REQUIRE(path.levels.size() == 3);
}

TEST_CASE("slice: shown again after undo, the view does not jump and what is left stays chosen") {
    const Slice first = slice_of(System::weft, {"T0 P0 T1", "P0 T0 T1"});
    OpenSliceEditor open(first);
    open.key(Qt::Key_S);
    open.key(Qt::Key_Plus);
    open.click(0, 0);
    open.click(1, 2, Qt::ShiftModifier);
    const QPoint before = open.canvas().place_of(0, 0);
    open.editor.show_slice(remove_yarns(first, std::vector{SliceYarnId::dot(1, 1)}).value());
    REQUIRE(open.canvas().place_of(0, 0) == before);
    REQUIRE(open.canvas().marks().selected == std::set{SliceYarnId::dot(0, 0)});
}

TEST_CASE("slice: the menu offers what can be done, with its keys") {
    OpenSliceEditor open(slice_of(System::weft, {"T0 P0 T1", "P0 T0 T1"}));
    Rows words;
    QTimer::singleShot(0, [&] {  // while the menu is open
        const auto* menu = open.canvas().findChild<QMenu*>("slice_menu");
        for (const QAction* action : menu->actions())
            words.push_back((action->text() + "|" + action->shortcut().toString()).toStdString());
        QMetaObject::invokeMethod(const_cast<QMenu*>(menu), "close");
    });
    const QPoint place = open.canvas().place_of(0, 2);
    QContextMenuEvent event(QContextMenuEvent::Mouse, place, open.canvas().mapToGlobal(place));
    QApplication::sendEvent(&open.canvas(), &event);
    REQUIRE(open.canvas().marks().selected == std::set{SliceYarnId::dot(0, 1)});
    REQUIRE(words.front() == "weft 2 of position 1: pick 2 on the loom|");
    for (const char* wish : {"Duplicate|Ctrl+D", "Remove|Del", "Enable or disable weft|E",
                             "Earlier on the loom|Ctrl+Left", "Add a yarn like it|Ins"})
        REQUIRE(std::ranges::find(words, wish) != words.end());
}
