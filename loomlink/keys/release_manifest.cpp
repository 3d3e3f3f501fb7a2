#include <loomlink/keys/release_manifest.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/keys/members.hpp>

#include <loomlink/keys/file_name.hpp>
#include <set>

namespace weave::loomlink {

namespace {

constexpr const char* format = "weave-release";
constexpr std::size_t hash_characters = 64;
constexpr std::int64_t most_yarns = 1'000'000'000;

Json file_json(const ReleasedFile& file) {
    return {{"path", file.path},     {"size", file.size},           {"sha256", file.sha256},
            {"format", file.format}, {"certified", file.certified}, {"label", file.label}};
}

ReleasedFile read_file_entry(JsonReader& entry) {
    constexpr std::size_t longest_label = 1024;
    ReleasedFile file;
    file.path = entry.text("path", {}, 4096);
    file.size = count_member(entry, "size", 0, static_cast<std::int64_t>(most_release_bytes));
    file.sha256 = hex_member(entry, "sha256", hash_characters);
    file.format = name_member(entry, "format");
    file.certified = entry.boolean("certified");
    file.label = entry.text("label", {}, longest_label);
    entry.no_others();
    if (const Status named = check_file_name(file.path); !entry.failed() && !named)
        entry.fail(named.error().message, "path");
    return file;
}

void read_files(JsonReader& reader, ReleaseManifest& manifest) {
    auto entries = reader.objects("files");
    if (entries.empty() || entries.size() > most_released_files)
        return reader.fail("must be a list of 1 to " + std::to_string(most_released_files) + " files",
                           "files");
    std::set<std::string> names{manifest_name};
    std::uint64_t bytes = 0;
    for (auto& entry : entries) {
        ReleasedFile file = read_file_entry(entry);
        if (!names.insert(folded_name(file.path)).second) entry.fail("is the name of another file", "path");
        bytes += file.size;
        if (bytes > most_release_bytes)
            entry.fail("makes the release larger than " + std::to_string(most_release_bytes) + " bytes",
                       "size");
        if (reader.failed()) return;
        manifest.files.push_back(std::move(file));
    }
}

void read_source(JsonReader& reader, ReleaseManifest& manifest) {
    manifest.design = name_member(reader, "design");
    JsonReader revision = reader.object("revision");
    manifest.revision = count_member(revision, "number", 1);
    manifest.revision_sha256 = hex_member(revision, "sha256", hash_characters);
    revision.no_others();
    manifest.design_sha256 = hex_member(reader, "design_sha256", hash_characters);
    manifest.scene_sha256 = hex_member(reader, "scene_sha256", hash_characters);
    manifest.card_sha256 = hex_member(reader, "card_sha256", hash_characters);
    JsonReader profile = reader.object("profile");
    manifest.profile_name = profile.text("name", {}, 256);
    manifest.profile_revision = profile.text("revision", {}, 64);
    manifest.profile_sha256 = hex_member(profile, "sha256", hash_characters);
    manifest.profile_version = count_member(profile, "version", 1);
    profile.no_others();
}

Json profile_json(const ReleaseManifest& manifest) {
    return {{"name", manifest.profile_name},
            {"revision", manifest.profile_revision},
            {"sha256", manifest.profile_sha256},
            {"version", manifest.profile_version}};
}

void read_reading(JsonReader& reader, ReleaseManifest& manifest) {
    manifest.reading = reader.raw("reading");
    manifest.feeders = reader.raw("feeders");
    if (!manifest.reading.is_object()) reader.fail("must be an object", "reading");
    if (!manifest.feeders.is_array()) reader.fail("must be a list", "feeders");
}

}  // namespace

Json manifest_body(const ReleaseManifest& manifest) {
    Json files = Json::array();
    for (const ReleasedFile& file : manifest.files) files.push_back(file_json(file));
    return {{"format", format},
            {"version", 1},
            {"site", manifest.site},
            {"loom", manifest.loom},
            {"release", manifest.release},
            {"released", utc_text(manifest.released)},
            {"design", manifest.design},
            {"revision", {{"number", manifest.revision}, {"sha256", manifest.revision_sha256}}},
            {"design_sha256", manifest.design_sha256},
            {"scene_sha256", manifest.scene_sha256},
            {"card_sha256", manifest.card_sha256},
            {"profile", profile_json(manifest)},
            {"picks", manifest.picks},
            {"ends", manifest.ends},
            {"reading", manifest.reading},
            {"feeders", manifest.feeders},
            {"files", std::move(files)}};
}

Result<ReleaseManifest> open_manifest(std::string_view bytes, const TrustDocument& trust) {
    ReleaseManifest manifest;
    WEAVE_TRY(manifest.document, read_signed(bytes, most_manifest_bytes));
    WEAVE_CHECK_OK(check_signatures(manifest.document, Purpose::release_manifest, trust, Role::release,
                                    trust.release_threshold));
    JsonReader reader(manifest.document.body, "body");
    read_heading(reader, format);
    manifest.site = name_member(reader, "site");
    manifest.loom = name_member(reader, "loom");
    manifest.release = count_member(reader, "release", 1);
    manifest.released = utc_member(reader, "released");
    read_source(reader, manifest);
    manifest.picks = count_member(reader, "picks", 1, most_yarns);
    manifest.ends = count_member(reader, "ends", 1, most_yarns);
    read_reading(reader, manifest);
    read_files(reader, manifest);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    if (manifest.site != trust.site)
        return Error{ErrorCode::refused,
                     "is a release of the site '" + manifest.site + "', not of '" + trust.site + "'",
                     "body.site"};
    return manifest;
}

}  // namespace weave::loomlink
