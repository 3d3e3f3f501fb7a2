#pragma once

#include <weave/design/design.hpp>

#include <studio/document/edit_step.hpp>

namespace weave::studio {

/// The warp's yarns and their order. While a person drags, `is_dragging`, the steps become one.
EditStep set_warp(const WarpPlan& warp, bool is_dragging = false);

}  // namespace weave::studio
