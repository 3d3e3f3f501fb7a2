#pragma once

#include <cstdint>
#include <loomlink/audit/head.hpp>
#include <loomlink/audit/record.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// The whole log up to a signed head, to be checked by anybody without the store. FORMAT.md describes the
/// file.
struct AuditBundle {
    SignedTreeHead head;
    std::vector<Hash> leaves;
    std::vector<std::string> records;  ///< record_bytes(), one a leaf
};

/// The bundle as a file: JSON with one leaf and one record a line, so that damage to a line leaves the others
/// readable.
std::string write_bundle(const AuditBundle& bundle);

/// Something in a log or store that is not as it was written.
struct AuditFinding {
    std::optional<std::uint64_t> seq;  ///< the record, where it is about one
    std::string place;                 ///< `head`, `record 17`, `line 5`
    std::string cause;
    [[nodiscard]] std::string text() const { return place + ": " + cause; }
};

/// What the reader of a bundle trusts beforehand.
struct BundleTrust {
    SignatureCheck log;  ///< the log's own key
    std::optional<SignedTreeHead>
        retained;               ///< a head kept from earlier; without one a rollback cannot be seen
    SignatureCheck statements;  ///< the keys of people; empty: their signatures are not looked at
    /// Whether the statement of an `evidence.added` is signed by the machine that it names; empty: not looked at.
    std::function<bool(const Statement&)> evidence{};
};

struct BundleReport {
    std::optional<SignedTreeHead> head;  ///< what the bundle says of itself, where it can be read
    std::uint64_t records = 0;           ///< lines that stand as records
    std::vector<AuditFinding> findings;  ///< the first `most_findings`
    std::uint64_t unlisted = 0;          ///< findings beyond those
    [[nodiscard]] bool clean() const { return findings.empty(); }
};

inline constexpr std::size_t most_findings = 1000;

/// Holds every byte of a bundle to the signed head: its layout, the head's signature, the leaves that make
/// its root, each record's leaf, form, number, site and link to the one before; with a retained head, that
/// the log only grew. Any change of the file makes a finding, which names the record where it lies in one.
/// Reads any bytes.
BundleReport verify_bundle(std::string_view file, const BundleTrust& trust);

}  // namespace weave::loomlink
