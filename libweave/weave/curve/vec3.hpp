#pragma once

#include <Eigen/Core>

namespace weave {

/// A place or direction in the cloth: x along the ends, y along the picks, z up; in mm unless a name says
/// otherwise.
using Vec3 = Eigen::Vector3d;

}  // namespace weave
