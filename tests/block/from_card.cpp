#include <weave/block/from_card.hpp>
#include <weave/block/operations.hpp>
#include <weave/block/preset.hpp>

#include <array>
#include <cstdio>
#include <block/brute.hpp>
#include <set>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

CardImage random_card(Random& random, std::size_t picks, std::size_t ends) {
    CardImage card(picks, ends);
    for (std::size_t pick = 0; pick < picks; ++pick) {
        for (std::size_t end = 0; end < ends; ++end) card.set(pick, end, random.coin());
    }
    return card;
}

/// Whether neighbours of one system stand in the order of their numbers wherever they could change places.
bool is_canonical(const Stack& stack) {
    const auto slots = stack.slots();
    for (std::size_t k = 0; k + 1 < slots.size(); ++k) {
        if (slots[k].is_empty()) return false;
        if (slots[k].same_system(slots[k + 1]) && slots[k].index() > slots[k + 1].index()) return false;
    }
    return true;
}

/// By the definition: no two picks and two ends of the cell lie crosswise.
bool admits_order(const CardImage& card, std::size_t first_pick, std::size_t picks, std::size_t first_end,
                  std::size_t ends) {
    for (std::size_t a = first_pick; a < first_pick + picks; ++a) {
        for (std::size_t b = a + 1; b < first_pick + picks; ++b) {
            for (std::size_t c = first_end; c < first_end + ends; ++c) {
                for (std::size_t d = first_end; d < first_end + ends; ++d) {
                    if (card.weft_over(a, c) && !card.weft_over(b, c) && !card.weft_over(a, d) &&
                        card.weft_over(b, d))
                        return false;
                }
            }
        }
    }
    return true;
}

/// The four numbers of the message, from 0: pick over end 1, under end 2; other pick.
std::array<std::size_t, 4> named_in(const std::string& message) {
    std::size_t pick = 0, over = 0, under = 0, other = 0, under_again = 0, over_again = 0;
    int read = 0;
    std::sscanf(message.c_str(),
                "no order fits: pick %zu lies over end %zu and under end %zu, but pick %zu under end %zu and over end "
                "%zu%n",
                &pick, &over, &under, &other, &under_again, &over_again, &read);
    REQUIRE(static_cast<std::size_t>(read) == message.size());
    REQUIRE(over == under_again);
    REQUIRE(under == over_again);
    return {pick - 1, other - 1, over - 1, under - 1};
}

std::size_t place_of(const std::vector<Grouping>& groupings, const Block& truth) {
    for (std::size_t k = 0; k < groupings.size(); ++k) {
        if (groupings[k].t == truth.t() && groupings[k].p == truth.p()) return k;
    }
    return groupings.size();
}

std::string described(const Preset& preset) {
    std::string text = preset.family;
    for (const auto& [name, value] : preset.options) text += " " + name + "=" + std::to_string(value);
    return text;
}

/// Each family in several sizes; combinations that do not go together are left out.
std::vector<Preset> presets_in_many_sizes() {
    std::vector<Preset> all;
    for (std::int64_t a = 1; a <= 5; ++a) {
        for (std::int64_t b = 1; b <= 5; ++b) {
            for (std::int64_t step = -2; step <= 2; ++step)
                all.push_back({"twill", {{"up", a}, {"down", b}, {"step", step}}});
            all.push_back({"pointed-twill", {{"up", a}, {"down", b}}});
            all.push_back({"herringbone", {{"up", a}, {"down", b}}});
            all.push_back({"basket", {{"ends", a}, {"picks", b}}});
            for (std::int64_t c = 0; c < 2; ++c)
                all.push_back({"rib", {{"first", a}, {"second", b}, {"weft-rib", c}}});
        }
    }
    for (std::int64_t size = 5; size <= 16; ++size) {
        all.push_back({"satin", {{"size", size}}});
        all.push_back({"sateen", {{"size", size}}});
    }
    for (std::int64_t layers = 2; layers <= 7; ++layers) {
        for (std::int64_t stuffers = 0; stuffers <= 2; ++stuffers) {
            for (std::int64_t depth = 0; depth <= layers; ++depth) {
                for (std::int64_t k = 1; k <= 3; ++k) {
                    all.push_back(
                        {"layer-to-layer",
                         {{"layers", layers}, {"depth", depth}, {"float", k}, {"stuffers", stuffers}}});
                    all.push_back(
                        {"angle-interlock",
                         {{"layers", layers}, {"depth", depth}, {"step", k}, {"stuffers", stuffers}}});
                }
            }
            // without stuffers and with floats the card is that of a rib to the last pixel: nothing tells the
            // layers
            for (std::int64_t k = 1; k <= (stuffers > 0 ? 3 : 1); ++k) {
                all.push_back({"orthogonal", {{"layers", layers}, {"float", k}, {"stuffers", stuffers}}});
            }
        }
        for (std::int64_t weave = 0; weave <= 2; ++weave) {
            for (std::int64_t stitch = 0; stitch <= 3; ++stitch) {
                all.push_back({"multi-layer", {{"layers", layers}, {"weave", weave}, {"stitch", stitch}}});
            }
        }
    }
    all.push_back({"plain", {}});
    return all;
}

}  // namespace

TEST_CASE("a card read with the counts of its block gives a block with the same card, in canonical order") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        const CardImage card = block.card_image();
        const Block read = block_from_card(card, block.t(), block.p()).value();
        REQUIRE(read.card_image() == card);
        REQUIRE(read.t() == block.t());
        REQUIRE(read.p() == block.p());
        for (const Stack& stack : read.stacks()) REQUIRE(is_canonical(stack));
        REQUIRE(block_from_card(read.card_image(), read.t(), read.p()).value() == read);
    });
}

TEST_CASE("a cell that admits no order is named with picks and ends that truly contradict each other") {
    std::size_t refused = 0;
    for_all([&](Random& random) {
        const std::size_t t = random.between(1, 3), p = random.between(1, 3);
        const std::size_t rows = random.between(1, 2), columns = random.between(1, 2);
        const CardImage card = random_card(random, t * rows, p * columns);
        const auto block =
            block_from_card(card, {static_cast<std::uint32_t>(t)}, {static_cast<std::uint32_t>(p)});
        std::string first_bad;
        for (std::size_t cell = rows * columns; cell-- > 0;) {
            const std::size_t row = cell / columns, column = cell % columns;
            if (!admits_order(card, row * t, t, column * p, p)) {
                first_bad = "stacks[" + std::to_string(row) + "][" + std::to_string(column) + "]";
            }
        }
        REQUIRE(static_cast<bool>(block) == first_bad.empty());
        if (block) {
            REQUIRE(block->card_image() == card);
            return;
        }
        ++refused;
        REQUIRE(block.error().where == first_bad);
        const auto [pick, other_pick, end, other_end] = named_in(block.error().message);
        REQUIRE(card.weft_over(pick, end));
        REQUIRE_FALSE(card.weft_over(pick, other_end));
        REQUIRE_FALSE(card.weft_over(other_pick, end));
        REQUIRE(card.weft_over(other_pick, other_end));
    });
    REQUIRE(refused > property_cases() / 20);
}

TEST_CASE("cells of all sizes are read alike, whether their pixels fit into a word or not") {
    for_all(
        [](Random& random) {
            const auto t = static_cast<std::uint32_t>(random.between(1, 12)),
                       p = static_cast<std::uint32_t>(random.between(1, 140));
            const Block block = random_block(random, {t, 1, t}, {p, 1, p, 2});
            const CardImage card = block.card_image();
            REQUIRE(block_from_card(card, block.t(), block.p()).value().card_image() == card);
        },
        property_cases());
    Random random(7);
    const CardImage card = random_card(random, 3, 200);
    const Block single_picks = block_from_card(card, {1}, {200}).value();
    REQUIRE(single_picks.card_image() == card);
    const auto contradiction = block_from_card(card, {3}, {200});
    const auto [pick, other_pick, end, other_end] = named_in(contradiction.error().message);
    REQUIRE((card.weft_over(pick, end) && card.weft_over(other_pick, other_end)));
    REQUIRE_FALSE((card.weft_over(pick, other_end) || card.weft_over(other_pick, end)));
}

TEST_CASE("counts that do not come out even with the card are refused") {
    Random random(8);
    const CardImage card = random_card(random, 6, 4);
    REQUIRE(block_from_card(card, {1}, {1}).value().card_image() == card);
    REQUIRE_THAT(block_from_card(card, {4}, {1}).error().message,
                 Catch::Contains("t add up to 4 picks") && Catch::Contains("card's 6"));
    REQUIRE_THAT(block_from_card(card, {1}, {1, 2}).error().message, Catch::Contains("p add up to 3 ends"));
    REQUIRE_FALSE(block_from_card(card, {}, {1}));
    REQUIRE_FALSE(block_from_card(card, {1, 0}, {1}));
    REQUIRE_FALSE(block_from_card(card, {UINT32_MAX, UINT32_MAX}, {1}));
    REQUIRE_FALSE(block_from_card(CardImage(), {1}, {1}));
    REQUIRE(possible_groupings(CardImage()).empty());
}

TEST_CASE("the true stacks of every preset are among the first three that its card is offered") {
    std::set<std::string> families;
    for (const Preset& preset : presets_in_many_sizes()) {
        const auto made = make_preset(preset);
        if (!made) continue;
        families.insert(preset.family);
        for (const Block& block : {*made, tile(*made, 2, 3, 1).value()}) {
            INFO(described(preset) << ", " << block.picks() << " picks");
            const auto groupings = possible_groupings(block.card_image());
            REQUIRE(place_of(groupings, block) < 3);
        }
    }
    REQUIRE(families.size() == preset_families().size());
}

TEST_CASE("every grouping that is offered fits the card, each once, with a reason") {
    for_all(
        [](Random& random) {
            const bool random_pixels = random.between(0, 3) == 0;
            const CardImage card = random_pixels
                                       ? random_card(random, random.between(1, 12), random.between(1, 12))
                                       : random_block(random).card_image();
            const std::size_t most = random.between(1, 12);
            const auto groupings = possible_groupings(card, most);
            REQUIRE_FALSE(groupings.empty());
            REQUIRE(groupings.size() <= most);
            std::set<std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>> seen;
            for (const Grouping& grouping : groupings) {
                REQUIRE(block_from_card(card, grouping.t, grouping.p).value().card_image() == card);
                REQUIRE(seen.emplace(grouping.t, grouping.p).second);
                REQUIRE_FALSE(grouping.reason.empty());
            }
        },
        property_cases());
}

TEST_CASE("layers that were renumbered, or change places from region to region, are still found") {
    const Block layers = make_preset({"multi-layer", {{"layers", 3}}}).value();
    const std::vector<std::size_t> order{2, 0, 1};
    Block mixed = tile(layers, 2, 4, 1).value();
    for (std::size_t row = 0; row < mixed.rows(); ++row) mixed = renumber_row(mixed, row, order).value();
    const auto found = possible_groupings(mixed.card_image());
    REQUIRE(found.front().t == mixed.t());
    REQUIRE(found.front().p == mixed.p());

    const Block two = make_preset({"multi-layer", {}}).value();
    const std::vector<std::size_t> exchange{1, 0};
    Block other = two;
    for (std::size_t k = 0; k < 2; ++k)
        other = renumber_column(renumber_row(other, k, exchange).value(), k, exchange).value();
    const std::vector<BlockPtr> blocks{std::make_shared<const Block>(two),
                                       std::make_shared<const Block>(other)};
    StencilMap map{8, 8, {}};
    for (std::size_t k = 0; k < 64; ++k) map.blocks.push_back(k / 32 == k % 8 / 4 ? 0 : 1);
    const Block checks = stencil(blocks, map).value();
    REQUIRE(place_of(possible_groupings(checks.card_image()), checks) < 3);
}
