#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <loomlink/keys/release_index.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// The newest index that a stamp key gave this loom.
struct SeenStamp {
    std::string key;
    std::uint64_t epoch = 0;
    Instant issued;
    std::string releases_sha256;  ///< of what it listed
    friend bool operator==(const SeenStamp&, const SeenStamp&) = default;
};

/// A release that an index named before.
struct SeenRelease {
    std::uint64_t number = 0;
    std::string revision_sha256;
    ReleaseState state = ReleaseState::released;
    std::string body_sha256;  ///< of what people signed; empty until the manifest was checked here
    friend bool operator==(const SeenRelease&, const SeenRelease&) = default;
};

/// A file that the terminal wrote.
struct PlacedFile {
    std::string path, sha256;
    friend bool operator==(const PlacedFile&, const PlacedFile&) = default;
};

/// A release whose files the terminal put, or was about to put, into a folder of its own.
struct PlacedRelease {
    std::uint64_t number = 0;
    std::filesystem::path within;  ///< the folder of releases, whole from the root, without links: a recall finds it from anywhere
    std::string folder;            ///< name in it
    std::vector<PlacedFile> files;
    [[nodiscard]] std::filesystem::path path() const { return within / folder; }
    friend bool operator==(const PlacedRelease&, const PlacedRelease&) = default;
};

/// All that the terminal of one loom remembers, so that it cannot be told otherwise later. A terminal of two
/// looms keeps two.
struct TerminalState {
    std::string loom;
    TrustDocument trust;
    std::vector<SeenStamp> stamps;           ///< sorted by key, of keys that `trust` knows
    std::optional<SignedLogHead> tree_head;  ///< the last head, signed by a log key that `trust` knows
    std::vector<SeenRelease> releases;       ///< by number
    std::vector<PlacedRelease> placed;
    Instant last_seen;  ///< when an index was last taken, by the terminal's own clock
};

inline constexpr std::size_t most_state_bytes = std::size_t{16} << 20;

/// A terminal's first state. `fingerprint` is what a person read off another way
/// (TrustDocument::fingerprint()): a document with another one is refused, or whoever answers first would be
/// believed for ever.
Result<TerminalState> first_state(const std::string& loom, std::string_view trust_bytes,
                                  std::string_view fingerprint);

/// The state as canonical JSON (FORMAT.md).
std::string write_state(const TerminalState& state);

/// Reads what write_state() wrote, with the checks of every part. Errors name the member.
Result<TerminalState> read_state(std::string_view bytes);

/// Keeps the state in a file of mode 0600, whole or not at all. Refused where others may read or write the
/// file that is there.
Status save_state(const std::filesystem::path& path, const TerminalState& state);

/// Refused: a file that others may read or write; an error for one that is damaged. Whoever can write the
/// file can make the terminal forget: it is as safe as the user that it belongs to.
Result<TerminalState> load_state(const std::filesystem::path& path);

}  // namespace weave::loomlink
