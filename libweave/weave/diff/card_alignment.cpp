#include <weave/diff/card_alignment.hpp>

#include <weave/block/card_bits.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace weave {

namespace {

constexpr std::size_t word = 64;

/// Both cards, and both lying on their side so that ends can be compared as picks are.
struct Cards {
    const CardImage &before, &after;
    CardImage before_ends, after_ends;
};

std::uint64_t mixed(std::uint64_t hash, std::uint64_t bits) {
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
    return hash ^ hash >> 29;
}

/// The part of a direction that comparing begins with: picks can agree in it though ends were inserted
/// beyond.
std::vector<LineAlignment> windows(std::size_t before, std::size_t after) {
    std::vector<LineAlignment> list{matched_from_front(before, after)};
    if (before != after) list.push_back(matched_from_back(before, after));
    const std::size_t part = std::min(before, after) / 4;
    if (part == 0) return list;
    for (const std::size_t share : {std::size_t{4}, std::size_t{1}}) {  // a quarter, and a sixteenth
        const std::size_t count = std::max<std::size_t>(part * share / 4, 1);
        list.push_back({before, after, {{0, 0, count}}});
        list.push_back({before, after, {{before - count, after - count, count}}});
    }
    return list;
}

/// The matches of lines that are equal.
LineAlignment only_equal(const LineAlignment& lines, const std::vector<std::uint64_t>& before,
                         const std::vector<std::uint64_t>& after) {
    LineAlignment equal{lines.before, lines.after, {}};
    for (const LineMatch& match : lines.matches) {
        for (std::size_t k = 0; k < match.count; ++k) {
            if (before[match.before + k] != after[match.after + k]) continue;
            std::vector<LineMatch>& list = equal.matches;
            if (k > 0 && !list.empty() && list.back().before + list.back().count == match.before + k)
                ++list.back().count;
            else
                list.push_back({match.before + k, match.after + k, 1});
        }
    }
    return equal;
}

struct AlignedLines {
    LineAlignment all, equal;
};

/// Matches the picks of two cards by what they do in matched ends.
AlignedLines align_lines(const CardImage& before, const CardImage& after, const LineAlignment& across) {
    const std::vector<std::uint64_t> old = line_hashes(before, across, true),
                                     now = line_hashes(after, across, false);
    AlignedLines lines{match_equal(old, now), {}};
    const auto distance = [&](std::size_t i, std::size_t j) {
        return old[i] == now[j] ? 0 : changed_in_line(before, after, i, j, across);
    };
    match_gaps(lines.all, distance);
    straighten(lines.all, distance, across.matched());
    lines.equal = only_equal(lines.all, old, now);
    return lines;
}

/// The crossings of removed and inserted picks and ends.
std::uint64_t cost_of_lone_lines(const CardAlignment& alignment) {
    const auto lone = [](const LineAlignment& lines) {
        return std::uint64_t{lines.before} + lines.after - 2 * lines.matched();
    };
    return lone(alignment.picks) * std::max(alignment.ends.before, alignment.ends.after) +
           lone(alignment.ends) * std::max(alignment.picks.before, alignment.picks.after);
}

/// What an alignment leaves to be told, in crossings.
std::uint64_t cost(const Cards& cards, const CardAlignment& alignment) {
    std::uint64_t sum = cost_of_lone_lines(alignment);
    for (const LineMatch& match : alignment.picks.matches) {
        for (std::size_t k = 0; k < match.count; ++k) {
            sum +=
                changed_in_line(cards.before, cards.after, match.before + k, match.after + k, alignment.ends);
        }
    }
    return sum;
}

/// From picks that agree in a window to the ends, and back to the picks by all ends that agree.
CardAlignment align_from(const Cards& cards, const LineAlignment& window) {
    LineAlignment picks = align_lines(cards.before, cards.after, window).equal;
    if (picks.matches.empty()) picks = matched_from_front(picks.before, picks.after);
    AlignedLines ends = align_lines(cards.before_ends, cards.after_ends, picks);
    const LineAlignment& agreeing = ends.equal.matches.empty() ? ends.all : ends.equal;
    return {align_lines(cards.before, cards.after, agreeing).all, std::move(ends.all)};
}

/// Which of two cards comes first, whichever is asked for first.
bool comes_first(const CardImage& a, const CardImage& b) {
    const auto size = [](const CardImage& card) { return std::pair(card.picks(), card.ends()); };
    if (size(a) != size(b)) return size(a) < size(b);
    return std::ranges::lexicographical_compare(a.bytes(), b.bytes());
}

}  // namespace

std::uint64_t changed_in_line(const CardImage& before, const CardImage& after, std::size_t pick_before,
                              std::size_t pick_after, const LineAlignment& ends) {
    const auto old = before.row(pick_before), now = after.row(pick_after);
    std::uint64_t sum = 0;
    for (const LineMatch& match : ends.matches) {
        for (std::size_t k = 0; k < match.count; k += word) {
            const std::size_t count = std::min(word, match.count - k);
            const std::uint64_t change =
                bits_at(old, match.before + k, count) ^ bits_at(now, match.after + k, count);
            sum += static_cast<std::uint64_t>(std::popcount(change));
        }
    }
    return sum;
}

std::vector<std::uint64_t> line_hashes(const CardImage& card, const LineAlignment& ends, bool is_before) {
    std::vector<std::uint64_t> hashes;
    hashes.reserve(card.picks());
    std::vector<std::pair<std::size_t, std::size_t>> words;  // both sides are cut alike, wherever they lie
    for (const LineMatch& match : ends.matches) {
        for (std::size_t k = 0; k < match.count; k += word)
            words.emplace_back((is_before ? match.before : match.after) + k, std::min(word, match.count - k));
    }
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        const auto row = card.row(pick);
        std::uint64_t hash = 0;
        for (const auto& [at, count] : words) hash = mixed(hash, bits_at(row, at, count));
        hashes.push_back(hash);
    }
    return hashes;
}

CardAlignment align_cards(const CardImage& before, const CardImage& after) {
    if (!comes_first(before, after) && before != after) {
        CardAlignment alignment = align_cards(after, before);
        return {turned_round(std::move(alignment.picks)), turned_round(std::move(alignment.ends))};
    }
    CardAlignment best{matched_from_front(before.picks(), after.picks()),
                       matched_from_front(before.ends(), after.ends())};
    Cards cards{before, after, {}, {}};
    std::uint64_t least = cost(cards, best);
    // Where the sizes agree a line that goes comes with one that is new: nothing beats so few changes.
    const bool same_size = before.picks() == after.picks() && before.ends() == after.ends();
    const std::uint64_t unbeaten = same_size ? 2 * std::min(before.picks(), before.ends()) : 0;
    if (least - cost_of_lone_lines(best) <= unbeaten) return best;
    cards.before_ends = before.transposed();
    cards.after_ends = after.transposed();
    for (const LineAlignment& window : windows(before.ends(), after.ends())) {
        CardAlignment found = align_from(cards, window);
        const std::uint64_t leaves = cost(cards, found);
        if (leaves >= least) continue;
        least = leaves;
        best = std::move(found);
    }
    return best;
}

}  // namespace weave
