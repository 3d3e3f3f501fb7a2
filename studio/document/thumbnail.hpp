#pragma once

#include <weave/block/block.hpp>
#include <weave/design/design.hpp>

#include <QImage>

namespace weave::studio {

/// The face of a block in its yarns' colours, `side` pixels along its longer side: of a small block several repeats, of a large
/// one samples of it.
QImage thumbnail(const Design& design, const Block& block, int side);

}  // namespace weave::studio
