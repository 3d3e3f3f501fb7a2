// Choosing a traditional weave, and where a block may be attached.

#include <weave/samples/samples.hpp>

#include <studio/panels/attach_menu.hpp>
#include <studio/panels/preset_dialog.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::studio;

TEST_CASE("traditional weaves have plain names, a yes or no is a box to tick, and the move is explained") {
    PresetDialog dialog;
    auto* families = dialog.findChild<QComboBox*>();
    CHECK(families->findText("Pointed twill") >= 0);
    dialog.set_preset({"satin", {{"size", 8}, {"weft-faced", 1}}});
    CHECK(families->currentText() == "Satin");
    auto* face = dialog.findChild<QCheckBox*>("weft-faced");
    REQUIRE(face != nullptr);
    CHECK(face->isChecked());
    CHECK(dialog.preset().options == std::map<std::string, std::int64_t>{{"size", 8}, {"weft-faced", 1}});
    face->setChecked(false);
    CHECK(dialog.preset().family == "satin");
    CHECK(dialog.preset().options == std::map<std::string, std::int64_t>{{"size", 8}});
    CHECK(dialog.findChild<QSpinBox*>("move")->toolTip().contains("binding point of the next pick"));
}

TEST_CASE("why a block cannot be attached is said whole, below its name") {
    Design design = find_sample("pocket")->make();
    for (const char* name : {"plain", "satin-e"}) {
        const Design other = find_sample(name)->make();
        design.blocks[name] = other.blocks.at(other.root);
    }
    QMenu menu;
    offer_blocks(menu, design, design.root, Face::plus_x, [](const std::string&) {});
    std::size_t reasons = 0, refused = 0;
    for (const QAction* action : menu.actions()) {
        CHECK_FALSE(action->text().endsWith("…"));
        refused += action->isEnabled() || action->isSeparator() ? 0 : 1;
        const auto* shown = qobject_cast<const QWidgetAction*>(action);
        const auto* label = shown == nullptr ? nullptr : qobject_cast<QLabel*>(shown->defaultWidget());
        if (label == nullptr || !label->wordWrap()) continue;
        ++reasons;
        CHECK(label->isEnabled());
        CHECK(label->text().contains(action->text()));
        CHECK(label->textFormat() == Qt::PlainText);
    }
    menu.popup({0, 0});
    for (const QAction* action : menu.actions()) {
        const auto* shown = qobject_cast<const QWidgetAction*>(action);
        const auto* label = shown == nullptr ? nullptr : qobject_cast<QLabel*>(shown->defaultWidget());
        if (label == nullptr || !label->wordWrap()) continue;
        const int right = label->mapTo(&menu, label->contentsRect().topRight()).x();
        CHECK(right + label->fontMetrics().height() / 2 < menu.width());  // clear of the menu's rim
    }
    menu.close();
    CHECK(reasons > 0);
    CHECK(reasons == refused);
}
