#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <loomlink/keys/trust.hpp>
#include <string>

namespace weave::loomlink {

/// How far the log had come: its number of records and the root of their Merkle tree (RFC 9162).
struct TreeHead {
    std::string site;
    std::uint64_t size = 0;
    std::string root;  ///< 64 hexadecimal characters
    Instant at;
    friend bool operator==(const TreeHead&, const TreeHead&) = default;
};

/// The body to sign with the log key: `at`, `root`, `site`, `size`.
Json tree_head_body(const TreeHead& head);

/// A head that a key with the role `log` signed for the site of `trust`. Errors say what is wrong with it.
Result<TreeHead> open_tree_head(const SignedDocument& document, const TrustDocument& trust);

}  // namespace weave::loomlink
