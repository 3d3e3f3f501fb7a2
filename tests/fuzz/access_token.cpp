// An access token from anywhere, and a body from anywhere that the right key signed: refused, and told why without a word
// of it, or a token that is written as it was read.
#include "support/must.hpp"

#include <weave/keys/access_token.hpp>
#include <weave/keys/hex.hpp>

#include <array>
#include <set>
#include <sodium.h>

using namespace weave;
using fuzz::must;

namespace {

const KeyPair& key() {
    static const KeyPair pair = KeyPair::from_seed(SecretBytes(KeyPair::seed_bytes));
    return pair;
}

std::string base64(std::string_view bytes) {
    constexpr int variant = sodium_base64_VARIANT_URLSAFE_NO_PADDING;
    std::string text(sodium_base64_encoded_len(bytes.size(), variant), '\0');
    sodium_bin2base64(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), variant);
    text.pop_back();
    return text;
}

std::string signed_body(std::string_view body) {
    const auto value = hex_array<64>(key().sign(Purpose::access_token, body).value).value();
    return base64(body) + "." + base64({reinterpret_cast<const char*>(value.data()), value.size()});
}

void check(std::string_view text) {
    static const std::set<std::string> words{
        "is not an access token",  "is of a key that this server does not know",
        "is for another service",  "lives longer than an access token may",
        "has expired: get a new one", "is from a time that has not come: compare the clocks"};
    const Instant now = parse_utc("2026-11-26T12:00:00.000Z").value();
    const std::array<PublicKey, 1> keys{key().public_key()};
    const auto token = read_access_token(text, keys, now);
    if (!token) return must(words.contains(token.error().message), "a refusal has words of its own alone");
    must(token->expires > now && token->expires - token->issued <= longest_access, "a token that counts lives, and not for long");
    const auto again = sign_access_token(key(), *token);
    must(again && *again == text, "a token has one text");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    check(text);
    check(signed_body(text));
    return 0;
}
