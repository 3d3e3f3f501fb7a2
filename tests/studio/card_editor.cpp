#include <weave/samples/samples.hpp>

#include <weave/picture/float_map.hpp>

#include <studio/commands/change_block.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/editors/float_legend.hpp>
#include <studio/editors/plain_text.hpp>

#include <QtTest>

#include <QComboBox>
#include <QSpinBox>
#include <QTextDocumentFragment>
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

TEST_CASE("a card seen from afar is pointed at but not flipped: nobody would see it") {
    Desk desk("shoe-adult");
    GridCanvas& canvas = desk.editor.canvas();
    const GridMapping& mapping = canvas.mapping();
    REQUIRE(mapping.cell() < GridCanvas::smallest_stroked);
    QString said;
    QObject::connect(&desk.editor, &CardEditor::told, &desk.editor, [&](const QString& words) { said = words; });
    const QPoint middle = mapping.frame().center().toPoint();
    QTest::mouseClick(&canvas, Qt::LeftButton, {}, middle);
    CHECK(said.contains("come nearer to flip"));
    REQUIRE(canvas.cursor_cell());
    REQUIRE(desk.document.focus().place());
    CHECK(desk.document.focus().place()->pick == canvas.cursor_cell()->row);
    CHECK(desk.document.focus().place()->end == canvas.cursor_cell()->column);
    QTest::mousePress(&canvas, Qt::LeftButton, {}, middle);
    QTest::mouseMove(&canvas, middle + QPoint(30, 30));
    QTest::mouseRelease(&canvas, Qt::LeftButton, {}, middle + QPoint(30, 30));
    QTest::keyClick(&canvas, Qt::Key_Return);
    CHECK(desk.document.undo_stack().count() == 0);
    // Near enough, the same click flips.
    canvas.zoom_by(1.01 * GridCanvas::smallest_stroked / mapping.cell());
    const GridCell at = *canvas.cursor_cell();
    for (std::size_t end = at.column; desk.document.undo_stack().count() == 0 && end < at.column + 20; ++end) desk.click(at.row, end);
    CHECK(desk.document.undo_stack().count() == 1);
}

TEST_CASE("the cursor stays on the same yarns in every view of the block") {
    Desk desk("pocket");
    const Block& block = *desk.document.shown().block;
    const CardPlace place{29, 20};
    const GridCell crossing{place.pick, place.end}, stack{block.row_of_pick(place.pick), block.column_of_end(place.end)};
    REQUIRE(stack != crossing);
    desk.document.focus().go_to(place);
    for (const CardMode mode : {CardMode::face_floats, CardMode::layer, CardMode::card, CardMode::back}) {
        desk.editor.show_mode(mode);
        const bool is_card = mode == CardMode::card;
        REQUIRE(QTest::qWaitFor([&] { return desk.editor.canvas().mapping().rows() == (is_card ? block.picks() : block.rows()); }, 20000));
        CHECK(desk.editor.canvas().cursor_cell() == (is_card ? crossing : stack));
    }
    CHECK(desk.document.focus().place()->pick == place.pick);
    CHECK(desk.document.focus().place()->end == place.end);
}

TEST_CASE("a click in a repeat leaves the cursor in that repeat") {
    Desk desk("twill-2-2");
    for (QSpinBox* box : desk.editor.findChildren<QSpinBox*>()) box->setValue(2);
    QCoreApplication::processEvents();
    desk.click(5, 6);
    desk.settle();
    CHECK(desk.editor.canvas().cursor_cell() == GridCell{5, 6});
}

TEST_CASE("all crossings of a stroke that refused are marked until the next press, and the first says why") {
    Desk desk("pocket");
    GridCanvas& canvas = desk.editor.canvas();
    const Block& block = *desk.document.shown().block;
    std::vector<CardPlace> line;
    std::vector<GridCell> refused;
    for (std::size_t pick = 0; refused.size() < 2 && pick < block.picks(); ++pick) {
        line.clear();
        refused.clear();
        for (std::size_t end = 0; end < block.ends(); ++end) line.push_back({pick, end});
        const FlippedStroke tried = flip_stroke(desk.document, line);
        if (tried.flipped == 0) continue;
        for (const RefusedCrossing& one : tried.refused) refused.push_back({one.place.pick, one.place.end});
    }
    REQUIRE(refused.size() >= 2);
    const std::string reason = flip_stroke(desk.document, line).refused.front().reason.message;
    const QPoint from = desk.at(line.front().pick, line.front().end), to = desk.at(line.back().pick, line.back().end);
    QTest::mousePress(&canvas, Qt::LeftButton, {}, from);
    QTest::mouseMove(&canvas, to);
    QTest::mouseRelease(&canvas, Qt::LeftButton, {}, to);
    desk.settle();  // the crossings that did flip are shown by now
    CHECK(desk.document.undo_stack().count() == 1);
    CHECK(canvas.refused() == refused);
    CHECK(QToolTip::text().toStdString().find(reason) != std::string::npos);
    QTest::keyClick(&canvas, Qt::Key_Right);
    CHECK(canvas.refused().empty());
    QToolTip::hideText();
}

TEST_CASE("a block that cannot be made for a while leaves the view where it was") {
    Desk desk("twill-2-2");
    const GridMapping& mapping = desk.editor.canvas().mapping();
    desk.editor.canvas().zoom_by(2.3);
    const QRectF frame = mapping.frame();
    const std::string& block = desk.document.shown_block();
    REQUIRE(desk.document.perform(change_block(desk.document.design(), block, SliceLeaf{}, "empty")));
    REQUIRE(QTest::qWaitFor([&] { return !desk.document.shown().block; }, 20000));
    desk.document.undo();
    REQUIRE(QTest::qWaitFor([&] { return desk.document.shown().block != nullptr; }, 20000));
    CHECK(mapping.frame() == frame);
    CHECK_FALSE(mapping.is_fitted());
}

TEST_CASE("a float map says what its colours mean, in steps that differ in lightness too") {
    Desk desk("pocket");
    auto* legend = desk.editor.findChild<FloatLegend*>();
    REQUIRE(legend != nullptr);
    CHECK_FALSE(legend->isVisible());
    desk.editor.show_mode(CardMode::back_floats);
    REQUIRE(QTest::qWaitFor([&] { return legend->isVisible(); }, 20000));
    const auto& steps = legend->steps();
    REQUIRE(steps.size() == 8);
    CHECK(steps[0].words == "1");
    CHECK(steps[4].words == "5–6");
    CHECK(steps[7].words == "≥ 16");
    const auto is = [](const QColor& colour, Colour other) { return colour == QColor(other.red, other.green, other.blue); };
    CHECK(is(steps[4].weft, float_colour(6)));
    CHECK(is(steps[4].warp, float_colour(-5)));
    CHECK(is(steps[7].weft, float_colour(400)));
    for (std::size_t k = 1; k < steps.size(); ++k) {
        CHECK(qGray(steps[k].weft.rgb()) + 12 < qGray(steps[k - 1].weft.rgb()));
        CHECK(qGray(steps[k].warp.rgb()) + 12 < qGray(steps[k - 1].warp.rgb()));
    }
    desk.editor.show_mode(CardMode::card);
    CHECK_FALSE(legend->isVisible());
}

TEST_CASE("numbers of a ruler never meet, at the seam of repeats neither") {
    for (const double cell : {0.3, 1.7, 4.0, 9.0, 40.0}) {
        for (const std::size_t repeat : {std::size_t{4}, std::size_t{7}, std::size_t{83}, std::size_t{1001}}) {
            for (const std::size_t in_line : {std::size_t{1}, std::size_t{2}, std::size_t{6}}) {
                const double room = 21;
                const PrintedNumbers numbers(cell, room, repeat, 3 * repeat, in_line);
                std::optional<std::size_t> last;
                for (std::size_t line = 0; line < 3 * repeat; ++line) {
                    const std::size_t first = line % repeat * in_line + 1;
                    const auto number = numbers.beside(line, first, first + in_line);
                    if (!number) continue;
                    REQUIRE((*number >= first && *number < first + in_line));
                    if (last) REQUIRE(static_cast<double>(line - *last) * cell >= room);
                    last = line;
                }
                CHECK(numbers.beside(0, 1, 1 + in_line) == 1);
            }
        }
    }
}

TEST_CASE("a ruler of stacks has round numbers all along, whatever a stack holds") {
    for (const std::size_t in_line : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{6}}) {
        const std::size_t lines = 6000 / in_line;
        const double cell = 600.0 / static_cast<double>(lines), room = 30;  // a whole shoe on 600 pixels
        const PrintedNumbers numbers(cell, room, lines, lines, in_line);
        std::vector<std::size_t> printed;
        for (std::size_t line = 0; line < lines; ++line) {
            if (const auto number = numbers.beside(line, line * in_line + 1, (line + 1) * in_line + 1)) printed.push_back(*number);
        }
        INFO(in_line);
        REQUIRE(printed.size() >= 10);
        CHECK(printed[0] == 1);
        CHECK(printed[1] % 100 == 0);
        for (std::size_t k = 2; k < printed.size(); ++k) CHECK(printed[k] == k * printed[1]);
    }
}

TEST_CASE("the triangle at pick 1 is in sight wherever one is on the card, and words stand clear of numbers") {
    Desk desk("twill-2-2");
    GridCanvas& canvas = desk.editor.canvas();
    GridRulers rulers;
    rulers.set(plain_labels("picks", "ends"), 80, 80);
    for (const Corner corner : {Corner::bottom_left, Corner::bottom_right, Corner::top_left, Corner::top_right}) {
        GridMapping mapping;
        mapping.set_corner(corner);
        mapping.set_grid(80, 80);
        mapping.set_room(rulers.room_in(canvas, corner));
        const int line = canvas.fontMetrics().height();
        CHECK(mapping.room().bottom() + 3 + line <= canvas.height() - line - 1);
        for (const QPointF& by : {QPointF(0, 0), QPointF(-900, 900), QPointF(900, -900)}) {
            mapping.zoom(8, mapping.room().center());
            mapping.move(by);
            const QRectF triangle = rulers.origin(canvas, mapping).boundingRect();
            CHECK(QRectF(canvas.rect()).contains(triangle));
            CHECK_FALSE(mapping.room().intersects(triangle));
        }
    }
}

TEST_CASE("a tooltip shows a name that looks like markup letter by letter") {
    for (const QString& words : {QString("plain"), QString("<b>bold</b> & <img src='x'>"), QString("a < b")})
        CHECK((Qt::mightBeRichText(as_plain(words)) ? QTextDocumentFragment::fromHtml(as_plain(words)).toPlainText() : as_plain(words)) == words);
}
