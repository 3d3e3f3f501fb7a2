#include <weave/ranks/cut.hpp>

#include <weave/core/sha256.hpp>
#include <weave/curve/wrapped.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace weave::ranks {

namespace {

constexpr std::int64_t reach = 3;  ///< points before and after one that its segments reach
static_assert(reach == sim::PlanInStretches::others);

const Vec3& place_of(const sim::Stretch& stretch, std::size_t index) {
    return stretch.control[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(index) - stretch.begin)];
}

/// Counts places along an axis, finely enough for borders between them.
class Tally {
  public:
    Tally(double low, double high, std::size_t bins) : m_low(low), m_step(std::max(1e-9, high - low) / static_cast<double>(bins)), m_counts(bins, 0) {}
    void add(double place) {
        const auto bin = static_cast<std::ptrdiff_t>(std::floor((place - m_low) / m_step));
        ++m_counts[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(bin, 0, static_cast<std::ptrdiff_t>(m_counts.size()) - 1))];
        ++m_all;
    }
    /// Borders of so many parts with about as many places each.
    [[nodiscard]] std::vector<double> borders(std::size_t parts) const {
        std::vector<double> found;
        std::uint64_t before = 0;
        for (std::size_t bin = 0; bin < m_counts.size() && found.size() + 1 < parts; ++bin) {
            while (found.size() + 1 < parts && before + m_counts[bin] / 2 >= m_all * (found.size() + 1) / parts) found.push_back(m_low + static_cast<double>(bin) * m_step);
            before += m_counts[bin];
        }
        found.resize(parts - 1, m_low + static_cast<double>(m_counts.size()) * m_step);
        return found;
    }

  private:
    double m_low, m_step;
    std::vector<std::uint32_t> m_counts;
    std::uint64_t m_all = 0;
};

std::size_t part_of(const std::vector<double>& borders, double place) {
    return static_cast<std::size_t>(std::upper_bound(borders.begin(), borders.end(), place) - borders.begin());
}

/// The block of each point.
class Cutter {
  public:
    Cutter(const sim::PlanInStretches& plan, const Cut& cut) : m_blocks(cut.blocks) {
        Tally x(cut.low[0], cut.high[0], bins_of_rows);
        each(plan, [&](const Vec3& place) { x.add(place.x()); });
        m_rows = x.borders(m_blocks[0]);
        std::vector<Tally> y(m_blocks[0], Tally(cut.low[1], cut.high[1], bins_of_columns));
        each(plan, [&](const Vec3& place) { y[part_of(m_rows, place.x())].add(place.y()); });
        for (const Tally& strip : y) m_columns.push_back(strip.borders(m_blocks[1]));
    }
    [[nodiscard]] std::uint32_t block(const Vec3& place) const {
        const std::size_t strip = part_of(m_rows, place.x());
        return static_cast<std::uint32_t>(strip * m_blocks[1] + part_of(m_columns[strip], place.y()));
    }

  private:
    static constexpr std::size_t bins_of_rows = 1 << 16, bins_of_columns = 1 << 12;

    template <class Visit>
    static void each(const sim::PlanInStretches& plan, const Visit& visit) {
        plan.each_stretch([&](const sim::Stretch& stretch) {
            for (std::size_t i = stretch.first; i < stretch.last; ++i) visit(place_of(stretch, i));
        });
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
    if (plan.rim_force_N[0] || plan.rim_force_N[1]) return refuse("a period that relaxes");
    return {};
}

Cut cut_of(const sim::PlanInStretches& stretches, std::size_t points_a_block) {
    const sim::Plan& plan = stretches.plan();
    Cut cut;
    cut.terms = plan.scene;
    cut.yarns = std::exchange(cut.terms.yarns, {});
    cut.terms.least_radius_mm = 1e300;
    std::size_t points = 0;
    for (std::size_t y = 0; y < cut.yarns.size(); ++y) {
        const std::size_t count = stretches.points(y);
        cut.yarns[y].whole_segments = cut.yarns[y].is_periodic ? count : std::max<std::size_t>(1, count) - 1;
        cut.points.push_back(static_cast<std::uint32_t>(count));
        points += count;
        cut.terms.least_radius_mm = std::min(cut.terms.least_radius_mm, cut.yarns[y].radius_mm);
    }
    for (std::size_t k = 0; k < 2; ++k) {
        cut.low[k] = stretches.box().min()[static_cast<Eigen::Index>(k)];
        cut.high[k] = stretches.box().max()[static_cast<Eigen::Index>(k)];
    }
    cut.blocks = blocks_for(points, points_a_block, {cut.high[0] - cut.low[0], cut.high[1] - cut.low[1]});
    return cut;
}

/// Deals points out to the parts from block `first` on, yarn by yarn and along each.
class Dealer {
  public:
    Dealer(const Cutter& cutter, const Cut& cut, std::size_t first, std::vector<Part>& parts) : m_cutter(cutter), m_cut(cut), m_first(first), m_parts(parts) {}

    void deal(const sim::Stretch& stretch) {
        if (stretch.first == 0) m_seen.clear();
        std::vector<Point> points;
        const auto count = static_cast<std::int64_t>(m_cut.points[stretch.yarn]);
        for (std::size_t k = 0; k < stretch.control.size(); ++k) {
            const std::int64_t index = wrapped(stretch.begin + static_cast<std::int64_t>(k), count).index;
            points.push_back({static_cast<std::uint32_t>(stretch.yarn), static_cast<std::uint32_t>(index), m_cutter.block(stretch.control[k]),
                              stretch.frozen[k] != 0, stretch.control[k]});
        }
        const auto at = [&](std::int64_t i) -> const Point& { return points[static_cast<std::size_t>(i - stretch.begin)]; };
        const std::int64_t end = stretch.begin + static_cast<std::int64_t>(points.size());
        for (auto i = static_cast<std::int64_t>(stretch.first); i < static_cast<std::int64_t>(stretch.last); ++i) {
            const std::uint32_t block = at(i).block;
            if (!has(block)) continue;
            part(block).own.push_back(at(i));
            for (std::int64_t j = std::max<std::int64_t>(i - reach, stretch.begin); j < std::min(i + reach + 1, end); ++j) {
                const std::int64_t turns = wrapped(j, count).round;
                if (turns == 0 && at(j).block == block) continue;
                if (m_seen.emplace(block, j).second) part(block).along.push_back({at(j), static_cast<std::int32_t>(turns), {}});
            }
        }
    }

  private:
    [[nodiscard]] bool has(std::uint32_t block) const { return block >= m_first && block < m_first + m_parts.size(); }
    [[nodiscard]] Part& part(std::uint32_t block) const { return m_parts[block - m_first]; }

    const Cutter& m_cutter;
    const Cut& m_cut;
    std::size_t m_first;
    std::vector<Part>& m_parts;
    std::set<std::pair<std::uint32_t, std::int64_t>> m_seen;  ///< along this yarn
};

void add(const sim::Stretch& stretch, Sha256& hash) {
    const auto own = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(stretch.first) - stretch.begin), count = stretch.last - stretch.first;
    hash.add({reinterpret_cast<const char*>(&stretch.control[own]), count * sizeof(Vec3)});
    hash.add({reinterpret_cast<const char*>(&stretch.frozen[own]), count});
}

}  // namespace

Result<CutPlan> cut_plan(const sim::PlanInStretches& plan, std::size_t rank, std::size_t ranks, std::size_t points_a_block) {
    WEAVE_CHECK_OK(check(plan.plan()));
    CutPlan result{cut_of(plan, points_a_block), {}};
    const auto [first, last] = result.cut.blocks_of(rank, ranks);
    result.parts.resize(last - first);
    const Cutter cutter(plan, result.cut);
    Dealer dealer(cutter, result.cut, first, result.parts);
    Sha256 hash;
    plan.each_stretch([&](const sim::Stretch& stretch) {
        dealer.deal(stretch);
        add(stretch, hash);
    });
    result.cut.sha256 = hash.hex();
    return result;
}

}  // namespace weave::ranks
