// The weft's way against an oracle: a reducer of crossing diagrams (diagram.hpp).

#include "../support/random.hpp"
#include "diagram.hpp"

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

CardImage card_of(const std::vector<std::string>& rows) {
    CardImage card(rows.size(), rows.front().size());
    for (std::size_t pick = 0; pick < rows.size(); ++pick) {
        for (std::size_t end = 0; end < rows[pick].size(); ++end) card.set(pick, end, rows[pick][end] == '1');
    }
    return card;
}

/// One feeder a pick; each goes back and forth, the first time from `starts` (0: left).
std::vector<Pick> picks_of(const std::vector<std::uint32_t>& feeders, std::vector<bool> from_right) {
    std::vector<Pick> picks;
    for (const std::uint32_t feeder : feeders) {
        Pick pick;
        pick.feeders = {feeder};
        pick.direction = from_right.at(feeder) ? Direction::right_to_left : Direction::left_to_right;
        from_right[feeder] = !from_right[feeder];
        picks.push_back(pick);
    }
    return picks;
}

/// Random, but neighbouring picks of a feeder are often alike so that loops have somewhere to slip to.
CardImage random_card(Random& random, const std::vector<std::uint32_t>& feeders, std::size_t ends) {
    CardImage card(feeders.size(), ends);
    std::map<std::uint32_t, std::size_t> before;
    for (std::size_t n = 0; n < feeders.size(); ++n) {
        const auto last = before.find(feeders[n]);
        for (std::size_t e = 0; e < ends; ++e) {
            const bool alike = last != before.end() && random.between(0, 4) > 1;
            card.set(n, e, alike ? card.weft_over(last->second, e) : random.coin());
        }
        before[feeders[n]] = n;
    }
    return card;
}

std::string described(const CardImage& card, const std::vector<Pick>& picks) {
    std::string text;
    for (std::size_t n = 0; n < picks.size(); ++n) {
        text += "pick " + std::to_string(n) + " feeder " + std::to_string(picks[n].feeders[0]) +
                (picks[n].direction == Direction::left_to_right ? " -> " : " <- ");
        for (std::size_t e = 0; e < card.ends(); ++e) text += card.weft_over(n, e) ? '1' : '0';
        text += '\n';
    }
    return text;
}

struct Tally {
    std::size_t compared = 0, crossed = 0, crossed_compared = 0, gave_up = 0, by_pick = 0;
};

/// Feeders with a crossed pick, and those with a pick between two of such a feeder or the other way round,
/// and so on.
std::vector<bool> touched_by_crossed(const WeftWay& way, const std::vector<Pick>& picks,
                                     std::size_t feeders) {
    std::vector<bool> touched(feeders, false);
    std::vector<std::pair<std::size_t, std::size_t>> range(feeders, {picks.size(), 0});
    for (const PickSpan& span : way.spans) {
        touched[span.feeder] = touched[span.feeder] || span.crossed;
        range[span.feeder].first = std::min(range[span.feeder].first, span.pick);
        range[span.feeder].second = std::max(range[span.feeder].second, span.pick);
    }
    for (std::size_t round = 0; round < feeders; ++round) {
        for (std::size_t f = 0; f < feeders; ++f) {
            for (std::size_t g = 0; g < feeders; ++g) {
                const bool apart = range[f].second < range[g].first || range[g].second < range[f].first;
                if (touched[g] && !apart) touched[f] = true;
            }
        }
    }
    return touched;
}

void compare(const CardImage& card, const std::vector<Pick>& picks, std::size_t feeders, Tally& tally) {
    INFO(described(card, picks));
    const WeftWay way = weft_way(card, picks);
    std::set<std::pair<int, int>> expected;
    bool crossed = false;
    for (const PickSpan& span : way.spans) {
        crossed = crossed || span.crossed;
        for (std::size_t e = span.first; e <= span.last; ++e)
            expected.insert({static_cast<int>(span.pick), static_cast<int>(e)});
    }
    bool gave_up = false;
    const auto left = pulled_tight(diagram_of(card, picks, feeders), card.ends(), 400, gave_up);
    if (gave_up) {
        ++tally.gave_up;
        return;
    }
    if (crossed) {
        // A yarn whose pick has left the cloth lies no longer as it was laid; neither do those that it held.
        std::set<int> there;
        for (const auto& [pick, end] : left) there.insert(pick);
        if (feeders == 1) CHECK(there.size() < picks.size());
        const auto touched = touched_by_crossed(way, picks, feeders);
        const auto without = [&](std::set<std::pair<int, int>> crossings) {
            std::erase_if(crossings, [&](const auto& c) {
                return touched[picks[static_cast<std::size_t>(c.first)].feeders[0]];
            });
            return crossings;
        };
        CHECK(without(left) == without(expected));
        tally.crossed_compared += !without(expected).empty();
        ++tally.crossed;
        return;
    }
    CHECK(left == expected);
    ++tally.compared;
    for (const Turn& turn : way.turns) {
        const bool differs =
            card.weft_over(turn.from_pick, turn.end) != card.weft_over(turn.to_pick, turn.end);
        CHECK(differs == (turn.caught_by == CaughtBy::end));
        tally.by_pick += turn.caught_by == CaughtBy::pick;
    }
}

}  // namespace

TEST_CASE("a loop is caught by the outermost end that differs, and says when none does") {
    const auto card = card_of({"0010", "0110", "0110"});
    const WeftWay way = weft_way(card, picks_of({0, 0, 0}, {false}));
    REQUIRE(way.turns.size() == 2);
    CHECK(way.turns[0].side == Side::right);
    CHECK(way.turns[0].caught_by == CaughtBy::end);
    CHECK(way.turns[0].end == 1);
    CHECK(way.turns[1].side == Side::left);
    CHECK(way.turns[1].caught_by == CaughtBy::none);
    CHECK(way.spans[0].last == 1);
    CHECK(way.spans[1].crossed);
}

TEST_CASE("a pick of another feeder that lies between holds a loop") {
    // Feeder 2's only pick lies over the end, the loop of feeder 1 under it, and the loop above the pick's
    // tail.
    const auto card = card_of({"0", "1", "0"});
    const WeftWay way = weft_way(card, picks_of({0, 1, 0}, {false, false}));
    REQUIRE(way.turns.size() == 1);
    CHECK(way.turns[0].caught_by == CaughtBy::pick);
    CHECK(way.turns[0].pick == 1);
    CHECK(way.turns[0].end == 0);
}

TEST_CASE("a shuttle on the wrong side misses its box and does not turn") {
    auto picks = picks_of({0, 0}, {false});
    picks[1].direction = Direction::left_to_right;
    const WeftWay way = weft_way(card_of({"01", "10"}), picks);
    CHECK(way.turns.empty());
    const auto missed = missed_boxes(picks);
    REQUIRE(missed.size() == 1);
    CHECK(missed[0].from_pick == 0);
    CHECK(missed[0].to_pick == 1);
}

TEST_CASE("two feeders in one pick both have their way, a pick without feeder has none") {
    auto picks = picks_of({0, 0, 0}, {false});
    picks[1].feeders = {0, 1};
    picks[2].feeders = {};
    const WeftWay way = weft_way(card_of({"01", "10", "11"}), picks);
    CHECK(way.spans.size() == 3);
    CHECK(way.turns.size() == 1);
}

TEST_CASE("one feeder: loops rest where the diagram reducer leaves them") {
    Tally tally;
    for_all([&](Random& random) {
        const std::vector<std::uint32_t> feeders(random.between(1, 6), 0);
        const CardImage card = random_card(random, feeders, random.between(1, 6));
        compare(card, picks_of(feeders, {random.coin()}), 1, tally);
    });
    std::printf("compared %zu, crossed %zu, given up %zu\n", tally.compared, tally.crossed, tally.gave_up);
    CHECK(tally.gave_up == 0);
    CHECK(tally.compared * 4 > tally.crossed);
}

TEST_CASE("several feeders: loops rest where the diagram reducer leaves them") {
    Tally tally;
    for_all([&](Random& random) {
        std::vector<std::uint32_t> feeders(random.between(2, 6));
        for (auto& feeder : feeders) feeder = static_cast<std::uint32_t>(random.between(0, 2));
        const CardImage card = random_card(random, feeders, random.between(1, 4));
        compare(card, picks_of(feeders, {random.coin(), random.coin(), random.coin()}), 3, tally);
    });
    std::printf("compared %zu, crossed %zu (%zu compared in part), given up %zu, caught by picks %zu\n",
                tally.compared, tally.crossed, tally.crossed_compared, tally.gave_up, tally.by_pick);
    CHECK(tally.gave_up * 20 <= tally.compared);
    CHECK(tally.crossed_compared > 0);
    CHECK(tally.by_pick > 0);
}

TEST_CASE("arcs of two feeders that cross outside: the later one lies above") {
    // Both turn right, 0-2 and 1-3; the end lies over pick 1 and under 0 and 2. The later loop 1-3 lies above
    // the earlier 0-2, so nothing is linked and both slip off.
    //   0 --+
    //   1 --|-+
    //   2 --+ |
    //   3 ----+
    const auto apart = weft_way(card_of({"10", "10", "10", "00"}), picks_of({0, 1, 0, 1}, {false, false}));
    CHECK(apart.turns[0].caught_by == CaughtBy::none);
    // Pick 1 over the end and the earlier loop under it: below the later yarn and below the end, it slips.
    const auto below = weft_way(card_of({"10", "11", "00", "01"}), picks_of({0, 1, 0, 1}, {false, false}));
    CHECK(below.turns[0].caught_by == CaughtBy::end);
    CHECK(below.turns[0].end == 0);
    // The other way round the earlier loop, over the end but below pick 1 under it, is held.
    const auto held = weft_way(card_of({"11", "10", "01", "00"}), picks_of({0, 1, 0, 1}, {false, false}));
    CHECK(held.turns[0].caught_by == CaughtBy::pick);
    CHECK(held.turns[0].pick == 1);
    CHECK(held.turns[0].end == 1);
}

TEST_CASE("a loop laid round another passes it on its own side of the end that catches it") {
    // Double cloth: feeder 1 turns round end 1 of the upper cloth, feeder 0 outside it in the lower one.
    //   0 -----+
    //   1 --+  |      end 1 lies round the turn 1-2, over both picks of feeder 0
    //   2 --+  |
    //   3 -----+
    const auto under = weft_way(card_of({"00", "10", "11", "10"}), picks_of({0, 1, 1, 0}, {false, false}));
    CHECK(under.turns[0].caught_by == CaughtBy::end);
    CHECK(under.turns[0].end == 0);
    // Feeder 0 over end 1: it passes above.
    const auto over = weft_way(card_of({"01", "10", "11", "11"}), picks_of({0, 1, 1, 0}, {false, false}));
    CHECK(over.turns[0].caught_by == CaughtBy::end);
    CHECK(over.turns[0].end == 0);
    // Above at end 2, the loop cannot dive under the nested picks at end 1.
    const auto held = weft_way(card_of({"001", "110", "111", "101"}), picks_of({0, 1, 1, 0}, {false, false}));
    CHECK(held.turns[0].caught_by == CaughtBy::pick);
    CHECK(held.turns[0].end == 1);
}

TEST_CASE("loops from both sides that hook each other stop where they meet") {
    // Each loop lies above the pick of the other that it crosses. The loop laid first, 0-2, comes to end 3;
    // 1-3 from the right meets it there.
    //     +-- 0
    //   1-|--+
    //     +--|2
    //   3 ---+
    const auto way =
        weft_way(card_of({"1100", "0001", "1101", "0101"}), picks_of({0, 1, 0, 1}, {true, false}));
    REQUIRE(way.turns.size() == 2);
    CHECK(way.turns[0].caught_by == CaughtBy::end);
    CHECK(way.turns[0].end == 3);
    CHECK(way.turns[1].caught_by == CaughtBy::pick);
    CHECK(way.turns[1].end == 2);
    CHECK(way.turns[1].pick == 2);
}

TEST_CASE("loops from both sides that meet between two ends are drawn past each other where nothing hooks them") {
    // 2-3 is caught by end 1, 1-4 from the right by end 0: drawn tight they no longer cross between the two ends, so
    // that 0-5, below the one and above the other, comes out.
    Tally tally;
    compare(card_of({"1000", "0111", "1101", "1011", "1111", "1000"}), picks_of({2, 1, 0, 0, 1, 2}, {true, false, true}), 3, tally);
    CHECK(tally.crossed + tally.compared == 1);
    const auto way = weft_way(card_of({"1000", "0111", "1101", "1011", "1111", "1000"}), picks_of({2, 1, 0, 0, 1, 2}, {true, false, true}));
    REQUIRE(way.turns.size() == 3);
    CHECK(way.turns[0].caught_by == CaughtBy::none);
    CHECK(way.turns[1].end == 0);
    CHECK(way.turns[2].end == 1);
}

TEST_CASE("a loop is not pulled past two others that hook each other") {
    // Loop 1-3 from the right hooks 2-4 from the left. Loop 0-5 lies below the first and above the second: it comes
    // past the one, and pick 3 keeps it from the other.
    const auto clasp = weft_way(card_of({"0101", "1000", "1110", "0010", "1110", "0101"}),
                                picks_of({1, 2, 0, 2, 0, 1}, {true, false, false}));
    CHECK(clasp.turns[0].caught_by == CaughtBy::pick);
    CHECK(clasp.turns[0].end == 2);
    // Both from the right: the picks stay in the order in which they were beaten up, so none makes way.
    const auto ring = weft_way(card_of({"10", "00", "10", "01", "10", "10"}), picks_of({0, 2, 1, 2, 1, 0}, {false, false, false}));
    CHECK(ring.turns[0].caught_by == CaughtBy::pick);
    CHECK(ring.turns[0].end == 1);
}

TEST_CASE("an end that is loose everywhere turns no more yarn than one that is not there") {
    std::size_t compared = 0, moved = 0;
    for_all([&](Random& random) {
        std::vector<std::uint32_t> feeders(random.between(2, 6));
        const std::size_t most = random.between(0, 1);
        for (auto& feeder : feeders) feeder = static_cast<std::uint32_t>(random.between(0, most));
        const CardImage card = random_card(random, feeders, random.between(2, 6));
        const auto picks = picks_of(feeders, {random.coin(), random.coin()});
        std::vector<std::size_t> firm;
        CardImage loose(card.picks(), card.ends());
        for (std::size_t end = 0; end < card.ends(); ++end) {
            const bool is_loose = random.between(0, 2) == 0;
            if (!is_loose) firm.push_back(end);
            for (std::size_t pick = 0; pick < card.picks(); ++pick) loose.set(pick, end, is_loose);
        }
        if (firm.empty()) return;
        CardImage trimmed(card.picks(), firm.size());
        for (std::size_t pick = 0; pick < card.picks(); ++pick) {
            for (std::size_t k = 0; k < firm.size(); ++k) {
                trimmed.set(pick, k, card.weft_over(pick, firm[k]));
            }
        }
        INFO(described(card, picks));
        const WeftWay way = weft_way(card, picks, &loose), expected = weft_way(trimmed, picks);
        for (const PickSpan& span : expected.spans) {
            if (span.crossed) return;
        }
        REQUIRE(way.turns.size() == expected.turns.size());
        const WeftWay woven = weft_way(card, picks);
        for (std::size_t k = 0; k < way.turns.size(); ++k) {
            const bool held = way.turns[k].caught_by != CaughtBy::none;
            CHECK(held == (expected.turns[k].caught_by != CaughtBy::none));
            // Loops of two feeders that hook each other may rest on either side of a loose end, one feeder's
            // where a firm end says.
            if (most == 0 && held) CHECK(way.turns[k].end == firm[expected.turns[k].end]);
            moved += way.turns[k].end != woven.turns[k].end;
        }
        ++compared;
    });
    CHECK(compared > 0);
    CHECK(moved > 0);
}
