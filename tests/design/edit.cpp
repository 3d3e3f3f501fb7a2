#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>

#include <catch2/catch.hpp>

#include <design/random_design.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

Design small() {
    Design design = design_of({{"toe", plain()},
                               {"heel", node(TileOperation{"toe", 2, 1, 1})},
                               {"cloth", node(AttachOperation{"heel", "toe", Face::plus_x})},
                               {"aside", plain()}},
                              "cloth");
    design.title = "shoe";
    design.notes = "left";
    return design;
}

/// The error of an edit that must be refused and leave the design as it was.
std::string refusal(const Design& before, const Edit& edit) {
    Design design = before;
    const Result<Edit> undo = weave::apply_edit(design, edit);
    REQUIRE_FALSE(undo);
    CHECK(design == before);
    CHECK(write_document(design) == write_document(before));
    return undo.error().text();
}

std::string any_name(Random& random, const Design& design) {
    if (random.between(0, 9) == 0)
        return random.coin() ? "nobody" : "fresh-" + std::to_string(random.between(0, 3));
    auto at = design.blocks.begin();
    std::advance(at, static_cast<std::ptrdiff_t>(random.between(0, design.blocks.size() - 1)));
    return at->first;
}

/// Any edit, often one that must be refused.
Edit random_edit(Random& random, const Design& design) {
    switch (random.between(0, 9)) {
        case 0: {
            std::vector<std::string> names;
            for (std::size_t k = 0; k < 3; ++k) names.push_back(any_name(random, design));
            return PutBlock{any_name(random, design), random_node(random, names)};
        }
        case 1:
            return RemoveBlock{any_name(random, design)};
        case 2:
            return RenameBlock{any_name(random, design), random.coin()
                                                             ? any_name(random, design)
                                                             : "n" + std::to_string(random.between(0, 99))};
        case 3:
            return SetRoot{any_name(random, design)};
        case 4:
            return PutFlip{any_name(random, design),
                           {random.between(0, 5), random.between(0, 5), random.coin()}};
        case 5: {
            const std::string name = any_name(random, design);
            const auto found = design.blocks.find(name);
            if (found == design.blocks.end() || found->second->flips.empty()) return RemoveFlip{name, 0, 0};
            return RemoveFlip{name, found->second->flips.front().pick, found->second->flips.front().end};
        }
        case 6:
            return SetTitle{random_text(random), random_text(random)};
        case 7:
            return SetWarp{random_warp(random)};
        case 8:
            return SetWeft{random_weft(random)};
        default:
            return SetScene{random_scene(random)};
    }
}

}  // namespace

TEST_CASE("edits undone in reverse give back the design, byte for byte") {
    std::size_t made = 0, refused = 0;
    for_all(
        [&](Random& random) {
            const Design start = random_design(random);
            const std::string text = write_document(start);
            Design design = start;
            std::vector<Edit> undo;
            std::vector<Design> stages;
            for (std::size_t step = random.between(1, 10); step > 0; --step) {
                const Design before = design;
                const Edit edit = random_edit(random, design);
                Result<Edit> inverse = weave::apply_edit(design, edit);
                if (inverse) {
                    ++made;
                    stages.push_back(before);
                    undo.push_back(std::move(inverse).value());
                    if (const Status sound = check(design); !sound) FAIL(sound.error().text());
                } else {
                    ++refused;
                    REQUIRE(design == before);
                    REQUIRE_FALSE(inverse.error().message.empty());
                }
            }
            std::vector<Edit> redo;
            const Design end = design;
            for (; !undo.empty(); undo.pop_back(), stages.pop_back()) {
                Result<Edit> inverse = weave::apply_edit(design, undo.back());
                if (!inverse) FAIL(inverse.error().text());
                REQUIRE(design == stages.back());
                redo.push_back(std::move(inverse).value());
            }
            REQUIRE(design == start);
            REQUIRE(write_document(design) == text);
            for (; !redo.empty(); redo.pop_back()) REQUIRE(weave::apply_edit(design, redo.back()));
            REQUIRE(design == end);
            REQUIRE(write_document(design) == write_document(end));
        },
        property_cases());
    CHECK(made > 0);
    CHECK(refused > 0);
}

TEST_CASE("an edit that went through JSON has the same effect, and so has its inverse") {
    for_all(
        [](Random& random) {
            Design design = random_design(random);
            const Edit edit = random_edit(random, design);
            const Json json = to_json(edit);
            const Result<Edit> read = edit_from_json(parse_json(json.dump()).value());
            if (!read) FAIL(read.error().text() << "\n" << json.dump());
            REQUIRE(to_json(*read) == json);
            Design other = design;
            const Design before = design;
            const Result<Edit> undo = weave::apply_edit(design, edit), other_undo = weave::apply_edit(other, *read);
            REQUIRE(bool(undo) == bool(other_undo));
            REQUIRE(design == other);
            if (!undo) {
                REQUIRE(undo.error().text() == other_undo.error().text());
                return;
            }
            const Result<Edit> back = edit_from_json(parse_json(to_json(*undo).dump()).value());
            REQUIRE(back);
            REQUIRE(weave::apply_edit(design, *back));
            REQUIRE(design == before);
            REQUIRE(write_document(design) == write_document(before));
        },
        property_cases());
}

TEST_CASE("blocks: what cannot be put, removed, renamed or made the cloth") {
    const Design design = small();
    CHECK_THAT(refusal(design, PutBlock{"a b", plain()}), Catch::Contains("'a b' is not a block name"));
    CHECK(refusal(design, PutBlock{"new", nullptr}) == "'new' would be made from nothing");
    CHECK(refusal(design, PutBlock{"new", node(TileOperation{"none", 1, 1, 1})}) ==
          "'none' is not a block of this design");
    CHECK(refusal(design, PutBlock{"new", node(TileOperation{"new", 1, 1, 1})}) ==
          "'new' is not a block of this design");
    CHECK(refusal(design, PutBlock{"toe", node(TileOperation{"toe", 1, 1, 1})}) ==
          "'toe' would be made from itself");
    CHECK(refusal(design, PutBlock{"toe", node(TileOperation{"cloth", 1, 1, 1})}) ==
          "'toe' would be made from itself");
    CHECK_THAT(refusal(design, PutBlock{"toe", node(TileOperation{"aside", 0, 1, 1})}),
               Catch::StartsWith("blocks.toe.x: must be from 1"));
    CHECK(refusal(design, RemoveBlock{"none"}) == "'none' is not a block of this design");
    CHECK(refusal(design, RemoveBlock{"cloth"}) == "'cloth' is the cloth itself; choose another root first");
    CHECK(refusal(design, RemoveBlock{"toe"}) == "'toe' is still used by cloth, heel");
    CHECK(refusal(design, RenameBlock{"none", "new"}) == "'none' is not a block of this design");
    CHECK(refusal(design, RenameBlock{"toe", "heel"}) == "there is a block named 'heel' already");
    CHECK_THAT(refusal(design, RenameBlock{"toe", ""}), Catch::Contains("'' is not a block name"));
    CHECK(refusal(design, SetRoot{"none"}) == "'none' is not a block of this design");
    CHECK(refusal(design, SetRoot{std::string(500, 'n')}).size() < 200);

    Design full = design;
    for (std::size_t k = full.blocks.size(); k < most_blocks; ++k)
        full.blocks["b" + std::to_string(k)] = plain();
    CHECK(refusal(full, PutBlock{"new", plain()}) == "a design has at most 4096 blocks");
    CHECK(weave::apply_edit(full, PutBlock{"b10", node(TileOperation{"toe", 1, 1, 1})}));
}

TEST_CASE("flips, texts and plans: what is refused") {
    const Design design = small();
    const std::size_t far = std::size_t{1} << 30;
    CHECK(refusal(design, PutFlip{"none", {0, 0, true}}) == "'none' is not a block of this design");
    CHECK(refusal(design, PutFlip{"toe", {far, 0, true}}) ==
          "no cloth has a crossing of pick 1073741825 and end 1");
    CHECK(refusal(design, PutFlip{"toe", {0, far, true}}) ==
          "no cloth has a crossing of pick 1 and end 1073741825");
    CHECK(refusal(design, RemoveFlip{"none", 0, 0}) == "'none' is not a block of this design");
    CHECK(refusal(design, RemoveFlip{"toe", 2, 3}) == "'toe' has no flip at pick 3 and end 4");
    CHECK(refusal(design, SetTitle{std::string(1001, 'x'), ""}) == "title: is longer than 1000 bytes");
    CHECK(refusal(design, SetTitle{"", std::string(65537, 'x')}) == "notes: is longer than 65536 bytes");
    CHECK(refusal(design, SetTitle{"new", "\xff"}) == "notes: is not UTF-8");
    WarpPlan warp = design.warp;
    warp.beams.clear();
    CHECK(refusal(design, SetWarp{warp}) == "warp.beams: needs at least one beam");
    WeftPlan weft = design.weft;
    weft.feeder_order = {{0}, {5}};
    CHECK(refusal(design, SetWeft{weft}) ==
          "weft.feeder_order: names feeder 5, but there are only 1, counted from 0");
    Scene scene;
    scene.friction = -1;
    CHECK(refusal(design, SetScene{scene}) == "scene.friction: must be from 0 to 100");
}

TEST_CASE("renaming takes every reference along, and a name may stay") {
    Design design = small();
    REQUIRE(weave::apply_edit(design, RenameBlock{"toe", "tip"}));
    CHECK(children_of(*design.blocks.at("heel")) == std::vector<std::string>{"tip"});
    CHECK(children_of(*design.blocks.at("cloth")) == std::vector<std::string>{"heel", "tip"});
    CHECK_FALSE(design.blocks.contains("toe"));
    REQUIRE(weave::apply_edit(design, RenameBlock{"cloth", "boot"}));
    CHECK(design.root == "boot");
    CHECK(check(design));
    const Design before = design;
    REQUIRE(weave::apply_edit(design, RenameBlock{"heel", "heel"}));
    CHECK(design == before);
}

TEST_CASE("a flip comes after the others, or takes the place of the last; undo brings back order and all") {
    Design design = small();
    for (const Flip flip : {Flip{0, 0, true}, Flip{0, 1, true}, Flip{1, 0, false}})
        REQUIRE(weave::apply_edit(design, PutFlip{"toe", flip}));
    const Design before = design;
    const Edit undo = weave::apply_edit(design, PutFlip{"toe", {0, 0, false}}).value();
    const std::vector<Flip> all{{0, 0, true}, {0, 1, true}, {1, 0, false}, {0, 0, false}};
    CHECK(design.blocks.at("toe")->flips == all);
    REQUIRE(weave::apply_edit(design, PutFlip{"toe", {0, 0, true}}));
    const std::vector<Flip> last_changed{{0, 0, true}, {0, 1, true}, {1, 0, false}, {0, 0, true}};
    CHECK(design.blocks.at("toe")->flips == last_changed);
    REQUIRE(weave::apply_edit(design, RemoveFlip{"toe", 0, 0}));
    CHECK(design.blocks.at("toe")->flips == std::vector<Flip>{{0, 1, true}, {1, 0, false}});
    REQUIRE(weave::apply_edit(design, undo));
    CHECK(design == before);
    const Edit again = weave::apply_edit(design, RemoveFlip{"toe", 0, 1}).value();
    CHECK(design.blocks.at("toe")->flips == std::vector<Flip>{{0, 0, true}, {1, 0, false}});
    REQUIRE(weave::apply_edit(design, again));
    CHECK(write_document(design) == write_document(before));
}

namespace {

/// The crossings of two blocks of the same size that differ.
std::vector<std::pair<std::size_t, std::size_t>> differing(const Block& a, const Block& b) {
    std::vector<std::pair<std::size_t, std::size_t>> places;
    for (std::size_t pick = 0; pick < a.picks(); ++pick) {
        for (std::size_t end = 0; end < a.ends(); ++end) {
            if (a.weft_over(pick, end) != b.weft_over(pick, end)) places.emplace_back(pick, end);
        }
    }
    return places;
}

std::vector<Flip> lost_flips(const Evaluation& cloth) {
    std::vector<Flip> flips;
    for (const LostFlip& lost : cloth.lost_flips) flips.push_back(lost.flip);
    return flips;
}

}  // namespace

TEST_CASE("in any sequence each possible flip changes one pixel, its own, and loses or revives no other") {
    std::size_t made = 0, again = 0, lost = 0, settled = 0;
    for_all(
        [&](Random& random) {
            // Few yarns in few stacks, so that flips depend on one another and crossings come again and again.
            const auto count = [&] { return static_cast<std::uint32_t>(random.between(1, 3)); };
            Design design = design_of({{"cloth", std::make_shared<const Node>(Node{
                                                     StacksLeaf{std::make_shared<const Block>(
                                                         random_block(random, {count()}, {count(), 1}))},
                                                     {}})}},
                                      "cloth");
            Evaluation now = evaluate(design).value();
            const auto any_crossing = [&] {
                return std::pair(random.between(0, now.block->picks() - 1), random.between(0, now.block->ends() - 1));
            };
            for (std::size_t k = random.between(0, 3); k > 0; --k) {  // whatever a file may hold, lost ones too
                const auto [pick, end] = any_crossing();
                REQUIRE(weave::apply_edit(design, PutFlip{"cloth", {pick, end, random.coin()}}));
            }
            now = evaluate(design).value();
            lost += now.lost_flips.size();
            std::vector<std::pair<Edit, Design>> undo;
            for (std::size_t step = 0; step < 12; ++step) {
                const auto [pick, end] = any_crossing();
                if (!flip(*now.block, pick, end)) continue;
                const std::vector<Flip>& flips = design.blocks.at("cloth")->flips;
                again += std::any_of(flips.begin(), flips.end(), [&, pick = pick, end = end](const Flip& flip) {
                    return flip.pick == pick && flip.end == end;
                });
                const Design before = design;
                const Flip wish{pick, end, !now.block->weft_over(pick, end)};
                undo.emplace_back(weave::apply_edit(design, PutFlip{"cloth", wish}).value(), before);
                const Evaluation then = evaluate(design).value();
                REQUIRE(differing(*now.block, *then.block) == std::vector{std::pair(pick, end)});
                std::vector<Flip> others = lost_flips(now);  // this crossing is settled
                settled += std::erase_if(
                    others, [&](const Flip& other) { return other.pick == wish.pick && other.end == wish.end; });
                REQUIRE(lost_flips(then) == others);
                now = then;
                ++made;
            }
            for (; !undo.empty(); undo.pop_back()) {
                REQUIRE(weave::apply_edit(design, undo.back().first));
                REQUIRE(design == undo.back().second);
            }
        },
        std::max<std::size_t>(property_cases() / 4, 1000));
    CHECK(made > 0);
    CHECK(again > 0);
    CHECK(lost > 0);
    CHECK(settled > 0);
}

TEST_CASE("JSON that is no edit is refused with its place") {
    const auto error = [](const std::string& text) {
        const Result<Edit> edit = edit_from_json(parse_json(text).value());
        REQUIRE_FALSE(edit);
        CHECK(edit.error().code == ErrorCode::bad_input);
        return edit.error().text();
    };
    CHECK_THAT(error("[]"), Catch::Contains("must be an object"));
    CHECK(error("{}") == "edit: is missing");
    CHECK_THAT(error(R"({"edit": "paint"})"),
               Catch::StartsWith("edit: must be one of put-block, remove-block"));
    CHECK(error(R"({"edit": "put-block", "name": "a"})") == "node: is missing");
    CHECK(error(R"({"edit": "put-block", "name": "a", "node": 3})") == "node: must be an object");
    CHECK_THAT(error(R"({"edit": "put-block", "name": "a", "node": {"kind": "tile", "of": "b", "x": 0}})"),
               Catch::StartsWith("node.x: must be a whole number from 1"));
    CHECK(error(R"({"edit": "put-block", "node": {"kind": "tile", "of": "b"}})") == "name: is missing");
    CHECK(error(R"({"edit": "remove-block"})") == "name: is missing");
    CHECK(error(R"({"edit": "remove-block", "name": "a", "force": true})") == "force: is not known here");
    CHECK(error(R"({"edit": "rename-block", "from": "a"})") == "to: is missing");
    CHECK(error(R"({"edit": "set-root", "name": 3})") == "name: must be a text");
    CHECK(error(R"({"edit": "put-flip", "block": "a"})") == "flip: is missing");
    CHECK(error(R"({"edit": "put-flip", "block": "a", "flip": {"pick": 0, "end": 0, "weft": "up"}})") ==
          "flip.weft: must be one of under, over");
    CHECK_THAT(error(R"({"edit": "remove-flip", "block": "a", "pick": -1, "end": 0})"),
               Catch::StartsWith("pick: must be a whole number from 0"));
    CHECK(error(R"({"edit": "set-title", "title": "a"})") == "notes: is missing");
    CHECK(error(R"({"edit": "set-warp"})") == "warp: is missing");
    CHECK(error(R"({"edit": "set-weft", "weft": {"feeders": 1}})") == "weft.feeders: must be a list");
    CHECK(error(R"({"edit": "set-scene", "scene": {"gravity": 1}})") ==
          "scene.gravity: must be true or false");
}
