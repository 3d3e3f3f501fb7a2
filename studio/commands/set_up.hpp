#pragma once

#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// How the cloth is set up and simulated. While a person drags, `is_dragging`, the steps become one.
EditStep set_scene(const Scene& scene, bool is_dragging = false);
EditStep set_warp(const WarpPlan& warp, bool is_dragging = false);
EditStep set_weft(const WeftPlan& weft, bool is_dragging = false);
EditStep set_title(const std::string& title, const std::string& notes);

}  // namespace weave::studio
