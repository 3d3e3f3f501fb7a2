#include <algorithm>
#include <loomlink/audit/hash.hpp>
#include <openssl/sha.h>

namespace weave::loomlink {

namespace {

unsigned digit_of(char c) {
    return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
}

}  // namespace

Hash sha256(std::string_view bytes) {
    Hash hash{};
    ::SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash.data());
    return hash;
}

std::string hash_hex(const Hash& hash) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text;
    text.reserve(2 * hash.size());
    for (const unsigned char byte : hash) {
        text.push_back(digits[byte >> 4]);
        text.push_back(digits[byte & 15]);
    }
    return text;
}

bool is_lower_hex(std::string_view text, std::size_t characters) {
    return text.size() == characters && std::all_of(text.begin(), text.end(), [](char c) {
               return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
           });
}

std::optional<Hash> parse_hash(std::string_view text) {
    if (!is_lower_hex(text, 64)) return {};
    Hash hash{};
    for (std::size_t k = 0; k < hash.size(); ++k)
        hash[k] = static_cast<unsigned char>(digit_of(text[2 * k]) << 4 | digit_of(text[2 * k + 1]));
    return hash;
}

}  // namespace weave::loomlink
