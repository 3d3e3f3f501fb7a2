#pragma once

#include <weave/io/bitmap.hpp>

#include <cstdint>
#include <string_view>

namespace weave::fuzz {

/// A picture from anywhere, read as a card in each reading and as a stencil's colours: refused with a reason,
/// or one that writes as `format` and reads as itself. One that claims to be large, where the caller can
/// tell, is read once.
void try_picture(std::string_view bytes, BitmapFormat format, std::uint64_t claimed_pixels = 0);

}  // namespace weave::fuzz
