#pragma once

#include <weave/curve/vec3.hpp>
#include <weave/picture/canvas.hpp>

namespace weave {

/// A straight line of sight, in the camera's axes: right, up, away.
struct Ray {
    Vec3 origin{0, 0, 0}, way{0, 0, 1};  ///< `way` has length 1
};

/// Looks at cloth from any side. As the axes of cloth are left-handed (x up and y to the right on the face),
/// so is this camera, and the cloth is seen as it is, not in a mirror.
class TubeCamera {
  public:
    TubeCamera(double azimuth_deg, double elevation_deg);
    /// Looks at what lies within `radius` of `centre`; with perspective from 3.4 radii away, else from
    /// infinity.
    void aim(const Vec3& centre, double radius, bool perspective);

    [[nodiscard]] Vec3 to_camera(const Vec3& place) const;
    /// A direction in the camera's axes.
    [[nodiscard]] Vec3 turned(const Vec3& way) const {
        return {way.dot(m_right), way.dot(m_up), way.dot(m_away)};
    }
    /// The box round the picture of a ball, in units of the picture plane: mm, or with perspective mm at
    /// distance 1 mm.
    [[nodiscard]] Rectangle box_of(const Vec3& centre, double radius) const;

    /// Fits what lies in `plane` (units of the picture plane) into `pixels`, as large as it goes.
    void fit(const Rectangle& plane, const Rectangle& pixels);
    /// The box in pixels; y downwards.
    [[nodiscard]] Rectangle on_screen(const Rectangle& plane) const;
    [[nodiscard]] Ray ray(double x, double y) const;
    /// Pixels of a mm; only without perspective does it hold everywhere.
    [[nodiscard]] double pixels_per_unit() const { return m_scale; }

  private:
    Vec3 m_right, m_up, m_away;
    Vec3 m_centre{0, 0, 0};
    double m_distance = 0;  ///< of the eye from the centre; 0: no perspective
    double m_scale = 1, m_x = 0, m_y = 0;
};

}  // namespace weave
