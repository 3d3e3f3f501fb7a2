#include <weave/samples/samples.hpp>

#include <studio/editors/card_editor.hpp>

#include <QtTest>

#include <QComboBox>
#include <QSpinBox>
#include <QToolTip>

#include <catch2/catch.hpp>

#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;

namespace {

/// A card editor in a window, with the design that it shows.
struct Desk {
    explicit Desk(const char* sample) : document(find_sample(sample)->make(), {}, true, folder.path) {
        editor.resize(800, 640);
        editor.show_document(&document);
        editor.show();
        REQUIRE(QTest::qWaitForWindowExposed(&editor));
        settle();
    }
    void settle() {
        REQUIRE(QTest::qWaitFor([&] { return document.shown_is_current(); }, 20000));
        QCoreApplication::processEvents();
    }
    [[nodiscard]] QPoint at(std::size_t pick, std::size_t end) { return editor.canvas().mapping().box({pick, end}).center().toPoint(); }
    void click(std::size_t pick, std::size_t end) { QTest::mouseClick(&editor.canvas(), Qt::LeftButton, {}, at(pick, end)); }
    [[nodiscard]] QRgb pixel(std::size_t pick, std::size_t end) {
        const QImage image = editor.canvas().grab().toImage();
        const QRectF box = editor.canvas().mapping().box({pick, end});
        const double scale = editor.canvas().devicePixelRatioF();
        return image.pixel((QPointF(box.left() + box.width() * 0.3, box.top() + box.height() * 0.7) * scale).toPoint());
    }

    weave::testing::TemporaryFolder folder;
    Document document;
    CardEditor editor;
};

constexpr QRgb black = 0xff000000, white = 0xffffffff;

}  // namespace

TEST_CASE("the card shows pick 1 at the bottom, black where the end is lifted") {
    Desk desk("twill-2-2");
    desk.editor.canvas().set_cursor_cell(std::nullopt);
    const Block& block = *desk.document.shown().block;
    for (std::size_t pick = 0; pick < block.picks(); ++pick) {
        for (std::size_t end = 0; end < block.ends(); ++end) CHECK(desk.pixel(pick, end) == (block.weft_over(pick, end) ? white : black));
    }
    CHECK(desk.at(0, 0).y() > desk.at(1, 0).y());
    CHECK(desk.at(0, 0).x() < desk.at(0, 1).x());
    desk.editor.canvas().set_corner(Corner::top_right);
    CHECK(desk.at(0, 0).y() < desk.at(1, 0).y());
    CHECK(desk.at(0, 0).x() > desk.at(0, 1).x());
    for (std::size_t end = 0; end < block.ends(); ++end) CHECK(desk.pixel(1, end) == (block.weft_over(1, end) ? white : black));
}

TEST_CASE("a click on a crossing flips it, and undo takes it back without a jump") {
    Desk desk("twill-2-2");
    const bool before = desk.document.shown().block->weft_over(2, 1);
    desk.editor.canvas().zoom_by(1.7);
    const QPoint place = desk.at(2, 1);
    desk.click(2, 1);
    desk.settle();
    CHECK(desk.document.shown().block->weft_over(2, 1) != before);
    CHECK(desk.document.undo_stack().undoText() == "Flip pick 3, end 2");
    desk.document.undo();
    desk.settle();
    CHECK(desk.document.shown().block->weft_over(2, 1) == before);
    CHECK(desk.at(2, 1) == place);
}

TEST_CASE("a click that cannot be tells which yarns stand in the way and changes nothing") {
    Desk desk("pocket");
    const Block& block = *desk.document.shown().block;
    CardPlace blocked{};
    std::string reason;
    for (std::size_t pick = 0; pick < block.picks(); ++pick) {
        for (std::size_t end = 0; reason.empty() && end < block.ends(); ++end) {
            const auto tried = flip(block, pick, end);
            if (!tried) blocked = {pick, end}, reason = tried.error().message;
        }
    }
    REQUIRE_FALSE(reason.empty());
    QSignalSpy told(&desk.editor, &CardEditor::told);
    desk.click(blocked.pick, blocked.end);
    CHECK(desk.document.undo_stack().count() == 0);
    CHECK(QToolTip::isVisible());
    CHECK(QToolTip::text().toStdString().find(reason) != std::string::npos);
    bool is_told = false;
    for (const auto& each : told) is_told = is_told || each[0].toString().toStdString().find(reason) != std::string::npos;
    CHECK(is_told);
    QToolTip::hideText();
}

TEST_CASE("a line drawn over crossings is one step") {
    Desk desk("plain");
    QWidget& canvas = desk.editor.canvas();
    QTest::mousePress(&canvas, Qt::LeftButton, {}, desk.at(0, 0));
    QTest::mouseMove(&canvas, desk.at(1, 1));
    QTest::mouseRelease(&canvas, Qt::LeftButton, {}, desk.at(1, 1));
    desk.settle();
    CHECK(desk.document.undo_stack().count() == 1);
    CHECK(desk.document.shown().block->weft_over(0, 0) == desk.document.shown().block->weft_over(1, 1));
}

TEST_CASE("the card can be walked and flipped with keys alone") {
    Desk desk("twill-2-2");
    QWidget& canvas = desk.editor.canvas();
    canvas.setFocus();
    QTest::keyClick(&canvas, Qt::Key_Home);
    QTest::keyClick(&canvas, Qt::Key_Up);
    QTest::keyClick(&canvas, Qt::Key_Right);
    QTest::keyClick(&canvas, Qt::Key_Right);
    REQUIRE(desk.editor.canvas().cursor_cell() == GridCell{1, 2});
    const bool before = desk.document.shown().block->weft_over(1, 2);
    QTest::keyClick(&canvas, Qt::Key_Return);
    desk.settle();
    CHECK(desk.document.shown().block->weft_over(1, 2) != before);
    QTest::keyClick(&canvas, Qt::Key_Up, Qt::ShiftModifier);
    CHECK(desk.editor.canvas().cursor_cell() == GridCell{3, 2});  // the last pick is as far as it goes
}

TEST_CASE("repeats show the cloth several times and a click in any of them is the same crossing") {
    Desk desk("twill-2-2");
    for (QSpinBox* box : desk.editor.findChildren<QSpinBox*>()) box->setValue(2);
    QCoreApplication::processEvents();
    CHECK(desk.editor.canvas().mapping().rows() == 8);
    const bool before = desk.document.shown().block->weft_over(1, 2);
    desk.click(5, 6);
    desk.settle();
    CHECK(desk.document.shown().block->weft_over(1, 2) != before);
}

TEST_CASE("every mode shows its picture") {
    Desk desk("pocket");
    auto* modes = desk.editor.findChild<QComboBox*>("card-mode");
    REQUIRE(modes->count() >= 7);  // card, two layers, face, back, floats of both
    for (int k = 0; k < modes->count(); ++k) {
        modes->setCurrentIndex(k);
        const std::size_t rows = k == 0 ? 80 : desk.document.shown().block->rows();
        CHECK(QTest::qWaitFor([&] { return desk.editor.canvas().mapping().rows() == rows; }));
    }
    // Squares of a face are stacks: what is chosen there is a crossing of the stack, and nothing is flipped.
    modes->setCurrentIndex(modes->count() - 1);
    desk.click(3, 3);
    CHECK(desk.document.undo_stack().count() == 0);
    REQUIRE(desk.document.focus().place());
    CHECK(desk.document.focus().place()->pick == desk.document.shown().block->first_pick(3));
}

TEST_CASE("a large card is seen whole, near and far") {
    Desk desk("shoe-adult");
    const Block& block = *desk.document.shown().block;
    const GridMapping& mapping = desk.editor.canvas().mapping();
    CHECK(mapping.frame().height() <= mapping.room().height());
    const CellPicture whole(desk.document.shown().card);
    GridMapping near = mapping;
    near.zoom(40, near.room().center());
    REQUIRE(near.cell() > 2);
    const CellPicture::Seen seen = whole.seen(near, 1);
    const GridSpan span = near.seen();
    for (int y = 0; y < seen.image.height(); y += 7) {
        for (int x = 0; x < seen.image.width(); x += 7) {
            const std::size_t pick = span.last_row - 1 - static_cast<std::size_t>(y), end = span.first_column + static_cast<std::size_t>(x);
            REQUIRE((qGray(seen.image.pixel(x, y)) > 128) == block.weft_over(pick, end));
        }
    }
}

TEST_CASE("squares and places of a grid find one another in every corner") {
    for (const Corner corner : {Corner::bottom_left, Corner::bottom_right, Corner::top_left, Corner::top_right}) {
        GridMapping mapping;
        mapping.set_room({40, 10, 500, 400});
        mapping.set_grid(30, 50);
        mapping.set_corner(corner);
        for (const double factor : {1.0, 3.7, 0.3}) {
            mapping.zoom(factor, {200, 200});
            const GridSpan span = mapping.seen();
            for (std::size_t row = 0; row < 30; ++row) {
                for (std::size_t column = 0; column < 50; ++column) {
                    const QPointF middle = mapping.box({row, column}).center();
                    if (!mapping.room().contains(middle)) continue;
                    REQUIRE(mapping.cell_at(middle) == GridCell{row, column});
                    REQUIRE((row >= span.first_row && row < span.last_row && column >= span.first_column && column < span.last_column));
                }
            }
        }
    }
}
