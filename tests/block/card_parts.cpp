#include <weave/block/card_part.hpp>
#include <weave/block/card_wish.hpp>

#include <algorithm>
#include <block/brute.hpp>
#include <set>
#include <support/random.hpp>
#include <utility>

using namespace weave;
using namespace weave::testing;

namespace {

CardImage random_part(Random& random, std::size_t picks, std::size_t ends) {
    CardImage part(picks, ends);
    for (std::size_t pick = 0; pick < picks; ++pick) {
        for (std::size_t end = 0; end < ends; ++end) part.set(pick, end, random.between(0, 1) == 1);
    }
    return part;
}

/// A block of one stack, the yarns in this order from the bottom.
Block one_stack(const std::vector<Slot>& yarns) {
    const Stack stack(yarns);
    return make_block({static_cast<std::uint32_t>(stack.wefts())},
                      {static_cast<std::uint32_t>(stack.warps())},
                      [&](std::size_t, std::size_t) { return stack; })
        .value();
}

/// The cards of all stacks of so many yarns.
std::vector<CardImage> all_cards(std::size_t wefts, std::size_t warps) {
    std::vector<CardImage> cards;
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < wefts + warps; ++k) order.push_back(k);
    do {
        std::vector<Slot> yarns;
        for (const std::size_t k : order) yarns.push_back(k < wefts ? Slot::weft(k) : Slot::warp(k - wefts));
        const CardImage card = one_stack(yarns).card_image();
        if (std::ranges::find(cards, card) == cards.end()) cards.push_back(card);
    } while (std::next_permutation(order.begin(), order.end()));
    return cards;
}

/// Whether each pixel is as in one of the two.
bool lies_between(const CardImage& card, const CardImage& one, const CardImage& other) {
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        for (std::size_t end = 0; end < card.ends(); ++end) {
            if (card.weft_over(pick, end) != one.weft_over(pick, end) &&
                card.weft_over(pick, end) != other.weft_over(pick, end))
                return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("a part of a card goes on at its beginning past its last pick and end") {
    for_all([](Random& random) {
        const CardImage card = random_part(random, random.between(1, 9), random.between(1, 19));
        const std::size_t pick = random.between(0, card.picks() - 1),
                          end = random.between(0, card.ends() - 1);
        const CardImage part = part_of(card, pick, end, random.between(1, 20), random.between(1, 40));
        for (std::size_t k = 0; k < part.picks(); ++k) {
            for (std::size_t j = 0; j < part.ends(); ++j)
                REQUIRE(part.weft_over(k, j) ==
                        card.weft_over((pick + k) % card.picks(), (end + j) % card.ends()));
        }
    });
}

TEST_CASE("a part is mirrored and inverted pixel by pixel, and twice is not at all") {
    for_all([](Random& random) {
        const CardImage part = random_part(random, random.between(1, 9), random.between(1, 19));
        const CardImage across = mirrored_across(part), along = mirrored_along(part), other = inverted(part);
        for (std::size_t pick = 0; pick < part.picks(); ++pick) {
            for (std::size_t end = 0; end < part.ends(); ++end) {
                REQUIRE(across.weft_over(pick, end) == part.weft_over(pick, part.ends() - 1 - end));
                REQUIRE(along.weft_over(pick, end) == part.weft_over(part.picks() - 1 - pick, end));
                REQUIRE(other.weft_over(pick, end) != part.weft_over(pick, end));
            }
        }
        REQUIRE(mirrored_across(across) == part);
        REQUIRE(mirrored_along(along) == part);
        REQUIRE(inverted(other) == part);  // the bits beside the last end stay 0
        REQUIRE(one_sided(3, 5, true) == inverted(one_sided(3, 5, false)));
    });
}

TEST_CASE("a wish is granted where flips can make it so, the rest is told, and nothing else changes") {
    std::size_t granted_some = 0, refused_some = 0;
    for_all([&](Random& random) {
        const Block block = random_block(random);
        CardWish wish{random.between(0, block.picks() - 1), random.between(0, block.ends() - 1), {}};
        wish.pixels = random_part(random, random.between(1, block.picks()), random.between(1, block.ends()));
        const GrantedWish granted = grant(block, wish);
        const FlippedBlock after = apply_flips(block, granted.flips);
        REQUIRE(after.refused.empty());  // each was valid in its turn
        auto expected = pixels(block.card_image());
        for (std::size_t k = 0; k < wish.pixels.picks(); ++k) {
            for (std::size_t j = 0; j < wish.pixels.ends(); ++j)
                expected[(wish.pick + k) % block.picks()][(wish.end + j) % block.ends()] =
                    wish.pixels.weft_over(k, j);
        }
        for (const Flip& refused : granted.refused) {
            expected[refused.pick][refused.end] = !refused.weft_over;
            REQUIRE_FALSE(flip(after.block, refused.pick, refused.end));
        }
        REQUIRE(pixels(after.block.card_image()) == expected);
        REQUIRE(std::ranges::is_sorted(granted.refused, {},
                                       [](const Flip& one) { return std::pair(one.pick, one.end); }));
        if (!granted.refused.empty()) {
            const Flip& first = granted.refused[0];
            REQUIRE(granted.reason == flip(after.block, first.pick, first.end).error().message);
        }
        // The flips the other way round, last first, give back what was.
        std::vector<Flip> back(granted.flips.rbegin(), granted.flips.rend());
        for (Flip& one : back) one.weft_over = !one.weft_over;
        REQUIRE(apply_flips(after.block, back).block.card_image() == block.card_image());
        granted_some += granted.flips.empty() ? 0 : 1;
        refused_some += granted.refused.empty() ? 0 : 1;
    });
    CHECK(granted_some > property_cases() / 4);
    CHECK(refused_some > property_cases() / 20);
}

TEST_CASE("what a stack can be at all is granted whole, and no refused crossings could be flipped together") {
    using Counts = std::pair<std::size_t, std::size_t>;
    for (const Counts& counts : {Counts{3, 3}, Counts{2, 3}, Counts{4, 2}}) {
        const std::size_t wefts = counts.first, warps = counts.second;
        const std::vector<CardImage> possible = all_cards(wefts, warps);
        for_all([&](Random& random) {
            std::vector<Slot> yarns;
            for (std::size_t k = 0; k < wefts; ++k) yarns.push_back(Slot::weft(k));
            for (std::size_t k = 0; k < warps; ++k) yarns.push_back(Slot::warp(k));
            for (std::size_t k = yarns.size(); k > 1; --k)
                std::swap(yarns[k - 1], yarns[random.between(0, k - 1)]);
            const Block block = one_stack(yarns);
            const CardImage& can_be = possible[random.between(0, possible.size() - 1)];
            REQUIRE(grant(block, {0, 0, can_be}).refused.empty());
            const CardImage wish = random_part(random, wefts, warps);
            const CardImage after = apply_flips(block, grant(block, {0, 0, wish}).flips).block.card_image();
            for (const CardImage& better : possible)
                REQUIRE((better == after || !lies_between(better, after, wish)));
        });
    }
}
