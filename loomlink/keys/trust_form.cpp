#include <loomlink/keys/trust_form.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/members.hpp>

#include <algorithm>
#include <set>

namespace weave::loomlink {

namespace {

constexpr const char* format = "weave-trust";
constexpr std::int64_t most_threshold = 16;
const std::vector<std::string> role_names{"root", "release", "stamp", "log", "evidence"};

bool is_for_people(Role role) {
    return role == Role::root || role == Role::release;
}

std::vector<Role> read_roles(JsonReader& entry) {
    const Json& list = entry.raw("roles");
    std::vector<Role> roles;
    const auto wrong = [&](const std::string& why) {
        entry.fail(why, "roles");
        return std::vector<Role>();
    };
    if (!list.is_array() || list.empty()) return wrong("must be a list of roles");
    for (const Json& item : list) {
        const auto name = std::find_if(role_names.begin(), role_names.end(),
                                       [&](const std::string& known) { return item == known; });
        if (name == role_names.end())
            return wrong("has a role that is none of root, release, stamp, log, evidence");
        const auto role = static_cast<Role>(name - role_names.begin());
        if (!roles.empty() && roles.back() >= role)
            return wrong("must be in the order root, release, stamp, log, evidence, none twice");
        roles.push_back(role);
    }
    // The server may not release, and each of its keys does one thing.
    const bool people = std::all_of(roles.begin(), roles.end(), is_for_people);
    if (roles.size() > 1 && !people) return wrong("gives a machine's key more than its one role");
    return roles;
}

TrustedKey read_key(JsonReader& entry) {
    constexpr std::size_t id_characters = 64;
    TrustedKey key;
    const std::string id = hex_member(entry, "id", id_characters), text = entry.text("public", {}, 64);
    key.person = name_member(entry, "person");
    key.roles = read_roles(entry);
    entry.no_others();
    if (entry.failed()) return key;
    const auto parsed = parse_public_key(text);
    if (!parsed) {
        entry.fail(parsed.error().message, "public");
    } else if (key_id(*parsed) != id) {
        entry.fail("is not the id of this public key", "id");
    } else {
        key.public_key = *parsed;
    }
    return key;
}

void read_keys(JsonReader& reader, TrustDocument& trust) {
    auto entries = reader.objects("keys");
    if (entries.size() > most_trusted_keys)
        reader.fail("has more than " + std::to_string(most_trusted_keys) + " keys", "keys");
    std::set<std::string> ids;
    for (auto& entry : entries) {
        if (reader.failed()) return;
        trust.keys.push_back(read_key(entry));
        if (!ids.insert(trust.keys.back().id()).second) entry.fail("is a key that is listed already", "id");
    }
}

std::size_t people_with(const TrustDocument& trust, Role role) {
    std::set<std::string> people;
    for (const TrustedKey& key : trust.keys)
        if (key.has(role)) people.insert(key.person);
    return people.size();
}

/// A document that nobody could follow, or under which nothing could be released, would shut its site out.
void check_reach(JsonReader& reader, const TrustDocument& trust) {
    if (people_with(trust, Role::root) < trust.root_threshold)
        reader.fail("asks for more people than have a root key", "thresholds.root");
    if (people_with(trust, Role::release) < trust.release_threshold)
        reader.fail("asks for more people than have a release key", "thresholds.release");
    if (people_with(trust, Role::stamp) == 0) reader.fail("has no stamp key", "keys");
    if (people_with(trust, Role::log) == 0) reader.fail("has no log key", "keys");
}

}  // namespace

const std::string& name_of(Role role) {
    return role_names[static_cast<std::size_t>(role)];
}

bool TrustedKey::has(Role role) const {
    return std::find(roles.begin(), roles.end(), role) != roles.end();
}

Json trust_body(const TrustDocument& trust) {
    Json keys = Json::array();
    for (const TrustedKey& key : trust.keys) {
        Json roles = Json::array();
        for (const Role role : key.roles) roles.push_back(name_of(role));
        keys.push_back(
            {{"id", key.id()}, {"public", to_hex(key.public_key)}, {"person", key.person}, {"roles", roles}});
    }
    return {{"format", format},
            {"version", 1},
            {"number", trust.version},
            {"site", trust.site},
            {"issued", utc_text(trust.issued)},
            {"keys", std::move(keys)},
            {"thresholds", {{"root", trust.root_threshold}, {"release", trust.release_threshold}}}};
}

Result<TrustDocument> read_trust_form(std::string_view bytes) {
    TrustDocument trust;
    WEAVE_TRY(trust.document, read_signed(bytes, most_trust_bytes));
    JsonReader reader(trust.document.body, "body");
    read_heading(reader, format);
    trust.version = count_member(reader, "number", 1);
    trust.site = name_member(reader, "site");
    trust.issued = utc_member(reader, "issued");
    read_keys(reader, trust);
    JsonReader thresholds = reader.object("thresholds");
    trust.root_threshold = static_cast<std::size_t>(count_member(thresholds, "root", 1, most_threshold));
    trust.release_threshold =
        static_cast<std::size_t>(count_member(thresholds, "release", 1, most_threshold));
    thresholds.no_others();
    reader.no_others();
    if (!reader.failed()) check_reach(reader, trust);
    WEAVE_CHECK_OK(reader.status());
    return trust;
}

}  // namespace weave::loomlink
