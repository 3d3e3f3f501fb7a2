#pragma once

#include <weave/picture/tube_camera.hpp>

#include <cstdint>
#include <limits>
#include <optional>

namespace weave {

/// A straight piece of round yarn, rounded at both ends so that pieces of one yarn join without a seam.
struct TubePiece {
    Vec3 from{0, 0, 0}, to{0, 0, 0};
    Eigen::Vector3f tangent_from{0, 0, 0}, tangent_to{0, 0, 0};  ///< of the yarn there, of length 1
    double radius = 1;
    std::uint32_t yarn = 0;
    float value_from = 0, value_to = 0;  ///< what colours it, at its ends
    /// Where a yarn ends it is cut flat instead; numbers of the scene's planes.
    static constexpr std::uint32_t round = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t plane_from = round, plane_to = round;
};

/// Keeps what lies behind it, where `normal` does not point.
struct Plane {
    Vec3 normal{0, 0, 1};  ///< of length 1
    double height = 0;     ///< of the plane along its normal
};

/// A stretch of a ray.
struct Stretch {
    double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
    [[nodiscard]] bool is_empty() const { return !(from < to); }
};

/// The part of a ray within a piece with round ends; empty where it misses.
Stretch within(const TubePiece& piece, const Ray& ray);
/// The part of a ray that a plane keeps.
Stretch behind(const Plane& plane, const Ray& ray);

/// How far along a piece a place lies, from 0 to 1.
double share_along(const TubePiece& piece, const Vec3& place);
/// The point of a piece's axis that is nearest to a place.
Vec3 nearest_on_axis(const TubePiece& piece, const Vec3& place);

}  // namespace weave
