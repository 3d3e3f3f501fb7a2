#include <weave/sim/neighbourhood.hpp>

#include <weave/sim/fabric.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

/// Points beyond what may be touched: a cut end runs on straight, which bends the last segment.
constexpr std::size_t margin = 2;

/// From a place, or the nearest of its images, to a point.
Vec3 from_nearest_image(const SimScene& scene, const Vec3& point, const Vec3& place) {
    Vec3 apart = point - place;
    for (std::size_t k = 0; k < 2; ++k) {
        double& part = apart[static_cast<Eigen::Index>(k)];
        if (scene.is_periodic[k]) part = std::remainder(part, scene.period_mm[k]);
    }
    return apart;
}

class Cutting {
  public:
    Cutting(const SimScene& scene, const Vec3& place, double moving_mm) : m_scene(scene), m_place(place), m_moving(moving_mm) {
        double thickest = 0, longest = 0;
        for (const SimYarn& yarn : scene.yarns) {
            thickest = std::max(thickest, yarn.radius_mm);
            for (std::size_t i = 0; i + 1 < yarn.control.size(); ++i)
                longest = std::max(longest, (yarn.control[i + 1] - yarn.control[i]).norm());
        }
        // A point moves the curve up to two segments away.
        m_outer = moving_mm + 2 * thickest + 2 * longest;
        const bool is_large = [&] {
            for (std::size_t axis = 0; axis < 2; ++axis) {
                if (scene.is_periodic[axis] && scene.period_mm[axis] < 2 * m_outer + 2 * (margin + 2) * longest) return false;
            }
            return scene.fields.empty();
        }();
        m_part.scene = scene;
        m_part.scene.yarns.clear();
        m_part.scene.transition.reset();
        m_part.scene.slip_from.reset();
        if (is_large) m_part.scene.is_periodic = {false, false};
        for (std::size_t y = 0; y < scene.yarns.size(); ++y) is_large ? cut(y) : keep(y);
    }

    Neighbourhood part() { return std::move(m_part); }

  private:
    [[nodiscard]] Vec3 apart(const Vec3& point) const { return from_nearest_image(m_scene, point, m_place); }

    [[nodiscard]] static std::uint8_t is_frozen(const SimYarn& yarn, std::size_t point) {
        return yarn.frozen.empty() ? 0 : yarn.frozen[point];
    }

    /// The whole yarn, if it comes near.
    void keep(std::size_t y) {
        SimYarn yarn = m_scene.yarns[y];
        bool is_near = false;
        yarn.frozen.resize(yarn.control.size(), 0);
        for (std::size_t i = 0; i < yarn.control.size(); ++i) {
            const double far = apart(yarn.control[i]).norm();
            if (far > m_moving) yarn.frozen[i] = 1;
            is_near = is_near || far < m_outer;
        }
        if (!is_near) return;
        m_part.scene.yarns.push_back(std::move(yarn));
        m_part.pieces.push_back({y, 0, {0, 0, 0}});
    }

    /// Each stretch of a yarn that comes near, with a margin. Where a periodic yarn begins counts for nothing.
    void cut(std::size_t y) {
        const SimYarn& yarn = m_scene.yarns[y];
        const std::size_t n = yarn.control.size();
        std::vector<std::uint8_t> taken(n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            if (apart(yarn.control[i]).norm() >= m_outer) continue;
            for (std::size_t k = 0; k <= 2 * margin; ++k) {
                const std::size_t at = i + n + k - margin;
                if (yarn.is_periodic || (at >= n && at < 2 * n)) taken[at % n] = 1;
            }
        }
        std::size_t begin = 0;
        while (yarn.is_periodic && begin < n && taken[begin] != 0) ++begin;
        if (begin == n && n > 0) return keep(y);  // all of it lies near, as no straight yarn of a large scene does
        for (std::size_t k = 0; k < n;) {
            std::size_t length = 0;
            while (k + length < n && taken[(begin + k + length) % n] != 0) ++length;
            if (length > 1) add(y, (begin + k) % n, length);
            k += length + 1;
        }
    }

    void add(std::size_t y, std::size_t first, std::size_t points) {
        const SimYarn& whole = m_scene.yarns[y];
        const std::size_t n = whole.control.size();
        SimYarn piece = whole;
        piece.control.clear();
        piece.frozen.clear();
        piece.is_periodic = false;
        piece.shift.setZero();
        piece.turns = {0, 0};
        const double segments = static_cast<double>(whole.is_periodic ? n : n - 1),
                     share = static_cast<double>(points - 1) / segments;
        piece.planned_mm = share * (whole.planned_mm > 0 ? whole.planned_mm : control_length(whole));
        piece.rest_mm = share * whole.rest_mm;
        const auto at = [&](std::size_t i) -> Vec3 {
            return whole.control[(first + i) % n] + static_cast<double>((first + i) / n) * whole.shift;
        };
        const Vec3 middle = at(points / 2), moved = m_place + apart(middle) - middle;
        for (std::size_t i = 0; i < points; ++i) {
            piece.control.emplace_back(at(i) + moved);
            const bool is_rim = (i < margin && !(first + i == 0 && !whole.is_periodic)) ||
                                (i + margin >= points && !(first + i + 1 == n && !whole.is_periodic));
            const bool far = (piece.control.back() - m_place).norm() > m_moving;
            piece.frozen.push_back(is_rim || far || is_frozen(whole, (first + i) % n) != 0 ? 1 : 0);
        }
        m_part.scene.yarns.push_back(std::move(piece));
        m_part.pieces.push_back({y, first, moved});
    }

    const SimScene& m_scene;
    Vec3 m_place;
    double m_moving, m_outer = 0;
    Neighbourhood m_part;
};

}  // namespace

Neighbourhood neighbourhood(const SimScene& scene, const Vec3& place, double moving_mm) {
    return Cutting(scene, place, moving_mm).part();
}

void put_back(const Neighbourhood& part, SimScene& scene) {
    for (std::size_t k = 0; k < part.pieces.size(); ++k) {
        const auto& [yarn, first, moved] = part.pieces[k];
        SimYarn& whole = scene.yarns[yarn];
        const std::size_t n = whole.control.size();
        const SimYarn& piece = part.scene.yarns[k];
        for (std::size_t i = 0; i < piece.control.size(); ++i) {
            if (!piece.frozen.empty() && piece.frozen[i] != 0) continue;
            whole.control[(first + i) % n] = piece.control[i] - moved - static_cast<double>((first + i) / n) * whole.shift;
        }
    }
}

}  // namespace weave::sim
