#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <loomlink/keys/trust.hpp>
#include <string>

namespace weave::loomlink {

/// How far the log had come: its number of records and the root of their Merkle tree (RFC 9162). The bytes
/// are those of a head in loomlink/audit, which this part may not include.
struct LogHead {
    std::string site;
    std::uint64_t size = 0;  ///< at least 1
    std::string root;        ///< 64 hexadecimal characters
    Instant at;
    friend bool operator==(const LogHead&, const LogHead&) = default;
};

/// A head and the signature of the log's key.
struct SignedLogHead {
    LogHead head;
    Signature signature;
    friend bool operator==(const SignedLogHead&, const SignedLogHead&) = default;
};

SignedLogHead sign_head(const KeyPair& log_key, const LogHead& head);

/// `{"head":{"at","root","site","size"},"signature":{"key","value"}}`
Json to_json(const SignedLogHead& signed_head);

/// Reads the form alone; see check_head().
Result<SignedLogHead> head_from_json(const Json& json);

/// Whether a key with the role `log` signed the head for the site of `trust`. Errors say what is wrong with
/// it.
Status check_head(const SignedLogHead& signed_head, const TrustDocument& trust);

}  // namespace weave::loomlink
