// A stencil in the main window, with the document that it belongs to.

#include <weave/core/file.hpp>
#include <weave/io/stencil_picture.hpp>

#include <studio/editors/stencil_dialogs.hpp>
#include <studio/panels/scaled_picture.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/window/main_window.hpp>
#include <studio/window/stencil_desk.hpp>

#include <QtTest>
#include <QtWidgets>

#include <catch2/catch.hpp>

#include "support/hands.hpp"
#include <support/temporary_folder.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

NodePtr stencil_of(std::size_t rows) {
    auto map = std::make_shared<const StencilMap>(StencilMap{rows, rows, std::vector<std::uint16_t>(rows * rows)});
    return std::make_shared<const Node>(Node{StencilOperation{{"plain"}, map}, {}});
}

Design two_stencils() {
    Design design;
    design.blocks["plain"] = std::make_shared<const Node>(Node{PresetLeaf{{"plain", {}}}, {}});
    design.blocks["one"] = stencil_of(2);
    design.blocks["two"] = stencil_of(4);
    design.root = "one";
    return design;
}

/// A window in which a stencil of one block was just begun, and is seen.
struct StencilCase {
    StencilCase() {
        window.show();
        REQUIRE(QTest::qWaitForWindowExposed(&window));
        QApplication::setActiveWindow(&window);
        window.show_sample("twill-2-2");
        REQUIRE(until([&] { return window.document()->shown_is_current(); }));
        choose(window, {"Block", "Stencil from the block shown"});
        window.findChild<QTabWidget*>("editors")->setCurrentWidget(&editor());
        REQUIRE(until([&] { return editor().isVisible() && window.document()->shown_is_current(); }));
    }
    StencilEditor& editor() { return *window.findChild<StencilEditor*>(); }
    StencilCanvas& canvas() { return editor().canvas(); }

    MainWindow window;
};

}  // namespace

TEST_CASE("stencil: a picture that was asked for in one stencil never comes into another") {
    const weave::testing::TemporaryFolder folder;
    const std::string path = (folder.path / "map.png").string();
    const Colour red{200, 0, 0};
    REQUIRE(write_file(path, write_png({2, 2, {red, red, red, red}}).value()));
    Document document(two_stencils(), {}, true, folder.path);
    StencilEditor editor;
    StencilDesk desk(editor, nullptr);
    desk.show_document(&document);
    editor.show();
    REQUIRE(QTest::qWaitForWindowExposed(&editor));
    REQUIRE(until([&] { return document.shown_is_current() && document.grid_of("plain") != nullptr; }));
    const auto ask = [&] {
        editor.load_picture(QString::fromStdString(path));
        REQUIRE(until([&] { return editor.findChild<PictureMapDialog*>() != nullptr; }));
        return editor.findChild<PictureMapDialog*>();
    };
    // The dialog is accepted, and the other stencil shown before the picture is mapped.
    PictureMapDialog* dialog = ask();
    const auto boxes = dialog->findChildren<QComboBox*>();
    REQUIRE(boxes.size() == 1);
    boxes[0]->setCurrentIndex(boxes[0]->findText("plain"));
    dialog->accept();
    document.focus().show_block("two");
    QThreadPool::globalInstance()->waitForDone();
    QCoreApplication::processEvents();
    CHECK(document.design() == two_stencils());
    CHECK(document.undo_stack().count() == 0);
    // A dialog goes with its stencil.
    const QPointer<PictureMapDialog> open = ask();
    document.focus().show_block("one");
    CHECK(until([&] { return !open; }));
    CHECK(document.undo_stack().count() == 0);
    desk.show_document(nullptr);
}

TEST_CASE("stencil: Space paints where the focus is, and runs no simulation") {
    StencilCase shown;
    QAction* run = shown.window.findChild<SimulationPanel*>()->run_action();
    QSignalSpy runs(run, &QAction::triggered);
    REQUIRE(until([&] { return run->isEnabled(); }));
    shown.canvas().setFocus();
    REQUIRE(shown.canvas().hasFocus());
    shown.canvas().set_tool(StencilTool::choose);
    QSignalSpy chosen(&shown.canvas(), &StencilCanvas::block_chosen);
    QTest::keyClick(&shown.canvas(), Qt::Key_Space);
    CHECK(runs.isEmpty());
    CHECK(chosen.size() == 1);
}

TEST_CASE("stencil: keys of the view act on the editor that is in sight") {
    StencilCase shown;
    const double before = shown.canvas().mapping().cell();
    choose(shown.window, {"View", "Smaller"});
    CHECK(shown.canvas().mapping().cell() < before);
}

TEST_CASE("the picture of changes takes Space for itself") {
    QMainWindow window;
    auto* picture = new ScaledPicture;
    window.setCentralWidget(picture);
    picture->set_image(QImage(40, 40, QImage::Format_RGB32));
    QAction run(&window);
    run.setShortcut(Qt::Key_Space);
    window.addAction(&run);
    window.show();
    REQUIRE(QTest::qWaitForWindowExposed(&window));
    QApplication::setActiveWindow(&window);
    picture->setFocus();
    QSignalSpy runs(&run, &QAction::triggered), large(picture, &ScaledPicture::large_wanted);
    QTest::keyClick(picture, Qt::Key_Space);
    CHECK(runs.isEmpty());
    CHECK(large.size() == 1);
}
