#pragma once

#include <weave/curve/vec3.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace weave {

/// A uniform cubic B-spline: C2, with control points q. A periodic one has as many segments as control
/// points, and q[i + n] = q[i] + shift. An open one begins at q[0] and ends at q[n-1] with no curvature (its
/// ends go on straight: q[-1] = 2 q[0] - q[1]) and has n-1 segments.
struct Spline {
    std::vector<Vec3> control;
    bool is_periodic = false;
    Vec3 shift{0, 0, 0};

    [[nodiscard]] std::size_t segments() const {
        return is_periodic ? control.size() : control.empty() ? 0 : control.size() - 1;
    }
    /// Control point `index` beyond the ends as described: any index of a periodic spline, -1 to size() of an
    /// open one. There must be a control point.
    [[nodiscard]] Vec3 at(std::ptrdiff_t index) const;
    /// Place, first and second derivative at parameter `t` in segments: from 0 to segments(), any of a
    /// periodic spline. Of an open spline of one point, that point and no derivative.
    [[nodiscard]] Vec3 place(double t) const;
    [[nodiscard]] Vec3 tangent(double t) const;
    [[nodiscard]] Vec3 bend(double t) const;
};

/// The spline that passes `keys` at t = 0, 1, 2 …: one control point a key.
Spline interpolate(const std::vector<Vec3>& keys, bool is_periodic, const Vec3& shift);

/// A spline of `points` control points (an open one at least 2) through as many places of this one, evenly
/// spread over the parameter. The curve is kept exactly where the new segments are a multiple of the old: of
/// a periodic spline where `points` is a multiple of the segments, of an open one where `points` - 1 is.
Spline resample(const Spline& spline, std::size_t points);

/// The Bézier points of segment `index`: the same cubic, inside their hull.
std::array<Vec3, 4> bezier(const Spline& spline, std::size_t index);

}  // namespace weave
