#pragma once

#include <weave/core/result.hpp>

#include <filesystem>
#include <loomlink/terminal/check.hpp>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Writes a release into its folder below `releases`, whole or not at all: the files go into a folder beside
/// it, are read back and hashed there, and only then get their name. Before that it is noted in `state`, and
/// the state is saved to `state_file`, so that a recall finds the files even if the power fails in between. A
/// folder that is there already and holds exactly this release is left as it is. Gives the folder. Errors:
/// one whose bytes are not as signed (`invalid`); one that holds another release (refused).
Result<std::filesystem::path> place_release(TerminalState& state, const CheckedRelease& release,
                                            const std::filesystem::path& state_file,
                                            const std::filesystem::path& releases);

/// How a file in a folder is not as the manifest says.
enum class FileTrouble : std::uint8_t { missing, differs, too_many, not_a_file, unreadable };

struct FileFinding {
    FileTrouble trouble = FileTrouble::missing;
    std::string path;     ///< name in the folder, fit to be shown
    std::string message;  ///< a sentence about it
};

struct FolderReport {
    ReleaseManifest manifest;
    std::vector<FileFinding> findings;  ///< empty: every byte is as people signed it
};

/// No more findings of one folder are told; the last one says so.
inline constexpr std::size_t most_folder_findings = 1000;

/// Holds a folder against the manifest in it, offline: its signatures under the newest trust document that is
/// known here, every file by size and hash, and that nothing else lies there. Errors: a manifest that is
/// missing (bad_input); forged, of a revoked key, of another site, or no file of its own (`invalid`). What
/// happened since (a recall) only the server knows: see check_recall() for what the terminal saw.
Result<FolderReport> verify_files(const std::filesystem::path& folder, const TrustDocument& trust);

/// Refused where this terminal has seen that the release is for another loom, other than what it had seen
/// under this number, superseded or withdrawn.
Status check_recall(const TerminalState& state, const ReleaseManifest& manifest);

/// What became of the files of recalled releases.
struct RecallReport {
    std::vector<std::string> removed;  ///< whole paths
    std::vector<FileFinding> kept;     ///< still there, each with the reason: a person has to look
    TerminalState state;               ///< without what is gone; to be saved
};

/// Removes the files of releases that came to `end`, withdrawn or superseded: those that this terminal wrote
/// itself and that nobody has changed since. A changed file stays and is told, as is whatever else lies in the
/// folder; an empty folder goes. They are looked for where they were put, whatever folder is pulled to now; where that
/// cannot be reached, they are told, and remembered.
RecallReport remove_ended(const TerminalState& state, ReleaseState end);

/// Whether a release was put into this folder of releases.
bool lies_in(const PlacedRelease& placed, const std::filesystem::path& releases);

/// What looks like a release in this folder and was put there neither `before` a pull nor by it (`after`).
std::vector<FileFinding> foreign_releases(const TerminalState& before, const TerminalState& after,
                                          const std::filesystem::path& releases);

}  // namespace weave::loomlink
