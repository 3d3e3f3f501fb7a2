#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/key.hpp>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// A body and the signatures over its canonical bytes: what trust documents, release indexes, manifests and
/// tree heads are.
struct SignedDocument {
    Json body;
    std::vector<Signature> signatures;
};

/// No document has more signatures.
inline constexpr std::size_t most_signatures = 64;

/// The signature of a key over a body for one purpose.
Signature sign_body(const KeyPair& pair, Purpose purpose, const Json& body);

/// Whether the signature is of this key over this body for this purpose; see verify().
[[nodiscard]] bool verify_body(const PublicKey& key, Purpose purpose, const Json& body,
                               const Signature& signature);

/// `{"body":…,"signatures":[{"key":…,"value":…},…]}` in canonical form, signatures sorted by key. A document
/// has one sequence of bytes only, so the SHA-256 of a file names what it says.
std::string write_signed(const SignedDocument& document);
Json to_json(const SignedDocument& document);

/// Reads the form alone; who signed is for the caller to check. Refused, each in words: more than `limit`
/// bytes, JSON that is not in canonical form (a space, a number such as 1.0 or beyond 2^53, members in
/// another order), other members, a key that signs twice, signatures out of order or none.
Result<SignedDocument> read_signed(std::string_view bytes, std::size_t limit);
/// The same of a value inside a document whose bytes were seen to be canonical.
Result<SignedDocument> signed_from_json(const Json& json);

/// SHA-256 of the canonical bytes of a body: what the people signed, whoever signs it again later.
std::string body_sha256(const SignedDocument& document);

}  // namespace weave
