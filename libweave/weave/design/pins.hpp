#pragma once

#include <weave/block/block.hpp>
#include <weave/core/result.hpp>
#include <weave/design/scene.hpp>

namespace weave {

/// Whether the cloth has every yarn that the scene pins, which no document knows before it is evaluated. The
/// error carries the first stray pin's place, such as `scene.pins[2].number`.
Status check_pins(const Scene& scene, const Block& cloth);

}  // namespace weave
