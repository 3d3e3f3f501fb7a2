#pragma once

#include <weave/core/json_reader.hpp>

#include <cstdint>
#include <loomlink/keys/log_head.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// What has become of a release. It only ever moves on.
enum class ReleaseState : std::uint8_t { released, superseded, withdrawn };

const std::string& name_of(ReleaseState state);
/// The member `state` of a document, one of the three names.
ReleaseState release_state_member(JsonReader& reader);

/// One release in an index.
struct IndexEntry {
    std::uint64_t number = 0;  ///< counts the releases for this loom, from 1
    std::string revision_sha256;
    std::string manifest_sha256;  ///< of the bytes of the signed manifest
    ReleaseState state = ReleaseState::released;
    friend bool operator==(const IndexEntry&, const IndexEntry&) = default;
};

/// All releases for one loom, as the server stamps them with its key for a short time.
struct ReleaseIndex {
    std::string site, loom;
    std::uint64_t trust = 1;  ///< number of the trust document under which it was stamped
    /// How many records the log had when the last one that concerns this loom's releases was in it. So it
    /// never falls, is never more than the size of the log, and two indexes of one epoch list the same.
    std::uint64_t epoch = 0;
    Instant issued, expires;
    SignedLogHead tree_head;           ///< the log's newest head
    std::vector<IndexEntry> releases;  ///< every release for this loom so far, by number

    /// The entry of a release, or nullptr.
    [[nodiscard]] const IndexEntry* find(std::uint64_t number) const;
};

inline constexpr std::size_t most_index_bytes = std::size_t{4} << 20, most_releases = 10000;

/// No index may hold for longer than this, whatever it says: a stamp key that was stolen for an hour must not
/// stamp for a year.
inline constexpr std::chrono::hours longest_validity{7 * 24};

/// The body to sign with the stamp key.
Json index_body(const ReleaseIndex& index);
/// SHA-256 of the list of releases alone: equal for two indexes that list the same.
std::string releases_sha256(const ReleaseIndex& index);

/// An index as a key with the role `stamp` signed it for the site of `trust`, in sound form: numbers
/// ascending, valid for no longer than `longest_validity`, with a head that the log's key signed. Whether it
/// is fresh and the right one is for check_index() in loomlink/terminal.
Result<ReleaseIndex> open_index(std::string_view bytes, const TrustDocument& trust);

}  // namespace weave::loomlink
