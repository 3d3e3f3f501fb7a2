#include <studio/viewport/block_faces.hpp>

#include <cmath>
#include <limits>

namespace weave::studio {

namespace {

Eigen::Index axis_of(Face face) {
    return static_cast<Eigen::Index>(face) / 2;
}

bool is_plus(Face face) {
    return static_cast<unsigned>(face) % 2 == 0;
}

}  // namespace

Vec3 normal_of(Face face) {
    return Vec3::Unit(axis_of(face)) * (is_plus(face) ? 1.0 : -1.0);
}

std::array<Vec3, 4> corners_of(const Box& box, Face face) {
    const Eigen::Index axis = axis_of(face), u = (axis + 1) % 3, v = (axis + 2) % 3;
    Vec3 corner = is_plus(face) ? box.high : box.low;
    std::array<Vec3, 4> corners;
    for (std::size_t k = 0; k < 4; ++k) {
        corner[u] = k == 1 || k == 2 ? box.high[u] : box.low[u];
        corner[v] = k >= 2 ? box.high[v] : box.low[v];
        corners[k] = corner;
    }
    return corners;
}

bool is_seen(const Box& box, Face face, const Camera& camera) {
    const Vec3 normal = normal_of(face);
    if (!camera.perspective) return normal.dot(camera.away()) < -1e-9;
    const Vec3 eye = camera.centre - camera.away() * camera.distance();
    return normal.dot(eye - corners_of(box, face)[0]) > 0;
}

std::optional<Face> face_at(const Box& box, const Ray& ray) {
    double from = 0, to = std::numeric_limits<double>::infinity();
    std::optional<Face> entered;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const double start = ray.origin[axis], way = ray.way[axis];
        if (std::abs(way) < 1e-12) {
            if (start < box.low[axis] || start > box.high[axis]) return std::nullopt;
            continue;
        }
        const double near = ((way > 0 ? box.low : box.high)[axis] - start) / way,
                     far = ((way > 0 ? box.high : box.low)[axis] - start) / way;
        if (near > from) {
            from = near;
            entered = static_cast<Face>(2 * axis + (way > 0 ? 1 : 0));
        }
        to = std::min(to, far);
    }
    return from <= to ? entered : std::nullopt;
}

Camera facing(Face face, Camera camera) {
    switch (face) {
        case Face::plus_z:
            camera.turn_to(StandardView::face);
            return camera;
        case Face::minus_z:
            camera.turn_to(StandardView::back);
            return camera;
        case Face::minus_x:
            camera.azimuth_deg = 0;
            break;
        case Face::plus_x:
            camera.azimuth_deg = 180;
            break;
        case Face::plus_y:
            camera.azimuth_deg = 90;
            break;
        case Face::minus_y:
            camera.azimuth_deg = -90;
            break;
    }
    camera.elevation_deg = 0;
    return camera;
}

}  // namespace weave::studio
