#include <weave/keys/access_token.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/members.hpp>
#include <weave/keys/sodium.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <sodium.h>
#include <utility>

namespace weave {

namespace {

constexpr const char* format = "weave-access-token";
constexpr const char* service = "simd";
/// How far the clocks of two machines may be apart.
constexpr std::chrono::minutes clock_slack{5};
constexpr int base64 = sodium_base64_VARIANT_URLSAFE_NO_PADDING;

using SignatureBytes = std::array<unsigned char, crypto_sign_BYTES>;

Error refused(std::string why) {
    return {ErrorCode::refused, std::move(why), "token"};
}

Error no_token() {
    return refused("is not an access token");
}

std::string to_base64(std::string_view bytes) {
    std::string text(sodium_base64_encoded_len(bytes.size(), base64), '\0');
    sodium_bin2base64(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), base64);
    text.pop_back();  // libsodium ends it with a zero
    return text;
}

/// The bytes that a text stands for, if it is the one text of them. libsodium takes every byte beyond ASCII for a digit, so
/// what it read is written again and compared.
std::optional<std::string> from_base64(std::string_view text) {
    std::string bytes(text.size(), '\0');
    std::size_t size = 0;
    const char* end = nullptr;
    const int failed = sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), text.data(),
                                         text.size(), nullptr, &size, &end, base64);
    if (failed != 0 || end != text.data() + text.size()) return {};
    bytes.resize(size);
    if (to_base64(bytes) != text) return {};
    return bytes;
}

Json body_of(const AccessToken& token) {
    return {{"format", format},      {"version", 1},
            {"site", token.site},    {"person", token.person},
            {"service", service},    {"issued", utc_text(token.issued)},
            {"expires", utc_text(token.expires)}};
}

struct TokenParts {
    std::string body;
    SignatureBytes signature{};
};

std::optional<TokenParts> parts_of(std::string_view text) {
    const std::size_t stop = text.find('.');
    if (text.size() > most_access_token || stop == std::string_view::npos) return {};
    auto body = from_base64(text.substr(0, stop));
    const auto signature = from_base64(text.substr(stop + 1));
    TokenParts parts;
    if (!body || body->empty() || !signature || signature->size() != parts.signature.size()) return {};
    parts.body = *std::move(body);
    std::copy(signature->begin(), signature->end(), parts.signature.begin());
    return parts;
}

/// Whether one of the keys signed it; each is tried, so that the time tells not which.
bool is_signed(const TokenParts& parts, std::span<const PublicKey> keys) {
    const std::string value = to_hex(parts.signature);
    bool is_known = false;
    for (const PublicKey& key : keys) is_known |= verify(key, Purpose::access_token, parts.body, {key_id(key), value});
    return is_known;
}

/// What a body says, after it was seen to be signed.
Result<AccessToken> read_body(const std::string& body, std::string& for_service) {
    const auto json = parse_json(body);
    if (!json || canonical_json(*json) != body) return no_token();
    JsonReader reader(*json, "");
    read_heading(reader, format);
    AccessToken token;
    token.site = name_member(reader, "site");
    token.person = name_member(reader, "person");
    for_service = name_member(reader, "service");
    token.issued = utc_member(reader, "issued");
    token.expires = utc_member(reader, "expires");
    reader.no_others();
    if (reader.failed()) return no_token();
    return token;
}

bool has_life(const AccessToken& token) {
    return token.expires > token.issued && token.expires - token.issued <= longest_access;
}

}  // namespace

Result<std::string> sign_access_token(const KeyPair& key, const AccessToken& token) {
    need_sodium();
    const std::string body = canonical_json(body_of(token));
    std::string unused;
    if (!read_body(body, unused)) return bad_input("the site and the person must be names", "token");
    if (!has_life(token)) return bad_input("lives for more than nothing and at most 12 hours", "token");
    SignatureBytes signature{};
    from_hex(key.sign(Purpose::access_token, body).value, signature);
    return to_base64(body) + "." +
           to_base64({reinterpret_cast<const char*>(signature.data()), signature.size()});
}

Result<AccessToken> read_access_token(std::string_view text, std::span<const PublicKey> keys, Instant now) {
    need_sodium();
    const auto parts = parts_of(text);
    if (!parts) return no_token();
    if (!is_signed(*parts, keys)) return refused("is of a key that this server does not know");
    std::string for_service;
    WEAVE_TRY(AccessToken token, read_body(parts->body, for_service));
    if (for_service != service) return refused("is for another service");
    if (!has_life(token)) return refused("lives longer than an access token may");
    if (token.issued > now + clock_slack) return refused("is from a time that has not come: compare the clocks");
    if (token.expires <= now) return refused("has expired: get a new one");
    return token;
}

}  // namespace weave
