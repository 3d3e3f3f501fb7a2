#include <studio/editors/coloured_picture.hpp>

#include <weave/core/file.hpp>

#include <algorithm>
#include <utility>

namespace weave::studio {

namespace {

Result<ColouredPicture> from_bytes(std::string_view bytes) {
    const auto fits = [](std::size_t rows, std::size_t columns) { return check_card_size(rows, columns); };
    WEAVE_TRY(ColourImage image, read_colour_image(bytes, fits));
    WEAVE_TRY(std::vector<CountedColour> colours, count_colours(image, most_picture_colours));
    return ColouredPicture{std::make_shared<const ColourImage>(std::move(image)), std::move(colours)};
}

}  // namespace

Result<ColouredPicture> read_coloured_picture(const std::filesystem::path& path) {
    WEAVE_TRY(const std::string bytes, read_file(path));
    auto picture = from_bytes(bytes);
    if (!picture) return std::move(picture).error().in(path.string());
    return picture;
}

PicturePalette palette_of(const ColouredPicture& picture, const std::vector<std::string>& blocks) {
    PicturePalette palette;
    for (std::size_t k = 0; k < picture.colours.size(); ++k) {
        const auto known = std::ranges::find(palette.blocks, blocks[k]);
        palette.numbers[picture.colours[k].colour] = static_cast<std::uint16_t>(known - palette.blocks.begin());
        if (known == palette.blocks.end()) palette.blocks.push_back(blocks[k]);
    }
    return palette;
}

}  // namespace weave::studio
