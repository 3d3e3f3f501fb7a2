#include <weave/sim/order.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace weave::sim {

namespace {

/// How many planned crossings a crossing may have slid along its yarns.
constexpr double farthest_keys = 3;

/// A yarn with the parameter of its planned key points.
struct Thread {
    const Spline& spline;
    double per_key;

    Thread(const Spline& of, const YarnCurve& curve) : spline(of) {
        const double keys = static_cast<double>(curve.is_periodic ? curve.keys.size() : curve.keys.size() - 1);
        per_key = keys > 0 ? static_cast<double>(of.segments()) / keys : 0;
    }
    [[nodiscard]] double clamped(double t) const {
        return spline.is_periodic ? t : std::clamp(t, 0.0, static_cast<double>(spline.segments()));
    }
};

/// Newton's method for the parameters at which two yarns cross, seen from above.
std::optional<FoundCrossing> by_newton(const Thread& weft, const Thread& warp, double t, double s) {
    const double t0 = t, s0 = s;
    for (int round = 0; round < 30; ++round) {
        const Vec3 apart = weft.spline.place(t) - warp.spline.place(s);
        if (std::hypot(apart.x(), apart.y()) < 1e-9) return FoundCrossing{t, s, apart.z()};
        const Vec3 a = weft.spline.tangent(t), b = warp.spline.tangent(s);
        const double det = -a.x() * b.y() + a.y() * b.x();
        if (std::abs(det) < 1e-12 * (1 + a.squaredNorm() + b.squaredNorm())) return {};
        const double dt = (apart.x() * b.y() - apart.y() * b.x()) / det,
                     ds = (apart.x() * a.y() - apart.y() * a.x()) / det;
        const double size = std::max(std::abs(dt) / weft.per_key, std::abs(ds) / warp.per_key);
        const double share = size > 0.5 ? 0.5 / size : 1;
        t = weft.clamped(t + share * dt);
        s = warp.clamped(s + share * ds);
        if (std::abs(t - t0) > farthest_keys * weft.per_key || std::abs(s - s0) > farthest_keys * warp.per_key) return {};
    }
    return {};
}

/// The crossing nearest to the planned place among those of two polylines along the yarns.
std::optional<FoundCrossing> by_search(const Thread& weft, const Thread& warp, double t0, double s0) {
    constexpr int pieces = 96;
    std::array<Vec3, pieces + 1> a, b;
    for (int i = 0; i <= pieces; ++i) {
        const double share = (2.0 * i / pieces - 1) * farthest_keys;
        a[static_cast<std::size_t>(i)] = weft.spline.place(weft.clamped(t0 + share * weft.per_key));
        b[static_cast<std::size_t>(i)] = warp.spline.place(warp.clamped(s0 + share * warp.per_key));
    }
    std::optional<FoundCrossing> found;
    int nearest = 4 * pieces;
    for (int i = 0; i < pieces; ++i) {
        for (int j = 0; j < pieces; ++j) {
            const Vec3 &p = a[static_cast<std::size_t>(i)], &q = b[static_cast<std::size_t>(j)];
            const Vec3 u = a[static_cast<std::size_t>(i) + 1] - p, v = b[static_cast<std::size_t>(j) + 1] - q, w = q - p;
            const double det = u.x() * v.y() - u.y() * v.x();
            if (det == 0) continue;
            const double along = (w.x() * v.y() - w.y() * v.x()) / det, other = (w.x() * u.y() - w.y() * u.x()) / det;
            if (along < 0 || along > 1 || other < 0 || other > 1) continue;
            const int far = std::abs(2 * i - pieces) + std::abs(2 * j - pieces);
            if (far >= nearest) continue;
            nearest = far;
            const double step = 2 * farthest_keys / pieces;
            found = FoundCrossing{weft.clamped(t0 + ((i + along) * step - farthest_keys) * weft.per_key),
                                  warp.clamped(s0 + ((j + other) * step - farthest_keys) * warp.per_key),
                                  p.z() + along * u.z() - q.z() - other * v.z()};
        }
    }
    return found;
}

}  // namespace

std::optional<FoundCrossing> find_crossing(const ClothCurves& curves, const std::vector<Spline>& splines,
                                           const Crossing& crossing) {
    const Thread weft(splines[crossing.weft], curves.yarns[crossing.weft]),
        warp(splines[crossing.warp], curves.yarns[crossing.warp]);
    const double t = weft.per_key * static_cast<double>(crossing.weft_key),
                 s = warp.per_key * static_cast<double>(crossing.warp_key);
    const std::optional<FoundCrossing> found = by_newton(weft, warp, t, s);
    return found ? found : by_search(weft, warp, t, s);
}

std::vector<LostCrossing> lost_crossings(const ClothCurves& curves, const std::vector<Spline>& splines) {
    std::vector<LostCrossing> lost;
    for (const Crossing& crossing : curves.crossings) {
        if (splines[crossing.weft].control.empty() || splines[crossing.warp].control.empty()) continue;
        const std::optional<FoundCrossing> found = find_crossing(curves, splines, crossing);
        if (!found || (found->height_mm > 0) != crossing.weft_over) lost.push_back({crossing, found.has_value()});
    }
    return lost;
}

}  // namespace weave::sim
