#include <weave/io/stencil_picture.hpp>

#include <algorithm>

namespace weave {

Result<std::vector<CountedColour>> count_colours(const ColourImage& image, std::size_t most) {
    std::map<Colour, std::size_t> counts;
    auto found = counts.end();
    for (const Colour colour : image.pixels) {
        if (found == counts.end() || found->first != colour) {  // mostly it is that of the pixel before
            found = counts.try_emplace(colour, 0).first;
            if (counts.size() > most) {
                return bad_input(
                    "the picture has more than " + std::to_string(most) +
                    " colours; a stencil's picture has one colour for each block: reduce its colours "
                    "in a picture editor first, without smoothing");
            }
        }
        ++found->second;
    }
    std::vector<CountedColour> list;
    for (const auto& [colour, pixels] : counts) list.push_back({colour, pixels});
    std::ranges::stable_sort(list, std::ranges::greater(), &CountedColour::pixels);
    return list;
}

Result<StencilMap> stencil_map(const ColourImage& image, const std::map<Colour, std::uint16_t>& numbers) {
    StencilMap map{image.rows, image.columns, {}};
    map.blocks.reserve(image.pixels.size());
    auto found = numbers.end();
    for (std::size_t k = 0; k < image.pixels.size(); ++k) {
        if (found == numbers.end() ||
            found->first != image.pixels[k])  // mostly it is that of the pixel before
            found = numbers.find(image.pixels[k]);
        if (found == numbers.end()) {
            return bad_input("the pixel in row " + std::to_string(k / image.columns + 1) +
                             " from the bottom and column " + std::to_string(k % image.columns + 1) +
                             " has the colour " + to_text(image.pixels[k]) + ", to which no block is given");
        }
        map.blocks.push_back(found->second);
    }
    return map;
}

}  // namespace weave
