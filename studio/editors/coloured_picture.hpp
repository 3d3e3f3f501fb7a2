#pragma once

#include <weave/core/result.hpp>
#include <weave/io/stencil_picture.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace weave::studio {

/// A picture of which a stencil can be made, and its colours.
struct ColouredPicture {
    std::shared_ptr<const ColourImage> image;
    std::vector<CountedColour> colours;
};

/// A picture with more colours is refused.
inline constexpr std::size_t most_picture_colours = 64;

/// Reads PNG, TIFF or BMP. Errors name the file: it is no picture, too large, or has too many colours.
Result<ColouredPicture> read_coloured_picture(const std::filesystem::path& path);

/// The palette of a stencil in which each colour of a picture stands for the block of this name, and the place of each colour in it.
struct PicturePalette {
    std::vector<std::string> blocks;
    std::map<Colour, std::uint16_t> numbers;
};
PicturePalette palette_of(const ColouredPicture& picture, const std::vector<std::string>& blocks);

}  // namespace weave::studio
