#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace weave {

/// Lower-case hexadecimal.
std::string to_hex(std::span<const unsigned char> bytes);

/// Whether `text` is `characters` of lower-case hexadecimal and nothing else. Upper case is refused, so that
/// a value has one text only.
bool is_hex(std::string_view text, std::size_t characters);

/// Fills `bytes` from its hexadecimal text; false (and `bytes` as they were) where the text is not exactly
/// that.
bool from_hex(std::string_view text, std::span<unsigned char> bytes);

/// The bytes of a text, or nothing where it is not exactly N bytes in lower-case hexadecimal.
template <std::size_t N>
std::optional<std::array<unsigned char, N>> hex_array(std::string_view text) {
    std::array<unsigned char, N> bytes{};
    if (!from_hex(text, bytes)) return {};
    return bytes;
}

}  // namespace weave
