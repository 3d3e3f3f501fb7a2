#include <weave/sim/take_up.hpp>

#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/design/picks.hpp>
#include <weave/sim/report_words.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace weave {

namespace {

bool reports(const Yarns& yarns, const char* name) {
    const auto found = yarns.report.find(name);
    return found != yarns.report.end() && found->is_boolean() && found->get<bool>();
}

Status check_fit(const Yarns& yarns, const Design& design) {
    const std::string own = design_sha256(design);
    if (yarns.design_sha256 != own) {
        const std::string of = yarns.design_sha256.empty()
                                   ? "do not tell their design"
                                   : "are of design " + yarns.design_sha256.substr(0, 12) + "…";
        return bad_input(
            "these yarns " + of + ", and this design is " + own.substr(0, 12) + "…: simulate it anew",
            "design_sha256");
    }
    const Region& region = yarns.region;
    if (region.first_row != 0 || region.first_column != 0 || region.last_row + 1 != yarns.cloth_rows ||
        region.last_column + 1 != yarns.cloth_columns)
        return bad_input("these yarns are only a part of the cloth", "region");
    if (!reports(yarns, "converged"))
        return bad_input("these yarns are not at rest: simulate on", "report.converged");
    if (!reports(yarns, "order_kept"))
        return bad_input("crossings of these yarns are no longer as the card says", "report.order_kept");
    return {};
}

/// The picks that each weft yarn crosses, from its first on.
Result<std::vector<std::set<std::size_t>>> picks_of(const Yarns& yarns, std::size_t picks) {
    std::vector<std::set<std::size_t>> all(yarns.yarns.size());
    for (std::size_t y = 0; y < all.size(); ++y) {
        if (yarns.yarns[y].system != System::weft) continue;
        if (yarns.yarns[y].number >= picks)
            return bad_input("is a pick that the design does not have", indexed("yarns", y));
        all[y].insert(yarns.yarns[y].number);
    }
    for (std::size_t i = 0; i < yarns.crossings.size(); ++i) {
        const Crossing& crossing = yarns.crossings[i];
        if (crossing.pick >= picks)
            return bad_input("is at a pick that the design does not have", indexed("crossings", i));
        all[crossing.weft].insert(crossing.pick);
    }
    return all;
}

/// Takes feeders from the picks of a design, each once.
class FeederFinder {
  public:
    FeederFinder(const Design& design, const Block& block)
        : m_design(design), m_picks(pick_table(design, block)), m_taken(m_picks.size()) {}

    /// The feeder of a yarn, which none of its picks gives again; nothing where they have none in common.
    std::optional<std::uint32_t> take(const SimulatedYarn& yarn, const std::set<std::size_t>& picks) {
        std::optional<std::uint32_t> best;
        for (const std::uint32_t feeder : m_picks[yarn.number].feeders) {
            const auto has_it = [&](std::size_t pick) {
                const auto& feeders = m_picks[pick].feeders;
                return std::ranges::find(feeders, feeder) != feeders.end() && !m_taken[pick].contains(feeder);
            };
            if (!std::ranges::all_of(picks, has_it)) continue;
            if (!best || (looks_like(*best, yarn) < looks_like(feeder, yarn)) ||
                (looks_like(*best, yarn) == looks_like(feeder, yarn) && feeder < *best))
                best = feeder;
        }
        for (const std::size_t pick : picks) {
            if (best) m_taken[pick].insert(*best);
        }
        return best;
    }

    /// Picks of one feeder that no yarn has taken.
    [[nodiscard]] std::vector<std::size_t> left() const {
        std::vector<std::size_t> counts(m_design.weft.feeders.size(), 0);
        for (std::size_t pick = 0; pick < m_picks.size(); ++pick) {
            for (const std::uint32_t feeder : m_picks[pick].feeders)
                counts[feeder] += m_taken[pick].contains(feeder) ? 0 : 1;
        }
        return counts;
    }

  private:
    [[nodiscard]] int looks_like(std::uint32_t feeder, const SimulatedYarn& yarn) const {
        const YarnType& type = m_design.weft.yarns[m_design.weft.feeders[feeder].yarn];
        const double radius = type.radius_mm * m_design.scene.weft.radius_scale.value_or(1);
        return (type.colour == yarn.colour ? 1 : 0) +
               (std::abs(radius - yarn.radius_mm) <= 1e-9 * radius ? 1 : 0);
    }

    const Design& m_design;
    std::vector<Pick> m_picks;
    std::vector<std::set<std::uint32_t>> m_taken;  ///< by pick
};

Result<std::vector<double>> from_feeders(const Yarns& yarns, const Design& design, const Block& block,
                                         double width_mm) {
    FeederFinder finder(design, block);
    WEAVE_TRY(const auto picks, picks_of(yarns, block.picks()));
    std::vector<double> lengths(design.weft.feeders.size(), 0);
    for (std::size_t y = 0; y < picks.size(); ++y) {
        if (picks[y].empty()) continue;
        const auto feeder = finder.take(yarns.yarns[y], picks[y]);
        if (!feeder) return bad_input("is a weft of no feeder of the design", indexed("yarns", y));
        lengths[*feeder] += yarns.yarns[y].rest_length_mm;
    }
    const std::vector<std::size_t> left = finder.left();
    for (std::size_t feeder = 0; feeder < left.size(); ++feeder)
        lengths[feeder] += static_cast<double>(left[feeder]) * width_mm;
    return lengths;
}

/// The width of the cloth: what it repeats after, or where its rims are free how far its outermost columns
/// lie apart, and half a column on either side.
void find_width(const Yarns& yarns, const Block& block, RelaxedCloth& cloth) {
    const std::string boundary = sim::plan_choice(yarns.report, "boundary y");
    cloth.width_mm = yarns.size_mm[1];
    cloth.width_found = boundary == "periodic, relaxing";
    if (yarns.is_periodic[1] || boundary != "free" || block.columns() < 2) return;
    const std::size_t last = block.columns() - 1;
    double sum[2]{}, count[2]{};
    for (const SimulatedYarn& yarn : yarns.yarns) {
        if (yarn.system != System::warp) continue;
        for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
            const std::size_t column = side == 0 ? 0 : last;
            if (yarn.number < block.first_end(column) || yarn.number >= block.first_end(column + 1)) continue;
            for (const Vec3& place : yarn.spline.control) sum[side] += place.y();
            count[side] += static_cast<double>(yarn.spline.control.size());
        }
    }
    if (!(count[0] > 0 && count[1] > 0)) return;
    const auto columns = static_cast<double>(block.columns());
    cloth.width_mm = (sum[1] / count[1] - sum[0] / count[0]) * columns / (columns - 1);
    cloth.width_found = true;
}

}  // namespace

double take_up_of(const SimulatedYarn& yarn) {
    const Spline& spline = yarn.spline;
    const double cloth =
        spline.is_periodic ? spline.shift.norm() : (spline.control.back() - spline.control.front()).norm();
    return cloth > 0 ? (yarn.length_mm - cloth) / cloth : 0;
}

Result<RelaxedCloth> relaxed_cloth(const Yarns& yarns, const Design& design, const Block& block) {
    WEAVE_CHECK_OK(check_fit(yarns, design));
    RelaxedCloth cloth;
    cloth.length_mm = yarns.size_mm[0];
    cloth.take_up.assign(block.ends(), std::numeric_limits<double>::quiet_NaN());
    cloth.end_mm = cloth.take_up;
    for (std::size_t y = 0; y < yarns.yarns.size(); ++y) {
        const SimulatedYarn& yarn = yarns.yarns[y];
        if (yarn.system != System::warp) continue;
        if (yarn.number >= block.ends())
            return bad_input("is an end that the design does not have", indexed("yarns", y));
        cloth.take_up[yarn.number] = take_up_of(yarn);
        cloth.end_mm[yarn.number] = yarn.rest_length_mm;
    }
    find_width(yarns, block, cloth);
    WEAVE_TRY(cloth.feeder_mm, from_feeders(yarns, design, block, cloth.width_mm));
    return cloth;
}

}  // namespace weave
