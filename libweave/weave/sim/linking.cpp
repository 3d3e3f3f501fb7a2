#include <weave/sim/linking.hpp>

#include <weave/curve/wrapped.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace weave::sim {

namespace {

constexpr int pieces_a_segment = 8;
/// Looked at from a little aside: planned yarns often lie exactly one over another.
constexpr double aside_x = 0.0137, aside_y = 0.0071;

/// A short straight piece of a yarn.
struct Piece {
    std::size_t yarn = 0;
    Vec3 from{0, 0, 0}, along{0, 0, 0};
};

std::vector<Piece> pieces_of(const std::vector<Spline>& yarns) {
    std::vector<Piece> pieces;
    for (std::size_t y = 0; y < yarns.size(); ++y) {
        const Spline& spline = yarns[y];
        const std::size_t count = pieces_a_segment * spline.segments();
        // Off the knots, so that a vertex on another yarn's straight line, which would count twice or not at
        // all, is rare.
        const auto place = [&](std::size_t k) {
            const Vec3 at =
                spline.place((static_cast<double>(k) + (spline.is_periodic ? 0.382 : 0)) / pieces_a_segment);
            return Vec3(at.x() + aside_x * at.z(), at.y() + aside_y * at.z(), at.z());
        };
        for (std::size_t k = 0; k < count; ++k) {
            const Vec3 from = place(k);
            pieces.push_back({y, from, place(k + 1) - from});
        }
    }
    return pieces;
}

double turn(const Vec3& a, const Vec3& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// 1 or -1 where two pieces cross, seen from above, the second moved; else 0.
int crossing(const Piece& first, const Piece& second, const Vec3& moved) {
    const Vec3 &u = first.along, &v = second.along, w = second.from + moved - first.from;
    const double det = turn(u, v);
    if (det == 0) return 0;
    const double along = turn(w, v) / det, other = turn(w, u) / det;
    if (along < 0 || along >= 1 || other < 0 || other >= 1) return 0;
    const double height = along * u.z() - w.z() - other * v.z();
    return (det > 0) == (height > 0) ? 1 : -1;
}

/// Pieces by the cell over which their middle lies, periods folded into one.
class Cells {
  public:
    Cells(const std::vector<Piece>& pieces, const std::array<double, 2>& period) {
        double longest = 1e-9;
        for (const Piece& piece : pieces)
            longest = std::max(longest, std::hypot(piece.along.x(), piece.along.y()));
        for (std::size_t k = 0; k < 2; ++k) {
            m_around[k] =
                period[k] > 0 ? std::max<std::int64_t>(1, static_cast<std::int64_t>(period[k] / longest)) : 0;
            m_width[k] = m_around[k] > 0 ? period[k] / static_cast<double>(m_around[k]) : longest;
        }
        for (std::uint32_t p = 0; p < pieces.size(); ++p) m_members[key(cell_of(pieces[p]))].push_back(p);
    }

    /// visit(other) for each piece that may cross one, once.
    template <class Visit>
    void each_near(const Piece& piece, const Visit& visit) const {
        const std::array<std::int64_t, 2> cell = cell_of(piece);
        for (std::int64_t i = first(0); i <= 1; ++i) {
            for (std::int64_t j = first(1); j <= 1; ++j) {
                const auto found = m_members.find(key({folded(cell[0] + i, 0), folded(cell[1] + j, 1)}));
                if (found == m_members.end()) continue;
                for (const std::uint32_t other : found->second) visit(other);
            }
        }
    }

  private:
    /// Around a period of one or two cells the neighbour before is the one after, or the cell itself.
    [[nodiscard]] std::int64_t first(std::size_t k) const {
        return m_around[k] == 1 ? 1 : m_around[k] == 2 ? 0 : -1;
    }
    [[nodiscard]] std::int64_t folded(std::int64_t cell, std::size_t k) const {
        return m_around[k] > 0 ? wrapped(cell, m_around[k]).index : cell;
    }
    /// Bounded, so that cells can be counted on from, however wild the yarns.
    [[nodiscard]] std::array<std::int64_t, 2> cell_of(const Piece& piece) const {
        constexpr double most = 1e15;
        std::array<std::int64_t, 2> cell{};
        for (std::size_t k = 0; k < 2; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            const double place = std::floor((piece.from[axis] + piece.along[axis] / 2) / m_width[k]);
            cell[k] = folded(static_cast<std::int64_t>(std::clamp(place, -most, most)), k);
        }
        return cell;
    }
    static std::uint64_t key(const std::array<std::int64_t, 2>& cell) {
        return (static_cast<std::uint64_t>(cell[0]) << 32U) ^ static_cast<std::uint32_t>(cell[1]);
    }

    std::array<double, 2> m_width{};
    std::array<std::int64_t, 2> m_around{};
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> m_members;
};

/// The whole number of periods nearest to a distance. Bounded, so that products of two of them are numbers still,
/// however wild the yarns.
int periods_in(double distance, double period) {
    constexpr double most = 1e9;
    return static_cast<int>(std::lround(std::clamp(distance / period, -most, most)));
}

/// By how many periods the second piece is to be moved to come nearest to the first.
std::array<int, 2> image_near(const Piece& first, const Piece& second, const std::array<double, 2>& period) {
    const Vec3 apart = first.from + first.along / 2 - second.from - second.along / 2;
    std::array<int, 2> image{};
    for (std::size_t k = 0; k < 2; ++k) {
        if (period[k] > 0) image[k] = periods_in(apart[static_cast<Eigen::Index>(k)], period[k]);
    }
    return image;
}

/// A yarn's own way on is no other strand: a loop that it lays in itself comes and goes freely.
bool is_same_strand(const Spline& yarn, const std::array<int, 2>& image,
                    const std::array<double, 2>& period) {
    if (image == std::array<int, 2>{}) return true;
    if (!yarn.is_periodic) return false;
    std::array<std::int64_t, 2> turns{};
    for (std::size_t k = 0; k < 2; ++k) {
        if (period[k] > 0) turns[k] = periods_in(yarn.shift[static_cast<Eigen::Index>(k)], period[k]);
    }
    return image[0] * turns[1] == image[1] * turns[0];
}

}  // namespace

Linking linking_of(const std::vector<Spline>& yarns, const std::array<double, 2>& period_mm) {
    const std::vector<Piece> pieces = pieces_of(yarns);
    const Cells cells(pieces, period_mm);
    Linking linking;
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
        const Piece& piece = pieces[p];
        cells.each_near(piece, [&](std::uint32_t q) {
            const Piece& other = pieces[q];
            if (other.yarn > piece.yarn || (other.yarn == piece.yarn && q >= p)) return;
            const std::array<int, 2> image = image_near(piece, other, period_mm);
            if (other.yarn == piece.yarn && is_same_strand(yarns[piece.yarn], image, period_mm)) return;
            const int sign =
                crossing(piece, other, Vec3(image[0] * period_mm[0], image[1] * period_mm[1], 0));
            if (sign != 0) linking[{piece.yarn, other.yarn}] += sign;
        });
    }
    std::erase_if(linking, [](const auto& entry) { return entry.second == 0; });
    return linking;
}

Linking linking_of(const SimScene& scene, const std::vector<std::vector<Vec3>>& control) {
    std::vector<Spline> yarns;
    for (std::size_t y = 0; y < control.size(); ++y)
        yarns.push_back({control[y], scene.yarns[y].is_periodic, scene.yarns[y].shift});
    std::array<double, 2> period{};
    for (std::size_t k = 0; k < 2; ++k) period[k] = scene.is_periodic[k] ? scene.period_mm[k] : 0;
    return linking_of(yarns, period);
}

}  // namespace weave::sim
