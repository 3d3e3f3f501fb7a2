#pragma once

#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// How the cloth is simulated, named by what differs from the scene before. While a person drags, `is_dragging`, the steps become one.
EditStep set_scene(const Scene& before, const Scene& scene, bool is_dragging = false);

}  // namespace weave::studio
