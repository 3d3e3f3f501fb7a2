#include <weave/curve/cloth_curves.hpp>

#include <weave/curve/meeting.hpp>
#include <weave/curve/passing.hpp>
#include <weave/curve/settled_levels.hpp>
#include <weave/curve/turn_shape.hpp>
#include <weave/curve/weft_parts.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace weave {

namespace {

/// Centrelines keep this share of the thinnest yarn's radius apart, or turns are laid otherwise.
constexpr double share_of_radius = 0.02;
/// Yarns of neighbouring lines are led aside by at most this share of the spacing of lines.
constexpr double share_of_line = 0.25;
/// Picks this many times as long as straight ones settle before they are laid.
constexpr double steep = 1.4;
/// How often turns are laid otherwise before it is given up.
constexpr std::size_t most_tries = 400;
/// After so many tries the rows that turns come near to are led otherwise as well.
constexpr std::size_t tries_of_turns = 100;

double scaled(double radius_mm, const SystemScene& scene) {
    return radius_mm * scene.radius_scale.value_or(1);
}

/// Where yarns lie in the stacks of a block, each different stack looked at once.
class Places {
  public:
    explicit Places(const Block& block) : m_block(block) {
        for (const Stack& stack : block.stacks()) {
            m_wefts.push_back(stack.positions(System::weft));
            m_warps.push_back(stack.positions(System::warp));
        }
    }
    [[nodiscard]] std::size_t of_pick(std::size_t pick, std::size_t row, std::size_t column) const {
        return m_wefts[m_block.cells(row)[column]][pick - m_block.first_pick(row)];
    }
    [[nodiscard]] std::size_t of_end(std::size_t end, std::size_t row, std::size_t column) const {
        return m_warps[m_block.cells(row)[column]][end - m_block.first_end(column)];
    }
    [[nodiscard]] bool is_loose(std::size_t place, std::size_t row, std::size_t column) const {
        return m_block.stack(row, column).slots()[place].is_loose();
    }

  private:
    const Block& m_block;
    std::vector<std::vector<std::size_t>> m_wefts, m_warps;  ///< per different stack
};

/// Radii of the yarns that lie in the cloth, scaled as the scene asks.
struct Radii {
    double warp_mm = 0, weft_mm = 0;  ///< mean
    double thinnest_mm = 0;
};

class Mean {
  public:
    void add(double value) {
        m_sum += value;
        ++m_count;
        m_least = m_count == 1 ? value : std::min(m_least, value);
    }
    [[nodiscard]] double mean() const { return m_count == 0 ? 0 : m_sum / static_cast<double>(m_count); }
    [[nodiscard]] double least() const { return m_least; }
    [[nodiscard]] bool is_empty() const { return m_count == 0; }

  private:
    double m_sum = 0, m_least = 0;
    std::size_t m_count = 0;
};

const YarnType& yarn_of(const Design& design, std::uint32_t feeder) {
    return design.weft.yarns.at(design.weft.feeders.at(feeder).yarn);
}

Radii radii_of(const Design& design, const Block& block, const std::vector<Pick>& picks) {
    Mean warps, wefts;
    for (std::size_t end = 0; end < block.ends(); ++end) {
        warps.add(scaled(yarn_of_end(design, end).radius_mm, design.scene.warp));
    }
    for (const Pick& pick : picks) {
        for (const std::uint32_t feeder : pick.feeders) {
            wefts.add(scaled(yarn_of(design, feeder).radius_mm, design.scene.weft));
        }
    }
    const double thinnest = wefts.is_empty()   ? warps.least()
                            : warps.is_empty() ? wefts.least()
                                               : std::min(warps.least(), wefts.least());
    return {warps.mean(), wefts.mean(), thinnest};
}

class Layout {
  public:
    Layout(const Design& design, const Block& block, const CurveOptions& options)
        : m_design(design),
          m_block(block),
          m_picks(pick_table(design, block)),
          m_places(block),
          m_radii(radii_of(design, block, m_picks)),
          m_wraps(options.weft_mode.value_or(design.scene.weft_mode) == WeftMode::wraparound) {
        measure(options);
        find_parts(options.region.has_value());
        if (wefts_climb()) settle_levels();
        lay_warps();
    }

    Result<ClothCurves> curves() {
        m_turn_variant.assign(m_wefts.bends.size(), 0);
        m_row_effort.assign(m_block.rows(), 0);
        if (m_wraps) make_turn_shapes();
        lay_wefts();
        if (m_wraps) WEAVE_CHECK_OK(clear_turns());
        if (m_wefts_laid.empty() && m_warps.empty()) return invalid("no yarn lies in this part of the cloth");
        assemble();
        return std::move(m_cloth);
    }

  private:
    struct LaidWeft {
        YarnCurve curve;
        std::vector<std::size_t> part;  ///< per key, none in turns
        std::vector<std::size_t> turn;  ///< per key, none in the stacks
    };

    /// How turns and rows were laid in one try, and how near two yarns then came.
    struct Way {
        double distance_mm = 0;
        std::size_t pick = 0;  ///< one of the two
        std::vector<std::size_t> turn_variant, row_effort;
    };

    void measure(const CurveOptions& options) {
        const Scene& scene = m_design.scene;
        const double columns = static_cast<double>(m_block.columns()),
                     ends = static_cast<double>(m_block.ends());
        m_cloth.dx_mm = scene.dx_mm.value_or(10 / m_design.weft.density_picks_per_cm);
        m_cloth.dy_mm = scene.dy_mm.value_or(10 * ends / columns / m_design.warp.density_ends_per_cm);
        m_cloth.dz_mm = scene.dz_mm.value_or(m_radii.warp_mm + m_radii.weft_mm);
        m_cloth.region = options.region.value_or(Region{0, m_block.rows() - 1, 0, m_block.columns() - 1});
        m_cloth.size_mm = {static_cast<double>(rows()) * m_cloth.dx_mm,
                           static_cast<double>(columns_here()) * m_cloth.dy_mm};
        if (options.region) return;
        m_cloth.is_periodic = {scene.boundary_x == Boundary::periodic,
                               scene.boundary_y == Boundary::periodic && !m_wraps};
    }

    const Region& region() const { return m_cloth.region; }
    std::size_t rows() const { return region().last_row - region().first_row + 1; }
    std::size_t columns_here() const { return region().last_column - region().first_column + 1; }

    Vec3 place(double row, double column, double level) const {
        return {row * m_cloth.dx_mm, column * m_cloth.dy_mm, level * m_cloth.dz_mm};
    }

    LineSpacing spacing_of_columns() const {
        return {m_cloth.is_periodic[0], m_cloth.dx_mm, m_cloth.dz_mm, 2 * m_radii.warp_mm,
                share_of_line * m_cloth.dy_mm};
    }
    LineSpacing spacing_of_rows() const {
        return {m_cloth.is_periodic[1], m_cloth.dy_mm, m_cloth.dz_mm, 2 * m_radii.weft_mm,
                share_of_line * m_cloth.dx_mm};
    }

    void lay_warps() {
        for (std::size_t column = region().first_column; column <= region().last_column; ++column) {
            std::vector<LineYarn> yarns;
            for (std::size_t end = m_block.first_end(column); end < m_block.first_end(column + 1); ++end) {
                LineYarn yarn;
                for (std::size_t row = region().first_row; row <= region().last_row; ++row) {
                    yarn.levels.push_back(level_of(end, row, column));
                }
                yarns.push_back(std::move(yarn));
            }
            const std::vector<Lead> leads = lead_past(yarns, spacing_of_columns());
            for (std::size_t k = 0; k < leads.size(); ++k)
                lay_warp(m_block.first_end(column) + k, column, leads[k]);
        }
    }

    void lay_warp(std::size_t end, std::size_t column, const Lead& lead) {
        YarnCurve curve;
        curve.number = end;
        curve.type = m_design.warp.order.at(end);
        curve.is_periodic = m_cloth.is_periodic[0];
        if (curve.is_periodic) curve.shift.x() = m_cloth.size_mm[0];
        for (std::size_t k = 0; k < lead.level.size(); ++k) {
            KeyPoint key;
            const double row = static_cast<double>(region().first_row) +
                               static_cast<double>(k) / static_cast<double>(lead.keys);
            key.place = place(row, static_cast<double>(column), lead.level[k]);
            key.place.y() += lead.aside_mm[k];
            key.column = column;
            key.yarn = end;
            if (k % lead.keys == 0) {
                key.row = region().first_row + k / lead.keys;
                key.loose = m_places.is_loose(m_places.of_end(end, key.row, column), key.row, column);
            }
            curve.keys.push_back(key);
        }
        mark_between(curve);
        m_warps.push_back(std::move(curve));
        m_keys_of_warp.push_back(lead.keys);
    }

    /// What lies between two stacks is loose where the yarn is loose in both.
    static void mark_between(YarnCurve& curve) {
        const auto in_stack = [](const KeyPoint& key) {
            return key.row != KeyPoint::none && key.column != KeyPoint::none;
        };
        const std::size_t n = curve.keys.size();
        for (std::size_t k = 0; k < n; ++k) {
            if (!in_stack(curve.keys[k])) continue;
            std::size_t next = k + 1;
            while (next < n && !in_stack(curve.keys[next])) ++next;
            if (next == n && !curve.is_periodic) break;
            const bool loose = curve.keys[k].loose && curve.keys[next % n].loose;
            for (std::size_t i = k + 1; i < next; ++i) curve.keys[i].loose = loose;
        }
    }

    void find_parts(bool is_region) {
        const bool repeats = m_design.scene.boundary_x == Boundary::periodic;
        m_wefts = m_wraps ? wrapped_parts(m_block, m_picks, repeats) : straight_parts(m_block, m_picks);
        if (is_region) m_wefts = cut(m_wefts, region());
    }

    double level_of(const WeftPart& part, std::size_t column) const {
        const double level = m_settled ? m_settled->of_pick(part.pick, column)
                                       : static_cast<double>(m_places.of_pick(part.pick, part.row, column));
        // Two wefts of one pick share its slot, so they are a part of a slot apart, however thick slots are.
        return level + part.offset * (m_settled ? settled_gap : 1);
    }
    double level_of(std::size_t end, std::size_t row, std::size_t column) const {
        return m_settled ? m_settled->of_end(end, row) : static_cast<double>(m_places.of_end(end, row, column));
    }

    /// Whether picks, laid in their slots, run so steeply up and down that they would be far longer than what is woven.
    bool wefts_climb() const {
        double way = 0, straight = 0;
        for (const WeftPart& part : m_wefts.parts) {
            for (std::size_t column = part.first_column; column < part.last_column; ++column) {
                const double rise = (level_of(part, column + 1) - level_of(part, column)) * m_cloth.dz_mm;
                way += std::hypot(m_cloth.dy_mm, rise);
                straight += m_cloth.dy_mm;
            }
        }
        return way > steep * straight;
    }

    void settle_levels() {
        m_settled.emplace(m_block, region(), LevelSpacing{m_cloth.dx_mm, m_cloth.dy_mm, m_cloth.is_periodic});
    }

    void make_turn_shapes() {
        const double reach = std::min(0.5, (m_radii.warp_mm + m_radii.weft_mm) / m_cloth.dy_mm);
        m_turns = std::make_unique<TurnShapes>(
            m_block, m_wefts,
            [this](const WeftPart& part, std::size_t column) { return level_of(part, column); }, reach);
    }

    void lay_wefts() {
        lead_rows();
        m_wefts_laid.clear();
        std::vector<bool> is_laid(m_wefts.parts.size());
        // First the yarns that begin somewhere, then the rings.
        for (const bool rings : {false, true}) {
            for (std::size_t k = 0; k < m_wefts.parts.size(); ++k) {
                if (is_laid[k] || (!rings && turn_before(k) != WeftPart::none)) continue;
                lay_weft(k, is_laid);
            }
        }
        std::stable_sort(m_wefts_laid.begin(), m_wefts_laid.end(), [](const LaidWeft& a, const LaidWeft& b) {
            return a.curve.number < b.curve.number;
        });
    }

    /// Leads the picks of every row past one another.
    void lead_rows() {
        if (m_leads.empty()) m_leads.resize(m_wefts.parts.size());
        for (std::size_t first = 0, next = 0; first < m_wefts.parts.size(); first = next) {
            const std::size_t row = m_wefts.parts[first].row;
            std::vector<LineYarn> yarns;
            for (next = first; next < m_wefts.parts.size() && m_wefts.parts[next].row == row; ++next) {
                const WeftPart& part = m_wefts.parts[next];
                LineYarn yarn{part.first_column, {}};
                for (std::size_t column = part.first_column; column <= part.last_column; ++column) {
                    yarn.levels.push_back(level_of(part, column));
                }
                yarns.push_back(std::move(yarn));
            }
            std::vector<Lead> leads = lead_past(yarns, spacing_of_rows(), m_row_effort[row]);
            std::move(leads.begin(), leads.end(), m_leads.begin() + static_cast<std::ptrdiff_t>(first));
        }
    }

    std::size_t turn_before(std::size_t part) const {
        const WeftPart& p = m_wefts.parts[part];
        return p.turn[p.is_leftwards ? 1 : 0];
    }
    std::size_t turn_after(std::size_t part) const {
        const WeftPart& p = m_wefts.parts[part];
        return p.turn[p.is_leftwards ? 0 : 1];
    }

    /// The yarn that begins with this part, to its end or once round.
    void lay_weft(std::size_t begin, std::vector<bool>& is_laid) {
        LaidWeft weft;
        const WeftPart& first = m_wefts.parts[begin];
        weft.curve.system = System::weft;
        weft.curve.number = first.pick;
        weft.curve.type = m_design.weft.feeders.at(first.feeder).yarn;
        if (m_cloth.is_periodic[1]) {
            weft.curve.is_periodic = true;
            weft.curve.shift.y() = m_cloth.size_mm[1];
        }
        for (std::size_t part = begin;;) {
            is_laid[part] = true;
            lay_part(weft, part);
            const std::size_t turn = turn_after(part);
            if (turn == WeftPart::none) break;
            lay_turn(weft, turn);
            part = m_wefts.bends[turn].to;
            if (!is_laid[part]) continue;
            weft.curve.is_periodic = true;
            weft.curve.shift.x() = m_cloth.size_mm[0];
            break;
        }
        mark_between(weft.curve);
        m_wefts_laid.push_back(std::move(weft));
    }

    void lay_part(LaidWeft& weft, std::size_t number) {
        const WeftPart& part = m_wefts.parts[number];
        const Lead& lead = m_leads[number];
        const std::size_t n = lead.level.size();
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t k = m_wraps && part.is_leftwards ? n - 1 - i : i;
            KeyPoint key;
            const double column = static_cast<double>(part.first_column) +
                                  static_cast<double>(k) / static_cast<double>(lead.keys);
            key.place = place(static_cast<double>(part.row), column, lead.level[k]);
            key.place.x() += lead.aside_mm[k];
            key.row = part.row;
            key.yarn = part.pick;
            if (k % lead.keys == 0) {
                key.column = part.first_column + k / lead.keys;
                key.loose =
                    m_places.is_loose(m_places.of_pick(part.pick, key.row, key.column), key.row, key.column);
            }
            weft.curve.keys.push_back(key);
            weft.part.push_back(number);
            weft.turn.push_back(WeftPart::none);
        }
    }

    void lay_turn(LaidWeft& weft, std::size_t turn) {
        for (const Vec3& at : m_turns->keys(turn, m_turn_variant[turn])) {
            KeyPoint key;
            key.place = place(at.x(), at.y(), at.z());
            key.yarn = m_wefts.parts[m_wefts.bends[turn].from].pick;
            weft.curve.keys.push_back(key);
            weft.part.push_back(WeftPart::none);
            weft.turn.push_back(turn);
        }
    }

    /// Lays turns otherwise, and leads picks further aside, until no two yarns come too near. Where nothing
    /// helps, the way that keeps them farthest apart is taken.
    Status clear_turns() {
        const double least_mm = share_of_radius * m_radii.thinnest_mm;
        Way best;
        for (std::size_t tried = 0; tried < most_tries; ++tried) {
            assemble();
            const std::vector<CloseSegments> close = close_segments(m_cloth, least_mm);
            if (close.empty()) return {};
            const Meeting& nearest = std::ranges::min_element(close, {}, [](const CloseSegments& pair) {
                                         return pair.meeting.distance_mm;
                                     })->meeting;
            if (tried == 0 || nearest.distance_mm > best.distance_mm)
                best = {nearest.distance_mm, m_cloth.yarns[nearest.yarn].number, m_turn_variant,
                        m_row_effort};
            if (!change(close, tried % 2 == 0, tried >= tries_of_turns)) break;
            lay_wefts();
        }
        if (best.distance_mm < 1e-6 * least_mm)
            return invalid("found no way to lay the turns of the weft clear of one another",
                           "pick " + std::to_string(best.pick + 1));
        m_turn_variant = std::move(best.turn_variant);
        m_row_effort = std::move(best.row_effort);
        lay_wefts();
        return {};
    }

    /// Changes one of each pair, first the one yarn, then the other: a turn, or where neither turns (or
    /// `rows_too`) a row.
    bool change(const std::vector<CloseSegments>& close, bool other_first, bool rows_too) {
        m_is_changed.assign(m_turn_variant.size(), false);
        bool any = false;
        for (const CloseSegments& pair : close) {
            std::pair one{pair.meeting.yarn, pair.segment}, two{pair.meeting.other, pair.other_segment};
            if (other_first) std::swap(one, two);
            const bool turn = change_turn(one.first, one.second) || change_turn(two.first, two.second);
            const bool row = (!turn || rows_too) &&
                             (change_row(one.first, one.second) || change_row(two.first, two.second));
            any = any || turn || row;
        }
        return any;
    }

    bool change_turn(std::size_t yarn, std::size_t segment) {
        if (yarn >= m_wefts_laid.size()) return false;
        const LaidWeft& weft = m_wefts_laid[yarn];
        const std::size_t n = weft.turn.size();
        std::size_t turn = weft.turn[segment];
        if (turn == WeftPart::none) turn = weft.turn[(segment + 1) % n];
        if (turn == WeftPart::none) return false;
        if (!m_is_changed[turn]) ++m_turn_variant[turn];
        m_is_changed[turn] = true;
        return true;
    }

    bool change_row(std::size_t yarn, std::size_t segment) {
        if (yarn >= m_wefts_laid.size()) return false;
        const std::size_t row = m_wefts_laid[yarn].curve.keys[segment].row;
        if (row == KeyPoint::none) return false;
        std::size_t& effort = m_row_effort[row];
        if (effort == most_effort) return false;
        ++effort;
        return true;
    }

    /// Puts the yarns together and finds their crossings.
    void assemble() {
        m_cloth.yarns.clear();
        for (const LaidWeft& weft : m_wefts_laid) m_cloth.yarns.push_back(weft.curve);
        m_cloth.yarns.insert(m_cloth.yarns.end(), m_warps.begin(), m_warps.end());
        m_cloth.crossings.clear();
        for (std::size_t yarn = 0; yarn < m_wefts_laid.size(); ++yarn) find_crossings(yarn);
    }

    void find_crossings(std::size_t yarn) {
        const LaidWeft& weft = m_wefts_laid[yarn];
        for (std::size_t k = 0; k < weft.part.size(); ++k) {
            const KeyPoint& key = weft.curve.keys[k];
            if (weft.part[k] == WeftPart::none || key.column == KeyPoint::none) continue;
            const WeftPart& part = m_wefts.parts[weft.part[k]];
            const std::size_t height = m_places.of_pick(part.pick, key.row, key.column);
            for (std::size_t end = std::max(part.first_end, m_block.first_end(key.column));
                 end <= part.last_end && end < m_block.first_end(key.column + 1); ++end) {
                const std::size_t warp = end - m_block.first_end(region().first_column);
                m_cloth.crossings.push_back({yarn, k, m_wefts_laid.size() + warp,
                                             (key.row - region().first_row) * m_keys_of_warp[warp], part.pick,
                                             end, height > m_places.of_end(end, key.row, key.column)});
            }
        }
    }

    const Design& m_design;
    const Block& m_block;
    std::vector<Pick> m_picks;
    Places m_places;
    std::optional<SettledLevels> m_settled;
    Radii m_radii;
    bool m_wraps;
    ClothCurves m_cloth;
    std::vector<YarnCurve> m_warps;
    std::vector<std::size_t> m_keys_of_warp;  ///< per stack, of each warp
    WeftParts m_wefts;
    std::vector<Lead> m_leads;  ///< of each part
    std::unique_ptr<TurnShapes> m_turns;
    std::vector<std::size_t> m_turn_variant, m_row_effort;
    std::vector<bool> m_is_changed;  ///< turns that were laid otherwise in this try
    std::vector<LaidWeft> m_wefts_laid;
};

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

Result<ClothCurves> cloth_curves(const Design& design, const Block& block, const CurveOptions& options) {
    WEAVE_CHECK_OK(check(block, options));
    return Layout(design, block, options).curves();
}

}  // namespace weave
