#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <loomlink/audit/record.hpp>
#include <string>

namespace weave::loomlink {

/// The whole log in one hash.
struct TreeHead {
    std::string site;
    std::uint64_t size = 0;  ///< records, at least 1
    Hash root{};
    std::string at;  ///< when it was signed, UTC as in a Statement
    friend bool operator==(const TreeHead&, const TreeHead&) = default;
};

struct SignedTreeHead {
    TreeHead head;
    RecordSignature signature;  ///< by the log's key over head_bytes()
    friend bool operator==(const SignedTreeHead&, const SignedTreeHead&) = default;
};

/// `{"at":…,"root":…,"site":…,"size":…}` in canonical form: what is signed.
std::string head_bytes(const TreeHead& head);

/// `{"head":{…},"signature":{…}}` in canonical form: what is handed out, retained and exported.
std::string signed_head_bytes(const SignedTreeHead& head);

/// Reads what signed_head_bytes() writes, and nothing else. Who signed is for the caller to check.
Result<SignedTreeHead> parse_signed_head(std::string_view bytes);

}  // namespace weave::loomlink
