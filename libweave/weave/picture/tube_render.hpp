#pragma once

#include <weave/picture/tube_scene.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave {

/// The scene as pixels 0xrrggbb on white, row after row. Four rays a pixel; of all yarns that a ray meets
/// behind the cut, the nearest is seen, of two equally near the one whose axis is nearer. Rows are shared
/// among threads; the result does not depend on their number.
std::vector<std::uint32_t> render(const TubeScene& scene, const TubeCamera& camera, std::size_t width,
                                  std::size_t height);

}  // namespace weave
