#include <weave/block/operations.hpp>

#include <block/brute.hpp>
#include <numeric>
#include <support/memory.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

std::vector<std::uint32_t> random_counts(Random& random, std::size_t size) {
    std::vector<std::uint32_t> counts(size);
    for (auto& count : counts) count = static_cast<std::uint32_t>(random.between(1, 3));
    return counts;
}

/// The wefts and warps of `part`, in its order, as they stand in a larger stack from `first` weft and warp
/// on.
bool holds_in_order(const Stack& whole, const Stack& part, std::size_t first_weft, std::size_t first_warp) {
    std::vector<Slot> inside, expected;
    for (const Slot slot : whole.slots()) {
        const std::size_t first = slot.is_weft() ? first_weft : first_warp;
        const std::size_t count = slot.is_weft() ? part.wefts() : part.warps();
        if (slot.is_empty() || slot.index() < first || slot.index() >= first + count) continue;
        inside.push_back(slot.renumbered(slot.index() - first));
    }
    for (const Slot slot : part.slots()) {
        if (!slot.is_empty()) expected.push_back(slot);
    }
    return inside == expected;
}

bool region_is(const CardImage& whole, const CardImage& part, std::size_t first_pick, std::size_t first_end) {
    for (std::size_t pick = 0; pick < part.picks(); ++pick) {
        for (std::size_t end = 0; end < part.ends(); ++end) {
            if (whole.weft_over(first_pick + pick, first_end + end) != part.weft_over(pick, end))
                return false;
        }
    }
    return true;
}

std::vector<std::size_t> random_order(Random& random, std::size_t count) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    random.shuffle(order);
    return order;
}

}  // namespace

TEST_CASE("a tiled block is what the paper's algorithm without its misprint makes") {
    for_all([](Random& random) {
        const Block block = random_block(random, {}, {}, 3);
        const std::size_t x = random.between(1, 3), y = random.between(1, 3), z = random.between(1, 3);
        const Block tiles = tile(block, x, y, z).value();
        REQUIRE(plain(tiles) == tiled(plain(block), x, y, z, false));
        REQUIRE(obeys(plain(tiles)));
        REQUIRE(pixels(tiles.card_image()) == pixels(plain(tiles)));
    });
}

TEST_CASE("each copy in a tiled block keeps the order and the card of its source") {
    for_all([](Random& random) {
        const Block block = random_block(random, {}, {}, 3);
        const std::size_t x = random.between(1, 3), y = random.between(1, 3), z = random.between(1, 3);
        const Block tiles = tile(block, x, y, z).value();
        const std::size_t row = random.between(0, tiles.rows() - 1),
                          column = random.between(0, tiles.columns() - 1);
        const std::size_t copy = random.between(0, z - 1);
        const Stack& source = block.stack(row % block.rows(), column % block.columns());
        REQUIRE(
            holds_in_order(tiles.stack(row, column), source, copy * source.wefts(), copy * source.warps()));
        if (z == 1) {
            REQUIRE(region_is(tiles.card_image(), block.card_image(), (x - 1) * block.picks(),
                              (y - 1) * block.ends()));
        }
    });
}

TEST_CASE("the tiling formula as printed breaks the yarn index constraints") {
    std::size_t broken = 0;
    for_all(
        [&](Random& random) {
            const Block block = random_block(random, {}, {}, 3);
            const Plain printed = tiled(plain(block), 2, 2, 2, true);
            // The factor is wrong in the first column, where it takes away the picks of the rows before, and
            // from the third on, where it counts yarns several times; only where all those sums are 0 it does
            // no harm.
            REQUIRE(obeys(printed) == (block.rows() == 1 && block.columns() <= 2));
            broken += obeys(printed) ? 0 : 1;
        },
        property_cases());
    REQUIRE(broken > 0);
}

TEST_CASE("tiling refuses nothing-times and more crossings than a card may have") {
    const Block block = make_block({1}, {1}, [](auto, auto) {
                            return Stack({Slot::weft(0), Slot::warp(0)});
                        }).value();
    REQUIRE_FALSE(tile(block, 0, 1, 1));
    REQUIRE_FALSE(tile(block, 1, 1, 0));
    for (const std::size_t times : {std::size_t{1} << 30, std::size_t{1} << 62, SIZE_MAX}) {
        REQUIRE_FALSE(tile(block, times, 2, 1));
        REQUIRE_FALSE(tile(block, 1, times, 2));
        REQUIRE_FALSE(tile(block, 1, 1, times));
        REQUIRE_FALSE(tile(block, times, times, times));
    }
    REQUIRE_THAT(tile(block, 40000, 40000, 1).error().message, Catch::Contains("limit"));
    REQUIRE_THAT(tile(block, 100'000, 1, 1000).error().message, Catch::Contains("where each layer counts: x times z"));
}

TEST_CASE("a block that claims a great height cannot be piled up into endless memory") {
    const auto block_of_height = [](std::size_t height) {
        return make_block(
            {1}, {1},
            [](auto, auto) {
                return Stack({Slot::weft(0), Slot::warp(0)});
            },
            height);
    };
    REQUIRE_THAT(block_of_height(most_height + 1).error().message, Catch::Contains("higher than the limit"));
    const Block tall = block_of_height(most_height).value(), small = block_of_height(2).value();
    REQUIRE(tile(tall, 2, 2, 1).value().height() == most_height);
    for (const std::size_t times : {2, 1000, 16384}) {
        REQUIRE_THAT(tile(tall, 1, 1, times).error().message, Catch::Contains("higher than the limit"));
    }
    REQUIRE_THAT(attach(tall, small, Face::plus_z).error().message, Catch::Contains("higher than the limit"));
    REQUIRE_THAT(attach(tall, small, Face::minus_z).error().message,
                 Catch::Contains("higher than the limit"));
    const Block half = block_of_height(most_height / 2).value();
    REQUIRE(attach(half, half, Face::plus_z).value().stack(0, 0).height() == most_height / 2 + 2);
    REQUIRE(check_slots(256, most_height));
    REQUIRE_THAT(check_slots(257, most_height).error().message, Catch::Contains("different stacks"));
}

TEST_CASE("a stack tiled to the greatest height takes no time to pile up") {
    const Block block = make_block({1}, {1}, [](auto, auto) {
                            return Stack({Slot::warp(0), Slot(), Slot::weft(0, true)});
                        }).value();
    const Block high = tile(block, 1, 1, 16384).value();
    REQUIRE(high.height() == 3 * 16384);
    REQUIRE(high.stack(0, 0).check());
    REQUIRE(high.stack(0, 0).slots()[3 * 16383] == Slot::warp(16383));
    REQUIRE(high.stack(0, 0).slots()[3 * 16383 + 2] == Slot::weft(16383, true));
}

TEST_CASE("attaching puts both blocks side by side on all six faces") {
    for_all([](Random& random) {
        const auto face = static_cast<Face>(random.between(0, 5));
        const std::size_t axis = static_cast<std::size_t>(face) / 2;
        const bool after = static_cast<std::size_t>(face) % 2 == 0;
        const Block one = random_block(random, {}, {}, 3);
        const auto t =
            axis == 1 ? one.t() : random_counts(random, axis == 2 ? one.rows() : random.between(1, 3));
        const auto p =
            axis == 0 ? one.p() : random_counts(random, axis == 2 ? one.columns() : random.between(1, 3));
        const Block other = random_block(random, t, p);
        const Block whole = attach(one, other, face).value();
        const Block &first = after ? one : other, &second = after ? other : one;
        REQUIRE(obeys(plain(whole)));
        const CardImage card = whole.card_image();
        REQUIRE(pixels(card) == pixels(plain(whole)));
        if (axis < 2) {
            const std::size_t picks = axis == 0 ? first.picks() : 0, ends = axis == 1 ? first.ends() : 0;
            REQUIRE(whole.height() == std::max(one.height(), other.height()));
            REQUIRE(region_is(card, first.card_image(), 0, 0));
            REQUIRE(region_is(card, second.card_image(), picks, ends));
            REQUIRE(whole.stack(axis == 0 ? first.rows() : 0, axis == 1 ? first.columns() : 0) ==
                    second.stack(0, 0));
            return;
        }
        REQUIRE(whole.height() == one.height() + other.height());
        for (std::size_t row = 0; row < one.rows(); ++row) {
            for (std::size_t column = 0; column < one.columns(); ++column) {
                const Stack &lower = first.stack(row, column), &upper = second.stack(row, column);
                REQUIRE(holds_in_order(whole.stack(row, column), lower, 0, 0));
                REQUIRE(holds_in_order(whole.stack(row, column), upper, lower.wefts(), lower.warps()));
                // the upper part starts at the lower block's full height, in every stack
                const auto slots = whole.stack(row, column).slots();
                REQUIRE(slots.size() == first.height() + upper.height());
            }
        }
    });
}

TEST_CASE("attaching names the pick or end at which blocks differ, as a weaver counts") {
    Random random(1);
    const Block one = random_block(random, {1, 2, 1}, {2, 2}),
                wider = random_block(random, {1, 2, 1}, {2, 3});
    const Block deeper = random_block(random, {1, 2, 3}, {2, 2}),
                longer = random_block(random, {1, 2}, {2, 2});
    REQUIRE(attach(one, wider, Face::plus_x).error().message ==
            "cannot attach: at end 3 the block has 2 ends in a stack and the other 3");
    REQUIRE(attach(one, deeper, Face::minus_y).error().message ==
            "cannot attach: at pick 4 the other has 3 picks in a stack and the block 1");
    REQUIRE(attach(one, longer, Face::plus_y).error().message ==
            "the block has 4 picks (3 rows) and the other 3 picks (2 rows): the rows must be equal on the faces that meet");
    REQUIRE(attach(one, longer, Face::plus_x));
}

TEST_CASE("attaching says which block has what, on whichever face") {
    Random random(1);
    const Block toe = random_block(random, {1, 2, 1}, {2, 2}), sole = random_block(random, {1, 2, 3}, {2, 3}),
                heel = random_block(random, {1, 2}, {2});
    const std::vector<std::string> toe_sole{"toe", "sole"}, toe_heel{"toe", "heel"};
    CHECK(attach(toe, sole, Face::plus_x, toe_sole).error().message ==
          "cannot attach: at end 3 'toe' has 2 ends in a stack and 'sole' 3");
    CHECK(attach(toe, sole, Face::minus_x, toe_sole).error().message ==
          "cannot attach: at end 3 'sole' has 3 ends in a stack and 'toe' 2");
    CHECK(attach(toe, sole, Face::plus_y, toe_sole).error().message ==
          "cannot attach: at pick 4 'toe' has 1 pick in a stack and 'sole' 3");
    CHECK(attach(toe, sole, Face::minus_y, toe_sole).error().message ==
          "cannot attach: at pick 4 'sole' has 3 picks in a stack and 'toe' 1");
    CHECK(attach(toe, heel, Face::plus_x, toe_heel).error().message ==
          "'toe' has 4 ends (2 columns) and 'heel' 2 ends (1 column): the columns must be equal on the faces that meet");
    CHECK(attach(toe, heel, Face::plus_z, toe_heel).error().message ==
          "'toe' has 4 picks (3 rows) and 4 ends (2 columns), 'heel' 3 picks (2 rows) and 2 ends (1 column); on top of "
          "each other rows and columns must be equal");
    CHECK_THAT(attach(toe, heel, Face::minus_z, toe_heel).error().message,
               Catch::StartsWith("'heel' has 3 picks (2 rows) and 2 ends (1 column), 'toe' 4 picks (3 rows) and 4 ends (2 columns);"));
}

TEST_CASE("a stencil takes each stack from the block that it names") {
    for_all([](Random& random) {
        const Block first = random_block(random);
        std::vector<BlockPtr> blocks{std::make_shared<const Block>(first)};
        const std::size_t more = random.between(0, 2);
        for (std::size_t k = 0; k < more; ++k) {
            blocks.push_back(std::make_shared<const Block>(random_block(random, first.t(), first.p())));
        }
        StencilMap map{random.between(1, 9), random.between(1, 9), {}};
        for (std::size_t k = 0; k < map.rows * map.columns; ++k) {
            map.blocks.push_back(static_cast<std::uint16_t>(random.between(0, more)));
        }
        const Block whole = stencil(blocks, map).value();
        REQUIRE(obeys(plain(whole)));
        REQUIRE(pixels(whole.card_image()) == pixels(plain(whole)));
        for (std::size_t row = 0; row < map.rows; ++row) {
            for (std::size_t column = 0; column < map.columns; ++column) {
                const Block& source = *blocks[map.row(row)[column]];
                REQUIRE(whole.stack(row, column) ==
                        source.stack(row % first.rows(), column % first.columns()));
            }
        }
    });
}

TEST_CASE("a stencil of blocks of different sizes fits where their repeated counts agree") {
    Random random(2);
    const auto share = [](Block block) { return std::make_shared<const Block>(std::move(block)); };
    const std::vector<BlockPtr> fits{share(random_block(random, {2}, {1, 3})),
                                     share(random_block(random, {2, 2}, {1, 3, 1, 3}))};
    StencilMap map{3, 4, std::vector<std::uint16_t>(12, 1)};
    REQUIRE(stencil(fits, map));
    map.blocks[7] = 2;
    REQUIRE(stencil(fits, map).error().text() ==
            "stencil[1][3]: names block 2, but there are only 2, counted from 0");
    map.blocks[7] = 0;
    const std::vector<BlockPtr> differ{share(random_block(random, {2}, {1, 3})),
                                       share(random_block(random, {2, 2, 1}, {1, 3}))};
    REQUIRE(stencil(differ, map).error().message ==
            "block 0 and block 1 do not fit together: at pick 5 block 0 has 2 picks in a stack and block 1 1");
    const std::vector<std::string> names{"ground", "figure"};
    REQUIRE(stencil(differ, map, names).error().message ==
            "'ground' and 'figure' do not fit together: at pick 5 'ground' has 2 picks in a stack and 'figure' 1");
    const std::vector<BlockPtr> wide{share(random_block(random, {2}, {1, 3})),
                                     share(random_block(random, {2}, {1, 2}))};
    REQUIRE_THAT(stencil(wide, map).error().message, Catch::Contains("at end 2 block 0 has 3 ends in a stack"));
    REQUIRE_FALSE(stencil(fits, StencilMap{}));
    REQUIRE_FALSE(stencil({}, map));
}

TEST_CASE("renumbering permutes picks within a row or ends within a column and nothing else") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        const bool of_row = random.coin();
        const std::size_t line = random.between(0, (of_row ? block.rows() : block.columns()) - 1);
        const auto order = random_order(random, of_row ? block.t()[line] : block.p()[line]);
        const Block changed =
            (of_row ? renumber_row(block, line, order) : renumber_column(block, line, order)).value();
        REQUIRE(obeys(plain(changed)));
        const std::size_t first = of_row ? block.first_pick(line) : block.first_end(line);
        auto expected = pixels(block.card_image());
        const auto source = [&](std::size_t yarn) {
            return yarn >= first && yarn < first + order.size() ? first + order[yarn - first] : yarn;
        };
        for (std::size_t pick = 0; pick < block.picks(); ++pick) {
            for (std::size_t end = 0; end < block.ends(); ++end) {
                expected[pick][end] =
                    block.weft_over(of_row ? source(pick) : pick, of_row ? end : source(end));
            }
        }
        REQUIRE(pixels(changed.card_image()) == expected);
        REQUIRE(changed.t() == block.t());
        REQUIRE(changed.p() == block.p());
        std::vector<std::size_t> back(order.size());
        for (std::size_t k = 0; k < order.size(); ++k) back[order[k]] = k;
        REQUIRE((of_row ? renumber_row(changed, line, back) : renumber_column(changed, line, back)).value() ==
                block);
    });
}

TEST_CASE("renumbering refuses what is not an order of that row's picks") {
    Random random(3);
    const Block block = random_block(random, {3}, {2, 1});
    const std::vector<std::size_t> twice{0, 1, 1}, short_one{0, 1}, foreign{0, 1, 3}, fine{2, 0, 1},
        ends{1, 0};
    for (const auto& wrong : {twice, short_one, foreign}) {
        REQUIRE_THAT(renumber_row(block, 0, wrong).error().message,
                     Catch::Contains("row 0") && Catch::Contains("3 picks"));
    }
    REQUIRE(renumber_row(block, 0, fine));
    REQUIRE_FALSE(renumber_row(block, 1, fine));
    REQUIRE(renumber_column(block, 0, ends));
    REQUIRE_THAT(renumber_column(block, 2, ends).error().message, Catch::Contains("no column 2"));
}

TEST_CASE("no operation makes a block higher than the limit, however few yarns it has") {
    const auto stack = [](std::size_t, std::size_t) { return Stack({Slot::weft(0), Slot::warp(0)}); };
    CHECK(!make_block({1}, {1}, stack, most_height + 1));
    const Block high = make_block({1}, {1}, stack, most_height).value();
    CHECK(tile(high, 1, 1, 1));
    CHECK(!tile(high, 1, 1, 2));
    CHECK(!attach(high, high, Face::plus_z));
    CHECK(attach(high, high, Face::plus_x));
}

TEST_CASE("renumbering a block whose table holds equal stacks twice leaves the other rows as they are") {
    const Stack one({Slot::weft(0), Slot::warp(0)}), other({Slot::warp(0), Slot::weft(0)});
    const Block block = Block::make({1, 1}, {1}, {one, one, other}, {1, 2}).value();
    const std::vector<std::size_t> order{0};
    CHECK(renumber_row(block, 0, order).value() == block);
    const Block wide = Block::make({1}, {1, 1}, {one, one, other}, {1, 2}).value();
    CHECK(renumber_column(wide, 0, order).value() == wide);
}

TEST_CASE("renumbering again and again leaves no stacks behind that no cell uses") {
    const std::vector<std::size_t> order{1, 2, 0};
    Block block = make_block({3, 3}, {1}, [](std::size_t, std::size_t) {
                      return Stack({Slot::weft(0), Slot::warp(0), Slot::weft(1), Slot::weft(2)});
                  }).value();
    for (int k = 0; k < 2; ++k) block = renumber_row(block, 0, order).value();
    CHECK(block.stacks().size() == 2);
    CHECK(renumber_row(block, 0, order)->stacks().size() == 1);
}

TEST_CASE("a block that would be too large is refused before a single stack of it is made") {
    std::size_t made = 0;
    const std::vector<std::uint32_t> counts(1000, 64);
    const Result<Block> block = make_block(counts, counts, [&](std::size_t, std::size_t) {
        ++made;
        return Stack();
    });
    REQUIRE_THAT(block.error().message,
                 Catch::Contains("64000 picks and 64000 ends is larger than the limit"));
    CHECK(made == 0);
}

TEST_CASE("a stencil that would be too large is refused before its cells are laid out") {
    constexpr std::uint32_t yarns = 16;
    const auto block =
        std::make_shared<const Block>(make_block({yarns, 0}, {yarns, 0}, [](std::size_t i, std::size_t j) {
                                          std::vector<Slot> slots;
                                          for (std::size_t k = 0; k < yarns; ++k) {
                                              if (i == 0) slots.push_back(Slot::weft(k));
                                              if (j == 0) slots.push_back(Slot::warp(k));
                                          }
                                          return Stack(std::move(slots));
                                      }).value());
    StencilMap map{5001, 5003, {}};
    map.blocks.resize(map.rows * map.columns);
    const double before = testing::peak_mb();
    const Error error = stencil(std::vector<BlockPtr>{block}, map).error();
    CHECK(testing::peak_mb() - before < 50);  // its cells would be 100 MB
    CHECK_THAT(error.message, Catch::Contains("40016 picks and 40032 ends is larger than the limit"));
    CHECK(check_stencil_size(block->grid(), map.rows, map.columns).error().message == error.message);
    CHECK(check_stencil_size(block->grid(), 2001, 2000));
}
