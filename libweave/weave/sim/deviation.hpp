#pragma once

#include <weave/curve/spline.hpp>

#include <vector>

namespace weave::sim {

/// How far one state of the yarns lies from another, across the yarns.
struct Deviation {
    double rms_mm = 0, max_mm = 0;
    std::size_t yarn = 0;  ///< where it is greatest
};

/// Distance of the centrelines `from` to those of the same yarns in `to`, whose points may be of another
/// number; what slides along a yarn does not count. Both must hold as many yarns. The mean movement of the
/// whole is taken off first where `may_drift`: a periodic cloth rests anywhere.
Deviation deviation_of(const std::vector<Spline>& from, const std::vector<Spline>& to, bool may_drift);

/// The way from a place to the nearest of a centreline near parameter `t`, without its part along the yarn, mm.
Vec3 way_across(const Spline& to, const Vec3& place, double t);

/// The movement of the whole that leaves least across the yarns, to be added to places of `from`.
Vec3 drift_of(const std::vector<Spline>& from, const std::vector<Spline>& to);

}  // namespace weave::sim
