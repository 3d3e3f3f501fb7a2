#include "screen_file.hpp"

#include <studio/editors/stencil_dialogs.hpp>
#include <studio/editors/stencil_editor.hpp>

#include <weave/block/preset.hpp>
#include <weave/core/file.hpp>

#include <QtTest>
#include <QtWidgets>

#include <catch2/catch.hpp>

#include <support/temporary_folder.hpp>

#include <filesystem>

using namespace weave;
using namespace weave::studio;

namespace {

BlockChoice choice(const QString& name, std::vector<std::uint32_t> t, std::vector<std::uint32_t> p,
                   const QString& reason = {}) {
    QPixmap look(32, 32);
    look.fill(Qt::gray);
    return {name, look, std::move(t), std::move(p), reason};
}

StencilOperation operation_of(std::size_t rows, std::size_t columns,
                              std::vector<std::string> of = {"plain", "twill"}) {
    return {std::move(of), std::make_shared<const StencilMap>(
                               StencilMap{rows, columns, std::vector<std::uint16_t>(rows * columns)})};
}

struct OpenStencil {
    StencilEditor editor;
    std::vector<StencilOperation> edits;
    std::vector<QString> names;
    QString status;

    explicit OpenStencil(const StencilOperation& operation) {
        QObject::connect(&editor, &StencilEditor::edited, &editor,
                         [this](const StencilOperation& edited, const QString& what) {
                             edits.push_back(edited);
                             names.push_back(what);
                         });
        QObject::connect(&editor, &StencilEditor::status, &editor,
                         [this](const QString& words) { status = words; });
        editor.set_blocks({choice("plain", {1, 1}, {1, 1}), choice("twill", {1}, {1}),
                           choice("double", {2, 2}, {1}),
                           choice("self", {1}, {1}, "it is made from this stencil")});
        editor.resize(1000, 600);
        editor.show();
        REQUIRE(QTest::qWaitForWindowExposed(&editor));
        editor.show_operation(operation);
    }
    StencilCanvas& canvas() { return editor.canvas(); }
    void tool(const char* name) { editor.findChild<QAction*>(name)->trigger(); }
    void choose(int entry) { editor.palette_list().choose(entry); }
    [[nodiscard]] QString bubble() {
        const auto* label = canvas().findChild<QLabel*>("bubble");
        return label->isVisible() ? label->text() : QString();
    }
    /// The pointer itself stays where it is: the display's own events would come whenever they like.
    void hover(QPoint stack, Qt::MouseButtons buttons = Qt::NoButton) {
        const QPoint place = canvas().place_of(stack);
        QMouseEvent move(QEvent::MouseMove, place, canvas().mapToGlobal(place), Qt::NoButton, buttons, Qt::NoModifier);
        QApplication::sendEvent(&canvas(), &move);
    }
    void drag(const std::vector<QPoint>& stacks) {
        QTest::mousePress(&canvas(), Qt::LeftButton, Qt::NoModifier, canvas().place_of(stacks.front()));
        for (const QPoint stack : stacks) hover(stack, Qt::LeftButton);
        QTest::mouseRelease(&canvas(), Qt::LeftButton, Qt::NoModifier, canvas().place_of(stacks.back()));
    }
    /// Rows from the top, as they are seen.
    [[nodiscard]] std::vector<std::string> rows() const {
        std::vector<std::string> list;
        const StencilMap& map = *editor.operation().map;
        for (std::size_t row = map.rows; row-- > 0;) {
            std::string& text = list.emplace_back();
            for (const std::uint16_t block : map.row(row)) text += static_cast<char>('0' + block);
        }
        return list;
    }
};
using Rows = std::vector<std::string>;

std::string picture_file(const weave::testing::TemporaryFolder& folder, const ColourImage& image) {
    const auto path = folder.path / "map.png";
    REQUIRE(write_file(path.string(), write_png(image).value()));
    return path.string();
}

}  // namespace

TEST_CASE(
    "stencil: a stroke paints at once and is told once, when the button is released; row 0 is the bottom") {
    OpenStencil open(operation_of(3, 4));
    open.choose(1);
    QTest::mousePress(&open.canvas(), Qt::LeftButton, Qt::NoModifier, open.canvas().place_of({0, 0}));
    REQUIRE(open.canvas().map().blocks[0] == 1);
    REQUIRE(open.edits.empty());
    QTest::mouseRelease(&open.canvas(), Qt::LeftButton, Qt::NoModifier, open.canvas().place_of({0, 0}));
    REQUIRE(open.edits.size() == 1);
    open.drag({{1, 2}, {3, 2}, {3, 0}});
    REQUIRE(open.edits.size() == 2);
    REQUIRE(open.rows() == Rows{"0111", "0001", "1001"});
    REQUIRE(open.names.back() == "Paint with twill");
    open.drag({{0, 0}, {0, 0}});  // changes nothing, so says nothing
    REQUIRE(open.edits.size() == 2);
    REQUIRE(open.edits.front().map->blocks !=
            open.edits.back().map->blocks);  // what was told stays as it was
    const QImage seen = open.canvas().grab().toImage();
    const double ratio = seen.devicePixelRatio();
    const auto colour = [&](QPoint stack) {
        return seen.pixelColor((QPointF(open.canvas().place_of(stack)) * ratio).toPoint());
    };
    REQUIRE(colour({2, 2}) == StencilPalette::colour_of(1));
    REQUIRE(colour({1, 0}) == StencilPalette::colour_of(0));
}

TEST_CASE("stencil: lines, rectangles, fills and choosing") {
    OpenStencil open(operation_of(5, 6));
    open.choose(1);
    open.tool("line");
    open.drag({{0, 0}, {2, 1}, {4, 4}});
    REQUIRE(open.rows() == Rows{"000010", "000100", "001000", "010000", "100000"});
    open.tool("rectangle");
    open.drag({{5, 1}, {4, 0}});
    REQUIRE(open.rows() == Rows{"000010", "000100", "001000", "010011", "100011"});
    open.tool("flood");
    open.drag({{2, 4}});
    REQUIRE(open.rows() == Rows{"111110", "111100", "111000", "110011", "100011"});
    REQUIRE(open.names.back() == "Fill with twill");
    open.tool("choose");
    REQUIRE(open.editor.findChild<QAction*>("choose")->text() == "Choose block");  // a pick is a yarn (docs/glossary.md)
    open.drag({{5, 4}});
    REQUIRE(open.editor.palette_list().chosen() == 0);
    REQUIRE(open.edits.size() == 3);
}

TEST_CASE("stencil: Escape gives a stroke up") {
    OpenStencil open(operation_of(2, 2));
    open.choose(1);
    QTest::mousePress(&open.canvas(), Qt::LeftButton, Qt::NoModifier, open.canvas().place_of({0, 0}));
    QTest::keyClick(&open.canvas(), Qt::Key_Escape);
    QTest::mouseRelease(&open.canvas(), Qt::LeftButton, Qt::NoModifier, open.canvas().place_of({0, 0}));
    REQUIRE(open.edits.empty());
    REQUIRE(open.canvas().map().blocks == std::vector<std::uint16_t>(4));
}

TEST_CASE("stencil: keys paint as well") {
    OpenStencil open(operation_of(3, 3));
    open.choose(1);
    open.canvas().setFocus();
    QTest::keyClick(&open.canvas(), Qt::Key_R);
    REQUIRE(open.canvas().tool() == StencilTool::rectangle);
    QTest::keyClick(&open.canvas(), Qt::Key_Up);
    QTest::keyClick(&open.canvas(), Qt::Key_Space);
    QTest::keyClick(&open.canvas(), Qt::Key_Right);
    QTest::keyClick(&open.canvas(), Qt::Key_Up);
    QTest::keyClick(&open.canvas(), Qt::Key_Space);
    REQUIRE(open.rows() == Rows{"110", "110", "000"});
}

TEST_CASE("stencil: a block that does not fit is grey, says why, and paints nothing") {
    OpenStencil open(operation_of(2, 2, {"plain", "double"}));
    const QListWidget& list = open.editor.palette_list().list();
    REQUIRE(list.item(0)->text().startsWith("plain\n4 stack"));
    REQUIRE(
        list.item(1)->text().toStdString() ==
        "double\n'plain' and 'double' do not fit together: at pick 1 'plain' has 1 pick in a stack and 'double' 2");
    REQUIRE(list.item(1)->foreground().color() ==
            open.editor.palette_list().palette().color(QPalette::Disabled, QPalette::Text));
    REQUIRE(open.editor.findChild<QLabel*>("stencil_trouble")->isVisible());
    open.choose(1);
    open.drag({{0, 0}, {1, 1}});
    REQUIRE(open.edits.empty());
    REQUIRE(open.bubble().contains("do not fit together"));
    REQUIRE(open.status == open.bubble());
    QMenu& menu = open.editor.palette_list().add_menu();
    REQUIRE_FALSE(menu.findChild<QAction*>("self")->isEnabled());
    REQUIRE(menu.findChild<QAction*>("self")->text() == "self — it is made from this stencil");
    REQUIRE(menu.findChild<QAction*>("twill")->isEnabled());
    REQUIRE_FALSE(menu.findChild<QAction*>("double")->isEnabled());
    open.editor.findChild<QToolButton*>("remove_block")->click();
    REQUIRE(open.editor.operation().of == std::vector<std::string>{"plain"});
    REQUIRE_FALSE(open.editor.findChild<QLabel*>("stencil_trouble")->isVisible());
    open.editor.findChild<QToolButton*>("remove_block")->click();
    REQUIRE(open.bubble().startsWith("A stencil needs at least one block"));
}

TEST_CASE("stencil: blocks are added, reordered and removed, and each stack keeps its block") {
    OpenStencil open(StencilOperation{});
    open.editor.palette_list().add_menu().findChild<QAction*>("plain")->trigger();
    REQUIRE(open.rows() == Rows(8, "00000000"));  // four repeats of two rows and columns
    open.editor.palette_list().add_menu().findChild<QAction*>("twill")->trigger();
    open.drag({{0, 0}, {1, 0}});
    REQUIRE(open.rows().back() == "11000000");
    open.editor.findChild<QToolButton*>("block_up")->click();
    REQUIRE(open.editor.operation().of == std::vector<std::string>{"twill", "plain"});
    REQUIRE(open.rows().back() == "00111111");
    // The library makes the same cloth of it, before and after.
    const auto block = [](const char* family) {
        return std::make_shared<const Block>(make_preset({family, {}}).value());
    };
    const std::vector<BlockPtr> before{block("plain"), block("twill")}, after{before[1], before[0]};
    REQUIRE(stencil(before, *open.edits[2].map)->card_image() ==
            stencil(after, *open.edits[3].map)->card_image());
    open.choose(0);
    open.editor.findChild<QToolButton*>("remove_block")->click();
    REQUIRE(open.editor.operation().of == std::vector<std::string>{"plain"});
    REQUIRE(open.rows() == Rows(8, "00000000"));
    REQUIRE(open.status == "2 stacks that were twill are plain now");
}

TEST_CASE("stencil: the picture's size changes at the side that is wanted") {
    OpenStencil open(operation_of(2, 2));
    open.choose(1);
    open.drag({{0, 0}});
    open.editor.ask_size();
    auto* dialog = open.editor.findChild<StencilSizeDialog*>("stencil_size");
    dialog->findChild<QSpinBox*>("rows")->setValue(3);
    dialog->findChild<QButtonGroup*>()->button(0)->setChecked(true);  // the top left stays
    dialog->accept();
    REQUIRE(open.rows() == Rows{"00", "10", "11"});
    REQUIRE(open.names.back() == "Resize the stencil");
}

TEST_CASE("stencil: a picture is loaded with a block for each of its colours") {
    const Colour red{200, 0, 0}, blue{0, 0, 200};
    const weave::testing::TemporaryFolder folder;
    const std::string path = picture_file(folder, {2, 3, {red, red, blue, blue, red, red}});
    OpenStencil open(operation_of(2, 2));
    open.editor.load_picture(QString::fromStdString(path));
    REQUIRE(QTest::qWaitFor([&] { return open.editor.findChild<PictureMapDialog*>() != nullptr; }, 60000));
    auto* dialog = open.editor.findChild<PictureMapDialog*>();
    const auto boxes = dialog->findChildren<QComboBox*>();
    REQUIRE(boxes.size() == 2);
    auto* accept = dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok);
    REQUIRE_FALSE(accept->isEnabled());
    boxes[0]->setCurrentIndex(1);  // red, the most frequent: twill
    REQUIRE(dialog->findChild<QLabel*>("trouble")->text().startsWith("1 colour is still"));
    boxes[1]->setCurrentIndex(2);  // blue: the double cloth, which has other counts
    REQUIRE_FALSE(accept->isEnabled());
    REQUIRE(
        dialog->findChild<QLabel*>("trouble")->text().contains("'twill' and 'double' do not fit together"));
    boxes[1]->setCurrentIndex(0);
    REQUIRE(accept->isEnabled());
    accept->click();
    REQUIRE(QTest::qWaitFor([&] { return !open.edits.empty(); }, 60000));
    REQUIRE(open.editor.operation().of == std::vector<std::string>{"twill", "plain"});
    REQUIRE(open.rows() == Rows{"100", "001"});
}

TEST_CASE("stencil: a picture that is none, or has too many colours, is refused in words") {
    ColourImage image{1, 100, {}};
    for (std::uint8_t k = 0; k < 100; ++k) image.pixels.push_back({k, k, 0});
    const weave::testing::TemporaryFolder folder;
    const std::string path = picture_file(folder, image);
    OpenStencil open(operation_of(2, 2));
    open.editor.load_picture(QString::fromStdString(path));
    REQUIRE(QTest::qWaitFor([&] { return open.bubble().contains("more than 64 colours"); }, 60000));
    std::filesystem::remove(path);
    open.editor.load_picture(QString::fromStdString(path));
    REQUIRE(QTest::qWaitFor([&] { return open.bubble().contains("No such file"); }, 60000));
    REQUIRE(open.edits.empty());
}

TEST_CASE("stencil: a large map is painted in part") {
    OpenStencil open(operation_of(3000, 3000));
    open.choose(1);
    open.drag({{10, 10}, {2900, 1500}, {100, 2950}, {10, 10}});
    REQUIRE(open.edits.size() == 1);
    REQUIRE(stacks_of_blocks(*open.edits[0].map, 2)[1] > 5500);
    open.tool("flood");
    open.drag({{2990, 2990}});
    REQUIRE(open.edits.size() == 2);
    REQUIRE(at(*open.edits[1].map, QPoint(2999, 0)) == 1);
    // Without gaps: nothing came through the pencil's line.
    REQUIRE(at(*open.edits[1].map, QPoint(1000, 1500)) == 0);
    // Shown again as before (undo), then anew.
    open.editor.show_operation(open.edits[0]);
    REQUIRE(open.canvas().map() == *open.edits[0].map);
}

TEST_CASE("stencil: beyond the picture there is nothing to choose") {
    OpenStencil open(operation_of(3, 3));
    open.tool("choose");
    open.canvas().setFocus();
    QSignalSpy chosen(&open.canvas(), &StencilCanvas::block_chosen);
    for (const QPoint stack : {QPoint(-2, 1), QPoint(1, -2), QPoint(4, 1), QPoint(1, 4)}) {
        open.hover(stack);
        QTest::keyClick(&open.canvas(), Qt::Key_Return);
        QTest::mouseClick(&open.canvas(), Qt::RightButton, Qt::NoModifier, open.canvas().place_of(stack));
    }
    REQUIRE(chosen.isEmpty());
    open.hover({1, 1});
    QTest::keyClick(&open.canvas(), Qt::Key_Return);
    REQUIRE(chosen.size() == 1);
}

TEST_CASE("stencil: after a stroke the status says what lies under the pointer now") {
    OpenStencil open(operation_of(3, 3));
    open.choose(1);
    open.hover({1, 1});
    REQUIRE(open.status == "row 2, column 2: plain");
    open.drag({{1, 1}});
    REQUIRE(open.status == "row 2, column 2: twill");
}

TEST_CASE("stencil: rulers stand beside the picture, rows from the bottom") {
    OpenStencil open(operation_of(12, 12));
    const QRectF room = open.canvas().mapping().room();
    const int line = open.canvas().fontMetrics().height();
    REQUIRE(room.left() > 2 * line);
    REQUIRE(room.bottom() < open.canvas().height() - 2 * line);
    const QImage seen = open.canvas().grab().toImage();
    const auto has_ink = [&](const QRectF& part) {
        const double ratio = seen.devicePixelRatio();
        const QRect pixels = QRectF(part.topLeft() * ratio, part.size() * ratio).toRect().intersected(seen.rect());
        const QRgb ground = seen.pixel(1, 1);
        for (int y = pixels.top(); y <= pixels.bottom(); ++y) {
            for (int x = pixels.left(); x <= pixels.right(); ++x)
                if (seen.pixel(x, y) != ground) return true;
        }
        return false;
    };
    const QRectF frame = open.canvas().mapping().frame();
    REQUIRE(has_ink({frame.left() - 2.0 * line, frame.bottom() - line, 1.5 * line, 1.0 * line}));
    REQUIRE(has_ink({frame.left(), frame.bottom() + 3, frame.width(), 1.0 * line}));
}

TEST_CASE("stencil: a picture's question is dropped when another stencil is shown") {
    const Colour red{200, 0, 0};
    const weave::testing::TemporaryFolder folder;
    const QString path = QString::fromStdString(picture_file(folder, {2, 2, {red, red, red, red}}));
    OpenStencil open(operation_of(2, 2));
    open.editor.load_picture(path);
    open.editor.drop_questions();  // while it is read
    QThreadPool::globalInstance()->waitForDone();
    QCoreApplication::processEvents();
    REQUIRE(open.editor.findChild<PictureMapDialog*>() == nullptr);
    open.editor.load_picture(path);
    REQUIRE(QTest::qWaitFor([&] { return open.editor.findChild<PictureMapDialog*>() != nullptr; }, 60000));
    const QPointer<QDialog> asks = open.editor.findChild<PictureMapDialog*>();
    open.editor.ask_size();
    const QPointer<QDialog> sizes = open.editor.findChild<StencilSizeDialog*>();
    open.editor.drop_questions();
    REQUIRE(QTest::qWaitFor([&] { return !asks && !sizes; }, 60000));
    REQUIRE(open.edits.empty());
}

TEST_CASE("stencil: screens", "[.screens]") {
    StencilOperation operation = operation_of(24, 32);
    StencilMap map = *operation.map;
    for (int row = 0; row < 24; ++row) {
        for (int column = 0; column < 32; ++column)
            if ((row - 12) * (row - 12) + (column - 16) * (column - 16) < 90)
                at(map, QPoint(column, row)) = 1;
    }
    operation.map = std::make_shared<const StencilMap>(map);
    operation.of.push_back("double");
    OpenStencil open(operation);
    open.choose(2);
    QTest::mouseMove(&open.canvas(), open.canvas().place_of({5, 5}));
    open.drag({{5, 5}});
    QApplication::processEvents();
    open.editor.grab().save(studio::test::screen_file("stencil.png"));
    open.editor.ask_size();
    QApplication::processEvents();
    open.editor.findChild<StencilSizeDialog*>()->grab().save(studio::test::screen_file("stencil-size.png"));
    open.editor.findChild<StencilSizeDialog*>()->reject();
    PictureMapDialog dialog(
        {{{200, 0, 0}, 12000}, {{0, 0, 200}, 900}, {{255, 255, 255}, 3}},
        {choice("plain", {1}, {1}), choice("self", {1}, {1}, "it is made from this stencil")},
        [](const auto&) { return QString(); }, &open.editor);
    dialog.show();
    QApplication::processEvents();
    dialog.grab().save(studio::test::screen_file("stencil-map.png"));
    OpenStencil large(operation_of(3000, 3000));
    QElapsedTimer timer;
    const auto took = [&](const char* what) {
        std::printf("%s: %.1f ms\n", what, double(timer.nsecsElapsed()) / 1e6);
        timer.restart();
    };
    timer.start();
    large.choose(1);
    QTest::mousePress(&large.canvas(), Qt::LeftButton, Qt::NoModifier, large.canvas().place_of({10, 10}));
    took("press");
    for (int k = 0; k < 20; ++k) {
        const QPoint place = large.canvas().place_of({10 + 100 * k, 10 + 50 * k});
        QMouseEvent move(QEvent::MouseMove, place, large.canvas().mapToGlobal(place), Qt::NoButton,
                         Qt::LeftButton, Qt::NoModifier);
        QApplication::sendEvent(&large.canvas(), &move);
    }
    took("20 moves");
    QTest::mouseRelease(&large.canvas(), Qt::LeftButton, Qt::NoModifier,
                        large.canvas().place_of({2000, 1000}));
    took("release");
    large.canvas().repaint();
    took("whole repaint");
    large.editor.show_operation(operation_of(3000, 3000));
    took("another map");
    large.editor.grab().save(studio::test::screen_file("stencil-large.png"));
}
