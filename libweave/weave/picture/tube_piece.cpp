#include <weave/picture/tube_piece.hpp>

#include <algorithm>
#include <cmath>

namespace weave {

namespace {

/// The part of a ray within a ball; the foot of the ray where it passes by.
Stretch within_ball(const Vec3& centre, double radius, const Ray& ray) {
    const Vec3 to_origin = ray.origin - centre;
    const double half = to_origin.dot(ray.way);
    const double square = (to_origin - half * ray.way).squaredNorm(), depth = radius * radius - square;
    if (depth <= 0) return {-half, -half};
    const double root = std::sqrt(depth);
    return {-half - root, -half + root};
}

}  // namespace

Stretch within(const TubePiece& piece, const Ray& ray) {
    const Vec3 axis = piece.to - piece.from;
    const double length2 = axis.squaredNorm(), radius2 = piece.radius * piece.radius;
    if (length2 < 1e-18 * radius2) return within_ball(piece.from, piece.radius, ray);
    // Counted from the place of the ray that is nearest to the piece, numbers stay small and precise.
    const double foot = ray.way.dot(piece.from - ray.origin);
    const Vec3 offset = ray.origin + foot * ray.way - piece.from;
    const double along = axis.dot(ray.way), start = axis.dot(offset);
    // The distance from the axis squared is (a t² + 2 b t + c) / length²: first the endless cylinder.
    const double a = length2 - along * along, b = -start * along,
                 c = length2 * (offset.squaredNorm() - radius2) - start * start;
    Stretch cylinder;  // from the foot on
    if (a > 1e-12 * length2) {
        const double depth = b * b - a * c;
        if (depth <= 0) return {0, 0};
        const double root = std::sqrt(depth);
        cylinder = {(-b - root) / a, (-b + root) / a};
    } else if (c >= 0) {
        return {0, 0};
    }
    // Then, where the ray enters or leaves beyond an end, the ball at that end.
    const auto end_at = [&](double t, bool entry) -> std::optional<Stretch> {
        const double height = std::isfinite(t)       ? start + t * along
                              : (along > 0) == entry ? -1.0
                                                     : length2 + 1;
        if (height >= 0 && height <= length2) return {};
        return within_ball(height < 0 ? piece.from : piece.to, piece.radius, ray);
    };
    Stretch stretch{cylinder.from + foot, cylinder.to + foot};
    if (const auto ball = end_at(cylinder.from, true)) {
        if (ball->is_empty()) return {0, 0};
        stretch.from = ball->from;
    }
    if (const auto ball = end_at(cylinder.to, false)) stretch.to = ball->to;
    return stretch;
}

Stretch behind(const Plane& plane, const Ray& ray) {
    const double slope = plane.normal.dot(ray.way), above = plane.normal.dot(ray.origin) - plane.height;
    Stretch stretch;
    if (std::abs(slope) < 1e-12) {
        if (above > 0) return {0, 0};
    } else if (slope > 0) {
        stretch.to = -above / slope;
    } else {
        stretch.from = -above / slope;
    }
    return stretch;
}

double share_along(const TubePiece& piece, const Vec3& place) {
    const Vec3 axis = piece.to - piece.from;
    const double length2 = axis.squaredNorm();
    return length2 > 0 ? std::clamp((place - piece.from).dot(axis) / length2, 0.0, 1.0) : 0.0;
}

Vec3 nearest_on_axis(const TubePiece& piece, const Vec3& place) {
    return piece.from + share_along(piece, place) * (piece.to - piece.from);
}

}  // namespace weave
