#include <weave/core/text.hpp>

#include <algorithm>
#include <charconv>

namespace weave {

namespace {

/// The number of a character that utf8_length() found whole.
std::uint32_t code_point(std::string_view character) {
    const auto lead = static_cast<unsigned char>(character[0]);
    std::uint32_t code = character.size() == 1 ? lead : lead & (0x7fU >> character.size());
    for (std::size_t k = 1; k < character.size(); ++k)
        code = code << 6 | (static_cast<unsigned char>(character[k]) & 0x3fU);
    return code;
}

/// What a terminal obeys or what reorders the rest of a line, after Unicode's Cc, Zl, Zp and Bidi_Control.
bool is_unprintable(std::uint32_t code) {
    const auto within = [code](std::uint32_t low, std::uint32_t high) { return code >= low && code <= high; };
    return code < 0x20 || within(0x7f, 0x9f) || code == 0x061c || within(0x200e, 0x200f) ||
           within(0x2028, 0x202e) || within(0x2066, 0x2069);
}

std::string hexadecimal(std::uint32_t number, int digits) {
    std::string text;
    for (int k = digits - 1; k >= 0; --k) text += "0123456789abcdef"[number >> 4 * k & 15];
    return text;
}

}  // namespace

std::optional<std::int64_t> parse_whole(std::string_view text) {
    std::int64_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size()) return {};
    return value;
}

std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
    if (text.empty()) return 0;
    const unsigned char lead = byte(0);
    if (lead < 0x80) return 1;
    const std::size_t length = lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
    if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(k) & 0xc0) != 0x80) return 0;
    }
    const bool overlong = (lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xf0 && byte(1) < 0x90);
    const bool beyond = (lead == 0xed && byte(1) > 0x9f) || (lead == 0xf4 && byte(1) > 0x8f);
    return overlong || beyond ? 0 : length;
}

bool is_utf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

std::string on_one_line(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        const std::size_t length = utf8_length(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(length, 1));
        if (length == 0) {
            shown += "\\x" + hexadecimal(static_cast<unsigned char>(text[0]), 2);
        } else if (const std::uint32_t code = code_point(character); is_unprintable(code)) {
            shown += code < 0x80 ? "\\x" + hexadecimal(code, 2) : "\\u" + hexadecimal(code, 4);
        } else {
            shown += character;
        }
        text.remove_prefix(character.size());
    }
    return shown;
}

std::vector<std::uint32_t> shortest_repeat(std::span<const std::uint32_t> list) {
    for (std::size_t length = 1; length < list.size(); ++length) {
        if (list.size() % length != 0) continue;
        if (std::equal(list.begin() + static_cast<std::ptrdiff_t>(length), list.end(), list.begin()))
            return {list.begin(), list.begin() + static_cast<std::ptrdiff_t>(length)};
    }
    return {list.begin(), list.end()};
}

std::string counted(std::size_t number, const std::string& noun) {
    return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

std::string indexed(const std::string& list, std::size_t index) {
    return list + "[" + std::to_string(index) + "]";
}

}  // namespace weave
