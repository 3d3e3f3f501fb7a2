#include <weave/curve/turn_shape.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

namespace weave {

namespace {

/// Turns that run beside one another share this part of the gap between two columns; in the rest yarns of the
/// columns pass one another.
constexpr double lanes_begin = 0.35, lanes_end = 0.65;
/// Levels that a turn keeps from a pick that it passes, where there is room.
constexpr double clear_levels = 0.5;

/// Numbers from 0 to 1 that differ well from variant to variant, 0 for the regular one: multiples of the
/// irrational numbers of Roberts' sequence in three dimensions.
double spread(std::size_t variant, std::size_t dimension) {
    constexpr double steps[] = {0.8191725134, 0.6710436067, 0.5497004779};
    const double all = static_cast<double>(variant) * steps[dimension];
    return all - std::floor(all);
}

/// The same from -1/2 to 1/2.
double aside(std::size_t variant, std::size_t dimension) {
    const double part = spread(variant, dimension);
    return part > 0.5 ? part - 1 : part;
}

/// The place nearest to `wish` that is `clear_levels` from all of these heights.
double nearest_free(std::vector<double> heights, double wish) {
    std::sort(heights.begin(), heights.end());
    double best = std::numeric_limits<double>::infinity();
    const auto offer = [&](double place) {
        const bool is_free = std::none_of(heights.begin(), heights.end(), [&](double height) {
            return std::abs(height - place) < clear_levels - 1e-9;
        });
        if (is_free && std::abs(place - wish) < std::abs(best - wish)) best = place;
    };
    offer(wish);
    for (const double height : heights) {
        offer(height - clear_levels);
        offer(height + clear_levels);
    }
    return best;
}

}  // namespace

TurnShapes::TurnShapes(const Block& block, const WeftParts& wefts, LevelOf level_of, double reach)
    : m_block(block), m_wefts(wefts), m_level_of(std::move(level_of)), m_of_row(block.rows()) {
    for (std::size_t k = 0; k < wefts.parts.size(); ++k) m_of_row[wefts.parts[k].row].push_back(k);
    std::map<std::size_t, std::vector<std::size_t>> gaps;
    for (std::size_t k = 0; k < wefts.bends.size(); ++k) {
        const WeftBend& bend = wefts.bends[k];
        Lane lane;
        lane.gap = bend.turn.side == Side::left ? bend.column : bend.column + 1;
        lane.first = end_of(bend, false).x();
        lane.last = end_of(bend, true).x();
        m_lanes.push_back(lane);
        gaps[lane.gap].push_back(k);
    }
    for (const auto& [gap, bends] : gaps) assign_lanes(bends, reach);
}

/// Row, column and level of the stack from which a turn leaves or to which it comes.
Vec3 TurnShapes::end_of(const WeftBend& bend, bool later) const {
    const WeftPart& part = m_wefts.parts[later ? bend.to : bend.from];
    const std::size_t row = part.row + (later && bend.closes ? m_block.rows() : 0);
    return {static_cast<double>(row), static_cast<double>(bend.column), m_level_of(part, bend.column)};
}

/// Turns in one gap whose rows overlap run in lanes of their own, the ones that begin first outside.
void TurnShapes::assign_lanes(const std::vector<std::size_t>& bends, double reach) {
    std::vector<std::size_t> order = bends;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(m_lanes[a].first, -m_lanes[a].last) < std::pair(m_lanes[b].first, -m_lanes[b].last);
    });
    std::vector<double> taken_to;  // per lane the last row so far
    std::vector<std::size_t> lane_of;
    for (const std::size_t bend : order) {
        const auto free = std::find_if(taken_to.begin(), taken_to.end(),
                                       [&](double row) { return row < m_lanes[bend].first; });
        lane_of.push_back(static_cast<std::size_t>(free - taken_to.begin()));
        if (free == taken_to.end()) taken_to.push_back(0);
        taken_to[lane_of.back()] = m_lanes[bend].last;
    }
    const auto is_left = [&](std::size_t bend) { return m_wefts.bends[bend].turn.side == Side::left; };
    const bool from_left = std::any_of(order.begin(), order.end(), is_left);
    for (std::size_t k = 0; k < order.size(); ++k) {
        const double lane = (static_cast<double>(lane_of[k]) + 0.5) / static_cast<double>(taken_to.size());
        const double inside =
            lanes_begin + (lanes_end - lanes_begin) * lane;  // from the outer side of the gap
        double& outside = m_lanes[order[k]].outside;
        if (taken_to.size() == 1) {
            outside = reach;
        } else {
            outside = is_left(order[k]) == from_left ? 1 - inside : inside;
        }
    }
}

std::vector<Vec3> TurnShapes::keys(std::size_t number, std::size_t variant) const {
    const WeftBend& bend = m_wefts.bends[number];
    const Vec3 from = end_of(bend, false), to = end_of(bend, true);
    const double outside =
        m_lanes[number].outside * (1 - spread(variant, 0) / 2) * (bend.turn.side == Side::left ? -1 : 1);
    const double raised = 2 * aside(variant, 1);
    const auto place = [&](double row, double angle, double level) {
        return Vec3(row, from.y() + outside * std::sin(angle), level);
    };
    const double eighth = std::numbers::pi / 4, corner = (1 - std::cos(eighth)) / 2;
    std::vector<Vec3> keys;
    const double rows = to.x() - from.x();
    if (rows < 1.5) {
        const double bulge = bulge_of(number, variant);
        for (int k = 1; k <= 3; ++k) {
            const double angle = k * eighth, way = (1 - std::cos(angle)) / 2;
            keys.push_back(place(from.x() + way * rows + bulge * std::sin(angle), angle,
                                 from.z() + way * (to.z() - from.z()) + (k == 2 ? raised : 0)));
        }
        return keys;
    }
    const double quarter = 2 * eighth;
    std::vector<Vec3> passed;
    for (std::size_t row = static_cast<std::size_t>(from.x()) + 1; row < static_cast<std::size_t>(to.x());
         ++row) {
        const double straight = from.z() + (static_cast<double>(row) - from.x()) / rows * (to.z() - from.z());
        passed.push_back(
            place(static_cast<double>(row), quarter, level_at_row(number, row, straight) + raised / 4));
    }
    keys.push_back(place(from.x() + corner, eighth, from.z()));
    keys.push_back(place(from.x() + 0.5, quarter, (from.z() + passed.front().z()) / 2));
    keys.insert(keys.end(), passed.begin(), passed.end());
    keys.push_back(place(to.x() - 0.5, quarter, (to.z() + passed.back().z()) / 2));
    keys.push_back(place(to.x() - corner, eighth, to.z()));
    return keys;
}

/// Calls visit(part, level) for every part of a row that runs through the gap of a turn or turns there
/// itself.
template <class Visit>
void TurnShapes::each_passing(std::size_t number, std::size_t row, Visit visit) const {
    const WeftBend& bend = m_wefts.bends[number];
    const std::size_t gap = m_lanes[number].gap;
    for (const std::size_t k : m_of_row[row % m_block.rows()]) {
        const WeftPart& part = m_wefts.parts[k];
        if (k == bend.from || k == bend.to || part.first_column > gap || part.last_column + 1 < gap) continue;
        const bool left = gap > 0 && part.first_column < gap && part.last_column + 1 >= gap,
                   right = part.first_column <= gap && part.last_column >= gap && gap < m_block.columns();
        const auto turns_here = [&](std::size_t turn) {
            return turn != WeftPart::none && m_lanes[turn].gap == gap;
        };
        if (!(left && right) && !turns_here(part.turn[0]) && !turns_here(part.turn[1])) continue;
        const double from_left = left ? m_level_of(part, gap - 1) : 0,
                     from_right = right ? m_level_of(part, gap) : 0;
        visit(part, left && right ? (from_left + from_right) / 2 : from_left + from_right);
    }
}

/// The level at which a turn passes a row between its own.
double TurnShapes::level_at_row(std::size_t number, std::size_t row, double straight) const {
    const WeftBend& bend = m_wefts.bends[number];
    constexpr double infinity = std::numeric_limits<double>::infinity();
    double under = -infinity, over = infinity;  // what it must lie above, and below
    std::vector<double> heights;
    each_passing(number, row, [&](const WeftPart& part, double level) {
        heights.push_back(level);
        if (lies_above(bend, part)) {
            under = std::max(under, level);
        } else {
            over = std::min(over, level);
        }
    });
    if (under < over) {
        const double low = under + clear_levels, high = over - clear_levels;
        return low <= high ? std::clamp(straight, low, high) : (under + over) / 2;
    }
    return nearest_free(std::move(heights), straight);
}

/// Whether a loop lies above a pick that it passes outside the cloth: the conventions of loom/weft_way.hpp.
bool TurnShapes::lies_above(const WeftBend& loop, const WeftPart& part) const {
    const std::size_t number = part.turn[static_cast<std::size_t>(loop.turn.side)];
    if (number == WeftPart::none) return true;
    const WeftBend& other = m_wefts.bends[number];
    const auto is_around = [](const WeftBend& outer, const WeftBend& inner) {
        return outer.turn.from_pick <= inner.turn.from_pick && inner.turn.to_pick <= outer.turn.to_pick;
    };
    if (is_around(other, loop)) return !passes_above(other, loop);
    if (is_around(loop, other)) return passes_above(loop, other);
    return loop.turn.to_pick > other.turn.to_pick;
}

bool TurnShapes::passes_above(const WeftBend& outer, const WeftBend& inner) const {
    if (inner.turn.caught_by == CaughtBy::none) return true;
    const std::size_t end = inner.turn.end, picks = m_block.picks();
    const bool from = m_block.weft_over(outer.turn.from_pick, end);
    return from != m_block.weft_over(outer.turn.to_pick % picks, end) || from;
}

/// How far a turn goes out of its way along the warp. Between picks of one row it has to pass those of that
/// row which lie between its own in height: behind the later ones, which the loom beats up against it, and
/// before the earlier ones.
double TurnShapes::bulge_of(std::size_t number, std::size_t variant) const {
    const WeftBend& bend = m_wefts.bends[number];
    const std::size_t row = m_wefts.parts[bend.from].row;
    if (row != m_wefts.parts[bend.to].row || bend.closes) return aside(variant, 2);
    const double a = end_of(bend, false).z(), b = end_of(bend, true).z();
    std::size_t between = 0, later = 0;
    each_passing(number, row, [&](const WeftPart& part, double level) {
        if (level <= std::min(a, b) - clear_levels || level >= std::max(a, b) + clear_levels) return;
        ++between;
        later += part.pick > bend.turn.to_pick ? 1 : 0;
    });
    if (between == 0) return aside(variant, 2);
    const double wish = 2 * later >= between ? -0.5 : 0.5;
    return wish + 2 * aside(variant, 2);
}

}  // namespace weave
