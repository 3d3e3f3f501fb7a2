#include <weave/block/flip.hpp>

#include <algorithm>
#include <block/brute.hpp>
#include <set>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// The pixels of a stack as one number: bit weft * warps + warp is set where the weft lies over the warp.
std::uint32_t pixels_of(const Stack& stack) {
    std::uint32_t image = 0;
    const auto wefts = stack.positions(System::weft), warps = stack.positions(System::warp);
    for (std::size_t weft = 0; weft < wefts.size(); ++weft) {
        for (std::size_t warp = 0; warp < warps.size(); ++warp) {
            if (wefts[weft] > warps[warp]) image |= std::uint32_t{1} << (weft * warps.size() + warp);
        }
    }
    return image;
}

/// Calls `visit` with every order of these yarns and empty slots.
template <class Visit>
void for_each_stack(std::size_t wefts, std::size_t warps, std::size_t empties, Visit visit) {
    std::vector<int> items;  // permuted as numbers: equal empties are then not repeated
    for (std::size_t k = 0; k < empties; ++k) items.push_back(-1);
    for (std::size_t k = 0; k < wefts + warps; ++k) items.push_back(static_cast<int>(k));
    do {
        std::vector<Slot> slots;
        for (const int item : items) {
            const auto k = static_cast<std::size_t>(item);
            slots.push_back(item < 0 ? Slot() : k < wefts ? Slot::weft(k) : Slot::warp(k - wefts));
        }
        visit(Stack(std::move(slots)));
    } while (std::next_permutation(items.begin(), items.end()));
}

std::vector<bool> empty_places(const Stack& stack) {
    std::vector<bool> places;
    for (const Slot slot : stack.slots()) places.push_back(slot.is_empty());
    return places;
}

/// Whether the yarns in the way truly are: each lies between the two, and without them the flip would be
/// possible.
bool truly_in_the_way(const Stack& stack, std::size_t weft, std::size_t warp,
                      const std::vector<Slot>& named) {
    const std::size_t a = stack.positions(System::weft)[weft], b = stack.positions(System::warp)[warp];
    for (const Slot yarn : named) {
        if (yarn.is_empty()) return false;
        const std::size_t place = stack.positions(yarn.is_weft() ? System::weft : System::warp)[yarn.index()];
        if (place <= std::min(a, b) || place >= std::max(a, b)) return false;
    }
    return !named.empty();
}

/// Checks one flip of one stack against the set of all images that any stack of these yarns has.
bool flip_is_right(const Stack& stack, std::size_t weft, std::size_t warp,
                   const std::vector<bool>& possible) {
    const std::uint32_t wanted = pixels_of(stack) ^ std::uint32_t{1} << (weft * stack.warps() + warp);
    const FlippedStack flipped = flip(stack, weft, warp);
    if (flipped.valid != possible[wanted]) return false;
    if (!flipped.valid)
        return flipped.stack == stack && truly_in_the_way(stack, weft, warp, flipped.in_the_way);
    return flipped.in_the_way.empty() && pixels_of(flipped.stack) == wanted && flipped.stack.check() &&
           empty_places(flipped.stack) == empty_places(stack);
}

}  // namespace

TEST_CASE(
    "a flip is accepted exactly when some stack differs in that one pixel: all stacks up to 4 + 4 yarns") {
    std::size_t flips = 0, wrong = 0;
    for (std::size_t wefts = 1; wefts <= 4; ++wefts) {
        for (std::size_t warps = 1; warps <= 4; ++warps) {
            std::vector<bool> possible(std::size_t{1} << (wefts * warps));
            for_each_stack(wefts, warps, 0, [&](const Stack& stack) { possible[pixels_of(stack)] = true; });
            for (std::size_t empties = 0; empties <= 2; ++empties) {
                // 8 yarns and 2 empties have 1.8 million orders; there every 7th flip of each is enough to
                // meet all kinds
                const std::size_t step = wefts + warps + empties >= 9 ? 7 : 1;
                for_each_stack(wefts, warps, empties, [&](const Stack& stack) {
                    for (std::size_t k = flips % step; k < wefts * warps; k += step) {
                        if (!flip_is_right(stack, k / warps, k % warps, possible)) ++wrong;
                    }
                    ++flips;
                });
            }
        }
    }
    REQUIRE(flips > 2000000);
    REQUIRE(wrong == 0);
}

TEST_CASE("a flip of a block changes one pixel, and back") {
    std::size_t accepted = 0, rejected = 0;
    for_all([&](Random& random) {
        const Block block = random_block(random);
        const std::size_t pick = random.between(0, block.picks() - 1),
                          end = random.between(0, block.ends() - 1);
        const auto flipped = flip(block, pick, end);
        const std::string pair = "pick " + std::to_string(pick + 1) + " and end " + std::to_string(end + 1);
        if (!flipped) {
            ++rejected;
            REQUIRE(flipped.error().code == ErrorCode::invalid);
            REQUIRE_THAT(flipped.error().message, Catch::StartsWith(pair) && Catch::Contains("in the way"));
            return;
        }
        ++accepted;
        REQUIRE(obeys(plain(*flipped)));
        auto expected = pixels(block.card_image());
        expected[pick][end] = !expected[pick][end];
        REQUIRE(pixels(flipped->card_image()) == expected);
        REQUIRE(flipped->height() == block.height());
        REQUIRE(flip(*flipped, pick, end).value().card_image() == block.card_image());
    });
    REQUIRE(accepted > property_cases() / 10);
    REQUIRE(rejected > property_cases() / 100);
}

TEST_CASE("a rejected flip names the yarns in the way as people count them") {
    const Stack stack = parse_stack("T0 - P0 T1 P1~").value();
    const Block block = make_block({1, 2}, {1, 2}, [&](std::size_t row, std::size_t column) {
                            if (row == 1 && column == 1) return stack;
                            std::vector<Slot> slots;
                            for (std::size_t k = 0; k <= row; ++k) slots.push_back(Slot::weft(k));
                            for (std::size_t k = 0; k <= column; ++k) slots.push_back(Slot::warp(k));
                            return Stack(slots);
                        }).value();
    REQUIRE(flip(block, 1, 2).error().message ==
            "pick 2 and end 3 cannot be flipped alone: in the way stand end 2, pick 3");
    REQUIRE_THAT(flip(block, 3, 0).error().message, Catch::Contains("no crossing of pick 4 and end 1"));
    REQUIRE_FALSE(flip(block, 0, 3));
    REQUIRE(flip(block, 1, 1));
}

TEST_CASE("many flips at once come to the same as one after the other, refusals in their order") {
    for_all(
        [](Random& random) {
            const Block block = random_block(random);
            std::vector<Flip> flips;
            for (std::size_t k = random.between(0, 20); k > 0; --k)
                flips.push_back(
                    {random.between(0, block.picks()), random.between(0, block.ends()), random.coin()});
            Block expected = block;
            std::vector<RefusedFlip> refused;
            for (const Flip& flip : flips) {
                FlippedBlock next = apply_flips(expected, std::span(&flip, 1));
                expected = std::move(next.block);
                if (next.refused.empty()) {
                    std::erase_if(refused, [&](const RefusedFlip& earlier) {
                        return earlier.flip.pick == flip.pick && earlier.flip.end == flip.end;
                    });
                }
                refused.insert(refused.end(), next.refused.begin(), next.refused.end());
            }
            std::erase_if(refused, [&](const RefusedFlip& lost) {
                const auto [pick, end, weft_over] = lost.flip;
                return expected.grid().holds(pick, end) && expected.weft_over(pick, end) == weft_over;
            });
            const FlippedBlock made = apply_flips(block, flips);
            REQUIRE(made.block == expected);
            REQUIRE(made.refused.size() == refused.size());
            for (std::size_t k = 0; k < refused.size(); ++k) {
                REQUIRE(made.refused[k].flip == refused[k].flip);
                REQUIRE(made.refused[k].reason == refused[k].reason);
            }
        },
        property_cases());
}

TEST_CASE(
    "a refused flip is lost only where its crossing does not lie as asked in the end and nothing settled "
    "it") {
    const Block block = make_block({2}, {2}, [](std::size_t, std::size_t) {
                            return parse_stack("T0 P0 T1 P1").value();
                        }).value();
    const Flip wish{0, 1, true}, clears{1, 1, true};
    const auto refused = [&](std::vector<Flip> flips) { return apply_flips(block, flips).refused.size(); };
    CHECK(refused({wish}) == 1);
    CHECK(refused({wish, clears}) == 1);
    CHECK(refused({wish, clears, wish}) == 0);
    CHECK(refused({wish, clears, wish, {0, 1, false}}) == 0);  // the last word on it is another
    CHECK(refused({wish, clears, {0, 1, false}}) == 0);
    CHECK(refused({wish, wish}) == 2);
    CHECK(refused({wish, {0, 1, false}, wish}) == 1);  // the second was met
}

TEST_CASE("flips in one stack leave no stacks behind on their way") {
    constexpr std::uint32_t yarns = 300;
    const Block block = make_block({yarns}, {yarns}, [](std::size_t, std::size_t) {
                            std::vector<Slot> slots;
                            for (std::size_t k = 0; k < yarns; ++k)
                                slots.push_back(Slot::weft(k)), slots.push_back(Slot::warp(k));
                            return Stack(std::move(slots));
                        }).value();
    std::vector<Flip> flips;
    for (std::size_t k = 0; k < yarns; ++k) flips.push_back({k, k, true});
    const FlippedBlock flipped = apply_flips(block, flips);
    CHECK(flipped.refused.empty());
    CHECK(flipped.block.stacks().size() == 1);
    for (std::size_t k = 0; k < yarns; ++k) CHECK(flipped.block.weft_over(k, k));
}
