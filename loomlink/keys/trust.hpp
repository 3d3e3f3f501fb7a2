#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/signed_document.hpp>
#include <weave/keys/utc.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// What a key counts for. Names in documents: `root`, `release`, `stamp`, `log`, `evidence`.
enum class Role : std::uint8_t {
    root,      ///< says whose keys count (trust documents); a person's
    release,   ///< releases files to looms (manifests); a person's
    stamp,     ///< says what is released now (indexes); the server's
    log,       ///< signs heads of the log; the server's
    evidence,  ///< signs what a simulation found; a simulation machine's
};

const std::string& name_of(Role role);

/// A key and whose it is.
struct TrustedKey {
    PublicKey public_key{};
    std::string person;       ///< login name of its holder, or the name of the machine
    std::vector<Role> roles;  ///< ascending, none twice

    [[nodiscard]] std::string id() const { return key_id(public_key); }
    [[nodiscard]] bool has(Role role) const;
};

/// Whose keys count for what at one site: version n of a chain in which each version is signed by enough
/// roots of the one before and of itself (as The Update Framework's root role). A key that is in the newest
/// version no more is revoked.
struct TrustDocument {
    std::uint64_t version = 1;
    std::string site;
    Instant issued;
    std::vector<TrustedKey> keys;
    /// How many different people must sign a trust document, and a manifest.
    std::size_t root_threshold = 1, release_threshold = 1;

    /// The document as it was signed.
    SignedDocument document;

    /// The key of this id, or nullptr.
    [[nodiscard]] const TrustedKey* find(std::string_view id) const;
    /// SHA-256 of the body: what a person compares when a terminal is set up.
    [[nodiscard]] std::string fingerprint() const { return body_sha256(document); }
};

/// A trust document has at most so many bytes and keys.
inline constexpr std::size_t most_trust_bytes = std::size_t{256} << 10, most_trusted_keys = 256;

/// The body to sign; all of `trust` but `document`.
Json trust_body(const TrustDocument& trust);

/// Reads one document that stands by itself: its form, and enough signatures of its own roots. That it is the
/// right one is for the caller to know, by its fingerprint. Signatures of keys that are no roots of this
/// document (roots of the version before) cannot be judged here and do not count. Refused in form: a key
/// twice, a key of the server with a person's role, thresholds that the people in it cannot reach, no stamp
/// or log key.
Result<TrustDocument> read_trust(std::string_view bytes);

/// Reads the version that follows `now`. Refused, each in words: another site, any version but the next, a
/// signature of a key that is root in neither or does not fit, too few roots of `now` or of itself.
Result<TrustDocument> next_trust(const TrustDocument& now, std::string_view bytes);

/// Follows a chain of documents, each the next of the one before; the last. An error says which.
Result<TrustDocument> follow_trust(TrustDocument pinned, std::span<const std::string> documents);

/// Whether a document is signed by `people` different people whose keys have `role`. Every signature has to
/// be such a one and fit: nothing is passed over. Errors name the key.
Status check_signatures(const SignedDocument& document, Purpose purpose, const TrustDocument& trust,
                        Role role, std::size_t people);

}  // namespace weave::loomlink
