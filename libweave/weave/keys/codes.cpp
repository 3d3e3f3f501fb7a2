#include <weave/keys/codes.hpp>

#include <weave/core/sha256.hpp>
#include <weave/keys/sodium.hpp>

#include <array>
#include <cctype>
#include <sodium.h>

namespace weave {

namespace {

constexpr std::string_view alphabet = "23456789abcdefghjkmnpqrstuvwxyz";
constexpr std::size_t groups = 6, group_length = 4;
constexpr std::size_t token_bytes = 32;

}  // namespace

std::string make_code() {
    need_sodium();
    std::string code;
    for (std::size_t k = 0; k < groups * group_length; ++k) {
        if (k > 0 && k % group_length == 0) code.push_back('-');
        code.push_back(alphabet[randombytes_uniform(alphabet.size())]);  // without a bias
    }
    return code;
}

Result<std::string> code_hash(std::string_view typed) {
    constexpr std::size_t most_typed = 200;
    std::string plain;
    for (const char c : typed.substr(0, most_typed))
        if (c != '-' && c != ' ')
            plain.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    if (typed.size() > most_typed || plain.size() != groups * group_length ||
        plain.find_first_not_of(alphabet) != std::string::npos)
        return bad_input(
            "is no code: a code has six groups of four, of digits and letters without 0, 1, i, l and o");
    return sha256_hex(plain);
}

std::string make_token() {
    need_sodium();
    std::array<unsigned char, token_bytes> bytes{};
    randombytes_buf(bytes.data(), bytes.size());
    constexpr int variant = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
    std::array<char, sodium_base64_ENCODED_LEN(token_bytes, variant)> text{};
    sodium_bin2base64(text.data(), text.size(), bytes.data(), bytes.size(), variant);
    sodium_memzero(bytes.data(), bytes.size());
    return text.data();
}

std::string token_hash(std::string_view token) {
    return sha256_hex(token);
}

}  // namespace weave
