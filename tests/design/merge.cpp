#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/design/merge.hpp>

#include <catch2/catch.hpp>

#include <design/random_design.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

Design pair_of(NodePtr toe) {
    return design_of({{"toe", std::move(toe)}, {"cloth", node(AttachOperation{"toe", "toe", Face::plus_x})}},
                     "cloth");
}

NodePtr other_plain() {
    return leaf({{"T0 P0", "P0 T0"}, {"P0 T0", "T0 P0"}});
}

}  // namespace

TEST_CASE("a free name is the wish itself, or the wish with the first free number") {
    Design design = design_of({{"toe", plain()}}, "toe");
    CHECK(free_name(design, "heel") == "heel");
    CHECK(free_name(design, "toe") == "toe-2");
    design.blocks["toe-2"] = plain();
    design.blocks["toe-4"] = plain();
    CHECK(free_name(design, "toe") == "toe-3");
}

TEST_CASE("free names of long wishes stay block names and stay free") {
    const std::string longest(64, 'n');
    Design design = design_of({{longest, plain()}}, longest);
    CHECK(free_name(Design{}, std::string(90, 'n')) == longest);
    for (int k = 0; k < 120; ++k) {
        const std::string name = free_name(design, std::string(90, 'n'));
        REQUIRE(check_block_name(name));
        REQUIRE_FALSE(design.blocks.contains(name));
        design.blocks[name] = plain();
    }
    CHECK(check(design));
}

TEST_CASE("equal blocks are shared, those of the same name that differ come in under another") {
    Design into = pair_of(plain());
    const Design before = into;
    CHECK(bring_in(into, pair_of(plain())) == "cloth");
    CHECK(into == before);

    // The toe differs, so the cloth that is made from it does as well.
    CHECK(bring_in(into, pair_of(other_plain())) == "cloth-2");
    CHECK(into.blocks.size() == 4);
    CHECK(into.root == "cloth");
    CHECK(*into.blocks.at("toe-2") == *other_plain());
    CHECK(children_of(*into.blocks.at("cloth-2")) == std::vector<std::string>{"toe-2", "toe-2"});
    CHECK(children_of(*into.blocks.at("cloth")) == std::vector<std::string>{"toe", "toe"});
    const Design twice = into;
    CHECK(bring_in(into, pair_of(other_plain())) == "cloth-2");
    CHECK(into == twice);

    // A part that is equal is shared even where the cloth differs; what the cloth does not need stays out.
    Design third = design_of(
        {{"toe", plain()}, {"aside", plain()}, {"cloth", node(TileOperation{"toe", 3, 1, 1})}}, "cloth");
    CHECK(bring_in(into, third) == "cloth-3");
    CHECK(children_of(*into.blocks.at("cloth-3")) == std::vector<std::string>{"toe"});
    CHECK_FALSE(into.blocks.contains("aside"));
}

TEST_CASE("flips make a block another one, and yarns, feeders and scene stay as they were") {
    Design into = pair_of(plain());
    Design from = pair_of(node(plain()->source, {{0, 0, true}}));
    from.warp.density_ends_per_cm = 7;
    from.scene.friction = 1;
    from.title = "other";
    const Design before = into;
    CHECK(bring_in(into, from) == "cloth-2");
    CHECK(into.warp == before.warp);
    CHECK(into.weft == before.weft);
    CHECK(into.scene == before.scene);
    CHECK(into.title == before.title);
    CHECK_FALSE(same_yarns(into, from));
    from.warp = into.warp;
    CHECK(same_yarns(into, from));
    from.weft.feeders[0].name += "x";
    CHECK_FALSE(same_yarns(into, from));
}

TEST_CASE("two long names that are cut alike do not become one block") {
    const std::string stem(62, 'n');
    Design into = design_of({{stem + "-a", plain()}, {stem + "-b", plain()}}, stem + "-a");
    const Design from = design_of({{stem + "-a", other_plain()},
                                   {stem + "-b", node(plain()->source, {{0, 0, true}})},
                                   {"cloth", node(AttachOperation{stem + "-a", stem + "-b", Face::plus_y})}},
                                  "cloth");
    const std::string root = bring_in(into, from);
    REQUIRE(check(into));
    const auto children = children_of(*into.blocks.at(root));
    REQUIRE(children.size() == 2);
    CHECK(*into.blocks.at(children[0]) == *other_plain());
    CHECK(into.blocks.at(children[1])->flips.size() == 1);
    CHECK(into.blocks.size() == 5);
}

TEST_CASE(
    "what is brought in evaluates to the same cloth, changes nothing that was there, and comes in once") {
    for_all(
        [](Random& random) {
            Design into = random_design(random);
            const Design from = random_design(random), before = into;
            const std::string root = bring_in(into, from);
            if (const Status sound = check(into); !sound) FAIL(sound.error().text());
            for (const auto& [name, made] : before.blocks) REQUIRE(into.blocks.at(name) == made);
            REQUIRE(into.root == before.root);
            const Result<Evaluation> there = evaluate(from), here = Evaluator().evaluate(into, root);
            REQUIRE(bool(there) == bool(here));
            if (there) {
                REQUIRE(*there->block == *here->block);
                REQUIRE(there->lost_flips.size() == here->lost_flips.size());
            }
            const Design once = into;
            REQUIRE(bring_in(into, from) == root);
            REQUIRE(into == once);
        },
        property_cases());
}
