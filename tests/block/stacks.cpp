#include <weave/block/stack.hpp>

#include <block/brute.hpp>
#include <support/memory.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::testing;

TEST_CASE("a random block obeys the constraints, and its card follows from them pixel by pixel") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        const Plain same = plain(block);
        REQUIRE(obeys(same));
        REQUIRE(pixels(block.card_image()) == pixels(same));
        const std::size_t pick = random.between(0, block.picks() - 1),
                          end = random.between(0, block.ends() - 1);
        REQUIRE(block.weft_over(pick, end) == pixels(same)[pick][end]);
        REQUIRE(block.first_pick(block.row_of_pick(pick)) <= pick);
        REQUIRE(block.first_pick(block.row_of_pick(pick) + 1) > pick);
        REQUIRE(block.first_end(block.column_of_end(end)) <= end);
        REQUIRE(block.first_end(block.column_of_end(end) + 1) > end);
    });
}

TEST_CASE("a block with one yarn missing, repeated or foreign is refused, and the cell is named") {
    for_all([](Random& random) {
        const Block block = random_block(random);
        const std::size_t row = random.between(0, block.rows() - 1),
                          column = random.between(0, block.columns() - 1);
        const auto slots = block.stack(row, column).slots();
        std::vector<Slot> broken(slots.begin(), slots.end());
        std::size_t at = random.between(0, broken.size() - 1);
        while (broken[at].is_empty()) at = random.between(0, broken.size() - 1);
        const Slot victim = broken[at];
        const std::size_t count = victim.is_weft() ? block.t()[row] : block.p()[column];
        switch (random.between(0, 3)) {
            case 0:
                broken[at] = Slot();
                break;
            case 1:
                broken.push_back(victim);
                break;
            case 2:
                broken[at] = victim.renumbered(count + random.between(0, 5));
                break;
            default:
                broken[at] = victim.is_weft() ? Slot::warp(block.p()[column]) : Slot::weft(block.t()[row]);
        }
        const auto made = make_block(block.t(), block.p(), [&](std::size_t i, std::size_t j) {
            return i == row && j == column ? Stack(broken) : block.stack(i, j);
        });
        REQUIRE_FALSE(made);
        REQUIRE(made.error().where == "stacks[" + std::to_string(row) + "][" + std::to_string(column) + "]");
    });
}

TEST_CASE("a stack survives its text, through the numbers of the whole block") {
    for_all([](Random& random) {
        const Stack stack = random_stack(random, random.between(0, 4), random.between(0, 4), 3);
        const std::size_t pick = random.between(0, 1000), end = random.between(0, 1000);
        REQUIRE(parse_stack(to_text(stack, pick, end), pick, end).value() == stack);
    });
    REQUIRE(to_text(parse_stack("T0\tP1 -  P0~ E T1 - -").value()) == "T0 P1 - P0~ - T1");
    REQUIRE(parse_stack("").value() == Stack());
}

TEST_CASE("a stack's text that is no stack is refused and quoted") {
    for (const char* text :
         {"T", "P~", "X1", "T-1", "T1.", "t0", "T99999999999999999999", "T268435456", "~", "T0P0", "T 0"}) {
        INFO(text);
        REQUIRE_FALSE(parse_stack(text));
    }
    REQUIRE_THAT(parse_stack("T0 Q1").error().message, Catch::Contains("'Q1'"));
    REQUIRE_THAT(parse_stack("T3", 4).error().message, Catch::Contains("earlier row"));
    REQUIRE_THAT(parse_stack("P3", 0, 4).error().message, Catch::Contains("earlier column"));
}

TEST_CASE("an empty block and one beyond the crossing limit are refused") {
    REQUIRE_THAT(Block::make({}, {}, {}, {}).error().message, Catch::Contains("at least one pick"));
    REQUIRE_FALSE(Block::make({0}, {1}, {Stack({Slot::warp(0)})}, {0}));
    REQUIRE_FALSE(check_card_size(0, 5));
    REQUIRE_FALSE(check_card_size(UINT64_MAX, UINT64_MAX));
    REQUIRE(check_card_size(20000, 20000));
    REQUIRE(check_card_size(1 << 15, 1 << 14));
    REQUIRE_THAT(check_card_size((1 << 15) + 1, 1 << 14).error().message, Catch::Contains("crossings"));
    REQUIRE(check_card_size(1, most_yarns));
    REQUIRE_THAT(check_card_size(1, most_yarns + 1).error().message, Catch::Contains("picks or ends"));
    REQUIRE_THAT(check_card_size(most_yarns + 1, 1).error().message, Catch::Contains("picks or ends"));
}

TEST_CASE("a card's bits are packed from the left, first pick first, and its hash is theirs") {
    CardImage card(2, 9);
    card.set(0, 0, true);
    card.set(1, 8, true);
    REQUIRE(std::vector<int>(card.bytes().begin(), card.bytes().end()) == std::vector<int>{0x80, 0, 0, 0x80});
    // sha256 of the bytes 80 00 00 80, computed with coreutils
    REQUIRE(card.sha256() == "4853ae55317dc20c8511533dc9a3ed161021a3a3f2754e0cde5d13a8a355c6dd");
    card.set(0, 0, false);
    REQUIRE_FALSE(card.weft_over(0, 0));
}

TEST_CASE("a transposed card has picks and ends exchanged") {
    for_all(
        [](Random& random) {
            CardImage card(random.between(1, 40), random.between(1, 40));
            for (std::size_t pick = 0; pick < card.picks(); ++pick) {
                for (std::size_t end = 0; end < card.ends(); ++end) card.set(pick, end, random.coin());
            }
            const CardImage turned = card.transposed();
            bool same = turned.picks() == card.ends() && turned.ends() == card.picks();
            for (std::size_t pick = 0; same && pick < card.picks(); ++pick) {
                for (std::size_t end = 0; end < card.ends(); ++end) {
                    same = same && turned.weft_over(end, pick) == card.weft_over(pick, end);
                }
            }
            REQUIRE(same);
            REQUIRE(turned.transposed() == card);  // the padding stays 0
        },
        property_cases());
}

TEST_CASE("a stack that is wrong names its yarns as they count through the block") {
    const auto error = [](std::vector<std::uint32_t> t, std::vector<std::uint32_t> p,
                          std::vector<Stack> stacks) {
        std::vector<std::uint32_t> cells(stacks.size());
        for (std::size_t k = 0; k < cells.size(); ++k) cells[k] = static_cast<std::uint32_t>(k);
        return Block::make(std::move(t), std::move(p), std::move(stacks), std::move(cells)).error().text();
    };
    const Stack plain({Slot::weft(0), Slot::warp(0)});
    CHECK_THAT(error({1}, {1, 2}, {plain, Stack({Slot::weft(0), Slot::warp(0), Slot::warp(0)})}),
               Catch::EndsWith("stacks[0][1]: holds P1 twice"));
    CHECK_THAT(error({1, 1}, {1}, {plain, Stack({Slot::weft(1), Slot::warp(0)})}),
               Catch::EndsWith("stacks[1][0]: holds T2, but the only pick of this stack is T1"));
    CHECK_THAT(error({1}, {1, 2}, {plain, Stack({Slot::weft(0), Slot::warp(4), Slot::warp(0)})}),
               Catch::EndsWith("stacks[0][1]: holds P5, but the ends of this stack are P1 to P2"));
}

TEST_CASE(
    "a cell that names no stack is refused, stacks that no cell names are left out, equal ones do no harm") {
    const Stack over({Slot::warp(0), Slot::weft(0)}), under({Slot::weft(0), Slot::warp(0)});
    CHECK(Block::make({1}, {1, 1}, {over}, {0, 1}).error().text() ==
          "stacks[0][1]: is stack 1 of a table of 1, counted from 0");
    const Stack tall({Slot(), Slot(), Slot(), Slot::weft(7)});  // what is not used is not looked at
    const Block block = Block::make({1}, {1, 1}, {tall, under, under, tall, over}, {4, 2}).value();
    CHECK(block.stacks().size() == 2);
    CHECK(block.stack(0, 0) == over);
    CHECK(block.stack(0, 1) == under);
    CHECK(block.height() == 2);
    CHECK(block.card_image().weft_over(0, 0));
    CHECK_FALSE(block.card_image().weft_over(0, 1));
    CHECK(Block::make({1}, {1, 1}, {over, over}, {0, 1}).value() ==
          Block::make({1}, {1, 1}, {over}, {0, 0}).value());
}

TEST_CASE("the card of many tall stacks, all different, takes little more memory than the block") {
    constexpr std::uint32_t picks = 4000, ends = 1500;
    Random random(5);
    std::vector<Stack> stacks;
    std::vector<std::uint32_t> cells;
    for (std::uint32_t end = 0; end < ends; ++end) {
        std::vector<Slot> slots;
        const std::size_t at = random.between(0, picks);
        for (std::size_t k = 0; k < picks; ++k) {
            if (k == at) slots.push_back(Slot::warp(0));
            slots.push_back(Slot::weft((k + end) % picks));
        }
        if (at == picks) slots.push_back(Slot::warp(0));
        stacks.emplace_back(std::move(slots));
        cells.push_back(end);
    }
    const Block block =
        Block::make({picks}, std::vector<std::uint32_t>(ends, 1), std::move(stacks), std::move(cells))
            .value();
    const double before = peak_mb();
    const CardImage card = block.card_image();
    CHECK(peak_mb() - before < 100);  // a list for each weft of each stack would take over 300 MB
    for (int k = 0; k < 1000; ++k) {
        const std::size_t pick = random.between(0, picks - 1), end = random.between(0, ends - 1);
        REQUIRE(card.weft_over(pick, end) == block.weft_over(pick, end));
    }
}
