#pragma once

#include <weave/core/result.hpp>

#include <cstdint>
#include <loomlink/keys/trust.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace weave::loomlink {

/// A file of a release.
struct ReleasedFile {
    std::string path;  ///< a file name, see check_file_name()
    std::uint64_t size = 0;
    std::string sha256;
    std::string format;      ///< such as `jc5`, `tiff`, `pick-table-csv`
    bool certified = false;  ///< whether the controller's maker confirmed the layout
    std::string
        label;  ///< what a person must know about it, such as "layout-compatible with observed files, …"
    friend bool operator==(const ReleasedFile&, const ReleasedFile&) = default;
};

/// What people signed: these files, made from this revision for this loom.
struct ReleaseManifest {
    std::string site, loom;
    std::uint64_t release = 0;
    Instant released;
    std::string design;
    std::uint64_t revision = 0;
    std::string revision_sha256, design_sha256, scene_sha256, card_sha256;
    std::string profile_name, profile_revision, profile_sha256;
    std::uint64_t profile_version = 0;  ///< as loomlink counts the profiles of this loom
    std::uint64_t picks = 0, ends = 0;
    /// How the bytes are to be read (which bit lifts, which row is pick 1, which column is end 1, bit order,
    /// seen from which face) and which feeder each yarn of the design takes: as loomlink/export wrote them,
    /// an object and a list.
    Json reading = Json::object(), feeders = Json::array();
    std::vector<ReleasedFile> files;

    /// The manifest as it was signed.
    SignedDocument document;
};

/// The name of the signed manifest in the folder of a release; no other file may have it.
inline constexpr const char* manifest_name = "manifest.json";

inline constexpr std::size_t most_manifest_bytes = std::size_t{1} << 20, most_released_files = 64;
/// A release holds at most so many bytes in all its files.
inline constexpr std::uint64_t most_release_bytes = std::uint64_t{512} << 20;

/// The body for the people to sign; all of `manifest` but `document`.
Json manifest_body(const ReleaseManifest& manifest);

/// A manifest signed by as many people with a release key as `trust` asks for, for its site, in sound form:
/// file names that harm nobody and differ in more than case, sizes within bounds. Judged by the newest trust
/// document always: one signature of a key that was revoked, and the release has to be signed again.
Result<ReleaseManifest> open_manifest(std::string_view bytes, const TrustDocument& trust);

}  // namespace weave::loomlink
