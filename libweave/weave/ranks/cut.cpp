#include <weave/ranks/cut.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace weave::ranks {

namespace {

constexpr std::int64_t reach = 3;  ///< points before and after one that its segments reach

/// Borders of so many parts with as many places each, on an axis.
std::vector<double> borders_of(std::vector<double> places, std::size_t parts) {
    std::sort(places.begin(), places.end());
    std::vector<double> borders;
    for (std::size_t k = 1; k < parts; ++k) borders.push_back(places[places.size() * k / parts]);
    return borders;
}

std::size_t part_of(const std::vector<double>& borders, double place) {
    return static_cast<std::size_t>(std::upper_bound(borders.begin(), borders.end(), place) - borders.begin());
}

/// The block of each point.
class Cutter {
  public:
    Cutter(const std::vector<sim::SimYarn>& yarns, const std::array<std::size_t, 2>& blocks) : m_blocks(blocks) {
        std::vector<double> x;
        each(yarns, [&](const Vec3& place) { x.push_back(place.x()); });
        m_rows = borders_of(std::move(x), blocks[0]);
        std::vector<std::vector<double>> y(blocks[0]);
        each(yarns, [&](const Vec3& place) { y[part_of(m_rows, place.x())].push_back(place.y()); });
        for (std::vector<double>& places : y) {
            if (places.empty()) places.push_back(0);
            m_columns.push_back(borders_of(std::move(places), blocks[1]));
        }
    }
    [[nodiscard]] std::uint32_t block(const Vec3& place) const {
        const std::size_t strip = part_of(m_rows, place.x());
        return static_cast<std::uint32_t>(strip * m_blocks[1] + part_of(m_columns[strip], place.y()));
    }

  private:
    template <class Visit>
    static void each(const std::vector<sim::SimYarn>& yarns, const Visit& visit) {
        for (const sim::SimYarn& yarn : yarns) {
            for (const Vec3& place : yarn.control) visit(place);
        }
    }
    std::array<std::size_t, 2> m_blocks;
    std::vector<double> m_rows;
    std::vector<std::vector<double>> m_columns;
};

/// Blocks that are about as long as wide.
std::array<std::size_t, 2> blocks_for(std::size_t points, std::size_t points_a_block, const std::array<double, 2>& size) {
    const double wanted = std::max(1.0, std::round(static_cast<double>(points) / static_cast<double>(points_a_block)));
    const double along = std::sqrt(wanted * std::max(1e-9, size[0]) / std::max(1e-9, size[1]));
    const double strips = std::clamp(std::round(along), 1.0, wanted);
    return {static_cast<std::size_t>(strips), static_cast<std::size_t>(std::max(1.0, std::round(wanted / strips)))};
}

Status check(const sim::Plan& plan) {
    const auto refuse = [](const char* what) {
        return Error{ErrorCode::usage, std::string(what) + " is not computed by several processes together: run it without mpirun", {}};
    };
    if (plan.scene.friction > 0) return refuse("friction");
    if (plan.scene.transition) return refuse("a flip");
    if (plan.rim_force_N[0] || plan.rim_force_N[1]) return refuse("a period that relaxes");
    return {};
}

Cut cut_of(const sim::Plan& plan, std::size_t points_a_block) {
    Cut cut;
    cut.terms = plan.scene;
    cut.terms.yarns.clear();
    cut.low = {1e300, 1e300};
    cut.high = {-1e300, -1e300};
    cut.terms.least_radius_mm = 1e300;
    std::size_t points = 0;
    for (const sim::SimYarn& yarn : plan.scene.yarns) {
        sim::SimYarn bare = yarn;
        bare.control.clear();
        bare.frozen.clear();
        const std::size_t count = yarn.control.size();
        bare.whole_segments = yarn.is_periodic ? count : std::max<std::size_t>(1, count) - 1;
        cut.yarns.push_back(std::move(bare));
        cut.points.push_back(static_cast<std::uint32_t>(count));
        points += count;
        cut.terms.least_radius_mm = std::min(cut.terms.least_radius_mm, yarn.radius_mm);
        for (const Vec3& place : yarn.control) {
            for (std::size_t k = 0; k < 2; ++k) {
                cut.low[k] = std::min(cut.low[k], place[static_cast<Eigen::Index>(k)]);
                cut.high[k] = std::max(cut.high[k], place[static_cast<Eigen::Index>(k)]);
            }
        }
    }
    cut.blocks = blocks_for(points, points_a_block, {cut.high[0] - cut.low[0], cut.high[1] - cut.low[1]});
    return cut;
}

/// Deals the points of one yarn out to the parts from block `first` on.
class Dealer {
  public:
    Dealer(const Cutter& cutter, std::size_t first, std::vector<Part>& parts) : m_cutter(cutter), m_first(first), m_parts(parts) {}

    void deal(const sim::SimYarn& yarn, std::uint32_t number) {
        const auto count = static_cast<std::int64_t>(yarn.control.size());
        std::vector<std::uint32_t> blocks;
        for (const Vec3& place : yarn.control) blocks.push_back(m_cutter.block(place));
        const auto point = [&](std::int64_t index) {
            const auto at = static_cast<std::size_t>(index);
            return Point{number, static_cast<std::uint32_t>(at), blocks[at], !yarn.frozen.empty() && yarn.frozen[at] != 0, yarn.control[at]};
        };
        std::set<std::pair<std::uint32_t, std::int64_t>> seen;
        for (std::int64_t i = 0; i < count; ++i) {
            const std::uint32_t block = blocks[static_cast<std::size_t>(i)];
            if (!has(block)) continue;
            part(block).own.push_back(point(i));
            for (std::int64_t j = i - reach; j <= i + reach; ++j) {
                if (!yarn.is_periodic && (j < 0 || j >= count)) continue;
                const std::int64_t turns = j >= 0 ? j / count : -((count - 1 - j) / count), index = j - turns * count;
                if (turns == 0 && blocks[static_cast<std::size_t>(index)] == block) continue;
                if (seen.emplace(block, j).second) part(block).along.push_back({point(index), static_cast<std::int32_t>(turns), {}});
            }
        }
    }

  private:
    [[nodiscard]] bool has(std::uint32_t block) const { return block >= m_first && block < m_first + m_parts.size(); }
    [[nodiscard]] Part& part(std::uint32_t block) const { return m_parts[block - m_first]; }

    const Cutter& m_cutter;
    std::size_t m_first;
    std::vector<Part>& m_parts;
};

}  // namespace

Result<CutPlan> cut_plan(const sim::Plan& plan, std::size_t rank, std::size_t ranks, std::size_t points_a_block) {
    WEAVE_CHECK_OK(check(plan));
    CutPlan result{cut_of(plan, points_a_block), {}};
    const auto [first, last] = result.cut.blocks_of(rank, ranks);
    result.parts.resize(last - first);
    const Cutter cutter(plan.scene.yarns, result.cut.blocks);
    Dealer dealer(cutter, first, result.parts);
    for (std::uint32_t y = 0; y < plan.scene.yarns.size(); ++y) dealer.deal(plan.scene.yarns[y], y);
    return result;
}

}  // namespace weave::ranks
