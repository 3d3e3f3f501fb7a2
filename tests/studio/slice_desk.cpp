// Slices in the main window, and where it is narrow or dark.

#include "screen_file.hpp"
#include "slice_case.hpp"

#include <studio/document/document.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/window/main_window.hpp>

#include <QtWidgets>

#include "support/hands.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

struct Window {
    explicit Window(const char* sample) {
        window.show();
        REQUIRE(QTest::qWaitForWindowExposed(&window));
        QApplication::setActiveWindow(&window);
        window.show_sample(sample);
        REQUIRE(until([&] { return window.document()->shown_is_current(); }));
        card = window.findChild<CardEditor*>();
        editor = window.findChild<SliceEditor*>();
    }
    void show_section(System dots, const CardPlace& place) {
        Q_EMIT card->slice_wanted(dots, place);
        REQUIRE(until([&] { return editor->isVisible() && canvas().slices() != nullptr; }));
        QCoreApplication::processEvents();
    }
    SliceReadCanvas& canvas() { return editor->reader().canvas(); }

    MainWindow window;
    CardEditor* card = nullptr;
    SliceEditor* editor = nullptr;
};

QPalette dark() {
    QPalette palette(QColor(0x31, 0x36, 0x3b));
    palette.setColor(QPalette::Base, QColor(0x1b, 0x1e, 0x20));
    palette.setColor(QPalette::Text, QColor(0xee, 0xee, 0xee));
    palette.setColor(QPalette::WindowText, QColor(0xee, 0xee, 0xee));
    return palette;
}

/// Every tool that is shown is shown whole, and what finds no room is in the menu at the bar's end.
void check_tools(SliceEditor& editor) {
    editor.resize(500, 420);
    editor.show();
    REQUIRE(QTest::qWaitForWindowExposed(&editor));
    editor.show_slice(slice_of(System::weft, {"T0 P0", "P0 T0"}));
    QCoreApplication::processEvents();
    auto* bar = editor.findChild<QToolBar*>("slice_tools");
    REQUIRE(bar != nullptr);
    CHECK(editor.width() == 500);
    bool has_rest = false;
    for (const QToolButton* button : bar->findChildren<QToolButton*>()) {
        if (button->objectName() == "qt_toolbar_ext_button") has_rest = button->isVisible();
        if (!button->isVisible()) continue;
        INFO(button->text().toStdString());
        CHECK(bar->rect().contains(button->geometry()));
        if (button->objectName() != "qt_toolbar_ext_button") CHECK(button->width() >= button->sizeHint().width());
    }
    CHECK(has_rest);
}

}  // namespace

TEST_CASE("slice: the section of a shoe opens at the place that was clicked, and marks it") {
    Window open("shoe-adult");
    const Block& block = *open.window.document()->shown().block;
    const CardPlace place{block.picks() / 2, block.ends() / 3};
    for (const System dots : {System::weft, System::warp}) {
        open.show_section(dots, place);
        const std::size_t position = dots == System::weft ? block.row_of_pick(place.pick) : block.column_of_end(place.end);
        REQUIRE(until([&] { return open.canvas().dots() == dots && open.canvas().marks().crossing.has_value(); }));
        const auto [first, count] = open.canvas().seen();
        CHECK(first <= position);
        CHECK(position < first + count);
        const SceneDot* dot = dot_of(open.canvas().scene(), open.canvas().marks().crossing->first);
        REQUIRE(dot != nullptr);
        CHECK(dot->number == (dots == System::weft ? place.pick : place.end));
        CHECK(open.canvas().rect().contains(open.canvas().place_of(position, static_cast<double>(dot->level))));
    }
}

TEST_CASE("slice: in a section + - F and Space are its own; the card behind it stays as it is") {
    Window open("pocket");
    open.show_section(System::weft, {3, 3});
    open.canvas().setFocus();
    REQUIRE(open.canvas().hasFocus());
    QAction* run = open.window.findChild<SimulationPanel*>()->run_action();
    REQUIRE(until([&] { return run->isEnabled(); }));
    QSignalSpy runs(run, &QAction::triggered);
    const QRectF card = open.card->canvas().mapping().frame();
    const double zoom = open.canvas().view().zoom();
    QTest::keyClick(&open.canvas(), Qt::Key_Plus, Qt::ShiftModifier);
    CHECK(open.canvas().view().zoom() > zoom);
    QTest::keyClick(&open.canvas(), Qt::Key_Minus);
    QTest::keyClick(&open.canvas(), Qt::Key_Minus);
    CHECK(open.canvas().view().zoom() < zoom);
    QTest::keyClick(&open.canvas(), Qt::Key_F);
    QTest::keyClick(&open.canvas(), Qt::Key_Space);
    CHECK(runs.isEmpty());
    // With the focus elsewhere the window's keys go to the section too, as it is what is seen.
    const double fitted = open.canvas().view().zoom();
    choose(open.window, {"View", "Larger"});
    CHECK(open.canvas().view().zoom() > fitted);
    CHECK(open.card->canvas().mapping().frame() == card);
}

TEST_CASE("slice: the tools are whole where the editor is narrow, and where letters are large") {
    {
        SliceEditor editor;
        check_tools(editor);
    }
    const QFont usual = QApplication::font();
    QFont large = usual;
    large.setPointSizeF(usual.pointSizeF() * 2);
    QApplication::setFont(large);
    {
        SliceEditor editor;
        check_tools(editor);
    }
    QApplication::setFont(usual);
}

TEST_CASE("slice: the way to the tools that find no room is seen on dark paper") {
    SliceEditor editor;
    editor.setPalette(dark());
    check_tools(editor);
    auto* more = editor.findChild<QToolBar*>("slice_tools")->findChild<QToolButton*>("qt_toolbar_ext_button");
    REQUIRE(more->isVisible());
    const QImage seen = more->grab().toImage();
    int lightest = 0;
    for (int y = 0; y < seen.height(); ++y) {
        for (int x = 0; x < seen.width(); ++x) lightest = std::max(lightest, qGray(seen.pixel(x, y)));
    }
    CHECK(lightest - qGray(dark().color(QPalette::Window).rgb()) > 100);
}

TEST_CASE("slice: the chooser of lines is long where the editor is narrow") {
    SliceEditor editor;
    editor.resize(500, 420);
    editor.show();
    REQUIRE(QTest::qWaitForWindowExposed(&editor));
    const Design design = find_sample("pocket")->make();
    Document document(design, {}, true);
    REQUIRE(until([&] { return document.shown_is_current(); }));
    editor.show_block(design, document.shown().block, System::weft, 0);
    QCoreApplication::processEvents();
    CHECK(editor.findChild<QSlider*>("line_slider")->width() > 400);
}

TEST_CASE("slice: a dark palette makes dark paper, and inks that are seen on it") {
    OpenSliceEditor open(slice_of(System::weft, {"T0 P0", "P0 T0", "T0 P0"}));
    open.editor.setPalette(dark());
    QCoreApplication::processEvents();
    const QImage seen = open.canvas().grab().toImage();
    CHECK(QColor(seen.pixel(seen.width() / 2, 6)) == dark().color(QPalette::Base));
    int darkest = 255, lightest = 0;
    const int ruler = seen.height() - open.canvas().fontMetrics().height();
    for (int y = ruler; y < seen.height() - 3; ++y) {
        for (int x = 4; x < seen.width() - 4; ++x) {
            darkest = std::min(darkest, qGray(seen.pixel(x, y)));
            lightest = std::max(lightest, qGray(seen.pixel(x, y)));
        }
    }
    CHECK(lightest - darkest > 120);  // the hint below the drawing
}

TEST_CASE("slice: a drawing is turned to run along the weft, and back") {
    const Slice slice = slice_of(System::weft, {"T0 P0 T1", "P0 T0", "T0 T1 P0"});
    OpenSliceEditor open(slice);
    QAction* turn = open.canvas().action("turn");
    CHECK(turn->text() == "Draw along the weft");
    turn->trigger();
    REQUIRE(open.edits.size() == 1);
    CHECK(open.slice() == slice_of(System::warp, {"P0 T0 P1", "T0 P0", "P0 P1 T0"}));
    CHECK(to_block(open.slice()).value().picks() == 1);
    CHECK(open.last_name() == "Draw along the weft");
    CHECK(turn->text() == "Draw along the warp");
    turn->trigger();
    CHECK(open.slice() == slice);
}

TEST_CASE("slice: a drawing with a disabled weft is not turned, and says why") {
    OpenSliceEditor open(slice_of(System::weft, {"T0 P0 (T1)", "P0 T0"}));
    open.canvas().action("turn")->trigger();
    CHECK(open.edits.empty());
    CHECK_FALSE(open.bubble().isEmpty());
    const auto* label = open.canvas().findChild<QLabel*>("bubble");
    CHECK(label->textFormat() == Qt::PlainText);
}

TEST_CASE("slice: screens, narrow and dark", "[.screens]") {
    const QPalette usual = QApplication::palette();
    for (const bool is_dark : {false, true}) {
        if (is_dark) QApplication::setPalette(dark());
        const QString kind = is_dark ? "dark" : "light";
        {
            Window open("shoe-adult");
            const auto keep = [&](const QString& name) {
                QTest::qWait(1500);
                open.window.grab().save(screen_file(QString("%1-%2.png").arg(kind, name)));
            };
            open.card->show_mode(CardMode::face_floats);
            open.window.document()->focus().go_to({2000, 800});
            keep("floats");
            open.card->show_mode(CardMode::card);
            open.card->canvas().zoom_by(60);
            keep("card-near");
            open.show_section(System::weft, {2000, 800});
            keep("section");
            choose(open.window, {"Block", "Stencil from the block shown"});
            open.window.findChild<QTabWidget*>("editors")->setCurrentIndex(2);
            keep("stencil");
        }
        SliceEditor editor;
        editor.resize(500, 420);
        editor.show();
        REQUIRE(QTest::qWaitForWindowExposed(&editor));
        editor.show_slice(slice_of(System::weft, {"T0 P0 T1", "P0 T0", "T0 T1 P0", "T0 (T1) P0"}));
        QTest::qWait(100);
        editor.grab().save(screen_file(QString("%1-narrow.png").arg(kind)));
    }
    QApplication::setPalette(usual);
}
