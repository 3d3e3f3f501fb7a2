#include <loomlink/keys/release_index.hpp>

#include <weave/core/sha256.hpp>
#include <weave/keys/members.hpp>

#include <algorithm>

namespace weave::loomlink {

namespace {

constexpr const char* format = "weave-release-index";
constexpr std::size_t hash_characters = 64;
const std::vector<std::string> state_names{"released", "superseded", "withdrawn"};

Json releases_json(const ReleaseIndex& index) {
    Json list = Json::array();
    for (const IndexEntry& entry : index.releases)
        list.push_back({{"number", entry.number},
                        {"revision_sha256", entry.revision_sha256},
                        {"manifest_sha256", entry.manifest_sha256},
                        {"state", name_of(entry.state)}});
    return list;
}

void read_releases(JsonReader& reader, ReleaseIndex& index) {
    auto entries = reader.objects("releases");
    if (entries.size() > most_releases)
        return reader.fail("has more than " + std::to_string(most_releases) + " releases", "releases");
    for (auto& item : entries) {
        IndexEntry entry;
        entry.number = count_member(item, "number", 1);
        entry.revision_sha256 = hex_member(item, "revision_sha256", hash_characters);
        entry.manifest_sha256 = hex_member(item, "manifest_sha256", hash_characters);
        entry.state = release_state_member(item);
        item.no_others();
        if (!index.releases.empty() && entry.number <= index.releases.back().number)
            item.fail("must be greater than the number before", "number");
        if (reader.failed()) return;
        index.releases.push_back(std::move(entry));
    }
}

void check_validity(JsonReader& reader, const ReleaseIndex& index) {
    if (index.expires <= index.issued) reader.fail("must be later than it was issued", "expires");
    if (index.expires - index.issued > longest_validity)
        reader.fail("is more than " + std::to_string(longest_validity.count() / 24) +
                        " days after it was issued: no index may hold for so long",
                    "expires");
}

}  // namespace

const std::string& name_of(ReleaseState state) {
    return state_names[static_cast<std::size_t>(state)];
}

ReleaseState release_state_member(JsonReader& reader) {
    return static_cast<ReleaseState>(reader.choice("state", state_names));
}

const IndexEntry* ReleaseIndex::find(std::uint64_t number) const {
    const auto found = std::find_if(releases.begin(), releases.end(),
                                    [&](const IndexEntry& entry) { return entry.number == number; });
    return found == releases.end() ? nullptr : &*found;
}

Json index_body(const ReleaseIndex& index) {
    return {{"format", format},
            {"version", 1},
            {"site", index.site},
            {"loom", index.loom},
            {"trust", index.trust},
            {"epoch", index.epoch},
            {"issued", utc_text(index.issued)},
            {"expires", utc_text(index.expires)},
            {"tree_head", to_json(index.tree_head)},
            {"releases", releases_json(index)}};
}

std::string releases_sha256(const ReleaseIndex& index) {
    return sha256_hex(canonical_json(releases_json(index)));
}

Result<ReleaseIndex> open_index(std::string_view bytes, const TrustDocument& trust) {
    WEAVE_TRY(const SignedDocument document, read_signed(bytes, most_index_bytes));
    WEAVE_CHECK_OK(check_signatures(document, Purpose::release_index, trust, Role::stamp, 1));
    JsonReader reader(document.body, "body");
    ReleaseIndex index;
    read_heading(reader, format);
    index.site = name_member(reader, "site");
    index.loom = name_member(reader, "loom");
    index.trust = count_member(reader, "trust", 1);
    index.epoch = count_member(reader, "epoch");
    index.issued = utc_member(reader, "issued");
    index.expires = utc_member(reader, "expires");
    if (!reader.failed()) check_validity(reader, index);
    const Json head = reader.object("tree_head").json();
    read_releases(reader, index);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    auto parsed = head_from_json(head);
    if (!parsed) return std::move(parsed).error().under("body.tree_head");
    index.tree_head = std::move(*parsed);
    if (Status signed_well = check_head(index.tree_head, trust); !signed_well)
        return std::move(signed_well).error().under("body.tree_head");
    if (index.site != trust.site)
        return Error{ErrorCode::refused,
                     "is an index of the site '" + index.site + "', not of '" + trust.site + "'",
                     "body.site"};
    return index;
}

}  // namespace weave::loomlink
