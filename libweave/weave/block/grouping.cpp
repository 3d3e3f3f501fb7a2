#include <weave/block/card_bits.hpp>
#include <weave/block/from_card.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>

namespace weave {

// How the layers are found. Picks are straight, so the picks of one row of stacks keep one order over the
// whole width: the sets of ends below them are nested, one within the next. Picks of different rows hardly
// ever are, because each layer binds differently from row to row. So a row is a run of neighbouring picks
// whose sets are nested; the same holds for the ends of a column as long as they do not change places, as
// they do where ends climb through the cloth. Yarns with equal sets lie side by side in one shed more often
// than on top of each other; both readings are offered.

namespace {

using Counts = std::vector<std::uint32_t>;

constexpr std::size_t most_in_a_stack = 1024;

/// The yarns of one system, each as the packed set of crossings at which the weft lies over the warp.
class Yarns {
  public:
    explicit Yarns(const CardImage& lines) : m_lines(lines), m_sizes(lines.picks()) {
        for (std::size_t yarn = 0; yarn < count(); ++yarn) {
            const std::span<const std::uint8_t> line = m_lines.row(yarn);
            for (std::size_t at = 0; at < line.size(); at += 8) {
                m_sizes[yarn] += static_cast<std::size_t>(std::popcount(word_at(line, at)));
            }
        }
    }
    [[nodiscard]] std::size_t count() const { return m_lines.picks(); }
    /// Crossings in the yarn's set.
    [[nodiscard]] std::size_t size(std::size_t yarn) const { return m_sizes[yarn]; }

    [[nodiscard]] Nesting nesting(std::size_t one, std::size_t other) const {
        const std::span<const std::uint8_t> a = m_lines.row(one), b = m_lines.row(other);
        NestingTest test;
        for (std::size_t at = 0; at < a.size() && !test.apart(); at += 8)
            test.add(word_at(a, at), word_at(b, at));
        return test.result();
    }

  private:
    static std::uint64_t word_at(std::span<const std::uint8_t> line, std::size_t at) {
        std::uint64_t word = 0;
        std::memcpy(&word, line.data() + at, std::min<std::size_t>(8, line.size() - at));
        return word;
    }
    const CardImage& m_lines;
    std::vector<std::size_t> m_sizes;
};

/// Yarns that keep one order over all their crossings, sorted by that order.
class Pile {
  public:
    Pile(const Yarns& yarns, bool equals_welcome) : m_yarns(yarns), m_equals_welcome(equals_welcome) {}

    /// Takes a yarn in, unless it crosses a yarn of the pile (or equals one that it must not equal).
    bool take(std::size_t yarn) {
        if (m_order.size() >= most_in_a_stack) return false;
        const auto above =
            std::upper_bound(m_order.begin(), m_order.end(), yarn,
                             [&](std::size_t a, std::size_t b) { return m_yarns.size(a) < m_yarns.size(b); });
        if (above != m_order.end() && m_yarns.nesting(yarn, *above) != Nesting::inside) return false;
        if (above != m_order.begin()) {
            const Nesting below = m_yarns.nesting(yarn, *(above - 1));
            if (below != Nesting::around && !(below == Nesting::equal && m_equals_welcome)) return false;
        }
        m_order.insert(above, yarn);
        return true;
    }
    void clear() { m_order.clear(); }
    [[nodiscard]] std::size_t size() const { return m_order.size(); }

  private:
    const Yarns& m_yarns;
    bool m_equals_welcome;
    std::vector<std::size_t> m_order;
};

/// The longest runs of neighbours that pile up, taken from the first yarn on.
Counts longest_runs(const Yarns& yarns, bool equals_welcome) {
    Counts runs;
    Pile pile(yarns, equals_welcome);
    for (std::size_t yarn = 0; yarn < yarns.count(); ++yarn) {
        if (pile.take(yarn)) continue;
        runs.push_back(static_cast<std::uint32_t>(pile.size()));
        pile.clear();
        pile.take(yarn);
    }
    runs.push_back(static_cast<std::uint32_t>(pile.size()));
    return runs;
}

/// Runs of neighbours that each lie higher than the one before wherever they differ.
Counts climbing_runs(const Yarns& yarns, Nesting to_the_next) {
    Counts runs{1};
    for (std::size_t yarn = 1; yarn < yarns.count(); ++yarn) {
        if (yarns.nesting(yarn - 1, yarn) == to_the_next)
            ++runs.back();
        else
            runs.push_back(1);
    }
    return runs;
}

/// Runs of neighbours that lie higher and higher on the whole, whatever places they change on the way. The
/// sizes rise with the height for picks and fall for ends.
Counts rising_runs(const Yarns& yarns, bool sizes_rise) {
    Counts runs{1};
    for (std::size_t yarn = 1; yarn < yarns.count(); ++yarn) {
        const std::size_t before = yarns.size(yarn - 1), now = yarns.size(yarn);
        if (sizes_rise ? now > before : now < before)
            ++runs.back();
        else
            runs.push_back(1);
    }
    return runs;
}

bool piles_evenly(const Yarns& yarns, std::size_t run, bool equals_welcome) {
    Pile pile(yarns, equals_welcome);
    for (std::size_t yarn = 0; yarn < yarns.count(); ++yarn) {
        if (yarn % run == 0) pile.clear();
        if (!pile.take(yarn)) return false;
    }
    return true;
}

Counts uniform(std::size_t yarns, std::size_t run) {
    return Counts(yarns / run, static_cast<std::uint32_t>(run));
}

/// The longest run that all yarns can be cut into, 1 at least.
std::size_t longest_even_run(const Yarns& yarns, bool equals_welcome) {
    for (std::size_t run = std::min(most_in_a_stack, yarns.count()); run > 1; --run) {
        if (yarns.count() % run == 0 && piles_evenly(yarns, run, equals_welcome)) return run;
    }
    return 1;
}

/// After how many entries the items repeat; their number if they never do.
template <class Equal>
std::size_t period_of(std::size_t count, Equal equal) {
    std::vector<std::size_t> border(count);  // of each prefix, the longest proper prefix that is also its end
    for (std::size_t i = 1, length = 0; i < count; ++i) {
        while (length > 0 && !equal(i, length)) length = border[length - 1];
        if (equal(i, length)) ++length;
        border[i] = length;
    }
    const std::size_t period = count - border[count - 1];
    return count % period == 0 ? period : count;
}

std::size_t period_of(const Counts& counts) {
    return period_of(counts.size(), [&](std::size_t a, std::size_t b) { return counts[a] == counts[b]; });
}

constexpr std::size_t longest_rule = 6;  // counts that repeat later than that came about by chance more often than by design

/// Counts that are all equal, or repeat after a few.
bool is_regular(const Counts& counts) {
    if (counts.size() <= 2) return true;
    const std::size_t period = period_of(counts);
    return period <= longest_rule && 2 * period <= counts.size();
}

/// One reading of one system and how far down it ranks.
struct Reading {
    Counts counts;
    int rank = 0;
    const char* why = "";
    bool nested =
        true;  ///< the yarns of each run keep one order, so any grouping of the other system goes with it
};

class Readings {
  public:
    void add(Counts counts, int rank, const char* why, bool nested) {
        for (Reading& known : m_all) {
            if (known.counts != counts) continue;
            if (known.rank > rank) known.rank = rank, known.why = why;
            known.nested = known.nested || nested;
            return;
        }
        m_all.push_back({std::move(counts), rank, why, nested});
    }
    [[nodiscard]] const std::vector<Reading>& all() const { return m_all; }

  private:
    std::vector<Reading> m_all;
};

constexpr const char* in_order = "keep one order";
constexpr const char* in_order_or_equal = "keep one order or work alike";
constexpr const char* cut_evenly = "can be cut evenly";
constexpr const char* rising = "lie higher and higher on the whole";
constexpr const char* repeat_found = "repeat";
constexpr const char* apart = "stand alone";

void add_even_cuts(Readings& readings, const Yarns& yarns, bool runs_regular) {
    for (const bool equals_welcome : {false, true}) {
        const std::size_t run = longest_even_run(yarns, equals_welcome);
        const int rank = runs_regular ? 3 : equals_welcome ? 2 : 1;
        if (run > 1) readings.add(uniform(yarns.count(), run), rank, cut_evenly, true);
    }
}

Readings readings_of(const Yarns& yarns, bool picks) {
    Readings readings;
    const std::size_t count = yarns.count();
    Counts strict = longest_runs(yarns, false), loose = longest_runs(yarns, true),
           upwards = rising_runs(yarns, picks);
    Counts climbing = climbing_runs(yarns, picks ? Nesting::inside : Nesting::around);
    const bool strict_regular = is_regular(strict), loose_regular = is_regular(loose);
    readings.add(std::move(strict), strict_regular ? 0 : 4, in_order, true);
    // Where no yarn climbs over the next, that tells nothing of which stand alone.
    if (is_regular(climbing) && !all_single(climbing)) readings.add(std::move(climbing), strict_regular ? 3 : 0, in_order, true);
    add_even_cuts(readings, yarns, strict_regular);
    if (is_regular(upwards)) readings.add(std::move(upwards), 3, rising, false);
    readings.add(std::move(loose), loose_regular ? 2 : 6, in_order_or_equal, true);
    const std::size_t period = period_of(count, [&](std::size_t a, std::size_t b) {
        return yarns.size(a) == yarns.size(b) && yarns.nesting(a, b) == Nesting::equal;
    });
    if (period > 1 && period <= 64) readings.add(uniform(count, period), 6, repeat_found, false);
    readings.add(uniform(count, 1), 5, apart, true);
    return readings;
}

std::string counts_said(const Counts& counts, const char* yarns, const char* line) {
    const auto [least, most] = std::minmax_element(counts.begin(), counts.end());
    std::string text;
    if (*least == *most) {
        text = std::to_string(*least);
    } else if (const std::size_t period = period_of(counts); period <= longest_rule && is_regular(counts)) {
        for (std::size_t k = 0; k < period; ++k) text += (k == 0 ? "" : ", ") + std::to_string(counts[k]);
        return text + " " + yarns + "s a " + line + " in turn";
    } else {
        text = std::to_string(*least) + " to " + std::to_string(*most);
    }
    return text + " " + yarns + (*most == 1 ? "" : "s") + " a " + line;
}

struct Ranked {
    Reading t, p;
    int rank = 0;
};

std::string reason_for(const Ranked& grouping) {
    const auto part = [](const Reading& reading, const char* yarns, const char* line) {
        const std::string counts = counts_said(reading.counts, yarns, line);
        return all_single(reading.counts) ? counts : counts + ", which " + reading.why;
    };
    return part(grouping.t, "pick", "row") + "; " + part(grouping.p, "end", "column");
}

bool same_grouping(const Ranked& a, const Ranked& b) {
    return a.t.counts == b.t.counts && a.p.counts == b.p.counts;
}

/// All pairs of readings, best first. As many ends as picks in a stack is the most usual layered cloth.
std::vector<Ranked> ranked_pairs(const Readings& picks, const Readings& ends, std::size_t end_count) {
    std::vector<Ranked> pairs;
    const auto add = [&](const Reading& t, const Reading& p) {
        Ranked pair{t, p, 2 * (t.rank + p.rank)};
        const bool alike =
            t.counts.front() == p.counts.front() && is_regular(t.counts) && is_regular(p.counts);
        if (!alike) ++pair.rank;
        pairs.push_back(std::move(pair));
    };
    for (const Reading& t : picks.all()) {
        for (const Reading& p : ends.all()) add(t, p);
        const std::uint32_t layers = t.counts.front();
        const bool even =
            std::all_of(t.counts.begin(), t.counts.end(), [&](auto count) { return count == layers; });
        if (t.nested && even && layers > 1 && end_count % layers == 0) {
            add(t, {uniform(end_count, layers), 2, "are as many as the picks", false});
        }
    }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Ranked& a, const Ranked& b) { return a.rank < b.rank; });
    std::vector<Ranked> different;
    for (Ranked& pair : pairs) {
        const auto same = [&](const Ranked& other) { return same_grouping(pair, other); };
        if (std::none_of(different.begin(), different.end(), same)) different.push_back(std::move(pair));
    }
    return different;
}

/// The first crossings of a card, enough to see that small stacks do not fit without looking through all of
/// it. It is cut between stacks of any of the usual counts.
CardImage corner_of(const CardImage& card) {
    constexpr std::size_t most_lines = 840;  // divides by 2, 3 and 4
    CardImage corner(std::min(card.picks(), most_lines), std::min(card.ends(), most_lines));
    for (std::size_t pick = 0; pick < corner.picks(); ++pick) {
        for (std::size_t end = 0; end < corner.ends(); ++end)
            corner.set(pick, end, card.weft_over(pick, end));
    }
    return corner;
}

/// Stacks of equal counts that every cell admits although neither system keeps its order over the whole
/// cloth: layers that change places from region to region. Where the yarns tell nothing at all, small
/// stacks are the likelier ones (`small_first`); where they tell something, large ones say more, after the
/// `likely` ones (0, 0: none): as many ends as picks, the most usual layered cloth, and what was counted.
std::vector<Ranked> even_stacks(const CardImage& card, std::size_t enough, bool small_first,
                                std::pair<std::uint32_t, std::uint32_t> likely) {
    std::array<std::pair<std::uint32_t, std::uint32_t>, 14> usual{{{6, 6},
                                                                   {8, 4},
                                                                   {6, 4},
                                                                   {6, 3},
                                                                   {4, 4},
                                                                   {6, 2},
                                                                   {3, 4},
                                                                   {4, 3},
                                                                   {3, 3},
                                                                   {4, 2},
                                                                   {2, 4},
                                                                   {2, 3},
                                                                   {3, 2},
                                                                   {2, 2}}};
    if (small_first) std::reverse(usual.begin(), usual.end());
    std::stable_partition(usual.begin(), usual.end(), [&](const auto& counts) {
        return counts == likely || counts == std::pair(likely.first, likely.first);
    });
    const CardImage corner = corner_of(card);
    std::vector<Ranked> found;
    for (const auto& [t, p] : usual) {
        if (found.size() == enough) break;
        if (card.picks() % t != 0 || card.ends() % p != 0) continue;
        if (!block_from_card(corner, {t}, {p}) || !block_from_card(card, {t}, {p})) continue;
        const Reading picks{uniform(card.picks(), t), 0, "fit in each stack", false};
        found.push_back({picks, {uniform(card.ends(), p), 0, "fit in each stack", false}, 0});
    }
    return found;
}

/// Puts readings into the ranking from this place on, unless they stand there or before.
void offer_early(std::vector<Ranked>& ranked, std::vector<Ranked> offers, std::size_t place) {
    for (Ranked& offer : offers) {
        place = std::min(place, ranked.size());
        const auto known = std::find_if(ranked.begin(), ranked.end(),
                                        [&](const Ranked& other) { return same_grouping(offer, other); });
        const auto target = ranked.begin() + static_cast<std::ptrdiff_t>(place);
        if (known < target) continue;
        if (known != ranked.end()) {
            std::rotate(target, known, known + 1);
        } else {
            ranked.insert(target, std::move(offer));
        }
        ++place;
    }
}

}  // namespace

std::vector<Grouping> possible_groupings(const CardImage& card, std::size_t most) {
    if (card.picks() == 0 || card.ends() == 0) return {};
    const CardImage turned = card.transposed();
    const Yarns picks(card), ends(turned);
    const Readings pick_readings = readings_of(picks, true), end_readings = readings_of(ends, false);
    std::vector<Ranked> ranked = ranked_pairs(pick_readings, end_readings, card.ends());
    const Ranked& first = ranked.front();
    const bool nothing_found = all_single(first.t.counts) && all_single(first.p.counts);
    // A cloth has one count more often than counts that change without a rule. The longest run that keeps one
    // order tells which: shorter ones came about where regions meet.
    const bool regular = is_regular(first.t.counts) && is_regular(first.p.counts);
    std::pair<std::uint32_t, std::uint32_t> likely{};
    if (!regular)
        likely = {*std::ranges::max_element(first.t.counts), *std::ranges::max_element(first.p.counts)};
    offer_early(ranked, even_stacks(card, regular && !nothing_found ? 2 : 3, nothing_found, likely),
                !regular        ? 0
                : nothing_found ? 2
                                : 3);
    std::vector<Grouping> groupings;
    for (const Ranked& candidate : ranked) {
        if (groupings.size() == most) break;
        const bool sure = candidate.t.nested || candidate.p.nested;
        if (!sure && !block_from_card(card, candidate.t.counts, candidate.p.counts)) continue;
        groupings.push_back({candidate.t.counts, candidate.p.counts, reason_for(candidate)});
    }
    return groupings;
}

}  // namespace weave
