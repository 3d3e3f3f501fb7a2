#include <weave/picture/tube_camera.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weave {

namespace {

constexpr double eye_distance =
    3.4;  ///< in radii of the scene: an angle of 34 degrees, as with the naked eye

/// Where a ball ends on both sides on the picture plane at distance 1, across one axis: the tangents from the
/// eye.
std::pair<double, double> seen(double across, double away, double radius) {
    const double square = across * across + away * away - radius * radius;
    const double root = radius * std::sqrt(std::max(square, 0.0)), below = away * away - radius * radius;
    return {(across * away - root) / below, (across * away + root) / below};
}

}  // namespace

TubeCamera::TubeCamera(double azimuth_deg, double elevation_deg) {
    const double azimuth = azimuth_deg * std::numbers::pi / 180,
                 elevation = elevation_deg * std::numbers::pi / 180;
    const Vec3 ahead(std::cos(azimuth), -std::sin(azimuth), 0);
    m_right = {std::sin(azimuth), std::cos(azimuth), 0};
    m_away = ahead * std::cos(elevation) - Vec3::UnitZ() * std::sin(elevation);
    m_up = ahead * std::sin(elevation) + Vec3::UnitZ() * std::cos(elevation);
}

void TubeCamera::aim(const Vec3& centre, double radius, bool perspective) {
    m_centre = centre;
    m_distance = perspective ? eye_distance * radius : 0;
}

Vec3 TubeCamera::to_camera(const Vec3& place) const {
    return turned(place - m_centre) + Vec3(0, 0, m_distance);
}

Rectangle TubeCamera::box_of(const Vec3& centre, double radius) const {
    if (m_distance == 0) return {centre.x() - radius, centre.y() - radius, 2 * radius, 2 * radius};
    const auto [left, right] = seen(centre.x(), centre.z(), radius);
    const auto [low, high] = seen(centre.y(), centre.z(), radius);
    return {left, low, right - left, high - low};
}

void TubeCamera::fit(const Rectangle& plane, const Rectangle& pixels) {
    m_scale = std::min(pixels.width / plane.width, pixels.height / plane.height);
    m_x = pixels.x + pixels.width / 2 - m_scale * (plane.x + plane.width / 2);
    m_y = pixels.y + pixels.height / 2 + m_scale * (plane.y + plane.height / 2);
}

Rectangle TubeCamera::on_screen(const Rectangle& plane) const {
    return {m_x + m_scale * plane.x, m_y - m_scale * (plane.y + plane.height), m_scale * plane.width,
            m_scale * plane.height};
}

Ray TubeCamera::ray(double x, double y) const {
    const double u = (x - m_x) / m_scale, v = (m_y - y) / m_scale;
    if (m_distance == 0) return {{u, v, 0}, {0, 0, 1}};
    return {{0, 0, 0}, Vec3(u, v, 1).normalized()};
}

}  // namespace weave
