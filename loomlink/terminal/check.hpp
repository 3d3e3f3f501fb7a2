#pragma once

#include <weave/core/result.hpp>

#include <functional>
#include <loomlink/keys/release_manifest.hpp>
#include <loomlink/terminal/state.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// Tells whether the log of the newer head holds all of the older one's, unchanged and in order: a
/// consistency proof of RFC 9162 that came with the index. Asked only where `newer` is larger; the error says
/// what is wrong.
using ConsistencyCheck = std::function<Status(const LogHead& older, const LogHead& newer)>;

/// A manifest as open_manifest() reads it. Whatever is wrong with its bytes is a finding (`invalid`): they
/// are not what people signed whose keys count here, be they forged, cut, in another form or of another site.
Result<ReleaseManifest> check_manifest(std::string_view bytes, const TrustDocument& trust);

/// How far two sound clocks may be apart.
inline constexpr std::chrono::minutes clock_tolerance{5};

/// An index that was found good, and the state to keep (save_state()) before anything is done by it.
struct CheckedIndex {
    ReleaseIndex index;
    TerminalState state;
};

/// The state under newer trust documents, each signed as next_trust() asks. What keys told that are trusted
/// no more is forgotten, since they may have been stolen: the epochs of a stamp key, a head of a log key; and
/// when a stamp key went, which releases there were and what became of them, save what people signed.
Result<TerminalState> adopt_trust(const TerminalState& state, std::span<const std::string> documents);

/// Judges an index by what the terminal trusts and remembers. A finding (`invalid`): forged, or not in its
/// form. Refused, with a sentence each: of another loom, stamped under another trust document, expired or
/// from the future (freeze), a clock turned back, an older epoch (rollback), an epoch beyond the log
/// (fast-forward), two lists for one epoch, a log that is not the one seen before, a release that vanished,
/// changed or came back.
Result<CheckedIndex> check_index(const TerminalState& state, std::string_view index_bytes, Instant now,
                                 const ConsistencyCheck& consistent);

/// A file as it was pulled.
struct PulledFile {
    std::string path, bytes;
};

/// A release whose every byte was found good.
struct CheckedRelease {
    ReleaseManifest manifest;
    std::vector<PulledFile> files;  ///< the signed manifest among them
    std::string folder;             ///< name of the folder into which place_release() puts it
};

/// Judges a pulled release. Findings (`invalid`), with a sentence each: a manifest other than the listed one
/// (mix and match), too few or wrong signatures, files missing, too many or not as signed. Refused: an index
/// that has run out, a release that is not listed, superseded or withdrawn, another loom, revision or number,
/// another content under a number seen before.
Result<CheckedRelease> check_release(const CheckedIndex& checked, std::uint64_t number,
                                     std::string_view manifest_bytes, std::vector<PulledFile> files,
                                     Instant now);

}  // namespace weave::loomlink
