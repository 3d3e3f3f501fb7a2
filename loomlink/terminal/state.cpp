#include <loomlink/terminal/state.hpp>

#include <weave/core/file.hpp>
#include <weave/keys/members.hpp>
#include <weave/keys/private_file.hpp>

#include <algorithm>
#include <loomlink/keys/file_name.hpp>
#include <loomlink/keys/release_manifest.hpp>
#include <set>

namespace weave::loomlink {

namespace {

constexpr const char* format = "weave-terminal";
constexpr std::size_t hash_characters = 64;

Json stamps_json(const TerminalState& state) {
    Json list = Json::array();
    for (const SeenStamp& stamp : state.stamps)
        list.push_back({{"key", stamp.key},
                        {"epoch", stamp.epoch},
                        {"issued", utc_text(stamp.issued)},
                        {"releases_sha256", stamp.releases_sha256}});
    return list;
}

Json releases_json(const TerminalState& state) {
    Json list = Json::array();
    for (const SeenRelease& seen : state.releases) {
        Json entry{{"number", seen.number},
                   {"revision_sha256", seen.revision_sha256},
                   {"state", name_of(seen.state)}};
        if (!seen.body_sha256.empty()) entry["body_sha256"] = seen.body_sha256;
        list.push_back(std::move(entry));
    }
    return list;
}

Json placed_json(const TerminalState& state) {
    Json list = Json::array();
    for (const PlacedRelease& placed : state.placed) {
        Json files = Json::array();
        for (const PlacedFile& file : placed.files)
            files.push_back({{"path", file.path}, {"sha256", file.sha256}});
        list.push_back({{"number", placed.number}, {"within", placed.within.string()}, {"folder", placed.folder}, {"files", std::move(files)}});
    }
    return list;
}

void read_stamps(JsonReader& reader, TerminalState& state) {
    for (auto& entry : reader.objects("stamps")) {
        SeenStamp stamp{hex_member(entry, "key", hash_characters), count_member(entry, "epoch"),
                        utc_member(entry, "issued"), hex_member(entry, "releases_sha256", hash_characters)};
        entry.no_others();
        if (!state.stamps.empty() && stamp.key <= state.stamps.back().key)
            entry.fail("must come after the key before it", "key");
        if (reader.failed()) return;
        state.stamps.push_back(std::move(stamp));
    }
}

void read_releases(JsonReader& reader, TerminalState& state) {
    for (auto& entry : reader.objects("releases")) {
        SeenRelease seen{count_member(entry, "number", 1),
                         hex_member(entry, "revision_sha256", hash_characters), release_state_member(entry),
                         ""};
        if (entry.has("body_sha256")) seen.body_sha256 = hex_member(entry, "body_sha256", hash_characters);
        entry.no_others();
        if (!state.releases.empty() && seen.number <= state.releases.back().number)
            entry.fail("must be greater than the number before", "number");
        if (reader.failed()) return;
        state.releases.push_back(std::move(seen));
    }
}

/// A name that may be removed later: so it has to be as harmless as when it was written.
std::string safe_name(JsonReader& reader, const std::string& key) {
    std::string name = reader.text(key, {}, 4096);
    if (const Status named = check_file_name(name); !reader.failed() && !named)
        reader.fail(named.error().message, key);
    return name;
}

/// The whole path of a folder. It may be any: files are removed there by name and hash alone.
std::filesystem::path whole_path_member(JsonReader& reader, const std::string& key) {
    const std::filesystem::path path = reader.text(key, {}, 4096);
    const bool is_whole = path.is_absolute() && path.native() == path.lexically_normal().native() && path.native().find('\0') == std::string::npos;
    if (!reader.failed() && !is_whole) reader.fail("is not the whole path of a folder", key);
    return path;
}

void read_placed(JsonReader& reader, TerminalState& state) {
    std::set<std::filesystem::path> folders;
    for (auto& entry : reader.objects("placed")) {
        PlacedRelease placed{count_member(entry, "number", 1), whole_path_member(entry, "within"), safe_name(entry, "folder"), {}};
        auto files = entry.objects("files");
        if (files.size() > most_released_files + 1) entry.fail("are more than a release has", "files");
        for (auto& file : files) {
            placed.files.push_back({safe_name(file, "path"), hex_member(file, "sha256", hash_characters)});
            file.no_others();
            if (reader.failed()) return;
        }
        entry.no_others();
        if (!folders.insert(placed.path()).second) entry.fail("is the folder of another release", "folder");
        if (reader.failed()) return;
        state.placed.push_back(std::move(placed));
    }
}

}  // namespace

Result<TerminalState> first_state(const std::string& loom, std::string_view trust_bytes,
                                  std::string_view fingerprint) {
    TerminalState state;
    state.loom = loom;
    WEAVE_TRY(state.trust, read_trust(trust_bytes));
    if (state.trust.fingerprint() != fingerprint)
        return Error{ErrorCode::refused,
                     "this trust document has the fingerprint " + state.trust.fingerprint() +
                         ", not the one that was given; ask the person who set up the site for the right one",
                     "fingerprint"};
    return state;
}

std::string write_state(const TerminalState& state) {
    Json json{{"format", format},
              {"version", 1},
              {"loom", state.loom},
              {"trust", to_json(state.trust.document)},
              {"stamps", stamps_json(state)},
              {"releases", releases_json(state)},
              {"placed", placed_json(state)},
              {"last_seen", utc_text(state.last_seen)}};
    if (state.tree_head) json["tree_head"] = to_json(*state.tree_head);
    return canonical_json(json);
}

Result<TerminalState> read_state(std::string_view bytes) {
    if (bytes.size() > most_state_bytes) return bad_input("is too large for the state of a terminal");
    WEAVE_TRY(const Json json, parse_json(bytes));
    JsonReader reader(json, "");
    TerminalState state;
    read_heading(reader, format);
    state.loom = name_member(reader, "loom");
    state.last_seen = utc_member(reader, "last_seen");
    read_stamps(reader, state);
    read_releases(reader, state);
    read_placed(reader, state);
    const Json trust = reader.object("trust").json();
    const bool has_head = reader.has("tree_head");
    const Json head = reader.object("tree_head", true).json();
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    auto read = read_trust(canonical_json(trust));
    if (!read) return std::move(read).error().under("trust");
    state.trust = std::move(*read);
    if (!has_head) return state;
    auto retained = head_from_json(head);
    if (!retained) return std::move(retained).error().under("tree_head");
    if (Status signed_well = check_head(*retained, state.trust); !signed_well)
        return std::move(signed_well).error().under("tree_head");
    state.tree_head = std::move(*retained);
    return state;
}

Status save_state(const std::filesystem::path& path, const TerminalState& state) {
    return write_private_file(path, write_state(state));
}

Result<TerminalState> load_state(const std::filesystem::path& path) {
    WEAVE_CHECK_OK(check_private_file(path));
    WEAVE_TRY(const std::string bytes, read_file(path, most_state_bytes));
    auto state = read_state(bytes);
    if (!state) return std::move(state).error().in(path.string());
    return state;
}

}  // namespace weave::loomlink
