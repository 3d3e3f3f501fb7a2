#include <weave/block/stencil_edit.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

StencilMap random_map(Random& random, std::size_t blocks) {
    StencilMap map{random.between(1, 6), random.between(1, 6), {}};
    for (std::size_t k = 0; k < map.rows * map.columns; ++k)
        map.blocks.push_back(static_cast<std::uint16_t>(random.between(0, blocks - 1)));
    return map;
}

}  // namespace

TEST_CASE("a stencil that grows and shrinks again at the same corner is as it was") {
    for_all([](Random& random) {
        const StencilMap map = random_map(random, 3);
        const auto rows_kept = static_cast<Keep>(random.between(0, 2)),
                   columns_kept = static_cast<Keep>(random.between(0, 2));
        const std::size_t rows = map.rows + random.between(0, 5),
                          columns = map.columns + random.between(0, 5);
        const StencilMap grown = resized(map, rows, columns, rows_kept, columns_kept, 7).value();
        REQUIRE(static_cast<std::size_t>(std::ranges::count(grown.blocks, std::uint16_t{7})) ==
                rows * columns - map.blocks.size());
        REQUIRE(resized(grown, map.rows, map.columns, rows_kept, columns_kept, 9).value() == map);
    });
}

TEST_CASE("the part of a stencil that is kept stays at its side") {
    const StencilMap map{2, 2, {1, 2, 3, 4}};
    REQUIRE(resized(map, 3, 2, Keep::low, Keep::low, 0)->blocks ==
            std::vector<std::uint16_t>{1, 2, 3, 4, 0, 0});
    REQUIRE(resized(map, 3, 2, Keep::high, Keep::low, 0)->blocks ==
            std::vector<std::uint16_t>{0, 0, 1, 2, 3, 4});
    REQUIRE(resized(map, 2, 4, Keep::low, Keep::middle, 0)->blocks ==
            std::vector<std::uint16_t>{0, 1, 2, 0, 0, 3, 4, 0});
    REQUIRE(resized(map, 1, 1, Keep::high, Keep::high, 0)->blocks == std::vector<std::uint16_t>{4});
    REQUIRE_FALSE(resized(map, 0, 1, Keep::low, Keep::low, 0));
    REQUIRE_FALSE(resized(map, most_yarns + 1, 1, Keep::low, Keep::low, 0));
    REQUIRE(with_blocks_renumbered(map, std::vector<std::uint16_t>{9, 5, 6, 7, 8}).blocks ==
            std::vector<std::uint16_t>{5, 6, 7, 8});
    REQUIRE(stacks_of_blocks({1, 4, {1, 0, 1, 5}}, 3) == std::vector<std::size_t>{1, 2, 0});
}

TEST_CASE("what a stencil refuses of its blocks for their counts, their grids tell alone") {
    for_all([](Random& random) {
        std::vector<BlockPtr> blocks;
        std::vector<const BlockGrid*> grids;
        std::vector<std::string> names;
        for (std::size_t k = random.between(1, 3); k > 0; --k) {
            blocks.push_back(std::make_shared<const Block>(random_block(random, {}, {}, 2)));
            grids.push_back(&blocks.back()->grid());
            names.push_back("b" + std::to_string(k));
        }
        const StencilMap map = random_map(random, blocks.size());
        const auto made = stencil(blocks, map, names);
        const Status told = check_stencil_counts(grids, map.rows, map.columns, names);
        REQUIRE(static_cast<bool>(made) == static_cast<bool>(told));
        if (!made) REQUIRE(made.error().text() == told.error().text());
    });
    REQUIRE_FALSE(check_stencil_counts({}, 1, 1));
}
