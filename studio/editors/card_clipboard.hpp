#pragma once

#include <weave/block/card_image.hpp>
#include <weave/core/result.hpp>

namespace weave::studio {

/// A part of a card on the system's clipboard, for this program and, as a picture, for others.
Status put_on_clipboard(const CardImage& part);
[[nodiscard]] bool clipboard_has_part();
/// Errors: there is none, or what is there is no card.
Result<CardImage> part_on_clipboard();

}  // namespace weave::studio
