#include <studio/viewport/camera.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weave::studio {

namespace {

constexpr double eye_in_heights =
    1.7;  ///< an angle of 33 degrees from top to bottom, as in pictures of relaxed cloth
constexpr double least_height_mm = 1e-3, most_height_mm = 1e6, farthest_mm = 1e9;
constexpr double rim_share = 0.06;

struct Turn {
    double azimuth_deg, elevation_deg;
};
constexpr Turn turns[standard_views]{{0, 90}, {180, -90}, {90, 0}, {0, 0}, {32, 38}, {212, -38}};

double radians(double degrees) {
    return degrees * std::numbers::pi / 180;
}

/// The same direction, from -180 to 180.
double turned(double degrees) {
    return std::remainder(degrees, 360.0);
}

/// How far the box reaches across the picture plane, as shares of a picture of height 1.
struct Reach {
    double left = std::numeric_limits<double>::infinity(), right = -left, low = left, high = -left;
};

Reach reach_of(const Camera& camera, const Box& box) {
    Reach reach;
    for (const Vec3& corner : box.corners()) {
        const Vec3 at = camera.to_camera(corner);
        const double shrink =
            camera.perspective ? camera.distance() / std::max(at.z(), 0.05 * camera.distance()) : 1;
        reach.left = std::min(reach.left, at.x() * shrink);
        reach.right = std::max(reach.right, at.x() * shrink);
        reach.low = std::min(reach.low, at.y() * shrink);
        reach.high = std::max(reach.high, at.y() * shrink);
    }
    return reach;
}

Result<double> number_in(const Json& json, const char* name, double least, double most) {
    const auto found = json.find(name);
    const std::string wish = "must be a number from " + std::to_string(least) + " to " + std::to_string(most);
    if (found == json.end() || !found->is_number()) return bad_input(wish, name);
    const double value = found->get<double>();
    if (!(value >= least && value <= most)) return bad_input(wish, name);
    return value;
}

Result<Vec3> place_in(const Json& json, const char* name) {
    const auto found = json.find(name);
    if (found == json.end() || !found->is_array() || found->size() != 3)
        return bad_input("must be three numbers", name);
    Vec3 place;
    for (std::size_t k = 0; k < 3; ++k) {
        const Json& number = (*found)[k];
        if (!number.is_number() || !(std::abs(number.get<double>()) <= farthest_mm))
            return bad_input("must be three numbers, mm", name);
        place[static_cast<Eigen::Index>(k)] = number.get<double>();
    }
    return place;
}

}  // namespace

std::array<Vec3, 8> Box::corners() const {
    std::array<Vec3, 8> all;
    for (unsigned k = 0; k < 8; ++k)
        all[k] = {(k & 1U) != 0 ? high.x() : low.x(), (k & 2U) != 0 ? high.y() : low.y(),
                  (k & 4U) != 0 ? high.z() : low.z()};
    return all;
}

Vec3 Camera::right() const {
    const double azimuth = radians(azimuth_deg);
    return {std::sin(azimuth), std::cos(azimuth), 0};
}

Vec3 Camera::up() const {
    const double azimuth = radians(azimuth_deg), elevation = radians(elevation_deg);
    const Vec3 ahead(std::cos(azimuth), -std::sin(azimuth), 0);
    return ahead * std::sin(elevation) + Vec3::UnitZ() * std::cos(elevation);
}

Vec3 Camera::away() const {
    const double azimuth = radians(azimuth_deg), elevation = radians(elevation_deg);
    const Vec3 ahead(std::cos(azimuth), -std::sin(azimuth), 0);
    return ahead * std::cos(elevation) - Vec3::UnitZ() * std::sin(elevation);
}

double Camera::distance() const {
    return perspective ? eye_in_heights * height_mm : 0;
}

Vec3 Camera::to_camera(const Vec3& place) const {
    const Vec3 way = place - centre;
    return {way.dot(right()), way.dot(up()), way.dot(away()) + distance()};
}

Projected Camera::project(const Vec3& place, const PictureSize& size) const {
    const Vec3 at = to_camera(place);
    const double pixels = perspective ? scale(size) * distance() / at.z() : scale(size);
    return {size.width / 2 + pixels * at.x(), size.height / 2 - pixels * at.y(), at.z()};
}

Vec3 Camera::in_plane(double x, double y, const PictureSize& size) const {
    return centre + right() * ((x - size.width / 2) / scale(size)) +
           up() * ((size.height / 2 - y) / scale(size));
}

Ray Camera::ray(double x, double y, const PictureSize& size, double reach_mm) const {
    const Vec3 target = in_plane(x, y, size);
    if (!perspective) return {target - away() * reach_mm, away()};
    const Vec3 eye = centre - away() * distance();
    return {eye, (target - eye).normalized()};
}

void Camera::orbit(double right_deg, double down_deg) {
    azimuth_deg = turned(azimuth_deg - right_deg);
    elevation_deg = std::clamp(elevation_deg + down_deg, -90.0, 90.0);
}

void Camera::pan(double to_right, double down, const PictureSize& size) {
    centre += (up() * down - right() * to_right) / scale(size);
}

void Camera::zoom_at(double x, double y, double factor, const PictureSize& size) {
    const Vec3 held = in_plane(x, y, size);
    const double height = std::clamp(height_mm / factor, least_height_mm, most_height_mm);
    centre = held + (centre - held) * (height / height_mm);
    height_mm = height;
}

void Camera::turn_to(StandardView view) {
    const Turn& turn = turns[static_cast<std::size_t>(view)];
    azimuth_deg = turned(turn.azimuth_deg);
    elevation_deg = turn.elevation_deg;
}

void Camera::fit(const Box& box, const PictureSize& size) {
    centre = box.centre();
    height_mm = std::max(box.size().norm(), least_height_mm);
    // Without perspective the second round changes nothing; with it each comes nearer.
    for (int round = 0; round < (perspective ? 8 : 1); ++round) {
        const Reach reach = reach_of(*this, box);
        centre += right() * ((reach.left + reach.right) / 2) + up() * ((reach.low + reach.high) / 2);
        const double wide = (reach.right - reach.left) * size.height / size.width,
                     high = reach.high - reach.low;
        height_mm = std::clamp(std::max(wide, high) * (1 + 2 * rim_share), least_height_mm, most_height_mm);
    }
}

Json Camera::to_json() const {
    return {{"azimuth_deg", azimuth_deg},
            {"elevation_deg", elevation_deg},
            {"centre_mm", {centre.x(), centre.y(), centre.z()}},
            {"height_mm", height_mm},
            {"perspective", perspective}};
}

Status Camera::from_json(const Json& json) {
    if (!json.is_object()) return bad_input("a view is an object", "");
    Camera read;
    WEAVE_TRY(read.azimuth_deg, number_in(json, "azimuth_deg", -360, 360));
    WEAVE_TRY(read.elevation_deg, number_in(json, "elevation_deg", -90, 90));
    WEAVE_TRY(read.height_mm, number_in(json, "height_mm", least_height_mm, most_height_mm));
    WEAVE_TRY(read.centre, place_in(json, "centre_mm"));
    const auto found = json.find("perspective");
    if (found == json.end() || !found->is_boolean()) return bad_input("must be true or false", "perspective");
    read.perspective = found->get<bool>();
    *this = read;
    return {};
}

Camera between(const Camera& from, const Camera& to, double share) {
    if (share >= 1) return to;
    Camera camera = to;
    camera.azimuth_deg = turned(from.azimuth_deg + share * turned(to.azimuth_deg - from.azimuth_deg));
    camera.elevation_deg = from.elevation_deg + share * (to.elevation_deg - from.elevation_deg);
    camera.centre = from.centre + share * (to.centre - from.centre);
    camera.height_mm = from.height_mm * std::pow(to.height_mm / from.height_mm, share);
    return camera;
}

std::optional<StandardView> view_of(const Camera& camera) {
    for (std::size_t k = 0; k < standard_views; ++k) {
        if (std::abs(turned(camera.azimuth_deg - turns[k].azimuth_deg)) < 1e-6 &&
            std::abs(camera.elevation_deg - turns[k].elevation_deg) < 1e-6)
            return static_cast<StandardView>(k);
    }
    return std::nullopt;
}

}  // namespace weave::studio
