// Whole designs compared: whatever differs is told, in its own section.

#include <weave/core/json.hpp>
#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/diff/design_diff.hpp>
#include <weave/samples/samples.hpp>

#include <catch2/catch.hpp>

#include <design/random_design.hpp>

using namespace weave;
using weave::testing::for_all;
using weave::testing::property_cases;
using weave::testing::Random;

namespace {

WovenDesign woven(const Design& design) {
    return weave_design(design).value();
}

DesignDiff diff_of(const Design& before, const Design& after) {
    return diff_designs(woven(before), woven(after));
}

std::string hashes(const Design& design) {
    return design_sha256(design) + scene_sha256(design);
}

Design sample(const char* name) {
    return find_sample(name)->make();
}

/// Some edit that is allowed; nothing where none was found.
std::optional<Edit> random_edit(Random& random, const Design& design) {
    std::vector<std::string> names;
    for (const auto& [name, node] : design.blocks) names.push_back(name);
    const std::string name = names[random.between(0, names.size() - 1)];
    switch (random.between(0, 9)) {
        case 0:
            return PutBlock{random.coin() ? name : "fresh", weave::testing::random_node(random, {})};
        case 1:
            return RemoveBlock{name};
        case 2:
            return RenameBlock{name, "renamed"};
        case 3:
            return SetRoot{name};
        case 4:
            return PutFlip{name, {random.between(0, 5), random.between(0, 5), random.coin()}};
        case 5:
            return RemoveFlip{name, random.between(0, 5), random.between(0, 5)};
        case 6:
            return SetTitle{weave::testing::random_text(random), design.notes};
        case 7:
            return SetWarp{weave::testing::random_warp(random)};
        case 8:
            return SetWeft{weave::testing::random_weft(random)};
        default:
            return SetScene{weave::testing::random_scene(random)};
    }
}

void check_mirrored(const DesignDiff& there, const DesignDiff& back) {
    REQUIRE(there.is_same() == back.is_same());
    REQUIRE(there.tree.blocks.size() == back.tree.blocks.size());
    REQUIRE(there.tree.same_root == back.tree.same_root);
    const auto count = [](const DesignDiff& diff, ChangeKind kind) {
        return std::ranges::count(diff.tree.blocks, kind, &BlockChange::kind);
    };
    REQUIRE(count(there, ChangeKind::added) == count(back, ChangeKind::removed));
    REQUIRE(count(there, ChangeKind::renamed) == count(back, ChangeKind::renamed));
    REQUIRE(there.picks.size() == back.picks.size());
    REQUIRE(there.ends.size() == back.ends.size());
    REQUIRE(there.yarns.size() == back.yarns.size());
    REQUIRE(there.parameters.size() == back.parameters.size());
    REQUIRE(there.card.has_value() == back.card.has_value());
    if (there.card) REQUIRE(there.card->lifted == back.card->lowered);
}

/// Only these sections may tell something: a design that tells it in another hides it there.
std::string sections(const DesignDiff& diff) {
    std::string text;
    if (!diff.tree.is_same()) text += "tree ";
    if (!diff.picks.empty()) text += "picks ";
    if (!diff.ends.empty()) text += "ends ";
    if (!diff.yarns.empty()) text += "yarns ";
    if (!diff.parameters.empty()) text += "parameters ";
    return text;
}

bool tells(const Changes& changes, const std::string& where, const std::string& piece) {
    return std::ranges::any_of(changes, [&](const Change& change) {
        return change.where == where && change.text.find(piece) != std::string::npos;
    });
}

}  // namespace

TEST_CASE("two designs differ exactly where their documents do, and the other way round alike") {
    for_all(
        [](Random& random) {
            const Design before = weave::testing::random_design(random);
            Design after = before;
            for (std::size_t k = random.between(0, 3); k > 0; --k) {
                if (const auto edit = random_edit(random, after)) static_cast<void>(apply_edit(after, *edit));
            }
            const DesignDiff diff = diff_of(before, after);
            INFO(in_words(diff, "before", "after"));
            REQUIRE(diff.is_same() == (hashes(before) == hashes(after)));
            check_mirrored(diff, diff_of(after, before));
            REQUIRE(to_json(diff).at("equal") == diff.is_same());
        },
        property_cases() / 20);
}

TEST_CASE("two unrelated designs are compared as well") {
    for_all(
        [](Random& random) {
            const Design a = weave::testing::random_design(random), b = weave::testing::random_design(random);
            const DesignDiff diff = diff_of(a, b);
            REQUIRE(diff.is_same() == (hashes(a) == hashes(b)));
            check_mirrored(diff, diff_of(b, a));
        },
        property_cases() / 40);
}

TEST_CASE("each small change of one member is told in its own section") {
    const Design before = sample("layer-to-layer");
    const auto told = [&](auto change) {
        Design after = before;
        change(after);
        const DesignDiff diff = diff_of(before, after);
        CHECK_FALSE(diff.is_same());
        return sections(diff);
    };
    CHECK(told([](Design& d) { d.title += "!"; }) == "parameters ");
    CHECK(told([](Design& d) { d.notes += "!"; }) == "parameters ");
    CHECK(told([](Design& d) { d.scene.warp.strain = 1.01; }) == "parameters ");
    CHECK(told([](Design& d) { d.scene.pins.push_back({true, 1}); }) == "parameters ");
    CHECK(told([](Design& d) { d.scene.fields.push_back({}); }) == "parameters ");
    CHECK(told([](Design& d) { d.warp.ends_per_dent += 1; }) == "parameters ");
    CHECK(told([](Design& d) { d.weft.density_picks_per_cm += 1; }) == "parameters ");
    CHECK(told([](Design& d) { d.warp.yarns[0].bending_stiffness_N_mm2 *= 2; }) == "yarns ");
    CHECK(told([](Design& d) { d.weft.feeders.push_back({"spare", 0}); }) == "yarns ");
    CHECK(told([](Design& d) { d.warp.beams.push_back({"binder"}); }) == "yarns ");
    CHECK(told([](Design& d) { d.weft.take_up = {true}; }) == "picks ");
    CHECK(told([](Design& d) { d.weft.directions = {Direction::right_to_left}; }) == "picks ");
    CHECK(told([](Design& d) { d.blocks["spare"] = d.blocks.begin()->second; }) == "tree ");
    Design seen = before;
    seen.view["zoom"] = 2;
    const DesignDiff view = diff_of(before, seen);
    CHECK(view.is_same());
    CHECK(view.view_differs);
}

TEST_CASE("words say what changed, in numbers from 1") {
    const Design before = sample("layer-to-layer");
    Design after = before;
    after.warp.yarns[0].radius_mm = 0.25;
    after.weft.feeders = {{"shuttle 1", 0}, {"red\x1b[2J", 0}};
    after.weft.feeder_order = {{0}, {1}};
    after.scene.weft.strain = 1.5;
    const DesignDiff diff = diff_of(before, after);
    CHECK(tells(diff.yarns, "warp.yarns[0].radius_mm", "radius is 0.25 mm, was"));
    CHECK(tells(diff.yarns, "weft.feeders[1]", "feeder 2 'red\\x1b[2J' is new"));
    CHECK(tells(diff.parameters, "scene.weft.strain", "target strain is 1.5, was not set"));
    CHECK(tells(diff.picks, "weft.feeder_order", "every 2nd: feeder 2 'red\\x1b[2J', was 1 'shuttle 1'"));
    const std::string words = in_words(diff, "a.weave", "b.weave");
    CHECK(words.find("a.weave and b.weave differ: picks (") == 0);
    CHECK(words.find("The cards are equal") != std::string::npos);
    CHECK(words.find('\x1b') == std::string::npos);
}

TEST_CASE("a renamed block is known again, and so is one that is used elsewhere") {
    Design before = sample("layer-to-layer");
    const std::string root = before.root;
    const auto put = [](Design& design, const std::string& name, NodeSource source) {
        design.blocks[name] = std::make_shared<const Node>(Node{std::move(source), {}});
    };
    put(before, "left", TileOperation{root, 2, 1, 1});
    put(before, "right", TileOperation{root, 2, 1, 1});
    put(before, "inset", TileOperation{root, 1, 1, 1});
    put(before, "wide", AttachOperation{"left", "right", Face::plus_y});
    before.root = "wide";
    Design after = before;
    REQUIRE(apply_edit(after, RenameBlock{root, "ply"}));
    const DesignDiff renamed = diff_of(before, after);
    REQUIRE(renamed.tree.blocks.size() == 1);
    CHECK(renamed.tree.blocks[0].kind == ChangeKind::renamed);
    CHECK(renamed.tree.blocks[0].after == "ply");
    CHECK(renamed.card->is_same());

    put(after, "wide", AttachOperation{"left", "right", Face::minus_y});
    put(after, "left", TileOperation{"ply", 3, 1, 1});
    put(after, "right", TileOperation{"ply", 3, 1, 1});
    const DesignDiff changed = diff_of(before, after);
    REQUIRE(changed.tree.blocks.size() == 4);
    CHECK(changed.tree.blocks[1].text == "'left': repeats along the warp is 3, was 2");
    CHECK(changed.tree.blocks[3].text == "'wide': face is '-y', was '+y'");

    Design moved = before;
    put(moved, "inset", TileOperation{"wide", 1, 1, 1});
    put(moved, "end", AttachOperation{"right", "right", Face::plus_x});
    put(moved, "wide", TileOperation{"left", 1, 1, 1});
    const TreeDiff tree = diff_trees(before, moved);
    const auto right = std::ranges::find(tree.blocks, "right", &BlockChange::before);
    REQUIRE(right != tree.blocks.end());
    CHECK(right->kind == ChangeKind::moved);
    CHECK(right->text == "'right' has moved: part of 'end', was of 'wide'");
}

TEST_CASE("flips that were added are told with what they do") {
    const Design before = sample("plain");
    Design after = before;
    REQUIRE(apply_edit(after, PutFlip{after.root, {0, 0, !woven(before).cloth->card.weft_over(0, 0)}}));
    const DesignDiff diff = diff_of(before, after);
    REQUIRE(diff.tree.blocks.size() == 1);
    CHECK(diff.tree.blocks[0].text.find("1 flip more (pick 1, end 1: weft ") != std::string::npos);
    CHECK(diff.card->changed() == 1);
    CHECK(sections(diff) == "tree ");
}

TEST_CASE("a design without a cloth is compared in all but its card") {
    const Design before = sample("plain");
    Design after = before;
    after.blocks["odd"] =
        std::make_shared<const Node>(Node{AttachOperation{before.root, "tall", Face::plus_x}, {}});
    after.blocks["tall"] = std::make_shared<const Node>(Node{TileOperation{before.root, 1, 2, 1}, {}});
    after.root = "odd";
    after.warp.order = {{0, 0, 0}};
    const DesignDiff diff = diff_of(before, after);
    CHECK_FALSE(diff.card);
    CHECK(diff.no_card.find("the design after has no cloth: ") == 0);
    CHECK(sections(diff) == "tree yarns parameters ");
    CHECK(to_json(diff).at("pixels").at("compared").is_null());
}
