#include <weave/sim/deviation.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

constexpr int places_a_segment = 4;

/// Calls found(yarn, place, parameter in the other) for places evenly spread over every yarn.
template <class Found>
void each_place(const std::vector<Spline>& from, const std::vector<Spline>& to, const Found& found) {
    for (std::size_t y = 0; y < from.size(); ++y) {
        if (from[y].control.empty() || to[y].control.empty()) continue;
        const std::size_t places = places_a_segment * std::max(from[y].segments(), to[y].segments());
        for (std::size_t k = 0; k < places; ++k) {
            const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(places);
            found(y, from[y].place(share * static_cast<double>(from[y].segments())),
                  share * static_cast<double>(to[y].segments()));
        }
    }
}

}  // namespace

Vec3 way_across(const Spline& spline, const Vec3& place, double t) {
    const auto last = static_cast<double>(spline.segments());
    const double start = t;
    for (int round = 0; round < 12; ++round) {
        const Vec3 tangent = spline.tangent(t);
        const double square = tangent.squaredNorm();
        if (square == 0) break;
        t += std::clamp((place - spline.place(t)).dot(tangent) / square, -0.5, 0.5);
        t = std::clamp(t, start - last / 2, start + last / 2);
        if (!spline.is_periodic) t = std::clamp(t, 0.0, last);
    }
    return spline.place(t) - place;
}

Vec3 drift_of(const std::vector<Spline>& from, const std::vector<Spline>& to) {
    // Along a yarn nothing holds its points, so the drift is that which leaves least across the yarns; a few
    // rounds of taking the mean off find it.
    Vec3 drift(0, 0, 0);
    for (int round = 0; round < 8; ++round) {
        Vec3 sum(0, 0, 0);
        Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();
        each_place(from, to, [&](std::size_t y, const Vec3& place, double t) {
            const Vec3 tangent = to[y].tangent(t).normalized();
            const Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() - tangent * tangent.transpose();
            sum += normal * way_across(to[y], place + drift, t);
            weight += normal;
        });
        if (weight.trace() == 0) break;
        drift += weight.ldlt().solve(sum);
    }
    return drift;
}

Deviation deviation_of(const std::vector<Spline>& from, const std::vector<Spline>& to, bool may_drift) {
    const Vec3 drift = may_drift ? drift_of(from, to) : Vec3(0, 0, 0);
    Deviation deviation;
    double squares = 0;
    std::size_t count = 0;
    each_place(from, to, [&](std::size_t y, const Vec3& place, double t) {
        const double distance = way_across(to[y], place + drift, t).norm();
        squares += distance * distance;
        ++count;
        if (distance <= deviation.max_mm) return;
        deviation.max_mm = distance;
        deviation.yarn = y;
    });
    deviation.rms_mm = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
    return deviation;
}

}  // namespace weave::sim
