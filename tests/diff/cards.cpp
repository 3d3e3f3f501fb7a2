// Cards laid on each other: what changed, and what was inserted, removed and moved.

#include <weave/diff/card_diff.hpp>

#include <catch2/catch.hpp>

#include <numeric>
#include <support/random.hpp>

using namespace weave;
using weave::testing::for_all;
using weave::testing::property_cases;
using weave::testing::Random;

namespace {

CardImage random_card(Random& random, std::size_t picks, std::size_t ends) {
    CardImage card(picks, ends);
    for (std::size_t pick = 0; pick < picks; ++pick)
        for (std::size_t end = 0; end < ends; ++end) card.set(pick, end, random.coin());
    return card;
}

/// The card made of these picks and ends of another.
CardImage taken(const CardImage& from, const std::vector<std::size_t>& picks,
                const std::vector<std::size_t>& ends) {
    CardImage card(picks.size(), ends.size());
    for (std::size_t i = 0; i < picks.size(); ++i)
        for (std::size_t j = 0; j < ends.size(); ++j) card.set(i, j, from.weft_over(picks[i], ends[j]));
    return card;
}

std::vector<std::size_t> all_but(std::size_t count, std::size_t first, std::size_t gone) {
    std::vector<std::size_t> lines;
    for (std::size_t k = 0; k < count; ++k)
        if (k < first || k >= first + gone) lines.push_back(k);
    return lines;
}

/// Counts by looking at each crossing, without words of 64.
struct Counted {
    std::uint64_t lifted = 0, lowered = 0, compared = 0, runs = 0;
};
Counted counted_one_by_one(const CardImage& before, const CardImage& after, const CardAlignment& alignment) {
    Counted sum;
    for (const LineMatch& p : alignment.picks.matches)
        for (std::size_t i = 0; i < p.count; ++i)
            for (const LineMatch& e : alignment.ends.matches) {
                int last = 0;
                for (std::size_t j = 0; j < e.count; ++j) {
                    const bool was = before.weft_over(p.before + i, e.before + j),
                               is = after.weft_over(p.after + i, e.after + j);
                    const int now = was == is ? 0 : was ? 1 : 2;
                    ++sum.compared;
                    sum.lifted += now == 1 ? 1 : 0;
                    sum.lowered += now == 2 ? 1 : 0;
                    sum.runs += now != 0 && now != last ? 1 : 0;
                    last = now;
                }
            }
    return sum;
}

void check_rising(const LineAlignment& lines) {
    std::size_t before = 0, after = 0;
    for (const LineMatch& match : lines.matches) {
        REQUIRE(match.count > 0);
        REQUIRE(match.before >= before);
        REQUIRE(match.after >= after);
        before = match.before + match.count;
        after = match.after + match.count;
    }
    REQUIRE(before <= lines.before);
    REQUIRE(after <= lines.after);
}

}  // namespace

TEST_CASE("a longest common subsequence is found, and never more than one") {
    for_all(
        [](Random& random) {
            std::vector<std::uint64_t> a(random.between(0, 12)), b(random.between(0, 12));
            for (auto* list : {&a, &b})
                for (auto& line : *list) line = random.between(0, 3);
            const LineAlignment lines = match_equal(a, b);
            check_rising(lines);
            for (const LineMatch& match : lines.matches)
                for (std::size_t k = 0; k < match.count; ++k)
                    REQUIRE(a[match.before + k] == b[match.after + k]);
            std::vector<std::vector<std::size_t>> best(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
            for (std::size_t i = 1; i <= a.size(); ++i)
                for (std::size_t j = 1; j <= b.size(); ++j)
                    best[i][j] = a[i - 1] == b[j - 1] ? best[i - 1][j - 1] + 1
                                                      : std::max(best[i - 1][j], best[i][j - 1]);
            REQUIRE(lines.matched() == best[a.size()][b.size()]);
        },
        property_cases() / 4);
}

TEST_CASE("an alignment that is cut short is still one") {
    Random random(7);
    std::vector<std::uint64_t> a(2000), b(1900);
    for (auto* list : {&a, &b})
        for (auto& line : *list) line = random.between(0, 1000);
    const LineAlignment lines = match_equal(a, b, 1000);
    check_rising(lines);
    CHECK(lines.matched() < 100);
}

TEST_CASE("counts agree with looking at each crossing, and the other way round is the mirror image") {
    for_all(
        [](Random& random) {
            const CardImage a = random_card(random, random.between(1, 12), random.between(1, 150));
            CardImage b =
                random.coin() ? random_card(random, random.between(1, 12), random.between(1, 150)) : a;
            for (std::size_t k = random.between(0, 4); k > 0; --k)
                b.set(random.between(0, b.picks() - 1), random.between(0, b.ends() - 1), random.coin());
            const CardDiff diff = diff_cards(a, b), back = diff_cards(b, a);
            check_rising(diff.alignment.picks);
            check_rising(diff.alignment.ends);
            const Counted sum = counted_one_by_one(a, b, diff.alignment);
            REQUIRE(diff.lifted == sum.lifted);
            REQUIRE(diff.lowered == sum.lowered);
            REQUIRE(diff.compared == sum.compared);
            REQUIRE(diff.runs_in_all == sum.runs);
            REQUIRE(diff.is_same() == (a == b));
            REQUIRE(back.lifted == diff.lowered);
            REQUIRE(back.lowered == diff.lifted);
            REQUIRE(back.alignment.picks.inserted() == diff.alignment.picks.removed());
            REQUIRE(back.alignment.ends.removed() == diff.alignment.ends.inserted());
            REQUIRE(back.moved_picks.size() == diff.moved_picks.size());
            std::uint64_t crossings = 0;
            for (const ChangedRun& run : diff.runs) {
                crossings += run.count;
                for (std::size_t k = 0; k < run.count; ++k) {
                    REQUIRE(a.weft_over(run.pick_before, run.end_before + k) == run.lifted);
                    REQUIRE(b.weft_over(run.pick_after, run.end_after + k) != run.lifted);
                }
            }
            if (diff.runs.size() == diff.runs_in_all) REQUIRE(crossings == diff.changed());
        },
        property_cases() / 20);
}

TEST_CASE("picks and ends taken out of a card anywhere are told as removed, and nothing as changed") {
    for_all(
        [](Random& random) {
            const CardImage a = random_card(random, 60, 70);
            const std::size_t picks = random.between(0, 3), ends = random.between(0, 3);
            const std::size_t pick = random.between(0, 60 - picks), end = random.between(0, 70 - ends);
            const CardDiff diff = diff_cards(a, taken(a, all_but(60, pick, picks), all_but(70, end, ends)));
            CHECK(diff.changed() == 0);
            const std::vector<LineSpan> gone_picks = diff.alignment.picks.removed(),
                                        gone_ends = diff.alignment.ends.removed();
            CHECK(gone_picks ==
                  (picks == 0 ? std::vector<LineSpan>{} : std::vector<LineSpan>{{pick, picks}}));
            CHECK(gone_ends == (ends == 0 ? std::vector<LineSpan>{} : std::vector<LineSpan>{{end, ends}}));
            CHECK(diff.alignment.picks.inserted().empty());
            CHECK(diff.alignment.ends.inserted().empty());
        },
        50);
}

TEST_CASE("one inserted pick in a twill with flipped crossings beside it leaves all others as they were") {
    CardImage twill(80, 64);
    for (std::size_t pick = 0; pick < 80; ++pick)
        for (std::size_t end = 0; end < 64; ++end) twill.set(pick, end, (pick + end) % 8 < 3);
    std::vector<std::size_t> picks(80), ends(64);
    std::iota(picks.begin(), picks.end(), 0);
    std::iota(ends.begin(), ends.end(), 0);
    picks.insert(picks.begin() + 37, 1);  // an odd one out there: pick 37 is the one of picks 5, 13 ...
    CardImage after = taken(twill, picks, ends);
    after.set(36, 3, !after.weft_over(36, 3));
    after.set(10, 60, !after.weft_over(10, 60));
    const CardDiff diff = diff_cards(twill, after);
    CHECK(diff.changed() == 2);
    CHECK(diff.alignment.picks.inserted() == std::vector<LineSpan>{{37, 1}});
    CHECK(diff.alignment.ends.is_straight());
    REQUIRE(diff.after);
    CHECK(*diff.after == ChangedBox{10, 36, 3, 60});
}

TEST_CASE("a changed region is told as changed, not as lines removed and inserted") {
    CardImage before(48, 48), after(48, 48);
    for (std::size_t pick = 0; pick < 48; ++pick)
        for (std::size_t end = 0; end < 48; ++end) {
            before.set(pick, end, (pick + end) % 4 < 2);
            const bool inside = pick >= 16 && pick < 32 && end >= 12 && end < 36;
            after.set(pick, end, inside ? (pick + 48 - end) % 4 < 2 : (pick + end) % 4 < 2);
        }
    const CardDiff diff = diff_cards(before, after);
    CHECK(diff.alignment.picks.is_straight());
    CHECK(diff.alignment.ends.is_straight());
    CHECK(diff.picks == 16);
    CHECK(diff.changed() == 16 * 24 / 2);
}

TEST_CASE("picks that changed places are known again") {
    Random random(3);
    const CardImage a = random_card(random, 30, 200);
    std::vector<std::size_t> picks(30), ends(200);
    std::iota(picks.begin(), picks.end(), 0);
    std::iota(ends.begin(), ends.end(), 0);
    std::swap(picks[4], picks[5]);
    const CardDiff diff = diff_cards(a, taken(a, picks, ends));
    CHECK(diff.alignment.picks.is_straight());
    CHECK(diff.moved_picks == std::vector<MovedLine>{{5, 4}, {4, 5}});
    CHECK(diff.moved_ends.empty());
}
