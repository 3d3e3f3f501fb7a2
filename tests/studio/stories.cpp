// The paper's study (section 7) as a person does it, in a real window with mouse and keys: a layer of two satins by a stencil, relaxed
// and mended by flips; a twill below it, sealed along the sides; and sealed at one end.

#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>

#include <studio/editors/card_editor.hpp>
#include <studio/editors/stencil_editor.hpp>
#include <studio/panels/design_tree.hpp>
#include <studio/panels/simulation_fidelity_group.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/panels/simulation_scene_group.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/main_window.hpp>

#include <QtTest>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <memory>

#include "support/hands.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

namespace {

constexpr std::size_t picks = 35, ends = 25;

/// The window with a person before it.
class Designer {
  public:
    Designer() {
        window.resize(1600, 1000);
        window.show();
        REQUIRE(QTest::qWaitForWindowExposed(&window));
        QApplication::setActiveWindow(&window);
        viewer().viewport()->set_animated(false);
    }

    void settle() {
        REQUIRE(until([&] { return window.document() != nullptr && window.document()->shown_is_current(); }));
        REQUIRE(until([&] { return window.document()->whole().revision == window.document()->revision(); }));
        QTest::qWait(50);
    }
    void choose_weave(QDialog& dialog, const QString& family, int size, int move) {
        choose_entry(dialog.findChild<QComboBox*>(), family);
        type_number(dialog.findChild<QSpinBox*>("size"), size);
        type_number(dialog.findChild<QSpinBox*>("move"), move);
        press(dialog, QDialogButtonBox::Ok);
    }
    void click_card(const CardPlace& place) {
        GridCanvas& canvas = card().canvas();
        QTest::mouseClick(&canvas, Qt::LeftButton, {}, canvas.mapping().box({place.pick, place.end}).center().toPoint());
    }
    void keep_screen(const char* name) {
        const char* folder = std::getenv("WEAVE_SCREENS");
        if (folder == nullptr) return;
        QTest::qWait(700);
        window.grab().toImage().convertToFormat(QImage::Format_RGB888).save(QString("%1/%2.png").arg(folder, name), "PNG", 0);
    }

    template <class Widget>
    Widget& find() {
        auto* found = window.findChild<Widget*>();
        REQUIRE(found != nullptr);
        return *found;
    }
    CardEditor& card() { return find<CardEditor>(); }
    ViewerPanel& viewer() { return find<ViewerPanel>(); }
    SimulationPanel& simulation() { return find<SimulationPanel>(); }
    QTabWidget& editors() { return *static_cast<QTabWidget*>(card().parentWidget()->parentWidget()); }
    void show_editor(const QString& name) {
        QTabBar* bar = editors().tabBar();
        for (int k = 0; k < bar->count(); ++k) {
            if (bar->tabText(k) == name && bar->isTabVisible(k)) return QTest::mouseClick(bar, Qt::LeftButton, {}, bar->tabRect(k).center());
        }
        FAIL("there is no editor " << name.toStdString());
    }
    [[nodiscard]] const Design& design() { return window.document()->design(); }
    [[nodiscard]] const CardImage& whole_card() {
        settle();
        return window.document()->whole().block ? m_card = window.document()->whole().block->card_image() : m_card;
    }

    MainWindow window;

  private:
    CardImage m_card;
};

QToolButton* button_of(QWidget& panel, const QAction* action) {
    for (auto* button : panel.findChildren<QToolButton*>()) {
        if (button->defaultAction() == action) return button;
    }
    return nullptr;
}

/// Task 1: a graphic of two satins.
void make_pattern(Designer& she) {
    with_dialog([&] { click(she.window.findChild<QAbstractButton*>("begin-weave")); },
                [&](QDialog& dialog) { she.choose_weave(dialog, "satin", 5, 2); });
    she.settle();
    with_dialog([&] { choose(she.window, {"Block", "Add a traditional weave …"}); },
                [&](QDialog& dialog) { she.choose_weave(dialog, "sateen", 5, 2); });
    she.settle();
    click_item(she.find<DesignTree>(), "satin");
    she.settle();
    choose(she.window, {"Block", "Stencil from the block shown"});
    she.settle();
    she.show_editor("Stencil");
    auto& stencil = she.find<StencilEditor>();
    with_dialog([&] { click(stencil.findChild<QAbstractButton*>("size")); },
                [&](QDialog& dialog) {
                    type_number(dialog.findChild<QSpinBox*>("columns"), ends);
                    type_number(dialog.findChild<QSpinBox*>("rows"), picks);
                    press(dialog, QDialogButtonBox::Ok);
                });
    she.settle();
    with_menu([&] { click(stencil.palette_list().findChild<QAbstractButton*>("add_block")); }, "sateen");
    she.settle();
    QListWidget& palette = stencil.palette_list().list();
    QTest::mouseClick(palette.viewport(), Qt::LeftButton, {}, palette.visualItemRect(palette.item(1)).center());
    for (QAction* tool : stencil.findChildren<QAction*>()) {
        if (tool->objectName() == "rectangle") click(button_of(stencil, tool));
    }
    StencilCanvas& canvas = stencil.canvas();
    const auto at = [&](std::size_t row, std::size_t column) { return canvas.place_of({static_cast<int>(column), static_cast<int>(row)}); };
    QTest::mousePress(&canvas, Qt::LeftButton, {}, at(8, 6));
    QTest::mouseMove(&canvas, at(20, 12));
    QTest::mouseMove(&canvas, at(26, 18));
    QTest::mouseRelease(&canvas, Qt::LeftButton, {}, at(26, 18));
    she.settle();
}

/// The same, by the library.
Design pattern_of_the_library() {
    Design design;
    design.root = "stencil";
    const auto satin = [](const char* family) { return std::make_shared<const Node>(Node{PresetLeaf{{family, {{"size", 5}, {"move", 2}}}}, {}}); };
    design.blocks["satin"] = satin("satin");
    design.blocks["sateen"] = satin("sateen");
    auto map = std::make_shared<StencilMap>();
    map->rows = picks;
    map->columns = ends;
    for (std::size_t row = 0; row < picks; ++row) {
        for (std::size_t column = 0; column < ends; ++column) map->blocks.push_back(row >= 8 && row <= 26 && column >= 6 && column <= 18 ? 1 : 0);
    }
    design.blocks["stencil"] = std::make_shared<const Node>(Node{StencilOperation{{"satin", "sateen"}, map}, {}});
    return design;
}

CardImage card_of(const Design& design) {
    const auto made = evaluate(design);
    REQUIRE(made);
    return made->block->card_image();
}

/// Waits until the viewer shows yarns that were measured, with their crossings.
void wait_for_relaxed(Designer& she) {
    REQUIRE(until([&] {
        const TubeModel* model = she.viewer().viewport()->model();
        return she.viewer().mode() == ViewerPanel::Mode::relaxed && model != nullptr && !model->crossings().empty();
    }));
}

void click_crossing(Designer& she, const CardPlace& place, const QString& item) {
    Viewport& view = *she.viewer().viewport();
    for (const ModelCrossing& crossing : view.model()->crossings()) {
        if (crossing.pick != place.pick || crossing.end != place.end) continue;
        const auto at = view.camera().project(crossing.place, {static_cast<double>(view.width()), static_cast<double>(view.height())});
        with_menu([&] { QTest::mouseClick(&view, Qt::LeftButton, {}, QPointF(at.x, at.y).toPoint()); }, item);
        return;
    }
    FAIL("no crossing of pick " << place.pick + 1 << " and end " << place.end + 1);
}

void run_to_rest(Designer& she) {
    SimulationPanel& simulation = she.simulation();
    click(button_of(simulation, simulation.run_action()));
    REQUIRE(QTest::qWaitFor([&] { return simulation.state().phase == RunPhase::at_rest; }, 240000));
    wait_for_relaxed(she);
}

/// Task 2: relaxed to rest, then crossings at the graphic's edge flipped in the relaxed cloth itself.
void relax_and_mend(Designer& she, const std::vector<CardPlace>& flaws) {
    choose_entry(she.simulation().fidelity()->choice(), "Draft");
    run_to_rest(she);
    she.keep_screen("story-2-relaxed");
    QTest::keyClick(she.viewer().viewport(), Qt::Key_1);
    QTest::keyClick(she.viewer().viewport(), Qt::Key_F);
    for (const CardPlace& flaw : flaws) {
        const int before = she.window.document()->undo_stack().count();
        click_crossing(she, flaw, "Flip pick");
        REQUIRE(QTest::qWaitFor([&] { return she.window.document()->undo_stack().count() == before + 1; }, 120000));
        REQUIRE(QTest::qWaitFor([&] { return she.simulation().state().phase == RunPhase::at_rest; }, 240000));
        wait_for_relaxed(she);
    }
    she.keep_screen("story-2-mended");
}

/// Task 3: a twill of the same size below, and the weft turned round the long sides.
void attach_and_wrap(Designer& she) {
    with_dialog([&] { choose(she.window, {"Block", "Add a traditional weave …"}); },
                [&](QDialog& dialog) {
                    choose_entry(dialog.findChild<QComboBox*>(), "twill");
                    type_number(dialog.findChild<QSpinBox*>("up"), 4);
                    type_number(dialog.findChild<QSpinBox*>("down"), 1);
                    press(dialog, QDialogButtonBox::Ok);
                });
    she.settle();
    with_dialog([&] { choose(she.window, {"Block", "The chosen block", "Repeat (tile) …"}); },
                [&](QDialog& dialog) {
                    type_number(dialog.findChild<QSpinBox*>("along"), 7);
                    type_number(dialog.findChild<QSpinBox*>("across"), 5);
                    press(dialog, QDialogButtonBox::Ok);
                });
    she.settle();
    click_item(she.find<DesignTree>(), "stencil");
    she.settle();
    // By the face in space: seen from below it is the back.
    ViewerPanel& viewer = she.viewer();
    choose_entry(viewer.findChild<QComboBox*>(), "Planned");
    REQUIRE(until([&] { return viewer.mode() == ViewerPanel::Mode::planned && viewer.viewport()->model() != nullptr; }));
    QTest::keyClick(viewer.viewport(), Qt::Key_2);
    QTest::keyClick(viewer.viewport(), Qt::Key_F);
    for (QToolButton* button : she.window.findChild<QToolBar*>("tools")->findChildren<QToolButton*>()) {
        if (button->text() == "Attach") click(button);
    }
    REQUIRE(viewer.viewport()->attach_mode());
    with_menu([&] { QTest::mouseClick(viewer.viewport(), Qt::LeftButton, {}, viewer.viewport()->rect().center()); }, "twill-repeated");
    she.settle();
    CHECK(she.design().root == "stencil-with-twill-repeated");
    choose_entry(she.simulation().scene()->weft_mode(), "Turns");
    REQUIRE(until([&] { return she.design().scene.weft_mode == WeftMode::wraparound; }));
    she.settle();
    she.keep_screen("story-3-attached");
}

/// The rows at the end that is closed.
constexpr std::size_t seam = 10;

/// For each column a crossing in the first rows where the uppermost yarn of the lower layer and the lowest of the upper one are a pick
/// and an end: flipped, they bind the two layers.
std::vector<CardPlace> bindings(const Block& pocket) {
    std::vector<CardPlace> places;
    for (std::size_t column = 0; column < pocket.columns(); ++column) {
        for (std::size_t row = 0; row < seam; ++row) {
            const auto slots = pocket.stack(row, column).slots();
            REQUIRE(slots.size() == 4);
            if (slots[1].same_system(slots[2])) continue;
            const Slot pick = slots[1].is_weft() ? slots[1] : slots[2], end = slots[1].is_weft() ? slots[2] : slots[1];
            places.push_back({pocket.first_pick(row) + pick.index(), pocket.first_end(column) + end.index()});
            break;
        }
    }
    return places;
}

/// Whether in that column, in one of the first rows, a yarn of the upper layer lies below one of the lower.
bool is_bound(const Block& open, const Block& closed, std::size_t column) {
    for (std::size_t row = 0; row < seam; ++row) {
        const auto was = open.stack(row, column).slots(), is = closed.stack(row, column).slots();
        const std::array lower{was[0], was[1]};
        if (!std::is_permutation(lower.begin(), lower.end(), is.begin())) return true;
    }
    return false;
}

/// Task 4: one short side closed, pair by pair, by flips on the card that bind both layers in the first picks.
std::vector<CardPlace> seal(Designer& she) {
    she.show_editor("Card");
    click_item(she.find<DesignTree>(), "stencil-with-twill-repeated");
    she.settle();
    const std::vector<CardPlace> places = bindings(*she.window.document()->whole().block);
    for (const CardPlace& place : places) {
        she.click_card(place);
        she.settle();
    }
    she.keep_screen("story-4-sealed");
    return places;
}

/// The whole pocket, by the library alone.
Design pocket_of_the_library(const std::vector<CardPlace>& mended, const std::vector<CardPlace>& sealed) {
    Design design = pattern_of_the_library();
    const auto flip = [&](const std::string& block, const CardPlace& place) {
        design.root = block;
        const bool over = card_of(design).weft_over(place.pick, place.end);
        REQUIRE(apply_edit(design, PutFlip{block, {place.pick, place.end, !over}}));
    };
    for (const CardPlace& place : mended) flip("stencil", place);
    design.blocks["twill"] = std::make_shared<const Node>(Node{PresetLeaf{{"twill", {{"up", 4}, {"down", 1}}}}, {}});
    design.blocks["twill-repeated"] = std::make_shared<const Node>(Node{TileOperation{"twill", 7, 5, 1}, {}});
    design.blocks["pocket"] = std::make_shared<const Node>(Node{AttachOperation{"stencil", "twill-repeated", Face::minus_z}, {}});
    design.root = "pocket";
    for (const CardPlace& place : sealed) flip("pocket", place);
    return design;
}

}  // namespace

TEST_CASE("the study: a pocket from two satins and a twill, drawn, relaxed, mended, attached and sealed", "[story]") {
    Designer she;
    make_pattern(she);
    CHECK(she.whole_card() == card_of(pattern_of_the_library()));
    CHECK(she.design().root == "stencil");
    she.keep_screen("story-1-pattern");
    const std::vector<CardPlace> flaws{{8, 7}, {20, 6}};
    relax_and_mend(she, flaws);
    attach_and_wrap(she);
    CHECK(she.whole_card() == card_of(pocket_of_the_library(flaws, {})));
    const BlockPtr open = she.window.document()->whole().block;
    const std::vector<CardPlace> sealed = seal(she);
    CHECK(she.whole_card() == card_of(pocket_of_the_library(flaws, sealed)));
    const BlockPtr closed = she.window.document()->whole().block;
    for (std::size_t column = 0; column < ends; ++column) {
        INFO("column " << column);
        CHECK_FALSE(is_bound(*open, *open, column));
        CHECK(is_bound(*open, *closed, column));
    }
}
