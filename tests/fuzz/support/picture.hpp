#pragma once

#include <weave/io/bitmap.hpp>

#include <cstdint>
#include <string_view>

namespace weave::fuzz {

/// A picture from anywhere, read as a card in each reading and as a stencil's colours: refused with a reason,
/// or one that writes as `format` and reads as itself.
void try_picture(std::string_view bytes, BitmapFormat format);

}  // namespace weave::fuzz
