#pragma once

#include <weave/block/card_image.hpp>
#include <weave/core/colour.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// How a bilevel picture stands for a card. The default is ours: bottom row = pick 1, left column = end 1,
/// black = end lifted.
struct BitmapReading {
    bool pick_1_at_bottom = true;
    bool end_1_at_left = true;
    bool black_is_lifted = true;
};

enum class BitmapFormat : std::uint8_t { png, tiff, bmp };

/// By the file's extension (.png, .tif, .tiff, .bmp, either case).
Result<BitmapFormat> bitmap_format_of(const std::filesystem::path& path);

/// A card as a bilevel picture file: PNG of one bit grey, TIFF as mills' looms take it (little-endian, one
/// bit, uncompressed, WhiteIsZero, one strip), BMP of one bit. What the reading means is written into PNG
/// text and the TIFF description.
Result<std::string> write_bitmap(const CardImage& card, BitmapFormat format,
                                 const BitmapReading& reading = {});

/// Whether bytes begin as a PNG, TIFF or BMP picture does.
bool is_bitmap(std::string_view bytes);

/// A card from such a file, whatever its format, recognised by its first bytes. Pictures that are not bilevel
/// (two colours, black and white) are refused, with the first pixel that is neither. Warnings tell what was
/// odd.
struct CardFromBitmap {
    CardImage card;
    std::vector<std::string> warnings;
};
Result<CardFromBitmap> read_bitmap(std::string_view bytes, const BitmapReading& reading = {});

/// A card as a picture file that was read back with the same reading and compared: what leaves the system. An
/// error of the system where it differs.
Result<std::string> write_proven_bitmap(const CardImage& card, BitmapFormat format,
                                        const BitmapReading& reading = {});

/// The comparison of it: an error of the system unless `bytes`, read so, are this card.
Status check_reads_back(std::string_view bytes, const CardImage& card, const BitmapReading& reading);

/// A colour picture for stencils: row 0 is the bottom row of the picture.
struct ColourImage {
    std::size_t rows = 0, columns = 0;
    std::vector<Colour> pixels;  ///< rows * columns, row by row from the bottom
};
/// An error where a picture of this size is of no use.
using PictureSizeCheck = std::function<Status(std::size_t rows, std::size_t columns)>;
/// Reads PNG, TIFF or BMP of any common kind. Transparency is refused unless fully opaque. `fits`, if given, is asked
/// before any pixel is read.
Result<ColourImage> read_colour_image(std::string_view bytes, const PictureSizeCheck& fits = {});

/// An 8-bit RGB PNG; rows from the bottom as in ColourImage.
Result<std::string> write_png(const ColourImage& image);

}  // namespace weave
