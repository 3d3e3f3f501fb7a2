#pragma once

#include <weave/curve/spline.hpp>

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// A rigid motion, and before it perhaps the exchange of x and y that turns left-handed axes into
/// right-handed ones.
struct Alignment {
    bool mirrored = false;  ///< x and y are exchanged first
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    Vec3 translation{0, 0, 0};

    [[nodiscard]] Vec3 operator()(const Vec3& place) const {
        const Vec3 own = mirrored ? Vec3(place.y(), place.x(), place.z()) : place;
        return rotation * own + translation;
    }
};

/// The alignment of this handedness that brings `from` nearest to `to` in the sense of least squares, point
/// by point (Kabsch 1976). Equally many, at least one.
Alignment kabsch(const std::vector<Vec3>& from, const std::vector<Vec3>& to, bool mirrored);

/// A place on a curve.
struct OnCurve {
    Vec3 place{0, 0, 0}, tangent{0, 0, 0};  ///< the tangent has length 1, or 0 where the curve stands still
    double distance = 0;                    ///< to the place that was asked for
};

/// Finds the place of a spline nearest to others, with all the repeats of a periodic one.
class CurveFinder {
  public:
    explicit CurveFinder(Spline spline);
    /// To within rounding, as long as places that are nearly equally far do not lie apart along the curve.
    [[nodiscard]] OnCurve nearest(const Vec3& place) const;
    /// Places evenly spread over its length, both ends of an open curve among them.
    [[nodiscard]] std::vector<Vec3> even_places(std::size_t count) const;
    [[nodiscard]] const Vec3& middle() const { return m_middle; }  ///< mean of its places
    [[nodiscard]] const Spline& spline() const { return m_spline; }

  private:
    struct Box {
        Eigen::AlignedBox3d bounds;
        std::size_t first = 0, last = 0;  ///< of the places, or of the boxes, both included
    };
    void search(const Vec3& place, double from, double& best, double& at) const;
    void search_again(const Vec3& place, const Vec3& by, double from, OnCurve& found) const;
    [[nodiscard]] OnCurve refined(const Vec3& place, double t) const;

    Spline m_spline;
    std::vector<Vec3> m_places;          ///< along the spline at even parameters
    std::vector<Box> m_boxes, m_groups;  ///< of places, and of boxes
    Vec3 m_middle{0, 0, 0};
    double m_reach = 0;  ///< greatest distance from a place of the curve to the nearest of m_places, mm
};

/// Places evenly spread over the length of a polyline, both its ends among them.
std::vector<Vec3> even_places(const std::vector<Vec3>& polyline, std::size_t count);

}  // namespace weave::sim
