#pragma once

#include <weave/core/colour.hpp>
#include <weave/core/result.hpp>

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// Where a decoder puts a picture, row by row from the top, so that a picture is never held twice.
struct RasterSink {
    /// Called once before any row; an error stops the decoder.
    std::function<Status(std::size_t width, std::size_t height)> start;
    std::function<Status(std::size_t row_from_top, std::span<const Colour> pixels)> row;
    std::string reading;                ///< what the file says of itself, if it is one of ours
    std::vector<std::string> warnings;  ///< what was odd about the file
};

/// One decoder a format. Errors say what is wrong with the file; nothing is allocated before `start` agreed
/// to the size.
Status decode_png(std::string_view bytes, RasterSink& sink);
Status decode_tiff(std::string_view bytes, RasterSink& sink);
Status decode_bmp(std::string_view bytes, RasterSink& sink);

/// A bilevel picture to write: packed rows from the top, most significant bit first, 1 = white, padding 0.
struct BilevelRaster {
    std::size_t width = 0, height = 0;
    std::function<void(std::size_t row_from_top, std::span<std::uint8_t> packed)> row;
    std::string reading;  ///< what the picture means, written into the file where it can hold it
};

Result<std::string> encode_png(const BilevelRaster& raster);
Result<std::string> encode_tiff(const BilevelRaster& raster);
Result<std::string> encode_bmp(const BilevelRaster& raster);

/// Pictures that must be held whole while they are decoded (interlaced, tiled, in colours) may have this many
/// pixels.
inline constexpr std::size_t most_pixels_at_once = std::size_t{1} << 26;

/// No picture, read or written, is longer on a side. Rows are held whole, several times over while they are
/// decoded, before a single byte of pixels had to come: a few bytes may claim a side of 2^31.
inline constexpr std::size_t longest_side = std::size_t{1} << 22;

}  // namespace weave
