#include <weave/sim/order.hpp>

#include <weave/sim/linking.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace weave::sim {

namespace {

/// How many planned crossings a crossing may have slid along its yarns.
constexpr double farthest_keys = 3;

double clamped(const LaidYarn& yarn, double t) {
    return yarn.spline.is_periodic ? t : std::clamp(t, 0.0, static_cast<double>(yarn.spline.segments()));
}

LaidYarn laid_yarn_of(const Spline& spline, const YarnCurve& curve) {
    const double keys = static_cast<double>(curve.is_periodic ? curve.keys.size() : curve.keys.size() - 1);
    return {spline, keys > 0 ? static_cast<double>(spline.segments()) / keys : 0};
}

/// Newton's method for the parameters at which two yarns cross, seen from above.
std::optional<CrossingSpot> spot_by_newton(const LaidYarn& weft, const LaidYarn& warp, double t, double s) {
    const double t0 = t, s0 = s;
    for (int round = 0; round < 30; ++round) {
        const Vec3 apart = weft.spline.place(t) - warp.spline.place(s);
        if (std::hypot(apart.x(), apart.y()) < 1e-9) return CrossingSpot{t, s, apart.z()};
        const Vec3 a = weft.spline.tangent(t), b = warp.spline.tangent(s);
        const double det = -a.x() * b.y() + a.y() * b.x();
        if (std::abs(det) < 1e-12 * (1 + a.squaredNorm() + b.squaredNorm())) return {};
        const double dt = (apart.x() * b.y() - apart.y() * b.x()) / det,
                     ds = (apart.x() * a.y() - apart.y() * a.x()) / det;
        const double size = std::max(std::abs(dt) / weft.per_key, std::abs(ds) / warp.per_key);
        const double share = size > 0.5 ? 0.5 / size : 1;
        t = clamped(weft, t + share * dt);
        s = clamped(warp, s + share * ds);
        if (std::abs(t - t0) > farthest_keys * weft.per_key ||
            std::abs(s - s0) > farthest_keys * warp.per_key)
            return {};
    }
    return {};
}

/// The crossing nearest to the planned place among those of two polylines along the yarns.
std::optional<CrossingSpot> spot_by_search(const LaidYarn& weft, const LaidYarn& warp, double t0, double s0) {
    constexpr int pieces = 96;
    std::array<Vec3, pieces + 1> a, b;
    for (int i = 0; i <= pieces; ++i) {
        const double share = (2.0 * i / pieces - 1) * farthest_keys;
        a[static_cast<std::size_t>(i)] = weft.spline.place(clamped(weft, t0 + share * weft.per_key));
        b[static_cast<std::size_t>(i)] = warp.spline.place(clamped(warp, s0 + share * warp.per_key));
    }
    std::optional<CrossingSpot> spot;
    const auto parameter = [](const LaidYarn& yarn, double from, double piece) {
        return clamped(yarn, from + (2 * piece / pieces - 1) * farthest_keys * yarn.per_key);
    };
    int nearest = 4 * pieces;
    for (int i = 0; i < pieces; ++i) {
        for (int j = 0; j < pieces; ++j) {
            const Vec3 &p = a[static_cast<std::size_t>(i)], &q = b[static_cast<std::size_t>(j)];
            const Vec3 u = a[static_cast<std::size_t>(i) + 1] - p, v = b[static_cast<std::size_t>(j) + 1] - q,
                       w = q - p;
            const double det = u.x() * v.y() - u.y() * v.x();
            if (det == 0) continue;
            const double along = (w.x() * v.y() - w.y() * v.x()) / det,
                         other = (w.x() * u.y() - w.y() * u.x()) / det;
            if (along < 0 || along > 1 || other < 0 || other > 1) continue;
            const int far = std::abs(2 * i - pieces) + std::abs(2 * j - pieces);
            if (far >= nearest) continue;
            nearest = far;
            spot = CrossingSpot{parameter(weft, t0, i + along), parameter(warp, s0, j + other),
                                p.z() + along * u.z() - q.z() - other * v.z()};
        }
    }
    return spot;
}

/// The places near their planned crossing at which two yarns are nearest.
CrossingSpot nearest_spot(const LaidYarn& weft, const LaidYarn& warp, double t0, double s0) {
    constexpr int pieces = 12;
    constexpr double farthest = 1.5;  ///< key points
    std::array<double, 2 * pieces + 1> t{}, s{};
    std::array<Vec3, 2 * pieces + 1> a, b;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double keys = farthest * (static_cast<int>(k) - pieces) / pieces;
        a[k] = weft.spline.place(t[k] = clamped(weft, t0 + keys * weft.per_key));
        b[k] = warp.spline.place(s[k] = clamped(warp, s0 + keys * warp.per_key));
    }
    double least = std::numeric_limits<double>::infinity();
    CrossingSpot spot;
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            const Vec3 apart = a[i] - b[j];
            if (apart.norm() >= least) continue;
            least = apart.norm();
            spot = {t[i], s[j], apart.z()};
        }
    }
    return spot;
}

/// Upwards across both yarns where the cloth lies as woven, `weft_way` being 1 where the weft runs along y.
Vec3 across_both(const LaidYarn& weft, const LaidYarn& warp, const CrossingSpot& at, double weft_way) {
    return warp.spline.tangent(at.warp_at).cross(weft.spline.tangent(at.weft_at)) * weft_way;
}

/// Whether a crossing lies as the card says. Cloth that stands on edge or hangs over, as an opened pocket's
/// does, shows nothing from above: there the yarns are looked at across both of them, where they are nearest.
bool lies_as_planned(const LaidYarn& weft, const LaidYarn& warp, const Crossing& crossing,
                     const std::optional<CrossingSpot>& spot, double weft_way) {
    constexpr double steepest = 0.5;
    const auto shows = [&](const Vec3& up) { return up.z() > steepest * up.norm(); };
    if (spot && shows(across_both(weft, warp, *spot, weft_way)))
        return (spot->height_mm > 0) == crossing.weft_over;
    const CrossingSpot nearest =
        nearest_spot(weft, warp, weft.at(crossing.weft_key), warp.at(crossing.warp_key));
    const Vec3 up = across_both(weft, warp, nearest, weft_way);
    if (!spot && shows(up)) return false;
    const Vec3 apart = weft.spline.place(nearest.weft_at) - warp.spline.place(nearest.warp_at);
    return (up.dot(apart) > 0) == crossing.weft_over;
}

}  // namespace

std::optional<CrossingSpot> find_crossing(const LaidYarn& weft, const LaidYarn& warp, std::size_t weft_key,
                                          std::size_t warp_key) {
    const double t = weft.at(weft_key), s = warp.at(warp_key);
    const std::optional<CrossingSpot> spot = spot_by_newton(weft, warp, t, s);
    return spot ? spot : spot_by_search(weft, warp, t, s);
}

std::optional<CrossingSpot> find_crossing(const ClothCurves& curves, const std::vector<Spline>& splines,
                                          const Crossing& crossing) {
    return find_crossing(laid_yarn_of(splines[crossing.weft], curves.yarns[crossing.weft]),
                         laid_yarn_of(splines[crossing.warp], curves.yarns[crossing.warp]), crossing.weft_key,
                         crossing.warp_key);
}

namespace {

/// Crossings that do not show as planned where they should.
std::vector<LostCrossing> doubtful_crossings(const std::vector<Crossing>& crossings,
                                             const OrderSubject& subject) {
    std::vector<LostCrossing> doubtful;
    for (const Crossing& crossing : crossings) {
        if (subject.now[crossing.weft].control.empty() || subject.now[crossing.warp].control.empty())
            continue;
        const LaidYarn weft = subject.laid_yarn(subject.now, crossing.weft), warp = subject.laid_yarn(subject.now, crossing.warp);
        const double t = weft.at(crossing.weft_key);
        const Spline& planned = subject.planned[crossing.weft];
        const double weft_way =
            planned.tangent(std::min(t, static_cast<double>(planned.segments()))).y() < 0 ? -1 : 1;
        const std::optional<CrossingSpot> spot =
            find_crossing(weft, warp, crossing.weft_key, crossing.warp_key);
        if (!lies_as_planned(weft, warp, crossing, spot, weft_way))
            doubtful.push_back({crossing, spot.has_value()});
    }
    return doubtful;
}

int entry(const Linking& linking, const Crossing& crossing) {
    const auto found =
        linking.find({std::max(crossing.weft, crossing.warp), std::min(crossing.weft, crossing.warp)});
    return found == linking.end() ? 0 : found->second;
}

}  // namespace

namespace {

/// Whether the plan itself has a crossing as the card says; a card that changed since has not.
bool planned_so(const Crossing& crossing, const OrderSubject& subject) {
    const auto spot = find_crossing(subject.laid_yarn(subject.planned, crossing.weft), subject.laid_yarn(subject.planned, crossing.warp),
                                    crossing.weft_key, crossing.warp_key);
    return spot && (spot->height_mm > 0) == crossing.weft_over;
}

}  // namespace

CrossingOrder crossing_order(const std::vector<Crossing>& crossings, const OrderSubject& subject) {
    CrossingOrder order;
    const std::vector<LostCrossing> doubtful = doubtful_crossings(crossings, subject);
    if (doubtful.empty()) return order;
    const Linking planned = linking_of(subject.planned, subject.period_mm),
                  now = linking_of(subject.now, subject.period_mm);
    for (const LostCrossing& crossing : doubtful) {
        const bool holds = planned_so(crossing.crossing, subject) &&
                           entry(now, crossing.crossing) == entry(planned, crossing.crossing);
        (holds ? order.slid : order.lost).push_back(crossing);
    }
    return order;
}

CrossingOrder crossing_order(const ClothCurves& curves, const std::vector<Spline>& splines) {
    OrderSubject subject{{}, splines, {}, {}, {}};
    for (std::size_t y = 0; y < splines.size(); ++y) {
        subject.per_key.push_back(laid_yarn_of(splines[y], curves.yarns[y]).per_key);
        Spline& planned = subject.planned.emplace_back();
        if (splines[y].control.empty()) continue;
        std::vector<Vec3> keys;
        for (const KeyPoint& key : curves.yarns[y].keys) keys.push_back(key.place);
        planned = resample(interpolate(keys, curves.yarns[y].is_periodic, curves.yarns[y].shift),
                           splines[y].control.size());
    }
    for (std::size_t k = 0; k < 2; ++k) subject.period_mm[k] = curves.is_periodic[k] ? curves.size_mm[k] : 0;
    return crossing_order(curves.crossings, subject);
}

std::vector<LostCrossing> lost_crossings(const ClothCurves& curves, const std::vector<Spline>& splines) {
    return crossing_order(curves, splines).lost;
}

}  // namespace weave::sim
