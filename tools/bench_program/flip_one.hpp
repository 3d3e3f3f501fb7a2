#pragma once

#include <weave/design/design.hpp>

namespace weave::bench {

/// Flips one more crossing of a design's cloth that may flip: for each number another one, far from the
/// others.
void flip_one(Design& design, std::size_t number);

}  // namespace weave::bench
