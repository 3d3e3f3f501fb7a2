// The outline of a cloth, told from its counts, against the cloth itself.

#include <weave/design/edit.hpp>
#include <weave/design/outline.hpp>

#include <catch2/catch.hpp>

#include <design/random_design.hpp>
#include <support/memory.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

void check_same_flips(const std::vector<LostFlip>& told, const std::vector<LostFlip>& lost) {
    REQUIRE(told.size() == lost.size());
    for (std::size_t k = 0; k < lost.size(); ++k) {
        REQUIRE(told[k].block == lost[k].block);
        REQUIRE(told[k].flip == lost[k].flip);
        REQUIRE(told[k].reason == lost[k].reason);
    }
}

/// Whether the cloth can be woven; the outline has to say the same either way.
bool outline_is_right(const Design& design, Random& random) {
    const CardPlace wish{random.between(0, 12), random.between(0, 12)};
    const Result<Evaluation> woven = evaluate(design);
    const Result<Outline> told = outline(design, wish);
    INFO((woven ? "woven" : woven.error().text()));
    REQUIRE(bool(told) == bool(woven));
    if (!woven) {
        REQUIRE(told.error().code == woven.error().code);
        REQUIRE(told.error().text() == woven.error().text());
        return false;
    }
    const Block& block = *woven->block;
    REQUIRE(told->grid == block.grid());
    REQUIRE(told->height == block.height());
    check_same_flips(told->lost_flips, woven->lost_flips);
    REQUIRE(bool(told->at) == block.grid().holds(wish.pick, wish.end));
    if (!told->at) return true;
    const PlacedStack expected = stack_at(block, wish.pick, wish.end);
    REQUIRE(told->at->stack == expected.stack);
    REQUIRE(told->at->first_pick == expected.first_pick);
    REQUIRE(told->at->first_end == expected.first_end);
    return true;
}

/// A node whose operands fit: `blocks` are all 2 by 2 with one pick and one end a cell, and so is the node.
NodePtr random_square(Random& random, const std::vector<std::string>& blocks) {
    const auto one = [&] { return blocks[random.between(0, blocks.size() - 1)]; };
    std::vector<Flip> flips;
    for (std::size_t k = random.between(0, 3); k > 0; --k)
        flips.push_back({random.between(0, 2), random.between(0, 2), random.coin()});
    switch (random.between(0, blocks.empty() ? 1 : 3)) {
        case 0:
            return node(StacksLeaf{std::make_shared<const Block>(random_block(random, {1, 1}, {1, 1}))},
                        std::move(flips));
        case 1: {
            CardImage card(2, 2);
            for (std::size_t k = 0; k < 4; ++k) card.set(k / 2, k % 2, random.coin());
            return node(CardLeaf{std::make_shared<const CardImage>(card), {1}, {1}}, std::move(flips));
        }
        case 2: {
            StencilMap map{2, 2, {}};
            for (int k = 0; k < 4; ++k)
                map.blocks.push_back(static_cast<std::uint16_t>(random.between(0, 1)));
            return node(StencilOperation{{one(), one()}, std::make_shared<const StencilMap>(std::move(map))},
                        std::move(flips));
        }
        default:
            return node(RenumberOperation{one(), random.coin() ? System::weft : System::warp, 1, {0}},
                        std::move(flips));
    }
}

/// A tower of operations on squares, which fit one another by their making.
Design random_tower(Random& random) {
    Design design;
    std::vector<std::string> squares;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string name = "s" + std::to_string(k);
        design.blocks[name] = random_square(random, squares);
        squares.push_back(name);
    }
    const auto square = [&] { return squares[random.between(0, squares.size() - 1)]; };
    const auto put = [&](const std::string& name, NodeSource source) {
        std::vector<Flip> flips;
        for (std::size_t k = random.between(0, 3); k > 0; --k)
            flips.push_back({random.between(0, 9), random.between(0, 9), random.coin()});
        design.blocks[name] = node(std::move(source), std::move(flips));
        design.root = name;
    };
    put("pile", AttachOperation{square(), square(), random.coin() ? Face::plus_z : Face::minus_z});
    put("other", AttachOperation{square(), square(), random.coin() ? Face::plus_z : Face::minus_z});
    put("order",
        RenumberOperation{"pile", random.coin() ? System::weft : System::warp, random.between(0, 1), {1, 0}});
    put("wide", AttachOperation{"order", "other", static_cast<Face>(random.between(0, 3))});
    put("tiled", TileOperation{"wide", random.between(1, 3), random.between(1, 3), random.between(1, 2)});
    return design;
}

Design large(std::size_t times) {
    return design_of({{"unit", plain()}, {"cloth", node(TileOperation{"unit", times, times, 1})}}, "cloth");
}

}  // namespace

TEST_CASE("the outline of a cloth is that of its evaluation: random designs, errors included") {
    std::size_t woven = 0;
    for_all(
        [&](Random& random) {
            if (outline_is_right(random_design(random), random)) ++woven;
        },
        property_cases());
    CHECK(woven > property_cases() / 20);
}

TEST_CASE("the outline of a cloth is that of its evaluation: towers of operations with flips on each") {
    std::size_t woven = 0;
    for_all(
        [&](Random& random) {
            if (outline_is_right(random_tower(random), random)) ++woven;
        },
        property_cases());
    CHECK(woven == property_cases());
}

TEST_CASE("a chain deeper than is looked through comes out the same") {
    Design design = design_of({{"b0", plain()}}, "b600");
    for (std::size_t k = 1; k <= 600; ++k)
        design.blocks["b" + std::to_string(k)] =
            node(RenumberOperation{"b" + std::to_string(k - 1), System::weft, 0, {0}}, {{0, 0, k % 2 == 0}});
    Random random(1);
    CHECK(outline_is_right(design, random));
}

TEST_CASE("more flips than are worth looking at one by one come out the same") {
    Design design = large(250);
    std::vector<Flip> flips;
    for (std::size_t k = 0; k < 500 * 500; k += 3) flips.push_back({k / 500, k % 500, k % 2 == 0});
    NodePtr below = node(TileOperation{"cloth", 1, 1, 1}, flips);
    for (std::size_t level = 0; level < 24; ++level) {
        const std::string name = "level-" + std::to_string(level);
        design.blocks[name] = below;
        below = node(TileOperation{name, 1, 1, 1}, flips);
        design.root = name;
    }
    Random random(2);
    CHECK(outline_is_right(design, random));
}

TEST_CASE("a flip in a cloth of 400 million crossings is told without laying them out") {
    Design design = large(10000);
    const double before = peak_mb();
    for (const bool over : {false, true}) {  // as in plain weave, and once flipped
        const Result<Outline> told = outline(design, CardPlace{777, 888});
        REQUIRE(told);
        CHECK(told->grid.picks() == 20000);
        REQUIRE(told->at);
        CHECK(told->at->stack.weft_over(0, 0) == over);
        REQUIRE(apply_edit(design, PutFlip{"cloth", {777, 888, !over}}));
    }
    CHECK_FALSE(outline(design, CardPlace{20000, 0})->at);
    CHECK(peak_mb() - before < 50);
}

TEST_CASE("what is beyond the evaluator's limit is beyond that of an outline") {
    Design design =
        design_of({{"unit", leaf({{"T0 P0"}, {"P0"}, {"P0"}, {"P0"}})}}, "cloth");  // 4 cells a crossing
    design.blocks["cloth"] = node(TileOperation{"unit", 22000, 22000, 1});
    const Error error = outline(design).error();
    CHECK_THAT(error.message, Catch::Contains("hold more than the limit"));
    CHECK(error.text() == evaluate(design).error().text());
}

TEST_CASE("what the counts of large blocks refuse is told without laying them out, before what memory holds") {
    const auto told = [](NodeSource source) {
        const Design design = design_of({{"plain", plain()},
                                         {"big", node(TileOperation{"plain", 16384, 8192, 1})},
                                         {"cloth", node(std::move(source))}},
                                        "cloth");
        const double before = peak_mb();
        const Result<Outline> cloth = outline(design);
        CHECK(peak_mb() - before < 50);
        REQUIRE_FALSE(cloth);
        return cloth.error().text();
    };
    CHECK_THAT(told(TileOperation{"big", 2, 1, 1}), Catch::StartsWith("blocks.cloth: a card image of 65536 picks"));
    CHECK_THAT(told(AttachOperation{"big", "big", Face::plus_x}),
               Catch::StartsWith("blocks.cloth: a card image of 65536 picks and 16384 ends"));
    CHECK_THAT(told(AttachOperation{"big", "big", Face::minus_z}),
               Catch::StartsWith("blocks.cloth: a card image of 65536 picks and 32768 ends"));
    CHECK_THAT(told(AttachOperation{"big", "plain", Face::plus_y}), Catch::Contains("on the faces that meet"));
    CHECK_THAT(told(RenumberOperation{"big", System::weft, 0, {1}}), Catch::Contains("must name each of its 1 picks"));
    CHECK_THAT(told(RenumberOperation{"big", System::warp, 99999, {0}}), Catch::Contains("there is no column 99999"));
}
