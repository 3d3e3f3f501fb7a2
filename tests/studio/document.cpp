#include <weave/block/changes.hpp>
#include <weave/curve/cloth_curves.hpp>

#include <studio/commands/add_block.hpp>
#include <studio/commands/attach_block.hpp>
#include <studio/commands/flip_stroke.hpp>
#include <studio/commands/set_scene.hpp>
#include <studio/commands/tile_block.hpp>
#include <studio/jobs/background.hpp>

#include <new>

#include <support/temporary_folder.hpp>
#include "document_case.hpp"

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

TEST_CASE("steps are undone and made again, and what the block comes to follows") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    settle(document);
    const CardImage before = document.shown().block->card_image();
    flip_at(document, 1, 2);
    CHECK(document.is_modified());
    settle(document);
    const CardImage flipped = document.shown().block->card_image();
    CHECK(flipped.weft_over(1, 2) != before.weft_over(1, 2));
    CHECK(document.shown().card->card == flipped);
    REQUIRE(document.shown().changed_cells);
    CHECK(document.shown().changed_cells->size() == 1);
    document.undo();
    CHECK_FALSE(document.is_modified());
    CHECK(document.design() == small_design());
    settle(document);
    CHECK(document.shown().card->card == before);
    document.redo();
    settle(document);
    CHECK(document.shown().card->card == flipped);
}

TEST_CASE("a flip that cannot be is refused with the yarns in the way, and changes nothing") {
    const weave::testing::TemporaryFolder folder;
    Document document(sample("pocket"), {}, true, folder.path);
    settle(document);
    const Block& block = *document.shown().block;
    std::size_t refused = 0;
    for (std::size_t pick = 0; pick < 8; ++pick) {
        for (std::size_t end = 0; end < 8; ++end) {
            const auto step = flip_crossing(document, {pick, end});
            CHECK(static_cast<bool>(step) == static_cast<bool>(flip(block, pick, end)));
            if (!step) ++refused;
        }
    }
    CHECK(refused > 0);
    CHECK(flip_crossing(document, {9999, 0}).error().code == ErrorCode::bad_input);
    CHECK(document.design() == sample("pocket"));
}

TEST_CASE("a flip before its block is made is judged by the design as it stands") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    settle(document);
    flip_at(document, 0, 0);
    REQUIRE_FALSE(document.shown_is_current());
    flip_at(document, 0, 0);  // back again: judged by the block of before it would be the same flip twice
    settle(document);
    CHECK(document.shown().block->card_image() == evaluate(small_design())->block->card_image());
}

TEST_CASE("a stroke gives its crossings one side as one step") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    settle(document);
    const std::vector<CardPlace> places{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}};
    const bool first = document.shown().block->weft_over(0, 0);
    const FlippedStroke flipped = flip_stroke(document, places);
    CHECK(flipped.refused.empty());
    REQUIRE(document.perform(flipped.step));
    settle(document);
    for (const CardPlace& place : places) CHECK(document.shown().block->weft_over(place.pick, place.end) != first);
    document.undo();
    CHECK(document.design() == small_design());
}

TEST_CASE("what a slider is drawn through is one step") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    Scene scene;
    for (int k = 1; k <= 5; ++k) {
        scene.friction = 0.1 * k;
        REQUIRE(document.perform(set_scene(document.design().scene, scene, true)));
    }
    CHECK(document.undo_stack().count() == 1);
    CHECK(document.undo_stack().undoText() == "Change the friction");
    document.undo();
    CHECK(document.design().scene == Scene{});
    document.redo();
    CHECK(document.design().scene.friction == Approx(0.5));
}

TEST_CASE("a step that fails in the middle leaves the design as it was") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    const EditStep step{"both", {SetTitle{"changed", ""}, RemoveBlock{"nothing"}}};
    CHECK_FALSE(document.perform(step));
    CHECK(document.design() == small_design());
    CHECK(document.undo_stack().count() == 0);
}

TEST_CASE("an edit of a child changes its parents") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    std::string name;
    REQUIRE(document.perform(*tile_block(document.design(), "face", 3, 2, 1, name)));
    CHECK(document.design().root == name);
    document.focus().show_block("face");
    settle(document);
    REQUIRE(QTest::qWaitFor([&] { return document.whole().block && document.whole().block->picks() == 15; }));
    flip_at(document, 0, 1);
    REQUIRE(QTest::qWaitFor([&] { return document.whole().revision == document.revision(); }));
    const Block& whole = *document.whole().block;
    const Block& face = *document.shown().block;
    for (std::size_t pick = 0; pick < whole.picks(); ++pick) {
        for (std::size_t end = 0; end < whole.ends(); ++end) REQUIRE(whole.weft_over(pick, end) == face.weft_over(pick % 5, end % 5));
    }
}

TEST_CASE("blocks that do not fit are refused in words and nothing is made") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    std::string name;
    REQUIRE(document.perform(add_block(document.design(), "plain", PresetLeaf{{"plain", {}}}, name)));
    const auto step = attach_block(document.design(), "face", "plain", Face::plus_x, name);
    REQUIRE_FALSE(step);
    CHECK(step.error().text().find("plain") != std::string::npos);
}

TEST_CASE("a layer on another keeps the cloth as wide as it was, and its warp as dense in each layer") {
    const weave::testing::TemporaryFolder folder;
    Document document(small_design(), {}, true, folder.path);
    const auto width = [&] {
        const auto block = evaluate(document.design())->block;
        return cloth_curves(document.design(), *block, {})->size_mm[1];
    };
    const double before = width(), density = document.design().warp.density_ends_per_cm;
    std::string name;
    const std::string root = document.design().root;
    REQUIRE(document.perform(*attach_block(document.design(), root, root, Face::minus_z, name)));
    CHECK(width() == Approx(before));
    CHECK(document.design().warp.density_ends_per_cm == Approx(2 * density));
    REQUIRE(document.perform(*attach_block(document.design(), name, name, Face::plus_x, name)));
    CHECK(document.design().warp.density_ends_per_cm == Approx(2 * density));
    document.undo();
    document.undo();
    CHECK(document.design().warp.density_ends_per_cm == density);
}

TEST_CASE("cells that changed are those whose stacks differ") {
    const auto before = evaluate(sample("pocket"));
    Block block = *before->block;
    Block after = apply_flips(block, std::vector<Flip>{{0, 0, !block.weft_over(0, 0)}, {40, 20, !block.weft_over(40, 20)}}).block;
    const auto changed = changed_cells(block, after);
    REQUIRE(changed);
    for (std::size_t cell = 0; cell < block.rows() * block.columns(); ++cell) {
        const bool differs = !(block.stack(cell / block.columns(), cell % block.columns()) == after.stack(cell / block.columns(), cell % block.columns()));
        CHECK(differs == (std::find(changed->begin(), changed->end(), cell) != changed->end()));
    }
    const auto patched = card_picture(after, *card_picture(block), *changed);
    CHECK(patched->card == after.card_image());
    CHECK(patched->coarse == card_picture(after)->coarse);
    CHECK_FALSE(changed_cells(block, *evaluate(small_design())->block));
}

TEST_CASE("a card is that of its block after a block was shown that cannot be made") {
    ClothMaker maker;
    Cloth cloth;
    QObject::connect(&maker, &ClothMaker::made, &maker, [&](const QString& block, const Cloth& made) {
        if (block == "face") cloth = made;
    });
    std::uint64_t revision = 0;
    const auto show = [&](const Design& design, const char* block) {
        maker.make(design, ++revision, block);
        REQUIRE(QTest::qWaitFor([&] { return cloth.revision == revision; }, 20000));
    };
    Design design = small_design(), flipped;
    design.blocks["never"] = std::make_shared<const Node>(Node{PresetLeaf{{"no such weave", {}}}, {}});
    flipped = design;
    flipped.blocks["face"] = std::make_shared<const Node>(Node{PresetLeaf{{"twill", {{"up", 1}, {"down", 4}}}}, {Flip{1, 2, true}, Flip{2, 2, true}}});
    show(flipped, "face");
    show(design, "never");  // `face` is told as well, being the cloth
    show(design, "face");
    REQUIRE(cloth.block);
    REQUIRE(cloth.card);
    CHECK(cloth.card->card == cloth.block->card_image());
}

TEST_CASE("work beside the window that throws ends nothing, and is an error where it can be one") {
    QObject receiver;
    Result<int> made = 0;
    in_background(&receiver, []() -> Result<int> { throw std::bad_alloc(); }, [&](Result<int> came) { made = std::move(came); });
    REQUIRE(QTest::qWaitFor([&] { return !made; }, 20000));
    CHECK(made.error().text().find("memory") != std::string::npos);
    bool came = false;
    in_background(&receiver, []() -> int { throw std::runtime_error("broken"); }, [&](int) { came = true; });
    QThreadPool::globalInstance()->waitForDone();
    QCoreApplication::processEvents();
    CHECK_FALSE(came);
}
