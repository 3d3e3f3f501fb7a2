#pragma once

// How near yarns may come in one step without passing through one another.

#include <weave/sim/bodies.hpp>

#include <Eigen/Geometry>

#include <cmath>

namespace weave::sim {

/// Share of their distance by which yarns may come closer in one step: below a half, so that both may.
inline constexpr double closest = 0.45;

/// What of `apart` is across two nearly parallel directions, the same whichever of them comes first.
template <class Real>
WEAVE_HD inline Vec<Real> away_from(const Vec<Real>& apart, const Vec<Real>& along, const Vec<Real>& other) {
    const Real turn = along.dot(other) < 0 ? Real(-1) : Real(1);
    const Vec<Real> both = along / along.norm() + turn * other / other.norm();
    return apart - both * (both.dot(apart) / both.squaredNorm());
}

/// What share of a change two samples may go that lie deep in one another, with tangents `along` and `other`. Such yarns may pass
/// between their samples: there it counts how far apart the straight lines through two samples are, if these lie about where the lines are
/// nearest. Nearer than the lines stand for the curves they do not come at all, whatever presses them together. 1e300: any.
template <class Real>
WEAVE_HD inline double crossing_share(const Vec<Real>& along, const Vec<Real>& other, const Vec<Real>& apart,
                                      const Vec<Real>& change, Real reach) {
    constexpr double none = 1e300, beside = 0.3, least_height = 0.02, least_sine = 0.1, least_segment = 0.1;
    // Segments as short as that have samples so close that nothing passes between them, and tangents that say little.
    const Real along2 = along.squaredNorm(), other2 = other.squaredNorm();
    const auto shortest = static_cast<double>(along2 < other2 ? along2 : other2);
    if (shortest < least_segment * least_segment * static_cast<double>(reach * reach)) return none;
    Vec<Real> across = along.cross(other);
    if (across.squaredNorm() < Real(least_sine * least_sine) * along2 * other2) across = away_from(apart, along, other);
    const auto size = static_cast<double>(across.norm());
    if (!(size > 0)) return none;
    const double height = static_cast<double>(apart.dot(across)) / size,
                 rise = static_cast<double>(change.dot(across)) / size;
    const double aside2 = static_cast<double>(apart.squaredNorm()) - height * height,
                 most = beside * static_cast<double>(reach);
    if (aside2 >= most * most || height * rise >= 0) return none;
    const double high = height < 0 ? -height : height, rises = rise < 0 ? -rise : rise;
    return high < least_height * static_cast<double>(reach) ? 0 : closest * (high / rises);
}

}  // namespace weave::sim
