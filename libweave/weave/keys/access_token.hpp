#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>
#include <weave/keys/utc.hpp>

#include <chrono>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace weave {

/// Lets a person use simd for some hours: who signs in to loomlink is given one, and simd needs nothing but loomlink's
/// public key to know the person. It cannot be called back, so it lives for hours and not for days.
struct AccessToken {
    std::string site;    ///< that gave it
    std::string person;  ///< the name to sign in with
    Instant issued{}, expires{};
    friend bool operator==(const AccessToken&, const AccessToken&) = default;
};

inline constexpr std::chrono::hours longest_access{12};
/// No token has more bytes.
inline constexpr std::size_t most_access_token = 4096;

/// The token as a text that fits a header: base64url of the canonical body, a full stop, base64url of the signature's 64
/// bytes. Errors (bad_input): a life of nothing or of more than longest_access, names that are none.
Result<std::string> sign_access_token(const KeyPair& key, const AccessToken& token);

/// Reads a token that one of these keys signed and that counts now. Refused in words: a text that is none, a foreign key,
/// another service, not yet or no longer good. The signature is looked at before anything that was signed, with every
/// key, and no message repeats what the token says, so that a refusal tells no stranger more than its words.
Result<AccessToken> read_access_token(std::string_view text, std::span<const PublicKey> keys, Instant now);

}  // namespace weave
