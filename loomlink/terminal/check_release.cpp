#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/terminal/check.hpp>

namespace weave::loomlink {

namespace {

Error refused(std::string why, std::string where = {}) {
    return {ErrorCode::refused, std::move(why), std::move(where)};
}

std::string release_name(std::uint64_t number) {
    return "release " + std::to_string(number);
}

Result<IndexEntry> released_entry(const CheckedIndex& checked, std::uint64_t number, Instant now) {
    const ReleaseIndex& index = checked.index;
    if (now >= index.expires || now + clock_tolerance < checked.state.last_seen)
        return refused("the index does not hold any more; fetch it again", "index");
    const IndexEntry* entry = index.find(number);
    if (entry == nullptr)
        return refused(release_name(number) + " is not released for the loom '" + index.loom + "'");
    if (entry->state == ReleaseState::withdrawn)
        return refused(release_name(number) + " was withdrawn: it must not be woven");
    if (entry->state == ReleaseState::superseded)
        return refused(release_name(number) + " was superseded by a newer one; pull that");
    return *entry;
}

Status check_match(const ReleaseManifest& manifest, const IndexEntry& entry, const TerminalState& state) {
    if (manifest.loom != state.loom)
        return refused("releases files to the loom '" + manifest.loom + "', not to '" + state.loom + "'",
                       "manifest");
    if (manifest.release != entry.number)
        return refused("is of " + release_name(manifest.release) + ", not of " + release_name(entry.number),
                       "manifest");
    if (manifest.revision_sha256 != entry.revision_sha256)
        return refused("is of another revision than the index lists", "manifest");
    const auto seen =
        std::find_if(state.releases.begin(), state.releases.end(),
                     [&](const SeenRelease& release) { return release.number == entry.number; });
    if (seen != state.releases.end() && !seen->body_sha256.empty() &&
        seen->body_sha256 != body_sha256(manifest.document))
        return refused("says other things than the manifest of " + release_name(entry.number) +
                           " that this terminal has seen before",
                       "manifest");
    return {};
}

Status check_file(const ReleasedFile& listed, const std::vector<PulledFile>& files) {
    const auto same = [&](const PulledFile& file) { return file.path == listed.path; };
    const auto pulled = std::find_if(files.begin(), files.end(), same);
    if (pulled == files.end()) return invalid("is missing among the files that came", listed.path);
    if (std::count_if(files.begin(), files.end(), same) > 1) return invalid("came twice", listed.path);
    if (pulled->bytes.size() != listed.size)
        return invalid("has " + counted(pulled->bytes.size(), "byte") + " where " +
                           std::to_string(listed.size) + " were signed: cut, or of another release",
                       listed.path);
    if (sha256_hex(pulled->bytes) != listed.sha256)
        return invalid("is not the file that was signed: altered, or of another release", listed.path);
    return {};
}

Status check_files(const ReleaseManifest& manifest, const std::vector<PulledFile>& files) {
    for (const ReleasedFile& listed : manifest.files) WEAVE_CHECK_OK(check_file(listed, files));
    for (const PulledFile& file : files) {
        const bool listed = std::any_of(manifest.files.begin(), manifest.files.end(),
                                        [&](const ReleasedFile& one) { return one.path == file.path; });
        if (!listed)
            return invalid("came with the release but does not belong to it", on_one_line(file.path));
    }
    return {};
}

/// Not the same for two manifests of one release, such as the one that was signed again after a key was
/// revoked.
std::string folder_of(const IndexEntry& entry) {
    return "release-" + std::to_string(entry.number) + "-" + entry.manifest_sha256.substr(0, 12);
}

}  // namespace

Result<ReleaseManifest> check_manifest(std::string_view bytes, const TrustDocument& trust) {
    auto manifest = open_manifest(bytes, trust);
    if (!manifest) return invalid(manifest.error().message, manifest.error().where);
    return manifest;
}

Result<CheckedRelease> check_release(const CheckedIndex& checked, std::uint64_t number,
                                     std::string_view manifest_bytes, std::vector<PulledFile> files,
                                     Instant now) {
    WEAVE_TRY(const IndexEntry entry, released_entry(checked, number, now));
    if (manifest_bytes.size() > most_manifest_bytes)
        return invalid(
            "is too large: a manifest has at most " + std::to_string(most_manifest_bytes) + " bytes",
            "manifest");
    if (sha256_hex(manifest_bytes) != entry.manifest_sha256)
        return invalid("is not the one that the index lists for " + release_name(number), "manifest");
    auto manifest = check_manifest(manifest_bytes, checked.state.trust);
    if (!manifest) return std::move(manifest).error().under("manifest");
    WEAVE_CHECK_OK(check_match(*manifest, entry, checked.state));
    WEAVE_CHECK_OK(check_files(*manifest, files));
    files.push_back({manifest_name, std::string(manifest_bytes)});
    return CheckedRelease{std::move(*manifest), std::move(files), folder_of(entry)};
}

}  // namespace weave::loomlink
