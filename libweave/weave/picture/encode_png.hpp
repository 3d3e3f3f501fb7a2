#pragma once

#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <string>

namespace weave {

/// An RGB picture as PNG: with a palette where it has at most 256 colours, which is small and quick even for
/// a whole shoe. `row_stride` counts pixels; a pixel is 0xrrggbb, its top byte is ignored.
Result<std::string> encode_png(const std::uint32_t* pixels, std::size_t width, std::size_t height,
                               std::size_t row_stride);

}  // namespace weave
