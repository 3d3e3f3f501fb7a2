#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>

#include <array>
#include <loomlink/keys/argon.hpp>
#include <string>
#include <string_view>

namespace weave::loomlink {

/// A person's signing key as the server keeps it: the secret sealed under a key that only the password gives
/// (Argon2id, then XChaCha20-Poly1305). Everything beside the secret is bound to it as associated data, so
/// that no sealed key can be given to another person or be made cheaper to guess.
struct SealedKey {
    std::string person;  ///< the login name
    PublicKey public_key{};
    GuessCost cost;
    std::array<unsigned char, argon_salt_bytes> salt{};
    std::array<unsigned char, 24> nonce{};
    std::array<unsigned char, 48> sealed{};  ///< the seed of 32 bytes and a tag of 16

    [[nodiscard]] std::string id() const { return key_id(public_key); }
};

/// A new key pair of a person, sealed. The password must have been checked with check_password().
SealedKey make_sealed_key(const std::string& person, std::string_view password, GuessCost cost);

/// Opens the key for one signature and wipes it again. Refused, in the same words, where the password is
/// wrong or the sealed key was altered: which of the two it is would help only who guesses.
Result<Signature> sign_with(const SealedKey& key, std::string_view password, Purpose purpose,
                            std::string_view message);

/// The same key sealed under another password. Refused as by sign_with().
Result<SealedKey> change_password(const SealedKey& key, std::string_view old_password,
                                  std::string_view new_password, GuessCost cost);

/// The sealed key as canonical JSON (FORMAT.md in loomlink/terminal), to be stored.
std::string write_sealed_key(const SealedKey& key);

/// Reads what write_sealed_key() wrote. Errors name the member; a cost that nobody would spend is refused.
Result<SealedKey> read_sealed_key(std::string_view text);

}  // namespace weave::loomlink
