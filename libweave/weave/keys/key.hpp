#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace weave {

using PublicKey = std::array<unsigned char, 32>;

/// What a signature is for. Each purpose has a domain of its own in front of the signed bytes, so that a
/// signature made for one can never be shown for another. The texts are part of the formats: do not change
/// them.
enum class Purpose : std::uint8_t {
    statement,         ///< who did what in the log: "weave statement v1"
    tree_head,         ///< size and root of the log: "weave tree head v1"
    release_manifest,  ///< the files of a release: "weave release manifest v1"
    release_index,     ///< what is released for a loom now: "weave release index v1"
    trust_document,    ///< whose keys count for what: "weave trust document v1"
    evidence,          ///< what a simulation found: "weave evidence v1"
    access_token,      ///< who may use a service for some hours: "weave access token v1"
};

/// The bytes that are signed: the domain of the purpose, a line feed, the message.
std::string signing_bytes(Purpose purpose, std::string_view message);

/// The SHA-256 of the public key, 64 lower-case hexadecimal characters. All of it, since half could be met by
/// a foreign key that somebody searched for; programs may show a person the first 16.
std::string key_id(const PublicKey& key);

/// A public key from 64 hexadecimal characters. Refused: what is not a point of the curve's main group, the
/// points of small order above all, under which one signature fits many messages.
Result<PublicKey> parse_public_key(std::string_view hex);

/// A signature (Ed25519, RFC 8032) and the key that it is said to be of.
struct Signature {
    std::string key;    ///< key_id(), 64 hexadecimal characters
    std::string value;  ///< 64 bytes as 128 hexadecimal characters
    friend bool operator==(const Signature&, const Signature&) = default;
};

/// Whether the signature is of this key over the message for this purpose. Strict: no S beyond the group's
/// order, no points of small order, the key id must be that of `key`.
[[nodiscard]] bool verify(const PublicKey& key, Purpose purpose, std::string_view message,
                          const Signature& signature);

/// A key pair with its secret in guarded memory.
class KeyPair {
  public:
    static constexpr std::size_t seed_bytes = 32;

    static KeyPair generate();
    /// The pair that follows from a seed of 32 bytes; another length is a mistake of the programmer.
    static KeyPair from_seed(const SecretBytes& seed);

    [[nodiscard]] const PublicKey& public_key() const { return m_public; }
    [[nodiscard]] const std::string& id() const { return m_id; }
    /// What the pair can be made from again.
    [[nodiscard]] SecretBytes seed() const;
    [[nodiscard]] Signature sign(Purpose purpose, std::string_view message) const;

  private:
    explicit KeyPair(const SecretBytes& seed);

    PublicKey m_public{};
    SecretBytes m_secret;
    std::string m_id;
};

}  // namespace weave
