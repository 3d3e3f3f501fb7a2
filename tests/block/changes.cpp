#include <weave/block/changes.hpp>

#include <weave/block/operations.hpp>

#include <block/brute.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// The block with the flips made one by one, each of which must change its pixel and no other.
Block made(Block block, const std::vector<Flip>& flips) {
    for (const Flip& wish : flips) {
        REQUIRE(block.weft_over(wish.pick, wish.end) != wish.weft_over);
        block = flip(block, wish.pick, wish.end).value();
    }
    return block;
}

constexpr std::size_t any_number = 1'000'000;

}  // namespace

TEST_CASE("the flips between two blocks can be made one by one and lead from the crossings of one to those of the other") {
    std::size_t led = 0;
    for_all([&](Random& random) {
        const Block before = random_block(random);
        // Any other order of the yarns of each stack.
        std::vector<std::vector<Slot>> shuffled;
        const Block after = make_block(before.t(), before.p(), [&](std::size_t row, std::size_t column) {
                                const auto old = before.stack(row, column).slots();
                                std::vector<Slot> slots(old.begin(), old.end());
                                for (std::size_t k = slots.size(); k > 1; --k) std::swap(slots[k - 1], slots[random.between(0, k - 1)]);
                                return Stack(std::move(slots));
                            }).value();
        const auto flips = flips_between(before, after, any_number);
        REQUIRE(flips);
        led += flips->size();
        REQUIRE(made(before, *flips).card_image() == after.card_image());
        const std::size_t differs = [&] {
            std::size_t count = 0;
            for (std::size_t pick = 0; pick < before.picks(); ++pick) {
                for (std::size_t end = 0; end < before.ends(); ++end)
                    count += before.weft_over(pick, end) != after.weft_over(pick, end) ? 1 : 0;
            }
            return count;
        }();
        REQUIRE(flips->size() == differs);  // none is led there and back
    });
    REQUIRE(led > property_cases());
}

TEST_CASE("a flip of a block is found at each place of it in a repeated cloth, up to as many as are asked for") {
    const Block block = make_block({1, 1}, {1, 1}, [](std::size_t row, std::size_t column) {
                            return row == column ? Stack({Slot::weft(0), Slot::warp(0)}) : Stack({Slot::warp(0), Slot::weft(0)});
                        }).value();
    const Block before = tile(block, 2, 3, 1).value(), after = tile(flip(block, 1, 0).value(), 2, 3, 1).value();
    const std::vector<Flip> expected{{1, 0, false}, {1, 2, false}, {1, 4, false}, {3, 0, false}, {3, 2, false}, {3, 4, false}};
    CHECK(flips_between(before, after, 6) == expected);
    CHECK_FALSE(flips_between(before, after, 5));
    CHECK(flips_between(before, before, 0) == std::vector<Flip>());
    CHECK_FALSE(flips_between(before, block, 6));
}
