#pragma once

#include <filesystem>
#include <weave/wire/mill_client.hpp>
#include <loomlink/terminal/folder.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// What a loom's terminal is to have.
struct PullWish {
    std::string loom;
    std::filesystem::path to;          ///< the folder of all its releases
    std::filesystem::path state_file;  ///< what it trusts and has seen
    std::string trust;                 ///< fingerprint to trust at first; empty: only a state is believed
    std::optional<std::int64_t> release;
    bool all = false;  ///< every release in force; else the one named, else the newest
};

/// A release that lies at the loom now.
struct HeldRelease {
    std::uint64_t number = 0;
    std::filesystem::path folder;
    bool is_new = false;  ///< came with this pull
};

/// A release in force that could not be had.
struct RefusedRelease {
    std::uint64_t number = 0;
    Error error;
};

/// What one pull did. What could not be had keeps nothing else from being done.
struct PullReport {
    std::vector<HeldRelease> releases;
    std::vector<std::string> removed;     ///< files of recalled releases
    std::vector<std::string> superseded;  ///< files of superseded ones, that were removed as well
    std::vector<FileFinding> kept;        ///< of all those that were left, and what else looks like a release; a person has to look
    std::vector<RefusedRelease> refused;
    Instant expires;                   ///< until when the index holds

    /// Whether anything is other than before.
    [[nodiscard]] bool has_news() const;
};

Json to_json(const PullReport& report, const std::string& loom);
std::string in_words(const PullReport& report, const std::string& loom);

/// Where the state of a loom's terminal lies if nobody says otherwise: `loomlink/LOOM.json` below
/// $XDG_STATE_HOME, or below `.local/state` at home.
Result<std::filesystem::path> usual_state_file(const std::string& loom);

/// Pulls once: newer trust documents, the index, then what was recalled goes, what is wanted comes, and what was
/// superseded goes, each held to what the terminal trusts and remembers (loomlink/terminal). A release appears
/// whole or not at all. Pulls with one state wait for one another.
/// Errors as of adopt_trust() and check_index(), usage where the terminal trusts nobody yet and no fingerprint is
/// given, refused where the one that is given is of another mill than the state's; those of single releases, as of
/// check_release() and place_release(), stand in the report.
Result<PullReport> pull(wire::MillClient& client, const PullWish& wish);

}  // namespace weave::loomlink
