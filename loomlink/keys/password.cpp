#include <loomlink/keys/password.hpp>

#include <weave/core/text.hpp>
#include <weave/keys/codes.hpp>
#include <weave/keys/sodium.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <new>
#include <sodium.h>

namespace weave::loomlink {

namespace {

constexpr std::size_t least_characters = 12, most_bytes = 1024;

Error no_password(std::string why) {
    return {ErrorCode::refused, std::move(why), "password"};
}

/// ASCII letters alone: a rule against carelessness, not against people who try.
bool same_but_case(std::string_view one, std::string_view other) {
    return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    });
}

bool has_control(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 || byte == 0x7f;
    });
}

/// How many characters there are, and whether they are all the same.
std::pair<std::size_t, bool> characters_of(std::string_view text) {
    const std::string_view first = text.substr(0, utf8_length(text));
    std::size_t count = 0;
    bool all_same = true;
    while (!text.empty()) {
        const std::string_view character = text.substr(0, utf8_length(text));
        all_same = all_same && character == first;
        text.remove_prefix(character.size());
        ++count;
    }
    return {count, all_same};
}

}  // namespace

Status check_password(std::string_view password, std::string_view login, std::string_view full_name) {
    if (password.size() > most_bytes)
        return no_password("has more than " + std::to_string(most_bytes) + " bytes; take a shorter one");
    if (!is_utf8(password) || has_control(password))
        return no_password(
            "has characters that cannot be typed everywhere; take letters, digits, signs and spaces");
    const auto [count, all_same] = characters_of(password);
    if (count < least_characters)
        return no_password("is too short: it takes " + std::to_string(least_characters) +
                           " characters or more, and a few words in a row will do");
    if (all_same) return no_password("is one character over and over; take another one");
    if (same_but_case(password, login) || same_but_case(password, full_name))
        return no_password("is your name, which others know; take another one");
    return {};
}

PasswordHasher::PasswordHasher(GuessCost cost) : m_cost(cost), m_nobody(hash(make_token())) {}

std::string PasswordHasher::hash(std::string_view password) const {
    need_sodium();
    std::array<char, crypto_pwhash_STRBYTES> text{};
    const ArgonPlace place;
    if (crypto_pwhash_str_alg(text.data(), password.data(), password.size(), m_cost.passes,
                              m_cost.memory_bytes, crypto_pwhash_ALG_ARGON2ID13) != 0)
        throw std::bad_alloc();
    return text.data();
}

bool PasswordHasher::matches(const std::optional<std::string>& stored, std::string_view password) const {
    const std::string& text = stored ? *stored : m_nobody;
    const ArgonPlace place;
    const bool same = crypto_pwhash_str_verify(text.c_str(), password.data(), password.size()) == 0;
    return same && stored.has_value();
}

bool PasswordHasher::is_stale(const std::string& stored) const {
    return crypto_pwhash_str_needs_rehash(stored.c_str(), m_cost.passes, m_cost.memory_bytes) != 0;
}

}  // namespace weave::loomlink
