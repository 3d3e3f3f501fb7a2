#include <weave/core/colour.hpp>

#include <cctype>
#include <charconv>

namespace weave {

std::string to_text(Colour colour) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text = "#";
    for (const std::uint8_t part : {colour.red, colour.green, colour.blue}) {
        text.push_back(digits[part >> 4]);
        text.push_back(digits[part & 15]);
    }
    return text;
}

Result<Colour> parse_colour(std::string_view text) {
    std::uint32_t value = 0;
    const char* end = text.data() + text.size();
    const bool shaped =
        text.size() == 7 && text[0] == '#' && std::isxdigit(static_cast<unsigned char>(text[1])) != 0;
    if (!shaped || std::from_chars(text.data() + 1, end, value, 16).ptr != end) {
        return bad_input("'" + std::string(text) + "' is not a colour such as #d08030");
    }
    return Colour{static_cast<std::uint8_t>(value >> 16), static_cast<std::uint8_t>(value >> 8 & 0xff),
                  static_cast<std::uint8_t>(value & 0xff)};
}

}  // namespace weave
