#pragma once

#include <weave/block/operations.hpp>
#include <studio/viewport/camera.hpp>

#include <array>
#include <optional>
#include <vector>

namespace weave::studio {

inline constexpr std::array<Face, 6> all_faces{Face::plus_x,  Face::minus_x, Face::plus_y,
                                               Face::minus_y, Face::plus_z,  Face::minus_z};

/// From the box outwards.
Vec3 normal_of(Face face);
/// Its corners, one after the other round it.
std::array<Vec3, 4> corners_of(const Box& box, Face face);
/// Whether a camera sees the outside of the face.
bool is_seen(const Box& box, Face face, const Camera& camera);
/// The face through which a ray enters the box; nothing where it misses.
std::optional<Face> face_at(const Box& box, const Ray& ray);
/// The turn from which a face is seen straight on, upright, and not in a mirror.
Camera facing(Face face, Camera camera);

}  // namespace weave::studio
