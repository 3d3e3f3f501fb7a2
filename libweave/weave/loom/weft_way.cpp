// Where the loops of a shuttle's weft come to rest.
//
// Seen from above, ends and picks are straight lines that cross in a grid, pick n at place n of the insertion
// order. On each side a feeder's yarn makes an arc outside the cloth from one of its picks, a, to its next,
// b. Tension pulls the arc inwards, end by end. It slips past an end when a and b lie on the same side of it
// (both over or both under): nothing holds it there. The outermost end for which they differ catches it.
//
// Another feeder's pick c between a and b, as far as it is still in the cloth at that end, has to let the
// loop pass as well. The loop crosses c (the bight, between a and b), c crosses the end, and the end crosses
// the bight: a triangle. One yarn of the three can pass the crossing of the other two unless each lies over
// the next in a ring; then c holds the loop. Whether the bight lies over c is settled outside the cloth,
// where c's own yarn leaves:
//   - c turns there to a pick outside a … b: the arcs cross once, and the one formed later lies above;
//   - c is the feeder's first or last pick and its tail leaves there: it was laid before the loop closed, so
//   the loop is above;
//   - c turns to a pick d that also lies in a … b: the arcs do not cross. The loop comes past them over both
//   or under both, on the side on which it lies itself at the end that the turn c-d wraps round; over both
//   where no end catches that turn or a and b differ there.
//
// Bights can stop each other as well, between two ends. Two loops from opposite sides hook each other unless
// one lies above the other at every crossing that they make. And one bight passes another only if no strand
// that crosses both lies with them in a ring.
// As loops are pulled in their picks vanish outside them and hold others no longer. Where loops hook each
// other it matters who comes first: always the loop laid first among those that can move, as far as it comes.
// tests/loom/weft_way.cpp holds this rule against a reducer of crossing diagrams that knows nothing of it.

#include <weave/loom/weft_way.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

namespace weave {

namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

/// One feeder's yarn in one pick. `depth` is, per side, how many ends its turn there has slipped past; `turn`
/// the turn there.
struct Strand {
    std::uint32_t feeder = 0;
    std::size_t pick = 0;
    std::array<std::size_t, 2> turn{nowhere, nowhere};
    std::array<std::size_t, 2> depth{0, 0};
};

/// A strand between the picks of a loop, and how the loop lies to it.
struct Obstacle {
    std::size_t strand = nowhere;
    bool loop_above = true;
};

struct Loop {
    Turn turn;
    std::size_t from = 0, to = 0;  ///< strands
    std::size_t catching_depth =
        0;  ///< of the outermost end that differs between the two picks; all ends if there is none
    std::size_t depth = 0;
    std::size_t holder = nowhere;  ///< strand that holds it at `depth`
    std::size_t arrival = 0;       ///< of the loops between the same two ends, the later comer lies outside
    std::vector<Obstacle> obstacles;      ///< in the order of strands
    std::vector<std::size_t> neighbours;  ///< loops that its bight or whose bight may have to pass
};

std::size_t index(Side side) {
    return static_cast<std::size_t>(side);
}

/// Side on which a pick starts or ends.
Side start_of(Direction direction) {
    return direction == Direction::left_to_right ? Side::left : Side::right;
}
Side end_of(Direction direction) {
    return direction == Direction::left_to_right ? Side::right : Side::left;
}

/// First (from the left) or last set bit of a row of bytes within the ends `low` … `high`, or nowhere.
template <class ByteAt>
std::size_t outermost(Side side, std::size_t low, std::size_t high, ByteAt byte_at) {
    if (low > high || high == nowhere) return nowhere;
    const std::size_t first = low / 8, last = high / 8;
    for (std::size_t k = 0; k <= last - first; ++k) {
        const std::size_t at = side == Side::left ? first + k : last - k;
        auto byte = static_cast<unsigned>(byte_at(at)) & 0xffU;
        if (at == first) byte &= 0xffU >> low % 8;
        if (at == last) byte &= 0xffU << (7 - high % 8) & 0xffU;
        if (byte == 0) continue;
        const auto zeros = side == Side::left ? std::countl_zero(static_cast<std::uint8_t>(byte))
                                              : 7 - std::countr_zero(static_cast<std::uint8_t>(byte));
        return at * 8 + static_cast<std::size_t>(zeros);
    }
    return nowhere;
}

class Loops {
  public:
    Loops(const CardImage& card, const std::vector<Pick>& picks, const CardImage* loose)
        : m_card(card), m_loose(loose), m_ends(card.ends()) {
        follow_feeders(picks);
        find_obstacles();
        lay_out();
        pull();
    }

    WeftWay way() && {
        for (const Loop& loop : m_loops) m_way.turns.push_back(at_rest(loop));
        std::sort(m_way.turns.begin(), m_way.turns.end(), [](const Turn& a, const Turn& b) {
            return std::pair(a.from_pick, a.feeder) < std::pair(b.from_pick, b.feeder);
        });
        for (const Strand& strand : m_strands) m_way.spans.push_back(span(strand));
        std::sort(m_way.spans.begin(), m_way.spans.end(), [](const PickSpan& a, const PickSpan& b) {
            return std::pair(a.pick, a.feeder) < std::pair(b.pick, b.feeder);
        });
        return std::move(m_way);
    }

  private:
    /// Strands in the order of picks; a loop wherever a feeder's next pick starts where the last one ended.
    void follow_feeders(const std::vector<Pick>& picks) {
        std::vector<std::size_t> last_strand;
        for (std::size_t k = 0; k < picks.size(); ++k) {
            for (const std::uint32_t feeder : picks[k].feeders) {
                if (feeder >= last_strand.size()) last_strand.resize(std::size_t{feeder} + 1, nowhere);
                const std::size_t before = std::exchange(last_strand[feeder], m_strands.size());
                m_strands.push_back({feeder, k, {nowhere, nowhere}, {0, 0}});
                if (before != nowhere) join(before, picks);
            }
        }
    }

    void join(std::size_t from, const std::vector<Pick>& picks) {
        const std::size_t to = m_strands.size() - 1;
        Loop loop;
        loop.turn.feeder = m_strands[to].feeder;
        loop.turn.from_pick = m_strands[from].pick;
        loop.turn.to_pick = m_strands[to].pick;
        loop.turn.side = end_of(picks[loop.turn.from_pick].direction);
        if (start_of(picks[loop.turn.to_pick].direction) != loop.turn.side) return;
        loop.from = from;
        loop.to = to;
        loop.catching_depth = depth_of_difference(loop.turn);
        m_strands[from].turn[index(loop.turn.side)] = m_loops.size();
        m_strands[to].turn[index(loop.turn.side)] = m_loops.size();
        m_loops.push_back(std::move(loop));
    }

    std::size_t depth_of(Side side, std::size_t end) const {
        return side == Side::left ? end : m_ends - 1 - end;
    }

    std::span<const std::uint8_t> row(std::size_t pick) const { return m_card.row(pick % m_card.picks()); }

    bool weft_over(std::size_t pick, std::size_t end) const {
        return m_card.weft_over(pick % m_card.picks(), end);
    }

    /// Eight ends of two picks, a bit set where the end is firm at both.
    unsigned firm(std::size_t byte, std::size_t pick, std::size_t other) const {
        if (m_loose == nullptr) return 0xffU;
        const std::size_t picks = m_card.picks();
        return ~(unsigned{m_loose->row(pick % picks)[byte]} | m_loose->row(other % picks)[byte]);
    }

    std::size_t depth_of_difference(const Turn& turn) const {
        const auto a = row(turn.from_pick), b = row(turn.to_pick);
        const std::size_t end = outermost(turn.side, 0, m_ends - 1, [&](std::size_t i) {
            return static_cast<unsigned>(a[i] ^ b[i]) & firm(i, turn.from_pick, turn.to_pick);
        });
        return end == nowhere ? m_ends : depth_of(turn.side, end);
    }

    /// Every strand between the picks of a loop, and for each strand the loops that it may hold.
    void find_obstacles() {
        m_held_by.resize(m_strands.size());
        for (std::size_t number = 0; number < m_loops.size(); ++number) {
            Loop& loop = m_loops[number];
            for (std::size_t s = loop.from + 1; s < loop.to; ++s) {
                const std::size_t pick = m_strands[s].pick;
                if (pick == loop.turn.from_pick || pick == loop.turn.to_pick) continue;
                loop.obstacles.push_back({s, lies_above(loop, s)});
                m_held_by[s].push_back(number);
                for (const std::size_t turn : m_strands[s].turn) {
                    if (turn == nowhere) continue;
                    loop.neighbours.push_back(turn);
                    m_loops[turn].neighbours.push_back(number);
                }
            }
        }
        for (Loop& loop : m_loops) {
            std::sort(loop.neighbours.begin(), loop.neighbours.end());
            const auto end = std::unique(loop.neighbours.begin(), loop.neighbours.end());
            loop.neighbours.erase(end, loop.neighbours.end());
        }
    }

    /// Loops lie one outside the other before they are pulled, the longer the farther out.
    void lay_out() {
        std::vector<std::size_t> order(m_loops.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            const Turn &s = m_loops[a].turn, &t = m_loops[b].turn;
            return s.to_pick - s.from_pick < t.to_pick - t.from_pick;
        });
        for (const std::size_t number : order) m_loops[number].arrival = m_arrivals++;
    }

    /// Whether a loop lies above a strand between its picks: see the top of this file.
    bool lies_above(const Loop& loop, std::size_t s) const {
        const std::size_t turn = m_strands[s].turn[index(loop.turn.side)];
        return turn == nowhere || lies_above(loop, m_loops[turn]);
    }

    bool lies_above(const Loop& loop, const Loop& other) const {
        if (is_around(other, loop)) return !passes_above(other, loop);
        if (is_around(loop, other)) return passes_above(loop, other);
        return loop.turn.to_pick > other.turn.to_pick;
    }

    /// Two feeders in one pick lie side by side, so the ends of the range count as inside.
    static bool is_around(const Loop& outer, const Loop& inner) {
        return outer.turn.from_pick <= inner.turn.from_pick && inner.turn.to_pick <= outer.turn.to_pick;
    }

    /// On which side a loop passes a turn round which it was laid: its own at the end that catches that turn.
    bool passes_above(const Loop& outer, const Loop& inner) const {
        if (inner.catching_depth >= m_ends) return true;
        const std::size_t end = end_at(inner.turn.side, inner.catching_depth);
        const bool from = weft_over(outer.turn.from_pick, end);
        return from != weft_over(outer.turn.to_pick, end) || from;
    }

    std::size_t end_at(Side side, std::size_t depth) const {
        return side == Side::left ? depth : m_ends - 1 - depth;
    }

    /// Ends at which a strand is still in the cloth: first … last, empty where first > last.
    std::pair<std::size_t, std::size_t> presence(const Strand& strand) const {
        const std::size_t left = strand.depth[index(Side::left)], right = strand.depth[index(Side::right)];
        if (left + right >= m_ends) return {1, 0};
        return {left, m_ends - 1 - right};
    }

    /// The depth from `from` on, short of the catching end, at which a strand holds a loop that lies above
    /// (below) it.
    std::size_t held_at(const Loop& loop, std::size_t strand, bool loop_above) const {
        auto [low, high] = presence(m_strands[strand]);
        if (low > high || loop.catching_depth <= loop.depth) return m_ends;
        const bool left = loop.turn.side == Side::left;
        const std::size_t outer = loop.depth, inner = loop.catching_depth - 1;  // depths
        low = std::max(low, left ? outer : m_ends - 1 - inner);
        high = std::min(high, left ? inner : m_ends - 1 - outer);
        const std::size_t pick = m_strands[strand].pick;
        const auto bight = row(loop.turn.from_pick), c = row(pick);
        const std::size_t end = outermost(loop.turn.side, low, high, [&](std::size_t i) {
            const int held = loop_above ? c[i] & ~bight[i] : ~c[i] & bight[i];
            return static_cast<unsigned>(held) & firm(i, loop.turn.from_pick, pick);
        });
        return end == nowhere ? m_ends : depth_of(loop.turn.side, end);
    }

    /// How far the loop comes with the strands and bights where they are now, and what holds it there.
    std::pair<std::size_t, std::size_t> reach(const Loop& loop) const {
        std::pair nearest{loop.catching_depth, nowhere};
        for (const Obstacle& obstacle : loop.obstacles) {
            const std::pair held{held_at(loop, obstacle.strand, obstacle.loop_above), obstacle.strand};
            if (held.first < nearest.first) nearest = held;
        }
        for (const std::size_t number : loop.neighbours) {
            const Loop& other = m_loops[number];
            const bool same_side = other.turn.side == loop.turn.side;
            const std::size_t depth = same_side ? other.depth : m_ends - std::min(other.depth, m_ends);
            if (depth < loop.depth || depth >= nearest.first) continue;
            if (same_side && depth == loop.depth && other.arrival > loop.arrival) continue;
            if (!passes(loop, other, depth)) nearest = {depth, holding_strand(loop, other)};
        }
        return nearest;
    }

    /// The pick of `other` between the picks of the loop that holds it, the first formed; else its last.
    static std::size_t holding_strand(const Loop& loop, const Loop& other) {
        return other.from > loop.from && other.from < loop.to ? other.from : other.to;
    }

    static const Obstacle* obstacle_of(const Loop& loop, std::size_t strand) {
        const auto at = std::lower_bound(loop.obstacles.begin(), loop.obstacles.end(), strand,
                                         [](const Obstacle& o, std::size_t s) { return o.strand < s; });
        return at != loop.obstacles.end() && at->strand == strand ? &*at : nullptr;
    }

    /// Whether a loop gets past the bight of another that lies at `depth` between the same two ends.
    bool passes(const Loop& loop, const Loop& other, std::size_t depth) const {
        const bool same_side = loop.turn.side == other.turn.side;
        bool above = same_side && lies_above(loop, other);
        if (!same_side) {
            const auto lies = crossings_agree(loop, other);
            if (!lies) return false;
            above = *lies;
        }
        for (const Obstacle& mine : loop.obstacles) {
            const Obstacle* its = obstacle_of(other, mine.strand);
            if (its == nullptr || its->loop_above != above || mine.loop_above == above) continue;
            if (is_between(mine.strand, loop, other, depth)) return false;
        }
        return true;
    }

    /// Loops from both sides whose bights come to meet: above or below at every crossing, or hooked.
    static std::optional<bool> crossings_agree(const Loop& loop, const Loop& other) {
        std::optional<bool> above;
        bool hooked = false;
        const auto meet = [&](const Loop& bight, const Loop& strands, bool is_loop) {
            for (const std::size_t s : {strands.from, strands.to}) {
                const Obstacle* crossing = obstacle_of(bight, s);
                if (crossing == nullptr) continue;
                const bool lies = crossing->loop_above == is_loop;
                hooked = hooked || (above && *above != lies);
                above = lies;
            }
        };
        meet(loop, other, true);
        meet(other, loop, false);
        if (hooked) return {};
        return above.value_or(true);
    }

    /// Whether a strand crosses both bights where they meet, `depth` ends in from the loop's side.
    bool is_between(std::size_t s, const Loop& loop, const Loop& other, std::size_t depth) const {
        const Strand& strand = m_strands[s];
        for (const Side side : {Side::left, Side::right}) {
            const std::size_t turn = strand.turn[index(side)],
                              from_there = side == loop.turn.side ? depth : m_ends - depth;
            if (turn == nowhere || strand.depth[index(side)] < from_there) continue;
            if (strand.depth[index(side)] > from_there) return false;
            if (other.turn.side == side && other.arrival > m_loops[turn].arrival) return false;
            // Bights from both sides between the same two ends are drawn past each other where nothing hooks them.
            if (other.turn.side != side && crossings_agree(other, m_loops[turn])) return false;
        }
        return true;
    }

    void pull() {
        std::set<std::size_t> waiting;
        for (std::size_t k = 0; k < m_loops.size(); ++k) waiting.insert(waiting.end(), k);
        while (!waiting.empty()) {
            Loop& loop = m_loops[*waiting.begin()];
            waiting.erase(waiting.begin());
            const auto [depth, holder] = reach(loop);
            loop.holder = holder;
            if (depth == loop.depth) continue;
            loop.depth = depth;
            loop.arrival = m_arrivals++;
            waiting.insert(loop.neighbours.begin(), loop.neighbours.end());
            for (const std::size_t strand : {loop.from, loop.to}) {
                m_strands[strand].depth[index(loop.turn.side)] = depth;
                waiting.insert(m_held_by[strand].begin(), m_held_by[strand].end());
            }
        }
    }

    Turn at_rest(const Loop& loop) const {
        Turn turn = loop.turn;
        if (loop.depth >= m_ends) return turn;
        turn.end = end_at(loop.turn.side, loop.depth);
        turn.caught_by = loop.holder == nowhere ? CaughtBy::end : CaughtBy::pick;
        if (loop.holder != nowhere) turn.pick = m_strands[loop.holder].pick;
        return turn;
    }

    PickSpan span(const Strand& strand) const {
        const auto [first, last] = presence(strand);
        if (first > last) return {strand.feeder, strand.pick, 0, m_ends - 1, true};
        return {strand.feeder, strand.pick, first, last, false};
    }

    const CardImage& m_card;
    const CardImage* m_loose;
    std::size_t m_ends;
    std::vector<Strand> m_strands;
    std::vector<Loop> m_loops;
    std::vector<std::vector<std::size_t>> m_held_by;
    std::size_t m_arrivals = 0;
    WeftWay m_way;
};

}  // namespace

WeftWay weft_way(const CardImage& card, const std::vector<Pick>& picks, const CardImage* loose) {
    if (card.ends() == 0 || card.picks() == 0) return {};
    return Loops(card, picks, loose).way();
}

CardImage loose_ends(const Block& block) {
    CardImage loose(block.picks(), block.ends());
    for (std::size_t row = 0; row < block.rows(); ++row) {
        for (std::size_t column = 0; column < block.columns(); ++column) {
            for (const Slot slot : block.stack(row, column).slots()) {
                if (!slot.is_warp() || !slot.is_loose()) continue;
                for (std::size_t pick = block.first_pick(row); pick < block.first_pick(row + 1); ++pick) {
                    loose.set(pick, block.first_end(column) + slot.index(), true);
                }
            }
        }
    }
    return loose;
}

std::vector<MissedBox> missed_boxes(const std::vector<Pick>& picks) {
    std::vector<MissedBox> missed;
    std::map<std::uint32_t, std::size_t> last_pick;
    for (std::size_t k = 0; k < picks.size(); ++k) {
        for (const std::uint32_t feeder : picks[k].feeders) {
            const auto [last, first_time] = last_pick.try_emplace(feeder, k);
            if (first_time) continue;
            if (end_of(picks[last->second].direction) != start_of(picks[k].direction)) {
                missed.push_back({feeder, last->second, k});
            }
            last->second = k;
        }
    }
    return missed;
}

}  // namespace weave
