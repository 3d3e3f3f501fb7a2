#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/design/tree.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <design/random_design.hpp>
#include <set>
#include <support/memory.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// A toe used by a heel and a sole, which make the cloth; a tongue stands aside.
Design shoe() {
    return design_of({{"toe", plain()},
                      {"heel", node(TileOperation{"toe", 2, 1, 1})},
                      {"sole", node(TileOperation{"toe", 2, 2, 1})},
                      {"cloth", node(AttachOperation{"heel", "sole", Face::plus_y})},
                      {"tongue", node(TileOperation{"toe", 5, 5, 1})}},
                     "cloth");
}

/// Plain weave whose first pick lies the other way.
NodePtr reversed() {
    return leaf({{"T0 P0", "P0 T0"}, {"T0 P0", "P0 T0"}});
}

Block cloth_of(Evaluator& evaluator, const Design& design) {
    const Result<Evaluation> cloth = evaluator.evaluate(design);
    if (!cloth) FAIL(cloth.error().text());
    return *cloth->block;
}

Edit edited(Design& design, const Edit& edit) {
    Result<Edit> undo = weave::apply_edit(design, edit);
    if (!undo) FAIL(undo.error().text());
    return std::move(undo).value();
}

/// How many nodes `evaluator` computes for the cloth.
std::size_t computed_for(Evaluator& evaluator, const Design& design) {
    const std::size_t before = evaluator.computed();
    static_cast<void>(cloth_of(evaluator, design));
    return evaluator.computed() - before;
}

/// Its four operands fit whatever they are, so that every random tree of them evaluates.
NodePtr random_square(Random& random, const std::vector<std::string>& blocks) {
    const auto one = [&] { return blocks[random.between(0, blocks.size() - 1)]; };
    std::vector<Flip> flips;
    for (std::size_t k = random.between(0, 3); k > 0; --k)
        flips.push_back({random.between(0, 4), random.between(0, 4), random.coin()});
    switch (random.between(0, blocks.empty() ? 0 : 2)) {
        case 0:
            return node(StacksLeaf{std::make_shared<const Block>(random_block(random, {1, 2}, {2, 1}))},
                        std::move(flips));
        case 1: {
            StencilMap map{2, 2, {}};
            for (int k = 0; k < 4; ++k)
                map.blocks.push_back(static_cast<std::uint16_t>(random.between(0, 1)));
            return node(StencilOperation{{one(), one()}, std::make_shared<const StencilMap>(std::move(map))},
                        std::move(flips));
        }
        default:
            return node(RenumberOperation{one(), System::weft, 1, {1, 0}}, std::move(flips));
    }
}

/// Six blocks, each made from those before it, and their names; the last one is the cloth.
std::pair<Design, std::vector<std::string>> random_tree(Random& random) {
    Design design;
    std::vector<std::string> names;
    for (std::size_t k = 0; k < 6; ++k) {
        const std::string name = "b" + std::to_string(k);
        design.blocks[name] = random_square(random, names);
        names.push_back(name);
    }
    design.root = names.back();
    return {design, names};
}

/// All blocks of which `name` is a part, itself included.
std::set<std::string> dependents(const Design& design, const std::string& name) {
    std::set<std::string> found;
    for (const auto& [user, ignored] : design.blocks) {
        const std::vector<std::string> parts = bottom_up(design, user);
        if (std::find(parts.begin(), parts.end(), name) != parts.end()) found.insert(user);
    }
    return found;
}

}  // namespace

TEST_CASE("an edit to a child reaches every block that is made from it") {
    Design design = shoe();
    Evaluator evaluator;
    const Block before = cloth_of(evaluator, design);
    CHECK(before.rows() == 4);
    CHECK(before.columns() == 6);
    edited(design, PutBlock{"toe", reversed()});
    const Block after = cloth_of(evaluator, design);
    for (std::size_t j = 0; j < 6; ++j) {
        for (const std::size_t i : {0U, 2U}) CHECK_FALSE(after.stack(i, j) == before.stack(i, j));
        for (const std::size_t i : {1U, 3U}) CHECK(after.stack(i, j) == before.stack(i, j));
    }
    CHECK(after == *evaluate(design).value().block);
}

TEST_CASE("a block that is used twice is computed once, and what the cloth does not need is not computed") {
    Evaluator evaluator;
    CHECK(computed_for(evaluator, shoe()) == 4);
    Design design = design_of({{"b0", plain()}}, "b20");
    for (std::size_t k = 1; k <= 20; ++k) {
        const std::string below = "b" + std::to_string(k - 1);
        design.blocks["b" + std::to_string(k)] = stencil_of({below, below}, 2, 2, {0, 1, 1, 0});
    }
    CHECK(computed_for(evaluator, design) == 21);
}

TEST_CASE("only what depends on an edit is computed again") {
    Design design = shoe();
    Evaluator evaluator;
    CHECK(computed_for(evaluator, design) == 4);
    CHECK(computed_for(evaluator, design) == 0);

    edited(design, PutBlock{"sole", node(TileOperation{"toe", 2, 3, 1})});
    CHECK(computed_for(evaluator, design) == 2);  // sole and cloth
    edited(design, PutBlock{"toe", reversed()});
    CHECK(computed_for(evaluator, design) == 4);
    edited(design, PutFlip{"cloth", {0, 0, true}});
    CHECK(computed_for(evaluator, design) == 1);
    edited(design, PutBlock{"tongue", plain()});
    edited(design, SetTitle{"boot", ""});
    WarpPlan warp = design.warp;
    warp.density_ends_per_cm = 12;
    edited(design, SetWarp{warp});
    CHECK(computed_for(evaluator, design) == 0);
    edited(design, SetRoot{"sole"});
    CHECK(computed_for(evaluator, design) == 0);
    CHECK(evaluator.evaluate(design, "tongue").value().block->rows() == 2);
}

TEST_CASE("undoing an edit, and making it again, computes nothing") {
    Design design = shoe();
    Evaluator evaluator;
    const Block before = cloth_of(evaluator, design);
    for (const Edit& edit :
         {Edit(PutBlock{"toe", reversed()}), Edit(PutFlip{"toe", {0, 0, true}}),
          Edit(PutBlock{"heel", node(TileOperation{"toe", 2, 7, 1})}), Edit(SetRoot{"sole"})}) {
        const Edit undo = edited(design, edit);
        const Block after = cloth_of(evaluator, design);
        const Edit redo = edited(design, undo);
        CHECK(computed_for(evaluator, design) == 0);
        CHECK(cloth_of(evaluator, design) == before);
        const Edit again = edited(design, redo);
        CHECK(computed_for(evaluator, design) == 0);
        CHECK(cloth_of(evaluator, design) == after);
        edited(design, again);
    }
}

TEST_CASE(
    "renaming a block computes nothing but that block and those made from it, and back again nothing wrong") {
    Design design = shoe();
    Evaluator evaluator;
    const Block before = cloth_of(evaluator, design);
    const Edit undo = edited(design, RenameBlock{"heel", "back"});
    CHECK(computed_for(evaluator, design) <= 2);
    CHECK(cloth_of(evaluator, design) == before);
    edited(design, undo);
    CHECK(computed_for(evaluator, design) <= 2);
    CHECK(cloth_of(evaluator, design) == before);
}

TEST_CASE("flips on a block are made again when what it is made from changes") {
    Design design = shoe();
    Evaluator evaluator;
    const Flip wish{3, 0, true};  // at pick 4, end 1 the warp lies over the weft in both toes
    const bool was = cloth_of(evaluator, design).weft_over(3, 0);
    edited(design, PutFlip{"cloth", {3, 0, !was}});
    CHECK(cloth_of(evaluator, design).weft_over(3, 0) != was);
    edited(design, PutBlock{"toe", reversed()});
    const Block after = cloth_of(evaluator, design);
    CHECK(after.weft_over(3, 0) != was);
    CHECK(evaluator.evaluate(design).value().lost_flips.empty());
    // Nothing else was kept from the old toe.
    edited(design, RemoveFlip{"cloth", wish.pick, wish.end});
    const Block bare = cloth_of(evaluator, design);
    for (std::size_t pick = 0; pick < bare.picks(); ++pick) {
        for (std::size_t end = 0; end < bare.ends(); ++end)
            CHECK(after.weft_over(pick, end) == ((pick == 3 && end == 0) != bare.weft_over(pick, end)));
    }
}

TEST_CASE("a flip that no longer applies is reported with its reason, kept in the document, and comes back") {
    Design design = shoe();
    edited(design, PutFlip{"heel", {3, 1, true}});
    edited(design, PutFlip{"heel", {1, 0, false}});
    Evaluator evaluator;
    REQUIRE(evaluator.evaluate(design).value().lost_flips.empty());
    const Block before = cloth_of(evaluator, design);

    const Edit undo = edited(design, PutBlock{"toe", leaf({{"P0 T0", "T0 P0"}})});
    edited(design, PutBlock{"heel", node(TileOperation{"toe", 1, 1, 1}, design.blocks.at("heel")->flips)});
    edited(design, PutBlock{"sole", node(TileOperation{"toe", 1, 1, 1})});
    const std::vector<LostFlip> lost = evaluator.evaluate(design).value().lost_flips;
    REQUIRE(lost.size() == 2);
    CHECK(lost[0].block == "heel");
    CHECK(lost[0].flip == Flip{3, 1, true});
    CHECK(lost[0].reason == "there is no crossing of pick 4 and end 2: the block has 1 picks and 2 ends");
    CHECK(lost[1].flip == Flip{1, 0, false});
    CHECK(evaluator.evaluate(design).value().lost_flips.size() == 2);  // remembered with the block

    const Design again = read_document(write_document(design)).value();
    CHECK(again == design);
    CHECK(again.blocks.at("heel")->flips.size() == 2);
    Design back = again;
    edited(back, undo);
    edited(back, PutBlock{"heel", node(TileOperation{"toe", 2, 1, 1}, again.blocks.at("heel")->flips)});
    edited(back, PutBlock{"sole", node(TileOperation{"toe", 2, 2, 1})});
    CHECK(evaluator.evaluate(back).value().lost_flips.empty());
    CHECK(cloth_of(evaluator, back) == before);
}

TEST_CASE("a flip that is blocked names the yarns in the way; one of several may be lost") {
    const Design design = design_of(
        {{"toe", node(leaf({{"T0 P0 T1 P1"}})->source, {{0, 1, true}, {0, 0, true}, {1, 1, true}})}}, "toe");
    const Evaluation cloth = evaluate(design).value();
    REQUIRE(cloth.lost_flips.size() == 1);
    CHECK(cloth.lost_flips[0].flip == Flip{0, 1, true});
    CHECK(cloth.lost_flips[0].reason ==
          "pick 1 and end 2 cannot be flipped alone: in the way stand end 1, pick 2");
    CHECK(cloth.block->stack(0, 0) == parse_stack("P0 T0 P1 T1").value());
}

TEST_CASE("lost flips of every block under the cloth are reported, once each") {
    const Design design = design_of({{"toe", node(plain()->source, {{9, 0, true}})},
                                     {"heel", node(TileOperation{"toe", 1, 1, 1}, {{0, 9, true}})},
                                     {"cloth", node(AttachOperation{"heel", "toe", Face::plus_x})},
                                     {"aside", node(plain()->source, {{7, 7, true}})}},
                                    "cloth");
    Evaluator evaluator;
    const std::vector<LostFlip> lost = evaluator.evaluate(design).value().lost_flips;
    REQUIRE(lost.size() == 2);
    CHECK(lost[0].block == "toe");
    CHECK(lost[1].block == "heel");
    CHECK(evaluator.evaluate(design, "toe").value().lost_flips.size() == 1);
}

TEST_CASE("a design that does not evaluate says which block and why, and evaluates again once mended") {
    Design design = shoe();
    Evaluator evaluator;
    static_cast<void>(cloth_of(evaluator, design));
    const Edit undo = edited(design, PutBlock{"heel", node(TileOperation{"toe", 3, 1, 1})});
    const Result<Evaluation> failed = evaluator.evaluate(design);
    REQUIRE_FALSE(failed);
    CHECK(failed.error().code == ErrorCode::bad_input);
    CHECK(failed.error().text() ==
          "blocks.cloth: 'heel' has 6 picks (6 rows) and 'sole' 4 picks (4 rows): the rows must be equal on the faces that meet");
    edited(design, undo);
    CHECK(computed_for(evaluator, design) == 0);

    const auto where = [&](NodeSource source) {
        Design wrong = shoe();
        wrong.blocks["toe"] = node(std::move(source));
        return evaluate(wrong).error().text();
    };
    CHECK_THAT(where(PresetLeaf{{"tartan", {}}}),
               Catch::StartsWith("blocks.toe") && Catch::Contains("tartan"));
    CHECK_THAT(where(SliceLeaf{}), Catch::StartsWith("blocks.toe"));
    CHECK_THAT(where(CardLeaf{std::make_shared<const CardImage>(3, 2), {2}, {1}}),
               Catch::StartsWith("blocks.toe"));
    CHECK(evaluator.evaluate(design, "none").error().text() == "'none' is not a block of this design");
    design.root = "none";
    CHECK(evaluator.evaluate(design).error().where == "root");
}

TEST_CASE("every kind of block evaluates to what its own function makes") {
    const auto map = std::make_shared<const StencilMap>(StencilMap{2, 2, {0, 0, 0, 0}});
    CardImage card(2, 2);
    card.set(0, 0, true);
    card.set(1, 1, true);
    Design design = shoe();
    const Block toe = *std::get<StacksLeaf>(plain()->source).block;
    const Preset twill{"twill", {}};
    const Slice slice = warp_slice(toe, 0).value();
    design.blocks["card"] = node(CardLeaf{std::make_shared<const CardImage>(card), {1}, {1}});
    design.blocks["preset"] = node(PresetLeaf{twill});
    design.blocks["slice"] = node(SliceLeaf{slice});
    design.blocks["stencil"] = node(StencilOperation{{"toe"}, map});
    design.blocks["pile"] = node(AttachOperation{"toe", "card", Face::plus_z});
    design.blocks["picks"] = node(RenumberOperation{"pile", System::weft, 0, {1, 0}});
    design.blocks["ends"] = node(RenumberOperation{"pile", System::warp, 1, {1, 0}});
    Evaluator evaluator;
    const auto made = [&](const char* name) { return *evaluator.evaluate(design, name).value().block; };
    CHECK(made("toe") == toe);
    CHECK(made("heel") == tile(toe, 2, 1, 1).value());
    CHECK(made("card").weft_over(0, 0));
    CHECK_FALSE(made("card").weft_over(0, 1));
    CHECK(made("preset") == make_preset(twill).value());
    CHECK(made("slice") == to_block(slice).value());
    const BlockPtr only = std::make_shared<const Block>(toe);
    CHECK(made("stencil") == stencil(std::span(&only, 1), *map).value());
    const Block pile = attach(toe, made("card"), Face::plus_z).value();
    const std::vector<std::size_t> order{1, 0};
    CHECK(made("pile") == pile);
    CHECK(made("picks") == renumber_row(pile, 0, order).value());
    CHECK(made("ends") == renumber_column(pile, 1, order).value());
}

TEST_CASE("the evaluator forgets old versions and removed blocks, and stays right") {
    Design design = shoe();
    Evaluator evaluator;
    const Block first = cloth_of(evaluator, design);
    const NodePtr old = design.blocks.at("toe");
    for (std::size_t k = 0; k < 12; ++k) {
        edited(design, PutFlip{"toe", {k % 2, k % 2, k % 4 < 2}});
        CHECK(computed_for(evaluator, design) == 4);  // each time one flip more, and the toe's parents with it
    }
    edited(design, PutBlock{"toe", old});
    CHECK(computed_for(evaluator, design) == 4);
    CHECK(cloth_of(evaluator, design) == first);
    static_cast<void>(evaluator.evaluate(design, "tongue").value());
    const Edit undo = edited(design, RemoveBlock{"tongue"});
    static_cast<void>(cloth_of(evaluator, design));
    edited(design, undo);
    CHECK(evaluator.evaluate(design, "tongue").value().block->rows() == 10);
}

TEST_CASE("remembering never changes the cloth, and computes no more than what depends on an edit") {
    for_all(
        [](Random& random) {
            auto [design, names] = random_tree(random);
            Evaluator evaluator;
            static_cast<void>(cloth_of(evaluator, design));
            for (std::size_t step = 0; step < 6; ++step) {
                const std::size_t at = random.between(0, names.size() - 1);
                const std::vector<std::string> below(names.begin(),
                                                     names.begin() + static_cast<std::ptrdiff_t>(at));
                std::size_t most = 0;
                const std::vector<std::string> before = bottom_up(design, design.root);
                const Edit undo = edited(design, PutBlock{names[at], random_square(random, below)});
                for (const std::string& name : dependents(design, names[at])) {
                    const std::vector<std::string> needed = bottom_up(design, design.root);
                    most += std::count(needed.begin(), needed.end(), name) > 0 ? 1 : 0;
                }
                for (const std::string& name : bottom_up(design, design.root)) {
                    const bool fresh = std::find(before.begin(), before.end(), name) == before.end();
                    if (fresh && !dependents(design, names[at]).contains(name)) ++most;
                }
                REQUIRE(computed_for(evaluator, design) <= most);
                const Evaluation made = evaluator.evaluate(design).value(), anew = evaluate(design).value();
                REQUIRE(*made.block == *anew.block);
                REQUIRE(made.lost_flips.size() == anew.lost_flips.size());
                if (random.coin()) continue;
                edited(design, undo);
                REQUIRE(computed_for(evaluator, design) == 0);
                REQUIRE(cloth_of(evaluator, design) == *evaluate(design).value().block);
            }
        },
        property_cases());
}

TEST_CASE("blocks that do not fit are named in the error, in attachments and stencils") {
    Design design = shoe();
    edited(design, PutBlock{"heel", leaf({{"T0 P0"}, {"T0 P0"}, {"T0 P0"}, {"T0 T1 P0"}})});
    CHECK(evaluate(design).error().text() ==
          "blocks.cloth: cannot attach: at pick 4 'heel' has 2 picks in a stack and 'sole' 1");
    edited(design, PutBlock{"cloth", stencil_of({"toe", "heel"}, 4, 2, {0, 0, 0, 0, 1, 1, 1, 1})});
    CHECK(evaluate(design).error().text() ==
          "blocks.cloth: 'toe' and 'heel' do not fit together: at pick 4 'toe' has 1 pick in a stack and 'heel' 2");
}

namespace {

/// A large block whose first row is renumbered again and again, each time as another block.
Design renumbered(std::size_t rows, std::size_t columns, std::size_t times) {
    Design design =
        design_of({{"unit", leaf({{"T0 P0 T1"}})}, {"b0", node(TileOperation{"unit", rows, columns, 1})}},
                  "b" + std::to_string(times));
    for (std::size_t k = 1; k <= times; ++k) {
        design.blocks["b" + std::to_string(k)] =
            node(RenumberOperation{"b" + std::to_string(k - 1), System::weft, k % rows, {1, 0}});
    }
    return design;
}

}  // namespace

TEST_CASE("evaluating once lets go of each block when nothing more is made from it") {
    const Design design = renumbered(1024, 2048, 60);  // 8 MB each
    const double before = peak_mb();
    const Evaluation cloth = evaluate(design).value();
    CHECK(cloth.block->rows() == 1024);
    CHECK(peak_mb() - before <
          350);  // all blocks together take 500 MB; a sanitizer keeps 256 of what was freed
}

TEST_CASE("an evaluator holds no more than its budget and computes what it forgot again") {
    Design design = renumbered(10, 10, 20);
    Evaluator frugal(500), lavish;
    const Block cloth = cloth_of(lavish, design);
    CHECK(cloth_of(frugal, design) == cloth);
    CHECK(frugal.held() <= 500);
    CHECK(lavish.held() > 2000);
    CHECK(computed_for(lavish, design) == 0);
    CHECK(computed_for(frugal, design) == 0);  // the cloth itself was used last
    edited(design, PutBlock{"b20", node(RenumberOperation{"b19", System::weft, 3, {1, 0}})});
    CHECK(computed_for(frugal, design) == 1);
    edited(design, SetRoot{"b3"});
    CHECK(computed_for(frugal, design) == 5);  // unit, b0, b1, b2, b3: forgotten long ago
    CHECK(frugal.held() <= 500);
    edited(design, RemoveBlock{"b20"});
    static_cast<void>(cloth_of(lavish, design));
    Evaluator fresh;
    for (std::size_t k = 0; k < 20; ++k)
        static_cast<void>(fresh.evaluate(design, "b" + std::to_string(k)).value());
    CHECK(lavish.held() == fresh.held());  // what a removed block held is counted no more
}

namespace {

/// The least limit, to 20 cells, within which the cloth can be made.
std::size_t least_limit(const Design& design) {
    std::size_t limit = 0;
    while (!Evaluator(0, limit).evaluate(design)) limit += 20;
    return limit;
}

}  // namespace

TEST_CASE("blocks that are needed at the same time stay within the limit, or the one beyond it is named") {
    Design design = design_of({{"unit", plain()}}, "cloth");  // 2 by 2
    std::vector<std::string> parts;
    for (std::size_t k = 0; k < 6; ++k) {
        parts.push_back("t" + std::to_string(k));
        design.blocks[parts.back()] = node(TileOperation{"unit", 5, 5 + k, 1});  // 10 by 10, 12, … 20
    }
    design.blocks["cloth"] = stencil_of(parts, 1, 6, {0, 1, 2, 3, 4, 5});
    const std::size_t least = least_limit(design);
    const Error error = Evaluator(0, least / 2).evaluate(design).error();
    CHECK(error.code == ErrorCode::bad_input);
    CHECK_THAT(error.where, Catch::StartsWith("blocks.t"));
    CHECK_THAT(error.message, Catch::Contains("limit of " + std::to_string(least / 2) + " cells"));
    Evaluator tight(0, least / 2);
    REQUIRE_FALSE(tight.evaluate(design));
    CHECK(tight.computed() < 7);  // what is refused is not made, nor what comes after it
    edited(design, SetRoot{"t0"});
    CHECK(tight.evaluate(design));
}

TEST_CASE("a chain of blocks holds two at a time, whatever its length; flips need one more") {
    const std::size_t least = least_limit(renumbered(10, 10, 10));
    Design design = renumbered(10, 10, 20);
    CHECK(least_limit(design) < least + 400);  // its stacks become more, its blocks do not
    Node last = *design.blocks.at("b20");
    last.flips.push_back({0, 0, true});
    edited(design, PutBlock{"b20", std::make_shared<const Node>(last)});
    CHECK(least_limit(design) > least + 100);
}

TEST_CASE("what is larger than any block may be is refused for that, not for the limit") {
    const Design design =
        design_of({{"unit", plain()}, {"cloth", node(TileOperation{"unit", 1 << 20, 1 << 20, 1})}}, "cloth");
    CHECK_THAT(evaluate(design).error().message, Catch::Contains("crossings"));
}

TEST_CASE("flips made one after the other, and taken back, come to what they come to all at once") {
    for_all(
        [](Random& random) {
            Design design;
            design.blocks["square"] = random_square(random, {});
            design.blocks["cloth"] = stencil_of({"square", "square"}, 2, 2, {0, 1, 1, 0});
            design.root = "cloth";
            Evaluator evaluator;
            std::vector<Edit> undo;
            for (std::size_t step = 0; step < 12; ++step) {
                const bool below = random.between(0, 4) == 0;
                if (undo.empty() || random.between(0, 3) > 0) {
                    const Flip flip{random.between(0, 5), random.between(0, 5), random.coin()};
                    undo.push_back(edited(design, PutFlip{below ? "square" : "cloth", flip}));
                } else {
                    edited(design, undo.back());
                    undo.pop_back();
                }
                const Evaluation made = evaluator.evaluate(design).value(), anew = evaluate(design).value();
                REQUIRE(*made.block == *anew.block);
                REQUIRE(made.lost_flips.size() == anew.lost_flips.size());
                for (std::size_t k = 0; k < made.lost_flips.size(); ++k) {
                    REQUIRE(made.lost_flips[k].flip == anew.lost_flips[k].flip);
                    REQUIRE(made.lost_flips[k].reason == anew.lost_flips[k].reason);
                }
            }
        },
        property_cases() / 20);
}

TEST_CASE("whatever the budget, the cloth and its lost flips are the same") {
    for_all(
        [](Random& random) {
            auto [design, names] = random_tree(random);
            Evaluator frugal(random.between(0, 60));
            for (std::size_t step = 0; step < 8; ++step) {
                const std::size_t at = random.between(0, names.size() - 1);
                const std::vector<std::string> below(names.begin(),
                                                     names.begin() + static_cast<std::ptrdiff_t>(at));
                if (random.coin()) design.blocks[names[at]] = random_square(random, below);
                design.root = names[random.between(0, names.size() - 1)];
                const Evaluation made = frugal.evaluate(design).value();
                Evaluator lavish;
                const Evaluation anew = lavish.evaluate(design).value();
                REQUIRE(*made.block == *anew.block);
                REQUIRE(made.lost_flips.size() == anew.lost_flips.size());
            }
        },
        property_cases() / 20);
}
