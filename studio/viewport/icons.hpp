#pragma once

#include <QIcon>

#include <cstdint>

namespace weave::studio {

enum class ViewIcon : std::uint8_t {
    fit,
    views,
    locked,
    unlocked,
    perspective,
    picture,
    flip,
    attach,
    back,
    on
};

/// A drawn icon of one colour, that of the palette's text, so that it can be seen on light and dark; sharp at
/// every size.
QIcon view_icon(ViewIcon icon);

}  // namespace weave::studio
