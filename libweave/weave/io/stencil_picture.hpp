#pragma once

#include <weave/block/operations.hpp>
#include <weave/io/bitmap.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace weave {

/// A colour of a picture, and how many pixels have it.
struct CountedColour {
    Colour colour;
    std::size_t pixels = 0;
    friend bool operator==(const CountedColour&, const CountedColour&) = default;
};

/// The colours of a picture, the most frequent first (equals by colour). Colours are never guessed together:
/// a picture with more than `most` is an error that says what to do, for it is a photograph or was scaled
/// with smoothing.
Result<std::vector<CountedColour>> count_colours(const ColourImage& image, std::size_t most);

/// The stencil that a picture draws: of each pixel the number that its colour has. A colour without a number
/// is an error that names the first such pixel.
Result<StencilMap> stencil_map(const ColourImage& image, const std::map<Colour, std::uint16_t>& numbers);

}  // namespace weave
