#include <weave/design/tree.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <design/random_design.hpp>
#include <set>

using namespace weave;
using namespace weave::testing;

TEST_CASE("bottom up each block comes once, after all that it is made from, the root last") {
    for_all(
        [](Random& random) {
            const Design design = random_design(random, 8);
            const std::vector<std::string> order = bottom_up(design, design.root);
            REQUIRE(order.back() == design.root);
            std::set<std::string> done;
            for (const std::string& name : order) {
                for (const std::string& child : children_of(*design.blocks.at(name)))
                    REQUIRE(done.contains(child));
                REQUIRE(done.insert(name).second);
            }
            // No more than the root needs: all but the root have a user.
            for (const std::string& name : order) {
                const bool used = std::any_of(order.begin(), order.end(), [&](const std::string& user) {
                    const auto children = children_of(*design.blocks.at(user));
                    return std::find(children.begin(), children.end(), name) != children.end();
                });
                REQUIRE((used || name == design.root));
            }
        },
        property_cases());
}

TEST_CASE("bottom up of a tree as deep and as shared as may be") {
    Design design = design_of({{"b0", plain()}}, "");
    for (std::size_t k = 1; k < most_blocks; ++k) {
        const std::string below = "b" + std::to_string(k - 1);
        design.blocks["b" + std::to_string(k)] = node(AttachOperation{below, below, Face::plus_x});
    }
    const std::vector<std::string> order = bottom_up(design, "b4095");
    REQUIRE(order.size() == most_blocks);
    CHECK(order.front() == "b0");
    CHECK(order.back() == "b4095");
    CHECK(bottom_up(design, "b0") == std::vector<std::string>{"b0"});
}

TEST_CASE("children are exchanged by name in every kind of operation, and otherwise the node stays itself") {
    const std::map<std::string, std::string> names{{"a", "x"}, {"b", "b"}};
    const auto children = [&](const NodePtr& old) { return children_of(*with_renamed_children(old, names)); };
    using Names = std::vector<std::string>;
    CHECK(children(node(TileOperation{"a", 2, 3, 4})) == Names{"x"});
    CHECK(children(node(RenumberOperation{"a", System::warp, 1, {0}})) == Names{"x"});
    CHECK(children(node(AttachOperation{"a", "b", Face::plus_z})) == Names{"x", "b"});
    CHECK(children(node(AttachOperation{"c", "a", Face::plus_z})) == Names{"c", "x"});
    CHECK(children(stencil_of({"a", "c", "a"}, 1, 3, {0, 1, 2})) == Names{"x", "c", "x"});
    for (const NodePtr& same :
         {plain(), node(TileOperation{"b", 2, 3, 4}), node(AttachOperation{"c", "c", Face::plus_x})})
        CHECK(with_renamed_children(same, names) == same);
    const NodePtr old = node(TileOperation{"a", 2, 3, 4}, {{1, 2, true}});
    const NodePtr renamed = with_renamed_children(old, names);
    CHECK(renamed->flips == old->flips);
    CHECK(std::get<TileOperation>(renamed->source).y == 3);
    CHECK(children_of(*old) == Names{"a"});
}

TEST_CASE("nodes are equal when source and flips are, whatever holds them") {
    for_all(
        [](Random& random) {
            const std::uint64_t seed = random.between(0, 1000000);
            Random one(seed), other(seed);
            const NodePtr a = random_node(one, {"toe", "heel"}), b = random_node(other, {"toe", "heel"});
            REQUIRE(*a == *b);
            Node flipped = *b;
            flipped.flips.push_back({0, 0, true});
            REQUIRE_FALSE(*a == flipped);
        },
        property_cases());
    const auto stack_leaf = plain(), tile = node(TileOperation{"a", 1, 1, 1});
    CHECK_FALSE(*stack_leaf == *tile);
    CHECK_FALSE(*tile == *node(TileOperation{"a", 1, 2, 1}));
    CHECK_FALSE(*tile == *node(TileOperation{"b", 1, 1, 1}));
    CHECK_FALSE(*stencil_of({"a"}, 1, 2, {0, 0}) == *stencil_of({"a"}, 2, 1, {0, 0}));
}
