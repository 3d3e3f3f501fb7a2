#include "diagram.hpp"

#include <deque>
#include <limits>

namespace weave::testing {

namespace {

struct Arc {
    int from = 0, to = 0;
};

/// Draws the yarns as they leave the loom: straight picks, an arc from each pick of a feeder to its next,
/// shorter arcs nearer to the cloth, tails to infinity. What is laid later lies above.
class Drawing {
  public:
    Drawing(const CardImage& card, const std::vector<Pick>& picks, std::size_t feeders)
        : m_card(card), m_picks(picks), m_of_feeder(feeders) {
        for (std::size_t n = 0; n < picks.size(); ++n)
            m_of_feeder.at(picks[n].feeders.at(0)).push_back(static_cast<int>(n));
        m_turn.resize(picks.size());
        for (const auto& own : m_of_feeder) {
            for (std::size_t k = 0; k + 1 < own.size(); ++k) {
                const std::size_t side = goes_right(own[k]) ? 1 : 0;
                m_turn[static_cast<std::size_t>(own[k])][side] =
                    m_turn[static_cast<std::size_t>(own[k + 1])][side] =
                        static_cast<int>(m_arcs[side].size());
                m_arcs[side].push_back({own[k], own[k + 1]});
            }
        }
    }

    Diagram draw() {
        for (std::size_t e = 0; e < m_card.ends(); ++e) {
            m_diagram.yarns.emplace_back();
            for (std::size_t n = 0; n < m_picks.size(); ++n) {
                visit(crossing_with_end(static_cast<int>(n), e), !m_card.weft_over(n, e));
            }
        }
        for (const auto& own : m_of_feeder) {
            m_diagram.yarns.emplace_back();
            for (const int n : own) draw_pick(n);
        }
        for (const auto& arcs : m_arcs) {
            for (const Arc& arc : arcs) m_diagram.loops.emplace_back(arc.from, arc.to);
        }
        std::sort(m_diagram.loops.begin(), m_diagram.loops.end(),
                  [](const auto& a, const auto& b) { return a.second < b.second; });
        for (const std::size_t side : {0U, 1U}) settle_nested(side);
        return std::move(m_diagram);
    }

  private:
    /// A loop comes past a turn inside it on its own side of the end that this turn lies round: over it where
    /// both its picks lie over that end, under it where both lie under, and otherwise over it.
    void settle_nested(std::size_t side) {
        for (const Arc& outer : m_arcs[side]) {
            for (const Arc& inner : m_arcs[side]) {
                if (inner.from <= outer.from || inner.to >= outer.to) continue;
                bool over = true;
                for (std::size_t k = 0; k < m_card.ends(); ++k) {
                    const std::size_t e = side == 0 ? k : m_card.ends() - 1 - k;
                    if (lies_over(inner.from, e) == lies_over(inner.to, e)) continue;
                    over = lies_over(outer.from, e) || lies_over(outer.to, e);
                    break;
                }
                m_diagram.over_when_passing[{{outer.from, outer.to}, {inner.from, inner.to}}] = over;
            }
        }
    }
    [[nodiscard]] bool lies_over(int n, std::size_t e) const {
        return m_card.weft_over(static_cast<std::size_t>(n), e);
    }

    static constexpr int tail = -1;
    [[nodiscard]] bool goes_right(int n) const {
        return m_picks[static_cast<std::size_t>(n)].direction == Direction::left_to_right;
    }
    [[nodiscard]] int turn(int n, std::size_t side) const {
        return m_turn[static_cast<std::size_t>(n)][side].value_or(tail);
    }
    [[nodiscard]] int length(std::size_t side, int arc) const {
        if (arc == tail) return std::numeric_limits<int>::max();
        const Arc& a = m_arcs[side][static_cast<std::size_t>(arc)];
        return (a.to - a.from) * 1000 + a.from;
    }

    void visit(int crossing, bool over) { m_diagram.yarns.back().push_back({crossing, over}); }

    int number(int kind, int a, int b, bool first_is_over_and_left_turn, std::pair<int, int> what) {
        const auto [at, fresh] = m_numbers.insert({{kind, a, b}, static_cast<int>(m_numbers.size())});
        if (fresh) {
            m_diagram.signs[at->second] = first_is_over_and_left_turn ? 1 : -1;
            m_diagram.of[at->second] = what;
        }
        return at->second;
    }

    /// Ends and arcs run towards later picks; a pick to the right that lies over one has it on its left.
    int crossing_with_end(int n, std::size_t e) {
        const bool over = m_card.weft_over(static_cast<std::size_t>(n), e);
        return number(2, n, static_cast<int>(e), over == goes_right(n), {n, static_cast<int>(e)});
    }

    [[nodiscard]] bool pick_over_arc(int n, std::size_t side, int arc) const {
        const int own = turn(n, side),
                  formed = own == tail ? n : m_arcs[side][static_cast<std::size_t>(own)].to;
        return formed > m_arcs[side][static_cast<std::size_t>(arc)].to;
    }

    void visit_arc(int n, std::size_t side, int arc, bool as_pick) {
        const bool over = pick_over_arc(n, side, arc);
        const int crossing = number(static_cast<int>(side), n, arc, over == goes_right(n), {-1, -1});
        visit(crossing, as_pick == over);
        const Arc& its = m_arcs[side][static_cast<std::size_t>(arc)];
        auto& along = m_diagram.along[crossing];
        along = {{its.from, n}, {its.to, n}};
        const int own = turn(n, side);
        if (own == tail) return;
        const Arc& mine = m_arcs[side][static_cast<std::size_t>(own)];
        const int inside = mine.from < its.from ? its.from : its.to;
        along.insert({mine.from, inside});
        along.insert({mine.to, inside});
    }

    /// Arcs that a pick passes on its way out on one side, nearest first.
    std::vector<int> passed(int n, std::size_t side) const {
        std::vector<int> arcs;
        for (int k = 0; k < static_cast<int>(m_arcs[side].size()); ++k) {
            const Arc& arc = m_arcs[side][static_cast<std::size_t>(k)];
            if (arc.from < n && n < arc.to && length(side, k) < length(side, turn(n, side)))
                arcs.push_back(k);
        }
        std::sort(arcs.begin(), arcs.end(), [&](int a, int b) { return length(side, a) < length(side, b); });
        return arcs;
    }

    void draw_pick(int n) {
        const std::size_t start = goes_right(n) ? 0 : 1, stop = 1 - start;
        const auto inwards = passed(n, start);
        for (auto arc = inwards.rbegin(); arc != inwards.rend(); ++arc) visit_arc(n, start, *arc, true);
        for (std::size_t k = 0; k < m_card.ends(); ++k) {
            const std::size_t e = goes_right(n) ? k : m_card.ends() - 1 - k;
            visit(crossing_with_end(n, e), m_card.weft_over(static_cast<std::size_t>(n), e));
        }
        for (const int arc : passed(n, stop)) visit_arc(n, stop, arc, true);
        const int own = turn(n, stop);
        if (own == tail) return;
        const Arc& arc = m_arcs[stop][static_cast<std::size_t>(own)];
        for (int m = arc.from + 1; m < arc.to; ++m) {
            if (length(stop, own) < length(stop, turn(m, stop))) visit_arc(m, stop, own, false);
        }
    }

    const CardImage& m_card;
    const std::vector<Pick>& m_picks;
    std::vector<std::vector<int>> m_of_feeder;
    std::array<std::vector<Arc>, 2> m_arcs;
    std::vector<std::array<std::optional<int>, 2>> m_turn;
    std::map<std::array<int, 3>, int> m_numbers;
    Diagram m_diagram;
};

using Dart = Diagram::Dart;

/// The picks that a piece of a feeder's yarn outside the cloth joins, the earlier first; nothing for other
/// pieces.
std::optional<std::pair<int, int>> loop_of(const Diagram& diagram, const Dart& dart) {
    const auto& yarn = diagram.yarns[dart.yarn];
    int before = -1, after = -1;
    for (std::size_t k = dart.gap; k-- > 0 && before < 0;) before = diagram.of.at(yarn[k].crossing).first;
    for (std::size_t k = dart.gap; k < yarn.size() && after < 0; ++k)
        after = diagram.of.at(yarn[k].crossing).first;
    if (before < 0 || after <= before) return {};
    return std::pair{before, after};
}

bool is_arc(const Diagram& diagram, const Dart& dart) {
    return loop_of(diagram, dart).has_value();
}

/// Every way of sliding a piece of a loop across a piece of another that it was laid round, on the side that
/// is settled for the two. Other loops are already crossed as they were laid: no taut loop climbs over one
/// that was laid on it.
std::vector<Diagram> pushes(const Diagram& diagram, std::size_t ends) {
    std::vector<Diagram> made;
    const auto where = diagram.spots();
    std::set<Dart> done;
    for (std::size_t y = ends; y < diagram.yarns.size(); ++y) {
        for (std::size_t gap = 1; gap < diagram.yarns[y].size(); ++gap) {
            for (const bool forward : {true, false}) {
                const Dart start{y, gap, forward};
                if (!is_arc(diagram, start) || done.contains(start)) continue;
                std::vector<Dart> face;
                std::optional<Dart> at = start;
                do {
                    if (at->yarn >= ends && is_arc(diagram, *at)) face.push_back(*at);
                    at = diagram.next(*at, where);
                } while (at && *at != start);
                if (at) done.insert(face.begin(), face.end());
                for (const Dart& e : face) {
                    for (const Dart& f : face) {
                        const auto around =
                            diagram.over_when_passing.find({*loop_of(diagram, e), *loop_of(diagram, f)});
                        if (around == diagram.over_when_passing.end()) continue;
                        made.push_back(
                            diagram.pushed(e, f, around->second, around->first.first, around->first.second));
                    }
                }
            }
        }
    }
    return made;
}

/// Two crossings of one end with the picks of a loop that the second move takes away, if there are any.
bool slip_at_ends(Diagram& diagram, std::size_t ends, const Diagram::Loop& loop) {
    for (std::size_t e = 0; e < ends; ++e) {
        const auto& yarn = diagram.yarns[e];
        for (std::size_t k = 0; k + 1 < yarn.size(); ++k) {
            if (yarn[k].over != yarn[k + 1].over) continue;
            const std::set<int> both{yarn[k].crossing, yarn[k + 1].crossing},
                picks{diagram.of.at(yarn[k].crossing).first, diagram.of.at(yarn[k + 1].crossing).first};
            if (picks != std::set<int>{loop.first, loop.second}) continue;
            for (std::size_t y = ends; y < diagram.yarns.size(); ++y) {
                const auto& weft = diagram.yarns[y];
                for (std::size_t m = 0; m + 1 < weft.size(); ++m) {
                    if (both != std::set<int>{weft[m].crossing, weft[m + 1].crossing}) continue;
                    diagram.remove(both);
                    return true;
                }
            }
        }
    }
    return false;
}

/// Looks through what slides (and at most `most_pushes` pushes) reach for a diagram in which the loop slips
/// past an end.
std::optional<Diagram> slipped(const Diagram& start, std::size_t ends, const Diagram::Loop& loop,
                               int most_pushes, std::size_t most_states, bool& gave_up) {
    std::set<std::vector<Diagram::Yarn>> seen{start.yarns};
    std::deque<std::pair<Diagram, int>> waiting{{start, 0}};
    if (Diagram now = start; slip_at_ends(now, ends, loop)) return now;
    while (!waiting.empty()) {
        const auto [diagram, pushed] = std::move(waiting.front());
        waiting.pop_front();
        auto next = diagram.slides(loop);
        if (Diagram simpler = diagram; simpler.simplify()) next.push_back(std::move(simpler));
        const std::size_t slides = next.size();
        if (pushed < most_pushes) {
            for (auto& made : pushes(diagram, ends)) next.push_back(std::move(made));
        }
        for (std::size_t k = 0; k < next.size(); ++k) {
            if (!seen.insert(next[k].yarns).second) continue;
            if (slip_at_ends(next[k], ends, loop)) return std::move(next[k]);
            if (seen.size() > most_states) {
                gave_up = true;
                return {};
            }
            waiting.emplace_back(std::move(next[k]), pushed + (k < slides ? 0 : 1));
        }
    }
    return {};
}

}  // namespace

Diagram diagram_of(const CardImage& card, const std::vector<Pick>& picks, std::size_t feeders) {
    return Drawing(card, picks, feeders).draw();
}

std::set<std::pair<int, int>> pulled_tight(Diagram diagram, std::size_t ends, std::size_t most_states,
                                           bool& gave_up) {
    const auto pull = [&](const Diagram::Loop& loop) {
        bool moved = false;
        for (int pushes_allowed = 0; pushes_allowed <= 2 && !gave_up; ++pushes_allowed) {
            auto further = slipped(diagram, ends, loop, pushes_allowed, most_states, gave_up);
            if (!further) continue;
            diagram = std::move(*further);
            moved = true;
            pushes_allowed = -1;
        }
        return moved;
    };
    const auto loops = diagram.loops;
    while (!gave_up && std::any_of(loops.begin(), loops.end(), pull)) {
    }
    std::set<std::pair<int, int>> left;
    for (const auto& [crossing, what] : diagram.of) {
        if (what.first >= 0) left.insert(what);
    }
    return left;
}

}  // namespace weave::testing
