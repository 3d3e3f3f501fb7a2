#include "slice_case.hpp"

#include <weave/design/evaluate.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

struct OpenReader {
    SliceEditor editor;
    Design design;
    BlockPtr block;
    std::vector<std::pair<std::size_t, std::size_t>> flips;
    QString status;

    OpenReader(const char* sample, System dots, std::size_t line) : design(find_sample(sample)->make()) {
        block = evaluate(design).value().block;
        QObject::connect(&editor, &SliceEditor::flip_wanted, &editor,
                         [this](std::size_t pick, std::size_t end) { flips.emplace_back(pick, end); });
        QObject::connect(&editor, &SliceEditor::status, &editor,
                         [this](const QString& words) { status = words; });
        editor.resize(1200, 600);
        editor.show();
        REQUIRE(QTest::qWaitForWindowExposed(&editor));
        editor.show_block(design, block, dots, line);
        REQUIRE(QTest::qWaitFor([&] { return canvas().slices() != nullptr; }, 60000));
    }
    SliceReadCanvas& canvas() { return editor.reader().canvas(); }
};

}  // namespace

TEST_CASE("slice: a block's column shows its yarns with their numbers on the card") {
    OpenReader open("angle-interlock-b", System::weft, 1);
    const SliceScene& scene = open.canvas().scene();
    REQUIRE(scene.dot_list.size() == open.block->picks());
    REQUIRE(scene.paths.size() == open.block->p()[1]);
    REQUIRE(scene.paths[0].number == open.block->first_end(1));
    for (const SceneDot& dot : scene.dot_list) {
        for (const ScenePath& path : scene.paths) {
            REQUIRE(open.block->weft_over(*dot.number, *path.number) ==
                    (dot.level > path.level_at(dot.yarn.position)));
        }
    }
}

TEST_CASE("slice: a click on a crossing asks for its flip, or says which yarns stand in the way") {
    OpenReader open("angle-interlock-b", System::weft, 0);
    const auto click = [&](std::size_t position, double level) {
        QTest::mouseClick(&open.canvas(), Qt::LeftButton, Qt::NoModifier,
                          open.canvas().place_of(position, level));
    };
    // Row 1 from the bottom: end 3, pick 1, end 1, pick 2, end 2, pick 3.
    click(0, 1.4);
    REQUIRE(open.flips == std::vector<std::pair<std::size_t, std::size_t>>{{0, 0}});
    click(0, 0.6);
    REQUIRE(open.flips.back() == std::pair<std::size_t, std::size_t>{0, 2});
    // In a slice of sample "rib" or plain every flip can be made; where an empty stretch is clicked it says
    // so.
    click(0, -3);
    REQUIRE(open.flips.size() == 2);
    REQUIRE(open.status == "No two yarns cross here; click on a dot");
}

TEST_CASE(
    "slice: a shoe of a thousand rows is laid out only where it is seen, and its chooser goes through all") {
    OpenReader open("shoe-adult", System::weft, 0);
    REQUIRE(open.canvas().scene().all_positions == open.block->rows());
    REQUIRE(open.canvas().scene().positions < 150);
    auto* along = open.editor.findChild<QScrollBar*>("along");
    REQUIRE(along->isVisible());
    along->setValue(600);
    const SliceScene& scene = open.canvas().scene();
    REQUIRE(scene.begin > 550);
    REQUIRE(scene.begin <= 600);
    REQUIRE(std::ranges::all_of(scene.dot_list, [&](const SceneDot& dot) {
        return open.block->row_of_pick(*dot.number) == dot.yarn.position;
    }));
    open.editor.findChild<QSpinBox*>("line")->setValue(201);
    REQUIRE(open.canvas().line() == 200);
    REQUIRE(open.canvas().scene().begin == scene.begin);
    REQUIRE(open.editor.findChild<QSlider*>("line_slider")->value() == 201);
    const ScenePath& path = open.canvas().scene().paths.front();
    REQUIRE(open.block->column_of_end(*path.number) == 200);
    auto* direction = open.editor.findChild<QComboBox*>("direction");
    direction->setCurrentIndex(1);
    Q_EMIT direction->activated(1);
    REQUIRE(open.canvas().dots() == System::warp);
    REQUIRE(open.canvas().scene().all_positions == open.block->columns());
}

TEST_CASE("slice: keys go from crossing to crossing, and Enter asks for the flip") {
    OpenReader open("plain", System::weft, 0);
    open.canvas().setFocus();
    QTest::keyClick(&open.canvas(), Qt::Key_Right);
    QTest::keyClick(&open.canvas(), Qt::Key_Right);
    REQUIRE(open.canvas().marks().crossing.has_value());
    QTest::keyClick(&open.canvas(), Qt::Key_Return);
    REQUIRE(open.flips == std::vector<std::pair<std::size_t, std::size_t>>{{1, 0}});
}

TEST_CASE("slice: a flip that cannot be made is not asked for; it says which yarns stand in the way") {
    OpenReader open("angle-interlock-b", System::weft, 0);
    open.canvas().setFocus();
    QTest::keyClick(&open.canvas(), Qt::Key_Right);  // pick 1 and end 1
    QTest::keyClick(&open.canvas(), Qt::Key_Up);     // pick 1 and end 2
    QTest::keyClick(&open.canvas(), Qt::Key_Return);
    REQUIRE(open.flips.empty());
    const auto* bubble = open.canvas().findChild<QLabel*>("bubble");
    REQUIRE(bubble->isVisible());
    REQUIRE(bubble->text().contains("pick 2"));
    REQUIRE(open.status == bubble->text());
}

TEST_CASE("slice: an edit of a large block leaves the place, and the slice is there all the time") {
    OpenReader open("shoe-adult", System::weft, 150);
    open.canvas().go_to(400);
    const auto place = open.canvas().seen();
    REQUIRE(place.first > 300);
    const auto again = std::make_shared<const Block>(*open.block);  // as an edit brings it
    const BlockSlices* before = open.canvas().slices();
    open.editor.show_block(open.design, again, System::weft, 150);
    REQUIRE(open.canvas().slices() == before);
    REQUIRE(open.canvas().scene().all_positions == open.block->rows());
    REQUIRE(QTest::qWaitFor([&] { return &open.canvas().slices()->block() == again.get(); }, 60000));
    REQUIRE(open.canvas().seen() == place);
    REQUIRE(open.canvas().line() == 150);
}

TEST_CASE("slice: the same block is not read again, and a mark stays where the line does") {
    OpenReader open("shoe-adult", System::weft, 150);
    open.canvas().setFocus();
    QTest::keyClick(&open.canvas(), Qt::Key_Right);
    const auto mark = open.canvas().marks().crossing;
    REQUIRE(mark);
    const BlockSlices* before = open.canvas().slices();
    open.editor.show_block(open.design, open.block, System::weft, 150);
    REQUIRE(open.canvas().marks().crossing == mark);
    open.editor.show_block(open.design, open.block, System::weft, 151);
    REQUIRE(open.canvas().slices() == before);
    REQUIRE(open.canvas().line() == 151);
    REQUIRE_FALSE(open.canvas().marks().crossing);
}
