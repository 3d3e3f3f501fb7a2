#include <loomlink/export/signed_manifest.hpp>

#include <weave/core/text.hpp>

#include <loomlink/keys/file_name.hpp>
#include <set>

namespace weave::loomlink {

namespace {

/// Members of the package's manifest that have a place of their own in the signed one.
constexpr const char* placed_elsewhere[] = {"design_sha256", "scene_sha256", "card_sha256", "picks",
                                            "ends",          "loom",         "feeders",     "files"};
constexpr const char* placed_in_file[] = {"path", "size", "sha256", "format", "certified", "label"};

/// Room that a manifest leaves for its signatures: as many as there may be, of a key and a value each.
constexpr std::size_t signature_room = most_signatures * 256;

ReleasedFile released(const Json& entry) {
    return {entry.at("path").get<std::string>(),   entry.at("size").get<std::uint64_t>(),
            entry.at("sha256").get<std::string>(), entry.at("format").get<std::string>(),
            entry.at("certified").get<bool>(),     entry.at("label").get<std::string>()};
}

Json reading_of(const Json& said) {
    Json reading = said;
    for (const char* member : placed_elsewhere) reading.erase(member);
    Json encoding = said.at("feeders");
    encoding.erase("map");
    reading["feeders"] = std::move(encoding);
    Json files = Json::object();
    for (const Json& entry : said.at("files")) {
        Json& file = files[entry.at("path").get<std::string>()] = entry;
        for (const char* member : placed_in_file) file.erase(member);
    }
    reading["files"] = std::move(files);
    return reading;
}

/// What open_manifest() would refuse once people have signed.
Status check_readable(const ReleaseManifest& manifest) {
    if (manifest.files.size() > most_released_files)
        return invalid("a release has at most " + counted(most_released_files, "file"));
    std::set<std::string> names{manifest_name};
    std::uint64_t bytes = 0;
    for (const ReleasedFile& file : manifest.files) {
        const Status named = check_file_name(file.path);
        if (!named)
            return invalid("the file name '" + on_one_line(file.path) + "': " + named.error().message);
        if (!names.insert(folded_name(file.path)).second)
            return invalid("the file name '" + file.path + "' stands twice");
        bytes += file.size;
    }
    if (bytes > most_release_bytes)
        return invalid("a release has at most " + std::to_string(most_release_bytes) + " bytes, not " +
                       std::to_string(bytes));
    const std::size_t length = canonical_json(manifest_body(manifest)).size();
    if (length + signature_room <= most_manifest_bytes) return {};
    return invalid("the manifest of this release has " + counted(length, "byte") + ", and no more than " +
                   std::to_string(most_manifest_bytes - signature_room) + " can be read again");
}

}  // namespace

Result<ReleaseManifest> manifest_of(const ReleasePackage& package, ReleaseManifest terms) {
    const Json& said = package.manifest;
    ReleaseManifest manifest = std::move(terms);
    manifest.design_sha256 = said.at("design_sha256").get<std::string>();
    manifest.scene_sha256 = said.at("scene_sha256").get<std::string>();
    manifest.card_sha256 = said.at("card_sha256").get<std::string>();
    manifest.picks = said.at("picks").get<std::uint64_t>();
    manifest.ends = said.at("ends").get<std::uint64_t>();
    const Json& loom = said.at("loom");
    manifest.profile_name = loom.at("name").get<std::string>();
    manifest.profile_revision = loom.at("revision").get<std::string>();
    manifest.profile_sha256 = loom.at("sha256").get<std::string>();
    manifest.reading = reading_of(said);
    manifest.feeders = said.at("feeders").at("map");
    manifest.files.clear();
    for (const Json& entry : said.at("files")) manifest.files.push_back(released(entry));
    WEAVE_CHECK_OK(check_readable(manifest));
    return manifest;
}

}  // namespace weave::loomlink
