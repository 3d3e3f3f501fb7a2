#include <weave/keys/hex.hpp>

#include <algorithm>

namespace weave {

namespace {

constexpr std::string_view digits = "0123456789abcdef";

unsigned digit(char c) {
    return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
}

}  // namespace

std::string to_hex(std::span<const unsigned char> bytes) {
    std::string text;
    text.reserve(2 * bytes.size());
    for (const unsigned char byte : bytes) {
        text.push_back(digits[byte >> 4]);
        text.push_back(digits[byte & 15]);
    }
    return text;
}

bool is_hex(std::string_view text, std::size_t characters) {
    return text.size() == characters && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
           });
}

bool from_hex(std::string_view text, std::span<unsigned char> bytes) {
    if (!is_hex(text, 2 * bytes.size())) return false;
    for (std::size_t k = 0; k < bytes.size(); ++k)
        bytes[k] = static_cast<unsigned char>(digit(text[2 * k]) << 4 | digit(text[2 * k + 1]));
    return true;
}

}  // namespace weave
