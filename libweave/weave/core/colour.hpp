#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace weave {

/// An opaque sRGB colour.
struct Colour {
    std::uint8_t red = 0, green = 0, blue = 0;
    friend bool operator==(const Colour&, const Colour&) = default;
    friend auto operator<=>(const Colour&, const Colour&) = default;
};

/// `#rrggbb` in lower case.
std::string to_text(Colour colour);

/// Reads `#rrggbb`, either case. Anything else is an error.
Result<Colour> parse_colour(std::string_view text);

}  // namespace weave
