// The main window, by mouse and keys.

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

namespace {

constexpr int patience_ms = 180000;  // for what must come

}  // namespace

TEST_CASE("a window comes up with a start page: ways to begin, and samples with pictures") {
    Desk shown;
    auto& list = shown.find<QListWidget>("samples");
    CHECK(list.count() == static_cast<int>(samples().size()));
    CHECK(until([&] { return shown.find<QAbstractButton>("begin-open").isVisible(); }));
    CHECK(shown.window.document() == nullptr);
    QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(list.item(1)).center());
    REQUIRE(until([&] { return shown.window.document() != nullptr; }));
    CHECK(shown.document().design() == samples()[1].make());
    CHECK_FALSE(shown.document().is_modified());
}

TEST_CASE("in the smallest window every way to begin is to be read whole") {
    Desk shown;
    shown.window.resize(10, 10);
    REQUIRE(until([&] { return shown.window.width() < 900; }));
    for (const char* name : {"begin-tutorial", "begin-weave", "begin-drawing", "begin-open"}) {
        INFO(name);
        auto& way = shown.find<QCommandLinkButton>(name);
        CHECK(until([&] { return way.height() >= way.heightForWidth(way.width()); }));
    }
}

TEST_CASE("a picture in colours is no card, but may become a stencil with a weave for each colour") {
    const weave::testing::TemporaryFolder folder;
    const Colour red{200, 0, 0}, blue{0, 0, 200};
    const QString path = QString::fromStdString(file_of(folder, "heart.png", write_png({2, 3, {red, red, blue, blue, red, red}}).value()));
    Desk shown("twill-2-2");
    with_dialog([&] { shown.window.open_file(path); }, [&](QDialog& offer) {
        CHECK(qobject_cast<QMessageBox*>(&offer)->text().contains("heart.png"));
        press(offer, "Cancel");
    });
    CHECK(shown.document().design() == find_sample("twill-2-2")->make());
    QTimer hands;  // the question about the weaves opens while the offer is being answered
    QObject::connect(&hands, &QTimer::timeout, [&] {
        auto* weaves = qobject_cast<PictureMapDialog*>(QApplication::activeModalWidget());
        if (weaves == nullptr || !weaves->isVisible()) return;
        hands.stop();
        const auto boxes = weaves->findChildren<QComboBox*>();
        REQUIRE(boxes.size() == 2);
        choose_entry(boxes[0], "satin-5");  // red, of which there is most
        choose_entry(boxes[1], "plain");
        press(*weaves, QDialogButtonBox::Ok);
    });
    hands.start(10);
    with_dialog([&] { shown.window.open_file(path); }, [](QDialog& offer) { press(offer, "Use it as a stencil"); });
    REQUIRE(until([&] { return shown.document().design().root == "stencil"; }));
    shown.settle();
    const Design& design = shown.document().design();
    const auto& stencil = std::get<StencilOperation>(design.blocks.at("stencil")->source);
    CHECK(stencil.of == std::vector<std::string>{"satin-5", "plain"});
    CHECK(stencil.map->blocks == std::vector<std::uint16_t>{0, 0, 1, 1, 0, 0});
    CHECK(std::get<PresetLeaf>(design.blocks.at("satin-5")->source).preset.family == "satin");
    CHECK(design.title == "heart");
    REQUIRE(shown.document().whole().block);
    CHECK(shown.document().whole().block->picks() == 2);
    CHECK(shown.document().path().isEmpty());
}

TEST_CASE("a picture of the 3D view is saved where one says, or it is told why not") {
    const weave::testing::TemporaryFolder folder;
    Desk shown("twill-2-2");
    auto& viewer = shown.find<ViewerPanel>();
    REQUIRE(until([&] { return viewer.viewport()->model() != nullptr; }));
    const auto save_as = [&](const QString& path) {
        with_dialog([&] { viewer.menu_actions().back()->trigger(); }, [&](QDialog& dialog) {
            dialog.findChild<QLineEdit*>()->setText(path);
            press(dialog, QDialogButtonBox::Save);
        });
    };
    const QString path = QString::fromStdString((folder.path / "seen.png").string());
    save_as(path);
    REQUIRE(until([&] { return QFile::exists(path); }));
    CHECK(QImage(path).width() == 2 * viewer.viewport()->width());
    const std::filesystem::path closed = folder.path / "closed";
    std::filesystem::create_directory(closed);
    save_as(QString::fromStdString((closed / "no" / ".." / ("x" + std::string(300, 'x') + ".png")).string()));
    CHECK(until([&] { return shown.said().contains("cannot be written"); }));
}

TEST_CASE("the window is there before unsaved work is read, which then comes with what could not be read") {
    const weave::testing::TemporaryFolder folder;
    const Design pocket = find_sample("pocket")->make();
    {
        Document first(pocket, {}, true, folder.path), second(pocket, {}, false, folder.path);
        REQUIRE(first.perform({"title", {SetTitle{"unsaved", ""}}}));
        second.keeper().flush();
        for (const auto& each : std::filesystem::directory_iterator(folder.path)) {
            const auto now = read_file(each.path() / "now");
            if (now && now->find("\"is_saved\":false") != std::string::npos) std::filesystem::resize_file(each.path() / "now", 3);
        }
    }
    Windows windows;
    windows.open({});
    REQUIRE(windows.all().size() == 1);
    MainWindow& window = *windows.all().front();
    CHECK(window.isVisible());
    windows.recover(folder.path);
    CHECK(window.document() == nullptr);
    REQUIRE(until([&] { return window.document() != nullptr; }));
    CHECK(window.document()->design().title == "unsaved");
    CHECK(until([&] { return window.document()->shown_is_current(); }));  // it was made in another thread, and lives in this one
    CHECK(window.document()->is_modified());
    CHECK(windows.all().size() == 1);
    CHECK(window.findChild<MessageBar*>("messages")->words().contains(".broken"));
    window.document()->discard();
}

TEST_CASE("what is drawn or typed after a release, or in another field, is undone by itself") {
    Desk shown("twill-2-2");
    auto& panel = shown.find<SimulationPanel>();
    Scene scene = shown.document().design().scene;
    const auto draw = [&](double friction, bool is_dragging) {
        scene.friction = friction;
        Q_EMIT panel.scene_edited(scene, is_dragging);
    };
    draw(0.11, true);
    draw(0.12, true);
    draw(0.12, false);  // released
    draw(0.13, true);
    CHECK(shown.document().undo_stack().count() == 2);
    shown.find<YarnsPanel>().parentWidget()->raise();
    auto& notes = shown.find<QPlainTextEdit>("notes");
    auto& title = shown.find<QLineEdit>("title");
    const auto type = [](QWidget& field, const QString& text) {
        field.setFocus();
        QTest::keyClicks(&field, text);
    };
    type(notes, "soft");
    CHECK(shown.document().undo_stack().count() == 3);
    title.setFocus();
    type(notes, "er");
    CHECK(shown.document().undo_stack().count() == 4);
    type(title, "x");
    QTest::keyClick(&title, Qt::Key_Return);
    CHECK(shown.document().undo_stack().count() == 5);
    shown.document().undo();
    CHECK(notes.toPlainText().contains("softer"));
}

TEST_CASE("undo and redo are in the menu, by name, and on their keys") {
    Desk shown("twill-2-2");
    REQUIRE(shown.document().perform({"the title", {SetTitle{"changed", ""}}}));
    QTest::keyClick(&shown.window, Qt::Key_Z, Qt::ControlModifier);
    CHECK(shown.document().design().title != "changed");
    const auto* status = shown.window.statusBar()->findChild<QLabel*>();
    CHECK(status->text() == "Undone: the title");  // no longer what the step itself said
    QTest::keyClick(&shown.window, Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    CHECK(shown.document().design().title == "changed");
    CHECK(status->text() == "Done again: the title");
    choose(shown.window, {"Edit", "Undo: the title"});
    CHECK(shown.document().design().title != "changed");
}

TEST_CASE("no words are cut in docks as wide as they come") {
    Desk shown("pocket");
    shown.window.resize(1650, 1000);
    const auto raise = [&](const char* dock) {
        shown.find<QDockWidget>(dock).raise();
        QCoreApplication::processEvents();
    };
    const auto room_for = [](const QWidget& field, const QString& words) { return field.width() - field.fontMetrics().horizontalAdvance(words); };
    shown.find<SimulationPanel>().tabs()->setCurrentIndex(2);
    raise("simulation-dock");
    const auto& weft = shown.find<QComboBox>("weft_mode");
    REQUIRE(weft.isVisible());
    CHECK(room_for(weft, weft.currentText()) > weft.height());  // beside its arrow
    raise("submit-dock");
    const auto& fingerprint = shown.find<QLineEdit>("fingerprint");
    REQUIRE(fingerprint.isVisible());
    CHECK(room_for(fingerprint, fingerprint.placeholderText()) > 8);
    raise("yarns-dock");
    auto& yarns = shown.find<YarnsPanel>();
    REQUIRE(yarns.isVisible());
    const auto* scroll = yarns.findChild<QScrollArea*>();
    CHECK(scroll->widget()->width() <= scroll->viewport()->width());
    CHECK(yarns.width() <= yarns.parentWidget()->width());
    auto& findings = shown.find<FindingsPanel>();
    REQUIRE(until([&] { return findings.report().has_value(); }));
    auto& list = shown.find<QTreeWidget>("findings");
    const QTreeWidgetItem* unjudged = list.topLevelItem(list.topLevelItemCount() - 1);
    REQUIRE(unjudged->childCount() > 0);
    CHECK(unjudged->child(0)->isFirstColumnSpanned());
}

TEST_CASE("blocks are copied, pasted, duplicated, renamed and removed") {
    Desk shown("pocket");
    auto& tree = shown.find<DesignTree>();
    click_item(tree, "layers");
    shown.settle();
    CHECK(shown.document().shown_block() == "layers");
    QTest::keyClick(&shown.window, Qt::Key_D, Qt::ControlModifier);
    CHECK(shown.document().design().blocks.contains("layers-2"));
    shown.settle();
    click_item(tree, "layers-2");
    QTest::keyClick(&shown.window, Qt::Key_C, Qt::ControlModifier);
    choose(shown.window, {"Block", "The chosen block", "Remove"});
    CHECK_FALSE(shown.document().design().blocks.contains("layers-2"));
    QTest::keyClick(&shown.window, Qt::Key_V, Qt::ControlModifier);
    CHECK(shown.document().design().blocks.contains("layers-2"));
    click_item(tree, "body");
    choose(shown.window, {"Block", "The chosen block", "Remove"});
    CHECK(shown.document().design().blocks.contains("body"));
    CHECK(shown.said().contains("still used"));
}

TEST_CASE("the finding that is clicked is shown, and each rule knows what would mend it") {
    for (const Rule& rule : rules()) CHECK_FALSE(fix_for(rule.id).isEmpty());
    Design design;
    design.root = "loose";
    Slice slice;
    slice.dots = System::weft;
    for (int position = 0; position < 6; ++position) slice.positions.push_back({{Slot::weft(0)}, {Slot::warp(0)}});
    design.blocks["loose"] = std::make_shared<const Node>(Node{SliceLeaf{slice}, {}});
    Desk shown;
    shown.window.show_design(design, {}, true);
    auto& list = shown.find<QTreeWidget>("findings");
    REQUIRE(until([&] { return list.topLevelItemCount() > 0 && list.topLevelItem(0)->childCount() > 0; }));
    QTreeWidgetItem* group = list.topLevelItem(0);
    CHECK(group->text(0).startsWith("bind."));
    CHECK_FALSE(group->text(1).isEmpty());
    group->setExpanded(true);
    QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(group->child(0)).center());
    REQUIRE(shown.document().focus().place().has_value());
    // The end stands out among the yarns until it is let go, or another block is looked at; no pick does, as none is named.
    auto& viewport = *shown.find<ViewerPanel>().viewport();
    const std::size_t end = shown.document().focus().place()->end;
    CHECK(viewport.pointed_out() == std::vector<YarnName>{{System::warp, end}});
    CHECK(viewport.hint().contains(QString("end %1").arg(end + 1)));
    list.setFocus();
    QTest::keyClick(&list, Qt::Key_Escape);
    CHECK(viewport.pointed_out().empty());
    QTest::mouseClick(list.viewport(), Qt::LeftButton, {}, list.visualItemRect(group->child(0)).center());
    REQUIRE_FALSE(viewport.pointed_out().empty());
    REQUIRE(shown.document().perform({"other", {PutBlock{"other", design.blocks["loose"]}}}));
    shown.document().focus().show_block("other");
    CHECK(viewport.pointed_out().empty());
}

TEST_CASE("yarns are set up in words that count from 1, and what is wrong is told and not taken") {
    CHECK(with_numbers_moved("0*12 1 0+1 -", 1) == "1*12 2 1+2 -");
    CHECK(with_numbers_moved("1*12 2 1+2 - x", -1) == "0*12 1 0+1 - x");
    CHECK(wrong_in_order("1*12  2", 2, false).isEmpty());
    CHECK(wrong_in_order("1*2 - 1+2*3", 2, true).isEmpty());
    CHECK(wrong_in_order("1*3 5", 2, false) == "there is no number 5: they go from 1 to 2");
    CHECK(wrong_in_order("1 0*3", 2, false) == "there is no number 0: they go from 1 to 2");
    for (const char* word : {"abc", "1*", "1*0", "-", "1+2", "-1", "1**2"}) CHECK(wrong_in_order(word, 2, false).contains(word));
    Desk shown("pocket");
    auto& panel = shown.find<YarnsPanel>();
    panel.parentWidget()->raise();
    auto& order = shown.find<QLineEdit>("warp-order");
    const WarpPlan before = shown.document().design().warp;
    const auto type = [&](const QString& text) {
        order.selectAll();
        QTest::keyClicks(&order, text);
        QTest::keyClick(&order, Qt::Key_Return);
    };
    type("1*3 2");
    CHECK(shown.document().design().warp.order.once == std::vector<std::uint32_t>{0, 0, 0, 1});
    type("1 7");
    CHECK(shown.document().design().warp.order.once == std::vector<std::uint32_t>{0, 0, 0, 1});
    CHECK(shown.find<QLabel>("yarns-trouble").text().contains("Not taken"));
    QTest::keyClick(&shown.window, Qt::Key_Z, Qt::ControlModifier);
    shown.document().undo();
    CHECK(shown.document().design().warp == before);
}

TEST_CASE("the tutorial goes on by what is done, and ends with a pocket") {
    Desk shown;
    click(&shown.find<QAbstractButton>("begin-tutorial"));
    shown.settle();
    auto& tutorial = shown.find<Tutorial>();
    REQUIRE(tutorial.isVisible());
    CHECK(tutorial.step() == 0);
    with_dialog([&] { choose(shown.window, {"Block", "Repeat the block shown …"}); },
                [&](QDialog& dialog) {
                    type_number(dialog.findChild<QSpinBox*>("along"), 10);
                    type_number(dialog.findChild<QSpinBox*>("across"), 10);
                    press(dialog, QDialogButtonBox::Ok);
                });
    shown.settle();
    CHECK(tutorial.step() == 1);
    choose(shown.window, {"Simulation", "Run"});
    REQUIRE(QTest::qWaitFor([&] { return tutorial.step() == 2; }, patience_ms));
    auto& canvas = shown.find<CardEditor>().canvas();
    QTest::mouseClick(&canvas, Qt::LeftButton, {}, canvas.mapping().box({2, 1}).center().toPoint());
    shown.settle();
    CHECK(tutorial.step() == 3);
    const std::string layer = shown.document().shown_block();
    choose(shown.window, {"Block", "The chosen block", "Attach a block", "below, on the back", QString::fromStdString(layer)});
    shown.settle();
    CHECK(tutorial.step() == 4);
    shown.find<SimulationPanel>().tabs()->setCurrentIndex(2);
    auto& weft = shown.find<QComboBox>("weft_mode");
    REQUIRE(weft.isVisible());
    weft.setFocus();
    QTest::keyClick(&weft, Qt::Key_Down);
    CHECK(tutorial.step() == Tutorial::steps);
    CHECK(shown.document().design().scene.weft_mode == WeftMode::wraparound);
    shown.document().undo();
    CHECK(tutorial.step() == 4);  // taken back is not done
    shown.document().undo();
    shown.settle();
    CHECK(tutorial.step() == 3);
    shown.document().redo();
    shown.settle();
    CHECK(tutorial.step() == 4);
    const weave::testing::TemporaryFolder folder;
    shown.document().save(QString::fromStdString((folder.path / "pocket.json").string()));
    REQUIRE(until([&] { return !shown.document().is_modified(); }));
    shown.window.show_sample("plain");
    CHECK_FALSE(tutorial.isVisible());
}

TEST_CASE("a click on 'Show me where' leaves the keys where they were") {
    Desk shown;
    click(&shown.find<QAbstractButton>("begin-tutorial"));
    shown.settle();
    shown.find<CardEditor>().canvas().setFocus();
    REQUIRE(shown.find<CardEditor>().canvas().hasFocus());
    for (QPushButton* button : shown.find<Tutorial>().findChildren<QPushButton*>()) {
        if (button->isVisible() && button->text().startsWith("Show")) click(button);
    }
    CHECK(shown.find<CardEditor>().canvas().hasFocus());
}

TEST_CASE("a block of a cloth of two layers is drawn as wide as it lies there") {
    Desk shown("plain");
    const auto size = [&] {
        const TubeModel* model = shown.find<ViewerPanel>().viewport()->model();
        return model == nullptr ? std::array<double, 2>{} : model->size_mm();
    };
    REQUIRE(until([&] { return size()[0] > 0; }));
    const std::array<double, 2> alone = size();
    const std::string layer = shown.document().shown_block();
    choose(shown.window, {"Block", "The chosen block", "Attach a block", "below, on the back", QString::fromStdString(layer)});
    shown.settle();
    REQUIRE(shown.document().shown_block() != layer);
    CHECK(shown.document().whole().block->ends() == 2 * shown.document().whole().block->columns());
    shown.document().focus().show_block(layer);
    CHECK(until([&] {
        const TubeModel* model = shown.find<ViewerPanel>().viewport()->model();
        return model != nullptr && !model->find(System::warp, 2) && std::abs(size()[0] - alone[0]) < 1e-9 && std::abs(size()[1] - alone[1]) < 1e-9;
    }));
}

TEST_CASE("a drawing that is begun is there to be drawn in") {
    Desk shown("plain");
    choose(shown.window, {"Block", "Add a drawing (slice)"});
    CHECK(shown.find<SliceEditor>().isVisible());
}

TEST_CASE("a stencil that is begun is there to be painted") {
    Desk shown("plain");
    choose(shown.window, {"Block", "Stencil from the block shown"});
    CHECK(shown.find<StencilEditor>().isVisible());
    shown.document().undo();
    CHECK_FALSE(shown.find<StencilEditor>().isVisible());
    CHECK(shown.find<CardEditor>().isVisible());
}

TEST_CASE("the window fits the screen of a laptop, and the first step of the tutorial is to be read whole") {
    Desk shown;
    const int em = shown.window.fontMetrics().height();
    CHECK(shown.window.minimumSizeHint().width() <= 80 * em);   // 1,280 pixels where a line has 16
    CHECK(shown.window.minimumSizeHint().height() <= 48 * em);  // 768
    click(&shown.find<QAbstractButton>("begin-tutorial"));
    shown.settle();
    auto& text = shown.find<QLabel>("tutorial-text");
    REQUIRE(until([&] { return text.isVisible(); }));
    CHECK(until([&] { return text.visibleRegion().boundingRect().height() >= text.heightForWidth(text.width()); }));
}

TEST_CASE("the plan of a large block moves to where the person goes, and stays while he works there") {
    Desk shown("plain");
    std::string name;
    REQUIRE(shown.document().perform(*tile_block(shown.document().design(), shown.document().shown_block(), 30, 30, 1, name)));
    shown.document().focus().show_block(name);
    shown.settle();
    auto& viewer = shown.find<ViewerPanel>();
    viewer.viewport()->set_animated(false);  // a view that still glides is not the one to compare with
    const auto shows = [&](std::size_t pick, std::size_t end) {
        return until([&] {
            const TubeModel* model = viewer.viewport()->model();
            if (model == nullptr) return false;
            return model->find(System::weft, pick).has_value() && model->find(System::warp, end).has_value();
        });
    };
    const std::size_t last = shown.document().shown().block->picks() - 1;
    REQUIRE(shown.document().shown().block->picks() * shown.document().shown().block->ends() > ViewerDesk::most_cells);
    shown.document().focus().go_to({last, last});
    REQUIRE(shows(last, last));
    const auto looks_at_it = [&] {
        const Box seen = viewer.viewport()->shown_box();
        return ((seen.low + seen.high) / 2 - viewer.viewport()->camera().centre).norm() < 0.1;
    };
    REQUIRE(until(looks_at_it));
    const Json before = viewer.viewport()->camera().to_json();
    const Box box = viewer.viewport()->shown_box();
    QSignalSpy made(&viewer, &ViewerPanel::model_shown);
    shown.document().focus().go_to({last - 17, last - 20});
    REQUIRE(shown.document().perform(*flip_crossing(shown.document(), {last - 17, last - 20})));
    REQUIRE(made.wait(patience_ms));
    CHECK(viewer.viewport()->camera().to_json() == before);
    CHECK((viewer.viewport()->shown_box().low - box.low).norm() < 0.5);
}

TEST_CASE("a click on the relaxed cloth is one on the cloth, whichever of its blocks is being edited") {
    Desk shown("pocket");
    auto& viewer = shown.find<ViewerPanel>();
    shown.document().focus().show_block("seam");
    shown.settle();
    viewer.set_mode(ViewerPanel::Mode::relaxed);
    Q_EMIT viewer.viewport()->yarn_clicked(System::weft, 70, Vec3{0, 0, 0});
    CHECK(shown.document().shown_block() == shown.document().design().root);
    CHECK(shown.document().focus().place()->pick == 70);
}

TEST_CASE("the guide opens in the window, with its pictures and its keys") {
    Desk shown;
    choose(shown.window, {"Help", "Keys and mouse"});
    auto& help = shown.find<HelpWindow>();
    REQUIRE(until([&] { return help.isVisible(); }));
    CHECK(help.text()->textCursor().block().text() == "Keys and mouse");
    const QString guide = help.text()->toPlainText();
    CHECK(guide.contains("A second layer"));
    std::size_t pictures = 0;
    for (const auto& format : help.text()->document()->allFormats()) {
        if (!format.isImageFormat()) continue;
        ++pictures;
        CHECK_FALSE(help.text()->document()->resource(QTextDocument::ImageResource, QUrl(format.toImageFormat().name())).value<QImage>().isNull());
    }
    CHECK(pictures >= 8);
}

TEST_CASE("a yarn clicked in space is shown on the card, and a section follows") {
    Desk shown("twill-2-2");
    auto& viewer = shown.find<ViewerPanel>();
    REQUIRE(until([&] { return viewer.viewport()->model() != nullptr; }));
    Q_EMIT viewer.viewport()->yarn_clicked(System::weft, 2, Vec3{0, 0, 0});
    REQUIRE(shown.document().focus().place());
    CHECK(shown.document().focus().place()->pick == 2);
    REQUIRE(shown.find<CardEditor>().canvas().cursor_cell());
    CHECK(shown.find<CardEditor>().canvas().cursor_cell()->row == 2);
}

TEST_CASE("a card that is likely to be of several layers says so, and is read as such when it is told") {
    const weave::testing::TemporaryFolder folder;
    const auto pocket = evaluate(find_sample("pocket")->make());
    REQUIRE(pocket);
    const CardImage card = pocket->block->card_image();
    const std::string path = file_of(folder, "pocket.png", write_proven_bitmap(card, BitmapFormat::png).value());
    Desk shown;
    shown.window.open_file(QString::fromStdString(path));
    REQUIRE(until([&] { return shown.said().contains("may be of several"); }));
    shown.settle();
    CHECK(shown.document().shown().block->rows() == card.picks());
    bool asked = false;
    with_dialog(
        [&] {
            choose(shown.window, {"Block", "The chosen block", "Layers of the card …"});
            REQUIRE(until([&] { return asked; }));
        },
        [&](QDialog& dialog) {
            asked = true;
            auto* list = dialog.findChild<QListWidget*>("groupings");
            const auto wanted = list->findItems("2 picks a row, 2 ends a column", Qt::MatchStartsWith);
            REQUIRE(wanted.size() == 1);
            QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualItemRect(wanted.front()).center());
            press(dialog, QDialogButtonBox::Ok);
        });
    shown.settle();
    CHECK(shown.document().shown().block->rows() == card.picks() / 2);
    CHECK(shown.document().shown().block->columns() == card.ends() / 2);
    CHECK(shown.document().shown().block->card_image() == card);
    shown.document().undo();
    shown.settle();
    CHECK(shown.document().shown().block->rows() == card.picks());
}

TEST_CASE("a block that lies 64 deep is in the tree, to be read and shown; one that many use makes no tree without end") {
    Design design;
    design.blocks["deep-0"] = std::make_shared<const Node>(Node{PresetLeaf{{"plain", {}}}, {}});
    for (int k = 1; k <= 64; ++k) {
        const std::string below = "deep-" + std::to_string(k - 1), side = "side-" + std::to_string(k);
        const bool is_twice = k % 8 == 1;  // made from the one below it twice over
        if (is_twice) design.blocks[side] = std::make_shared<const Node>(Node{TileOperation{below, 1, 1, 1}, {}});
        design.blocks["deep-" + std::to_string(k)] =
            std::make_shared<const Node>(Node{is_twice ? NodeSource(AttachOperation{side, below, Face::plus_x}) : NodeSource(TileOperation{below, 1, 1, 1}), {}});
    }
    design.root = "deep-64";
    Desk desk;
    desk.window.show_design(design, {}, true);
    desk.settle();
    auto& tree = desk.find<DesignTree>();
    int items = 0;
    for (QTreeWidgetItemIterator item(&tree); *item != nullptr; ++item) ++items;
    CHECK(items < 1000);
    const auto seen = [&] { return tree.visualItemRect(tree.currentItem()).intersected(tree.viewport()->rect()).width(); };
    const int a_name = 12 * tree.fontMetrics().averageCharWidth();
    desk.document().focus().show_block("deep-0");
    REQUIRE(tree.currentItem()->text(0).startsWith("deep-0\n"));
    int depth = 0;
    for (const QTreeWidgetItem* item = tree.currentItem(); item->parent() != nullptr; item = item->parent()) ++depth;
    CHECK(depth >= 64);
    CHECK(until([&] { return seen() >= a_name; }));
    tree.setFocus();
    QTest::keyClick(&tree, Qt::Key_Up);
    CHECK(until([&] { return desk.document().shown_block() == "side-1"; }));
    CHECK(until([&] { return seen() >= a_name; }));
}
