#pragma once

#include <weave/loom/weft_way.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// The oracle for the weft's way: a crossing diagram of yarns and Reidemeister's three moves on it. It knows
/// yarns as lists of crossings, over or under, and what a move may do to them; it knows nothing of picks that
/// hold loops.
namespace weave::testing {

class Diagram {
  public:
    struct Visit {
        int crossing = 0;
        bool over = false;
        auto operator<=>(const Visit&) const = default;
    };
    using Yarn = std::vector<Visit>;

    /// Where a yarn visits a crossing.
    struct Spot {
        std::size_t yarn = 0, place = 0;
    };

    std::vector<Yarn> yarns;
    std::map<int, int> signs;  ///< +1: over yarn turned left gives the under yarn's direction
    std::map<int, std::pair<int, int>>
        of;  ///< crossing of an end with a pick (pick, end), or (-1, -1) between wefts
    /// For a crossing between wefts the pairs of picks along which it may pass an end: see is_straight.
    std::map<int, std::set<std::set<int>>> along;
    using Loop = std::pair<int, int>;  ///< the two picks that it joins
    std::vector<Loop> loops;           ///< in the order in which they were laid
    /// Loops on one side laid one round the other: whether the outer one would pass over the inner one.
    std::map<std::pair<Loop, Loop>, bool> over_when_passing;

    [[nodiscard]] std::map<int, std::array<Spot, 2>> spots() const {
        std::map<int, std::vector<Spot>> all;
        for (std::size_t y = 0; y < yarns.size(); ++y) {
            for (std::size_t k = 0; k < yarns[y].size(); ++k) all[yarns[y][k].crossing].push_back({y, k});
        }
        std::map<int, std::array<Spot, 2>> found;
        for (const auto& [crossing, places] : all) found[crossing] = {places.at(0), places.at(1)};
        return found;
    }

    [[nodiscard]] bool is_between_wefts(int crossing) const { return of.at(crossing).first < 0; }

    /// A loop under tension crosses the picks between its own straight across. So where a third move brings a
    /// crossing of two wefts past an end, the loop's pick and the crossed pick are those at which it was
    /// laid; it does not climb round the turn of the crossed pick at the other side.
    [[nodiscard]] bool is_straight(const std::set<int>& triangle, const Loop& pulled) const {
        std::set<int> picks;
        const std::set<std::set<int>>* straight = nullptr;
        for (const int crossing : triangle) {
            if (is_between_wefts(crossing))
                straight = &along.at(crossing);
            else
                picks.insert(of.at(crossing).first);
        }
        if (picks.empty() || straight == nullptr) return true;
        return straight->contains(picks) && (picks.contains(pulled.first) || picks.contains(pulled.second));
    }

    void remove(const std::set<int>& crossings) {
        for (Yarn& yarn : yarns) {
            std::erase_if(yarn, [&](const Visit& v) { return crossings.contains(v.crossing); });
        }
        for (const int crossing : crossings) {
            signs.erase(crossing);
            of.erase(crossing);
            along.erase(crossing);
        }
    }

    /// First and second move wherever they remove crossings between wefts, until none does. True if anything
    /// was removed.
    bool simplify() {
        bool any = false;
        while (const auto gone = removable()) {
            remove(*gone);
            any = true;
        }
        return any;
    }

    [[nodiscard]] std::optional<std::set<int>> removable() const {
        std::set<std::pair<int, int>> seen;  // neighbours that one yarn passes over both, or under both
        for (const Yarn& yarn : yarns) {
            for (std::size_t k = 0; k + 1 < yarn.size(); ++k) {
                const Visit a = yarn[k], b = yarn[k + 1];
                if (!is_between_wefts(a.crossing) || !is_between_wefts(b.crossing)) continue;
                if (a.crossing == b.crossing) return std::set{a.crossing};
                if (a.over != b.over) continue;
                if (!seen.insert(std::minmax(a.crossing, b.crossing)).second)
                    return std::set{a.crossing, b.crossing};
            }
        }
        return {};
    }

    /// All diagrams that one third move makes of this one while a loop is pulled. Past an end, crossings of wefts come
    /// only with that loop: other picks stay beside each other as they were beaten up.
    [[nodiscard]] std::vector<Diagram> slides(const Loop& pulled) const {
        std::vector<Diagram> made;
        const auto where = spots();
        struct Edge {
            std::size_t yarn, place;  ///< from place to place + 1
        };
        std::map<std::pair<int, int>, std::vector<Edge>> edges;
        std::map<int, std::set<int>> neighbours;
        for (std::size_t y = 0; y < yarns.size(); ++y) {
            for (std::size_t k = 0; k + 1 < yarns[y].size(); ++k) {
                const int a = yarns[y][k].crossing, b = yarns[y][k + 1].crossing;
                edges[std::minmax(a, b)].push_back({y, k});
                neighbours[a].insert(b);
                neighbours[b].insert(a);
            }
        }
        const auto for_triangle = [&](Edge p, Edge q, Edge r) {
            // Each of the three corners joins two of the edges; a yarn that is over at both its corners is on
            // top.
            const std::array sides{p, q, r};
            int tops = 0, bottoms = 0;
            for (const Edge& side : sides) {
                const bool first = yarns[side.yarn][side.place].over,
                           second = yarns[side.yarn][side.place + 1].over;
                tops += first && second;
                bottoms += !first && !second;
            }
            std::set<std::pair<std::size_t, std::size_t>> used;
            std::set<int> corners;
            for (const Edge& side : sides) corners.insert(yarns[side.yarn][side.place].crossing);
            for (const Edge& side : sides) corners.insert(yarns[side.yarn][side.place + 1].crossing);
            if (!is_straight(corners, pulled)) return;
            for (const Edge& side : sides) {
                used.insert({side.yarn, side.place});
                used.insert({side.yarn, side.place + 1});
            }
            if (tops != 1 || bottoms != 1 || used.size() != 6) return;
            Diagram next = *this;
            for (const Edge& side : sides)
                std::swap(next.yarns[side.yarn][side.place], next.yarns[side.yarn][side.place + 1]);
            made.push_back(std::move(next));
        };
        for (const auto& [pair, first] : edges) {
            for (const int third : neighbours[pair.second]) {
                if (third <= pair.second || !neighbours[pair.first].contains(third)) continue;
                for (const Edge& p : first) {
                    for (const Edge& q : edges[std::minmax(pair.second, third)]) {
                        for (const Edge& r : edges[std::minmax(pair.first, third)]) for_triangle(p, q, r);
                    }
                }
            }
        }
        return made;
    }

    /// A directed edge of the plane graph: the piece of a yarn after `place` visits.
    struct Dart {
        std::size_t yarn = 0, gap = 0;
        bool forward = true;
        auto operator<=>(const Dart&) const = default;
    };

    /// The next dart round the face on the left, or nothing where the yarn leaves for infinity.
    [[nodiscard]] std::optional<Dart> next(const Dart& dart,
                                           const std::map<int, std::array<Spot, 2>>& where) const {
        const Yarn& yarn = yarns[dart.yarn];
        if (dart.forward ? dart.gap == yarn.size() : dart.gap == 0) return {};
        const std::size_t place = dart.forward ? dart.gap : dart.gap - 1;
        const Visit visit = yarn[place];
        const auto& both = where.at(visit.crossing);
        const bool is_first = both[0].yarn == dart.yarn && both[0].place == place;
        const Spot other = is_first ? both[1] : both[0];
        // Whether the other yarn runs to the left of the direction in which this one arrives.
        int left = signs.at(visit.crossing) * (visit.over ? 1 : -1) * (dart.forward ? 1 : -1);
        if (left > 0) return Dart{other.yarn, other.place + 1, true};
        return Dart{other.yarn, other.place, false};
    }

    /// Pushes piece `e` across piece `f`, over or under it; both bound the same face on their left.
    /// `outer` is the loop of `e`, `inner` that of `f`.
    [[nodiscard]] Diagram pushed(const Dart& e, const Dart& f, bool over, const Loop& outer,
                                 const Loop& inner) const {
        Diagram made = *this;
        const int x = signs.empty() ? 0 : signs.rbegin()->first + 1, y = x + 1;
        const int same = e.forward == f.forward ? 1 : -1;
        made.signs[x] = (over ? 1 : -1) * same;
        made.signs[y] = -made.signs[x];
        made.of[x] = made.of[y] = {-1, -1};
        const int at_x = f.forward ? inner.second : inner.first,
                  at_y = f.forward ? inner.first : inner.second;
        made.along[x] = {{outer.first, at_x}, {outer.second, at_x}};
        made.along[y] = {{outer.first, at_y}, {outer.second, at_y}};
        const auto insert = [&](const Dart& at, int first, int second, bool is_over) {
            Yarn& yarn = made.yarns[at.yarn];
            if (!at.forward) std::swap(first, second);
            yarn.insert(yarn.begin() + static_cast<std::ptrdiff_t>(at.gap),
                        {{first, is_over}, {second, is_over}});
        };
        insert(e, x, y, over);
        insert(f, y, x, !over);
        return made;
    }
};

/// The diagram of a card: ends first, then the yarn of each feeder; arcs and tails as they leave the loom.
Diagram diagram_of(const CardImage& card, const std::vector<Pick>& picks, std::size_t feeders);

/// Pulls loops as far as moves allow, always the one laid first of those that can move, and gives the
/// (pick, end) crossings that remain.
std::set<std::pair<int, int>> pulled_tight(Diagram diagram, std::size_t ends, std::size_t most_states,
                                           bool& gave_up);

}  // namespace weave::testing
