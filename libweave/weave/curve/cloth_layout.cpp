#include <weave/curve/cloth_layout.hpp>

#include <weave/curve/cloth_lines.hpp>
#include <weave/curve/meeting.hpp>
#include <weave/curve/turn_shape.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace weave {

namespace {

/// Centrelines keep this share of the thinnest yarn's radius apart, or turns are laid otherwise.
constexpr double share_of_radius = 0.02;
/// How often turns are laid otherwise before it is given up.
constexpr std::size_t most_tries = 400;
/// After so many tries the rows that turns come near to are led otherwise as well.
constexpr std::size_t tries_of_turns = 100;
/// Rows beside those that are looked over: where a yarn is cut its spline runs otherwise, by a factor 0.27 less each key point further.
constexpr std::size_t rows_beside = 12;

bool is_in_stack(const KeyPoint& key) {
    return key.row != KeyPoint::none && key.column != KeyPoint::none;
}

/// What lies between two stacks, the later of which follows these keys, is loose where the yarn is loose in both.
void mark_between(std::vector<KeyPoint>& keys, std::size_t begin, std::optional<bool> loose_after) {
    for (std::size_t k = begin; k < keys.size(); ++k) {
        if (!is_in_stack(keys[k])) continue;
        std::size_t next = k + 1;
        while (next < keys.size() && !is_in_stack(keys[next])) ++next;
        if (next == keys.size() && !loose_after) break;
        const bool loose = keys[k].loose && (next < keys.size() ? keys[next].loose : *loose_after);
        for (std::size_t i = k + 1; i < next; ++i) keys[i].loose = loose;
    }
}

Status check(const Block& block, const CurveOptions& options) {
    if (block.rows() == 0 || block.columns() == 0) return invalid("the cloth has no stacks");
    if (!options.region) return {};
    const Region& region = *options.region;
    const auto check_line = [](const char* what, std::size_t first, std::size_t last,
                               std::size_t count) -> Status {
        if (first <= last && last < count) return {};
        return bad_input(std::string(what) + " " + std::to_string(first + 1) + " to " +
                             std::to_string(last + 1) + " are not in the cloth, which has " +
                             std::to_string(count),
                         "region");
    };
    WEAVE_CHECK_OK(check_line("rows", region.first_row, region.last_row, block.rows()));
    return check_line("columns", region.first_column, region.last_column, block.columns());
}

}  // namespace

class ClothLayout::Lines {
  public:
    Lines(const Design& design, const Block& block, const CurveOptions& options, std::size_t most_keys_at_once)
        : m_design(design), m_block(block), m_most_keys_at_once(most_keys_at_once), m_lines(design, block, options), m_bare(m_lines.frame()) {}

    Status find_yarns() {
        count_keys_of_parts();
        if (m_lines.wraps()) make_turn_shapes();
        find_wefts();
        find_warps();
        count_keys_of_wefts();
        if (m_bare.yarns.empty()) return invalid("no yarn lies in this part of the cloth");
        return {};
    }

    Status lay() {
        WEAVE_CHECK_OK(find_yarns());
        if (m_lines.wraps()) WEAVE_CHECK_OK(clear_turns());
        return {};
    }

    Extent of_bound_yarns() const {
        Extent all;
        for (std::size_t yarn = 0; yarn < m_bare.yarns.size(); ++yarn) {
            if (is_loose(yarn)) continue;
            const std::size_t open = m_bare.yarns[yarn].is_periodic ? 0 : 1;
            all.open_yarns += open;
            all.segments += keys(yarn) - open;
        }
        return all;
    }

    const ClothCurves& bare() const { return m_bare; }

    std::size_t keys(std::size_t yarn) const {
        return yarn < m_wefts.size() ? m_wefts[yarn].first_key.back() : m_keys_of_warp[yarn - m_wefts.size()].keys;
    }

    void add_keys(std::size_t yarn, std::size_t first, std::size_t last, std::vector<KeyPoint>& to) const {
        std::vector<KeyPoint> laid;
        if (yarn >= m_wefts.size()) {
            lay_warp(yarn, laid);
            return take(laid, 0, first, last, to);
        }
        const std::vector<std::size_t>& first_key = m_wefts[yarn].first_key;
        const auto after = std::ranges::upper_bound(first_key, first);
        for (auto at = static_cast<std::size_t>(after - first_key.begin()) - 1; at + 1 < first_key.size() && first_key[at] < last; ++at) {
            laid.clear();
            lay_pick(yarn, at, laid);
            take(laid, first_key[at], first, last, to);
        }
    }

    void each_crossing(std::size_t yarn, const std::function<void(const Crossing&)>& visit) const {
        const Weft& weft = m_wefts[yarn];
        for (std::size_t at = 0; at < weft.parts.size(); ++at) {
            const WeftPart& part = m_lines.wefts().parts[weft.parts[at]];
            const std::size_t n = keys_of_part(weft.parts[at]), per_stack = m_keys_per_stack[weft.parts[at]];
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t k = goes_left(part) ? n - 1 - i : i;
                if (k % per_stack == 0) cross(yarn, weft.first_key[at] + i, part, part.first_column + k / per_stack, visit);
            }
        }
    }

  private:
    /// A weft: parts and the turns after them, one behind the other.
    struct Weft {
        std::vector<std::size_t> parts;
        std::vector<std::size_t> first_key;  ///< of each part with its turn, and behind the last
    };
    struct WarpKeys {
        std::size_t per_stack = 1, keys = 0;
    };

    /// How turns and rows were laid in one try, and how near two yarns then came.
    struct Way {
        double distance_mm = 0;
        std::size_t pick = 0;  ///< one of the two
        std::vector<std::size_t> turn_variant, row_effort;
    };

    /// A key point of a weft: its number along it, and the turn that it is of, or none.
    struct WeftKey {
        std::size_t number = 0, turn = WeftPart::none;
    };
    /// A segment of a yarn: the key where it begins, and of a weft the turn in which it begins or ends, and its row.
    struct Spot {
        std::size_t yarn = 0, key = 0, turn = WeftPart::none, row = WeftPart::none;
    };
    /// Two of them that come too near to one another, the later one first.
    struct TooNear {
        double distance_mm = 0;
        std::array<Spot, 2> spots;
    };

    /// Some rows of the cloth, with those beside them.
    struct Window {
        ClothCurves curves;
        std::vector<std::size_t> yarn_of_curve;  ///< of bare()
        std::vector<std::vector<WeftKey>> keys;  ///< of each curve of a weft
        double first_mm = -1e300, last_mm = 1e300;  ///< in x, what is looked over

        void add(YarnCurve curve, std::size_t yarn, std::vector<WeftKey> of_weft) {
            curves.yarns.push_back(std::move(curve));
            yarn_of_curve.push_back(yarn);
            keys.push_back(std::move(of_weft));
        }
        [[nodiscard]] Spot spot(std::size_t curve, std::size_t segment) const {
            Spot spot{yarn_of_curve[curve], 0, WeftPart::none, WeftPart::none};
            const std::vector<WeftKey>& along = keys[curve];
            if (along.empty()) return spot;  // a warp
            spot.key = along[segment].number;
            spot.turn = along[segment].turn != WeftPart::none ? along[segment].turn : along[(segment + 1) % along.size()].turn;
            spot.row = curves.yarns[curve].keys[segment].row;
            return spot;
        }
    };

    const Region& region() const { return m_bare.region; }
    bool goes_left(const WeftPart& part) const { return m_lines.wraps() && part.is_leftwards; }
    std::size_t turn_before(std::size_t part) const {
        const WeftPart& p = m_lines.wefts().parts[part];
        return p.turn[p.is_leftwards ? 1 : 0];
    }
    std::size_t turn_after(std::size_t part) const {
        const WeftPart& p = m_lines.wefts().parts[part];
        return p.turn[p.is_leftwards ? 0 : 1];
    }

    /// All along.
    bool is_loose(std::size_t yarn) const {
        if (yarn < m_wefts.size()) return std::ranges::all_of(m_wefts[yarn].parts, [&](std::size_t part) { return m_lines.is_loose_part(part); });
        const std::size_t end = m_bare.yarns[yarn].number, column = m_block.column_of_end(end);
        for (std::size_t row = region().first_row; row <= region().last_row; ++row) {
            if (!m_lines.is_loose_end(end, row, column)) return false;
        }
        return true;
    }

    std::size_t keys_of_part(std::size_t part) const {
        const WeftPart& p = m_lines.wefts().parts[part];
        const std::size_t stacks = p.last_column - p.first_column + 1;
        return m_bare.is_periodic[1] ? stacks * m_keys_per_stack[part] : (stacks - 1) * m_keys_per_stack[part] + 1;
    }

    void count_keys_of_parts() {
        const std::vector<WeftPart>& parts = m_lines.wefts().parts;
        m_keys_per_stack.resize(parts.size());
        for (std::size_t first = 0; first < parts.size(); first = m_lines.first_part(parts[first].row + 1)) count_keys_of_row(parts[first].row);
    }

    void count_keys_of_row(std::size_t row) {
        const ClothLines::Leads leads = m_lines.row(row);
        const std::size_t first = m_lines.first_part(row);
        for (std::size_t k = 0; k < leads->size(); ++k) m_keys_per_stack[first + k] = (*leads)[k].keys;
    }

    void make_turn_shapes() {
        const ClothRadii& radii = m_lines.radii();
        const double reach = std::min(0.5, (radii.warp_mm + radii.weft_mm) / m_bare.dy_mm);
        m_turns = std::make_unique<TurnShapes>(
            m_block, m_lines.wefts(), [this](const WeftPart& part, std::size_t column) { return m_lines.level_of(part, column); }, reach);
        m_turn_variant.assign(m_lines.wefts().bends.size(), 0);
    }

    void find_wefts() {
        const std::size_t parts = m_lines.wefts().parts.size();
        std::vector<bool> is_laid(parts);
        std::vector<std::pair<YarnCurve, Weft>> wefts;
        // First the yarns that begin somewhere, then the rings.
        for (const bool rings : {false, true}) {
            for (std::size_t k = 0; k < parts; ++k) {
                if (!is_laid[k] && (rings || turn_before(k) == WeftPart::none)) wefts.push_back(weft_from(k, is_laid));
            }
        }
        std::ranges::stable_sort(wefts, {}, [](const auto& weft) { return weft.first.number; });
        for (auto& [bare, weft] : wefts) {
            m_bare.yarns.push_back(std::move(bare));
            m_wefts.push_back(std::move(weft));
        }
    }

    /// The yarn that begins with this part, to its end or once round.
    std::pair<YarnCurve, Weft> weft_from(std::size_t begin, std::vector<bool>& is_laid) const {
        const WeftPart& first = m_lines.wefts().parts[begin];
        YarnCurve bare;
        bare.system = System::weft;
        bare.number = first.pick;
        bare.type = m_design.weft.feeders.at(first.feeder).yarn;
        if (m_bare.is_periodic[1]) {
            bare.is_periodic = true;
            bare.shift.y() = m_bare.size_mm[1];
        }
        Weft weft;
        for (std::size_t part = begin;;) {
            is_laid[part] = true;
            weft.parts.push_back(part);
            const std::size_t turn = turn_after(part);
            if (turn == WeftPart::none) break;
            part = m_lines.wefts().bends[turn].to;
            if (!is_laid[part]) continue;
            bare.is_periodic = true;
            bare.shift.x() = m_bare.size_mm[0];
            break;
        }
        return {std::move(bare), std::move(weft)};
    }

    void find_warps() {
        for (std::size_t column = region().first_column; column <= region().last_column; ++column) {
            const ClothLines::Leads leads = m_lines.column(column);
            for (std::size_t k = 0; k < leads->size(); ++k) {
                YarnCurve bare;
                bare.number = m_block.first_end(column) + k;
                bare.type = m_design.warp.order.at(bare.number);
                bare.is_periodic = m_bare.is_periodic[0];
                if (bare.is_periodic) bare.shift.x() = m_bare.size_mm[0];
                m_bare.yarns.push_back(std::move(bare));
                m_keys_of_warp.push_back({(*leads)[k].keys, (*leads)[k].level.size()});
            }
        }
    }

    void count_keys_of_wefts() {
        for (Weft& weft : m_wefts) {
            weft.first_key.assign(1, 0);
            for (const std::size_t part : weft.parts) {
                const std::size_t turn = m_lines.wraps() ? turn_after(part) : WeftPart::none;
                const std::size_t of_turn = turn == WeftPart::none ? 0 : m_turns->keys(turn, m_turn_variant[turn]).size();
                weft.first_key.push_back(weft.first_key.back() + keys_of_part(part) + of_turn);
            }
        }
    }

    /// Of keys that begin with number `begin`, those from `first` to before `last`.
    static void take(const std::vector<KeyPoint>& laid, std::size_t begin, std::size_t first, std::size_t last, std::vector<KeyPoint>& to) {
        const std::size_t from = std::max(begin, first), until = std::min(begin + laid.size(), last);
        if (from < until)
            to.insert(to.end(), laid.begin() + static_cast<std::ptrdiff_t>(from - begin), laid.begin() + static_cast<std::ptrdiff_t>(until - begin));
    }

    void lay_warp(std::size_t yarn, std::vector<KeyPoint>& keys) const {
        const std::size_t end = m_bare.yarns[yarn].number, column = m_block.column_of_end(end);
        const ClothLines::Leads leads = m_lines.column(column);
        const Lead& lead = (*leads)[end - m_block.first_end(column)];
        for (std::size_t k = 0; k < lead.level.size(); ++k) {
            KeyPoint key;
            const double row = static_cast<double>(region().first_row) + static_cast<double>(k) / static_cast<double>(lead.keys);
            key.place = m_lines.place(row, static_cast<double>(column), lead.level[k]);
            key.place.y() += lead.aside_mm[k];
            key.column = column;
            key.yarn = end;
            if (k % lead.keys == 0) {
                key.row = region().first_row + k / lead.keys;
                key.loose = m_lines.is_loose_end(end, key.row, column);
            }
            keys.push_back(key);
        }
        mark_between(keys, 0, m_bare.is_periodic[0] ? std::optional(keys.front().loose) : std::nullopt);
    }

    /// A weft's part `at` and the turn after it.
    void lay_pick(std::size_t yarn, std::size_t at, std::vector<KeyPoint>& keys) const {
        const Weft& weft = m_wefts[yarn];
        const std::size_t begin = keys.size(), part = weft.parts[at];
        lay_part(part, keys);
        std::optional<bool> loose_after;
        if (m_bare.is_periodic[1]) loose_after = keys[begin].loose;
        if (m_lines.wraps() && turn_after(part) != WeftPart::none) {
            lay_turn(turn_after(part), keys);
            const WeftPart& next = m_lines.wefts().parts[weft.parts[(at + 1) % weft.parts.size()]];
            loose_after = m_lines.is_loose_pick(next.pick, next.row, goes_left(next) ? next.last_column : next.first_column);
        }
        mark_between(keys, begin, loose_after);
    }

    void lay_part(std::size_t number, std::vector<KeyPoint>& keys) const {
        const WeftPart& part = m_lines.wefts().parts[number];
        const ClothLines::Leads leads = m_lines.row(part.row);
        const Lead& lead = (*leads)[number - m_lines.first_part(part.row)];
        const std::size_t n = lead.level.size();
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t k = goes_left(part) ? n - 1 - i : i;
            KeyPoint key;
            const double column = static_cast<double>(part.first_column) + static_cast<double>(k) / static_cast<double>(lead.keys);
            key.place = m_lines.place(static_cast<double>(part.row), column, lead.level[k]);
            key.place.x() += lead.aside_mm[k];
            key.row = part.row;
            key.yarn = part.pick;
            if (k % lead.keys == 0) {
                key.column = part.first_column + k / lead.keys;
                key.loose = m_lines.is_loose_pick(part.pick, key.row, key.column);
            }
            keys.push_back(key);
        }
    }

    void lay_turn(std::size_t turn, std::vector<KeyPoint>& keys) const {
        for (const Vec3& at : m_turns->keys(turn, m_turn_variant[turn])) {
            KeyPoint key;
            key.place = m_lines.place(at.x(), at.y(), at.z());
            key.yarn = m_lines.wefts().parts[m_lines.wefts().bends[turn].from].pick;
            keys.push_back(key);
        }
    }

    void cross(std::size_t yarn, std::size_t key, const WeftPart& part, std::size_t column, const std::function<void(const Crossing&)>& visit) const {
        for (std::size_t end = std::max(part.first_end, m_block.first_end(column)); end <= part.last_end && end < m_block.first_end(column + 1); ++end) {
            const std::size_t warp = end - m_block.first_end(region().first_column);
            visit({yarn, key, m_wefts.size() + warp, (part.row - region().first_row) * m_keys_of_warp[warp].per_stack, part.pick, end,
                   m_lines.is_over(part.pick, end, part.row, column)});
        }
    }

    /// Lays turns otherwise, and leads picks further aside, until no two yarns come too near. Where nothing
    /// helps, the way that keeps them farthest apart is taken.
    Status clear_turns() {
        const double least_mm = share_of_radius * m_lines.radii().thinnest_mm;
        Way best;
        for (std::size_t tried = 0; tried < most_tries; ++tried) {
            const std::vector<TooNear> near = too_near(least_mm);
            if (near.empty()) return {};
            const TooNear& nearest = *std::ranges::min_element(near, {}, &TooNear::distance_mm);
            if (tried == 0 || nearest.distance_mm > best.distance_mm)
                best = {nearest.distance_mm, m_bare.yarns[nearest.spots[0].yarn].number, m_turn_variant, m_lines.efforts()};
            if (!change(near, tried % 2 == 0, tried >= tries_of_turns)) break;
        }
        if (best.distance_mm < 1e-6 * least_mm)
            return invalid("found no way to lay the turns of the weft clear of one another", "pick " + std::to_string(best.pick + 1));
        m_turn_variant = std::move(best.turn_variant);
        m_lines.set_efforts(std::move(best.row_effort));
        count_keys_of_parts();
        count_keys_of_wefts();
        return {};
    }

    std::vector<TooNear> too_near(double least_mm) const {
        std::vector<TooNear> near;
        for (std::size_t w = 0; w < windows(); ++w) {
            const Window window = window_of(w);
            for (const CloseSegments& pair : close_segments(window.curves, least_mm)) {
                const Meeting& meeting = pair.meeting;
                if (meeting.place.x() < window.first_mm || meeting.place.x() >= window.last_mm) continue;
                TooNear found{meeting.distance_mm, {window.spot(meeting.yarn, pair.segment), window.spot(meeting.other, pair.other_segment)}};
                const auto place = [](const Spot& spot) { return std::pair(spot.yarn, spot.key); };
                if (place(found.spots[0]) < place(found.spots[1])) std::swap(found.spots[0], found.spots[1]);
                near.push_back(found);
            }
        }
        return near;
    }

    /// Changes one of each pair, first the one yarn, then the other: a turn, or where neither turns (or
    /// `rows_too`) a row.
    bool change(const std::vector<TooNear>& near, bool other_first, bool rows_too) {
        std::vector<bool> is_changed(m_turn_variant.size(), false);
        bool any = false;
        const std::size_t one = other_first ? 1 : 0, two = 1 - one;
        for (const TooNear& pair : near) {
            const Spot &first = pair.spots[one], &second = pair.spots[two];
            const bool turn = change_turn(first.turn, is_changed) || change_turn(second.turn, is_changed);
            const bool row = (!turn || rows_too) && (change_row(first.row) || change_row(second.row));
            any = any || turn || row;
        }
        count_keys_of_wefts();
        return any;
    }

    bool change_turn(std::size_t turn, std::vector<bool>& is_changed) {
        if (turn == WeftPart::none) return false;
        if (!is_changed[turn]) ++m_turn_variant[turn];
        is_changed[turn] = true;
        return true;
    }

    bool change_row(std::size_t row) {
        if (row == WeftPart::none || !m_lines.lead_further(row)) return false;
        count_keys_of_row(row);
        return true;
    }

    std::size_t all_keys() const {
        std::size_t all = 0;
        for (std::size_t yarn = 0; yarn < m_bare.yarns.size(); ++yarn) all += keys(yarn);
        return all;
    }

    /// Small cloth is one window.
    std::size_t windows() const { return all_keys() / m_most_keys_at_once + 1; }

    /// Everything, or the yarns of some rows and of those beside them.
    Window window_of(std::size_t number) const {
        Window window{m_bare, {}, {}};
        window.curves.yarns.clear();
        const std::size_t count = windows();
        if (count == 1) {
            for (std::size_t yarn = 0; yarn < m_bare.yarns.size(); ++yarn) add_whole(yarn, window);
            return window;
        }
        const auto rows = static_cast<std::ptrdiff_t>(m_lines.rows()), beside = static_cast<std::ptrdiff_t>(rows_beside + longest_turn());
        const auto border = [&](std::size_t k) { return rows * static_cast<std::ptrdiff_t>(k) / static_cast<std::ptrdiff_t>(count); };
        const auto mm = [&](std::ptrdiff_t row) { return (static_cast<double>(region().first_row) + static_cast<double>(row)) * m_bare.dx_mm; };
        std::ptrdiff_t first = border(number) - beside, last = border(number + 1) + beside;
        if (m_bare.is_periodic[0] || number > 0) window.first_mm = mm(border(number));
        if (m_bare.is_periodic[0] || number + 1 < count) window.last_mm = mm(border(number + 1));
        if (!m_bare.is_periodic[0]) first = std::max<std::ptrdiff_t>(first, 0), last = std::min(last, rows);
        window.curves.is_periodic[0] = false;
        for (std::size_t weft = 0; weft < m_wefts.size(); ++weft) add_picks(weft, first, last, window);
        for (std::size_t yarn = m_wefts.size(); yarn < m_bare.yarns.size(); ++yarn) add_stretch(yarn, first, last, window);
        return window;
    }

    std::size_t longest_turn() const {
        std::size_t longest = 0;
        for (const WeftBend& bend : m_lines.wefts().bends) {
            const std::size_t from = m_lines.wefts().parts[bend.from].row, to = m_lines.wefts().parts[bend.to].row;
            longest = std::max(longest, to + (bend.closes ? m_lines.rows() : 0) - from);
        }
        return longest;
    }

    void add_whole(std::size_t yarn, Window& window) const {
        YarnCurve curve = m_bare.yarns[yarn];
        std::vector<WeftKey> of_weft;
        if (yarn < m_wefts.size()) {
            for (std::size_t at = 0; at < m_wefts[yarn].parts.size(); ++at) add_pick(yarn, at, true, Vec3::Zero(), curve, of_weft);
        } else {
            lay_warp(yarn, curve.keys);
        }
        window.add(std::move(curve), yarn, std::move(of_weft));
    }

    void add_pick(std::size_t yarn, std::size_t at, bool with_turn, const Vec3& moved, YarnCurve& curve, std::vector<WeftKey>& of_weft) const {
        const std::size_t part = m_wefts[yarn].parts[at];
        std::vector<KeyPoint> keys;
        lay_pick(yarn, at, keys);
        if (!with_turn) keys.resize(keys_of_part(part));
        for (std::size_t k = 0; k < keys.size(); ++k) {
            keys[k].place += moved;
            curve.keys.push_back(keys[k]);
            of_weft.push_back({m_wefts[yarn].first_key[at] + k, k < keys_of_part(part) ? WeftPart::none : turn_after(part)});
        }
    }

    /// The picks of a weft in some rows, those that follow one another as one curve; rows beyond the rims are those of other repeats.
    void add_picks(std::size_t yarn, std::ptrdiff_t first, std::ptrdiff_t last, Window& window) const {
        const Weft& weft = m_wefts[yarn];
        const auto rows = static_cast<std::ptrdiff_t>(m_lines.rows());
        const bool is_ring = m_bare.yarns[yarn].shift.x() != 0;
        YarnCurve curve;
        std::vector<WeftKey> of_weft;
        const auto row_of = [&](std::size_t at, std::ptrdiff_t repeat) {
            return static_cast<std::ptrdiff_t>(m_lines.wefts().parts[weft.parts[at]].row - region().first_row) + repeat * rows;
        };
        const auto is_here = [&](std::ptrdiff_t row) { return row >= first && row < last; };
        const std::ptrdiff_t repeats = m_bare.is_periodic[0] ? 1 : 0;
        for (std::ptrdiff_t repeat = -repeats; repeat <= repeats; ++repeat) {
            for (std::size_t at = 0; at < weft.parts.size(); ++at) {
                if (!is_here(row_of(at, repeat))) continue;
                const bool is_last = at + 1 == weft.parts.size();
                const bool goes_on = is_last ? is_ring && is_here(row_of(0, repeat + 1)) : is_here(row_of(at + 1, repeat));
                if (curve.keys.empty()) {
                    curve = m_bare.yarns[yarn];
                    curve.is_periodic = false;
                }
                add_pick(yarn, at, goes_on, Vec3(static_cast<double>(repeat) * m_bare.size_mm[0], 0, 0), curve, of_weft);
                if (!goes_on) window.add(std::exchange(curve, {}), yarn, std::exchange(of_weft, {}));
            }
        }
        if (!curve.keys.empty()) window.add(std::move(curve), yarn, std::move(of_weft));
    }

    /// What of a warp lies in some rows.
    void add_stretch(std::size_t yarn, std::ptrdiff_t first, std::ptrdiff_t last, Window& window) const {
        std::vector<KeyPoint> keys;
        lay_warp(yarn, keys);
        YarnCurve curve = m_bare.yarns[yarn];
        curve.is_periodic = false;
        const auto n = static_cast<std::ptrdiff_t>(keys.size()), per_stack = static_cast<std::ptrdiff_t>(m_keys_of_warp[yarn - m_wefts.size()].per_stack);
        for (std::ptrdiff_t k = first * per_stack; k <= (last - 1) * per_stack; ++k) {
            const std::ptrdiff_t repeat = k >= 0 ? k / n : -((n - 1 - k) / n);
            KeyPoint key = keys[static_cast<std::size_t>(k - repeat * n)];
            key.place += static_cast<double>(repeat) * m_bare.yarns[yarn].shift;
            curve.keys.push_back(key);
        }
        window.add(std::move(curve), yarn, {});
    }

    const Design& m_design;
    const Block& m_block;
    std::size_t m_most_keys_at_once;
    ClothLines m_lines;
    ClothCurves m_bare;
    std::vector<std::size_t> m_keys_per_stack;  ///< of each part
    std::vector<Weft> m_wefts;
    std::vector<WarpKeys> m_keys_of_warp;
    std::unique_ptr<TurnShapes> m_turns;
    std::vector<std::size_t> m_turn_variant;
};

ClothLayout::ClothLayout(std::unique_ptr<Lines> lines) : m_lines(std::move(lines)) {}
ClothLayout::ClothLayout(ClothLayout&&) noexcept = default;
ClothLayout& ClothLayout::operator=(ClothLayout&&) noexcept = default;
ClothLayout::~ClothLayout() = default;

Result<ClothLayout> ClothLayout::make(const Design& design, const Block& block, const CurveOptions& options,
                                      std::size_t most_keys_at_once) {
    WEAVE_CHECK_OK(check(block, options));
    auto lines = std::make_unique<Lines>(design, block, options, most_keys_at_once);
    WEAVE_CHECK_OK(lines->lay());
    return ClothLayout(std::move(lines));
}

Result<ClothLayout::Extent> ClothLayout::foreseen(const Design& design, const Block& block, const CurveOptions& options) {
    WEAVE_CHECK_OK(check(block, options));
    Lines lines(design, block, options, usual_keys_at_once);
    WEAVE_CHECK_OK(lines.find_yarns());
    return lines.of_bound_yarns();
}

const ClothCurves& ClothLayout::bare() const {
    return m_lines->bare();
}

std::size_t ClothLayout::keys(std::size_t yarn) const {
    return m_lines->keys(yarn);
}

void ClothLayout::add_keys(std::size_t yarn, std::size_t first, std::size_t last, std::vector<KeyPoint>& to) const {
    m_lines->add_keys(yarn, first, last, to);
}

void ClothLayout::each_crossing(std::size_t weft, const std::function<void(const Crossing&)>& visit) const {
    m_lines->each_crossing(weft, visit);
}

}  // namespace weave
