#pragma once

#include <weave/block/block.hpp>
#include <weave/design/design.hpp>

#include <QImage>

#include <cstddef>
#include <cstdint>

namespace weave::studio {

/// What the card editor can show of a block.
enum class CardMode : std::uint8_t { card, layer, face, back, face_floats, back_floats };

/// A picture with a pixel a stack, row 0 its first line, for every mode but the card. `layer` counts from the top, from 0. The back is not
/// mirrored here: its ends keep their columns.
QImage block_picture(const Design& design, const Block& block, CardMode mode, std::size_t layer);

}  // namespace weave::studio
