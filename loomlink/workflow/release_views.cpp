#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/workflow/policy.hpp>
#include <loomlink/workflow/releases.hpp>
#include <set>

namespace weave::loomlink {

namespace {

constexpr std::int64_t most_listed_picks = 1000;

/// Why signatures are too few: those that are there may count no more, or more are asked for than before.
std::string manifest_lacks(const Release& release, const SignedManifest& manifest) {
    if (manifest.counting < release.signatures.size())
        return "a key that signed it counts no more: it has to be signed again";
    return "of " + std::to_string(manifest.needed) + " people who must sign it now " +
           std::to_string(manifest.people) + " did: it has to be signed by more";
}

/// Refused unless the files may be woven now.
Status check_pullable(const Reader& reader, const FoundRelease& found) {
    const Release& release = found.release;
    if (release.state == ReleaseStage::prepared)
        return deny(Denial::conflict, "the release waits for signatures");
    if (release.state != ReleaseStage::released)
        return deny(Denial::conflict,
                    std::string("the release is ") + release_word(release.state) + ": it must not be woven");
    WEAVE_TRY(const auto versions, reader.profiles(found.loom.id));
    if (versions.empty() || versions.back().version != release.profile_version)
        return deny(Denial::conflict, "the loom has another profile now: it has to be released again");
    WEAVE_TRY(const SignedManifest manifest, signed_manifest(reader, release));
    if (manifest.people < manifest.needed)
        return deny(Denial::conflict, manifest_lacks(release, manifest));
    return {};
}

Json file_list(const Release& release) {
    Json list = Json::array();
    for (const ReleaseFile& file : release.files)
        list.push_back({{"name", file.name}, {"size", file.size}, {"sha256", hash_hex(file.object)}});
    return list;
}

Result<Json> signature_list(const Reader& reader, const Release& release) {
    Json list = Json::array();
    for (const ReleaseSignature& signature : release.signatures) {
        WEAVE_TRY(const auto key, reader.key(signature.key));
        WEAVE_TRY(const std::string person, full_name_of(reader, key && key->person ? *key->person : Id{0}));
        list.push_back({{"person", person}, {"key", signature.key}});
    }
    return list;
}

Json feeder_words(const Json& body) {
    Json words = Json::array();
    for (const Json& feeder : body.at("feeders"))
        words.push_back("loom feeder " + std::to_string(feeder.at("loom_feeder").get<std::size_t>()) + ": " +
                        feeder.at("name").get<std::string>() + " (" + feeder.at("yarn").get<std::string>() +
                        ")");
    return words;
}

Result<Json> may_of(const Reader& reader, const Caller& caller, const FoundRelease& found) {
    Json may = Json::array();
    const ReleaseStage state = found.release.state;
    const bool live = state == ReleaseStage::released || state == ReleaseStage::prepared;
    WEAVE_TRY(const auto own, reader.looms_of(caller.id));
    const bool is_operator =
        caller.is(PersonRole::operator_) &&
        std::any_of(own.begin(), own.end(), [&](const Loom& loom) { return loom.id == found.loom.id; });
    WEAVE_TRY(const SignedManifest manifest, signed_manifest(reader, found.release));
    if (is_operator && state == ReleaseStage::released) {
        if (manifest.people >= manifest.needed) may.push_back("loaded");
        may.push_back("fault");
    }
    WEAVE_TRY(const auto key, signing_key(reader, caller.id).operator bool()
                                  ? Result<std::string>(signing_key(reader, caller.id)->id)
                                  : Result<std::string>(std::string()));
    const bool signed_it = std::any_of(found.release.signatures.begin(), found.release.signatures.end(),
                                       [&](const ReleaseSignature& one) { return one.key == key; });
    if (live && caller.is(PersonRole::approver) && manifest.people < manifest.needed && !signed_it)
        may.push_back("sign");
    if (live && (caller.is(PersonRole::approver) || caller.is(PersonRole::engineer)))
        may.push_back("withdraw");
    return may;
}

Result<Json> release_json(const Reader& reader, const Caller& caller, const FoundRelease& found) {
    const Release& release = found.release;
    WEAVE_TRY(const auto text, reader.object(release.manifest));
    WEAVE_TRY(const Json body, parse_json(text.value_or("")));
    WEAVE_TRY(const SignedManifest manifest, signed_manifest(reader, release));
    WEAVE_TRY(const LastStep step, last_step(reader, release));
    WEAVE_TRY(const auto bookmark, reader.bookmark(release.id));
    WEAVE_TRY(const std::string now, state_now(reader, release));
    Json json{
        {"loom", found.loom.name},
        {"number", release.number},
        {"design", body.at("design")},
        {"revision", body.at("revision").at("number")},
        {"revision_sha256", body.at("revision").at("sha256")},
        {"state", now},
        {"reason", step.reason},
        {"since", step.at},
        {"picks", body.at("picks")},
        {"ends", body.at("ends")},
        {"label", body.at("reading").at("label")},
        {"profile_name", body.at("profile").at("name")},
        {"profile_version", release.profile_version},
        {"profile_sha256", body.at("profile").at("sha256")},
        {"manifest_sha256", sha256_hex(manifest.bytes)},
        {"signatures_missing", manifest.needed > manifest.people ? manifest.needed - manifest.people : 0},
        {"files", file_list(release)},
        {"feeder_words", feeder_words(body)},
        {"place", bookmark ? Json(bookmark->pick) : Json(nullptr)}};
    WEAVE_TRY(json["signatures"], signature_list(reader, release));
    WEAVE_TRY(json["may"], may_of(reader, caller, found));
    return json;
}

}  // namespace

const char* release_word(ReleaseStage state) {
    return state == ReleaseStage::prepared ? "awaiting" : word(state);
}

Result<std::string> state_now(const Reader& reader, const Release& release) {
    if (release.state == ReleaseStage::released) {
        WEAVE_TRY(const SignedManifest manifest, signed_manifest(reader, release));
        if (manifest.people < manifest.needed) return std::string(release_word(ReleaseStage::prepared));
    }
    return std::string(release_word(release.state));
}

Result<LastStep> last_step(const Reader& reader, const Release& release) {
    WEAVE_TRY(const auto steps, reader.release_steps(release.id));
    if (steps.empty()) return system_fault("the store is damaged: a release has no state");
    WEAVE_TRY(const EventRecord record, reader.record(steps.back().event));
    WEAVE_TRY(const auto person, reader.person(record.statement.actor));
    return LastStep{record.statement.reason.value_or(""), record.statement.at,
                    person ? person->full_name : record.statement.actor};
}

Result<SignedManifest> signed_manifest(const Reader& reader, const Release& release) {
    WEAVE_TRY(const auto text, reader.object(release.manifest));
    if (!text) return system_fault("the store is damaged: a manifest is missing");
    SignedDocument document;
    WEAVE_TRY(document.body, parse_json(*text));
    WEAVE_TRY(const auto trust, newest_trust(reader));
    WEAVE_TRY(const SitePolicy policy, policy_in_force(reader));
    SignedManifest manifest;
    manifest.needed = std::max(policy.release_signatures, trust ? trust->release_threshold : 1);
    std::set<std::string> people;
    for (const ReleaseSignature& one : release.signatures) {
        const TrustedKey* key = trust ? trust->find(one.key) : nullptr;
        if (key == nullptr || !key->has(Role::release)) continue;
        people.insert(key->person);
        document.signatures.push_back({one.key, one.value});
        ++manifest.counting;
    }
    manifest.people = people.size();
    manifest.bytes = write_signed(document);
    return manifest;
}

Result<Json> ReleaseDesk::read(const Caller& caller, const std::string& loom, std::int64_t number) {
    const Json place{{"loom", loom}, {"release", number}};
    WEAVE_TRY(Json json, m_desk->look(caller, {"release.viewed", {}, {}, place}, [&] {
        return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
            WEAVE_TRY(const FoundRelease found, find_release(reader, caller, loom, number));
            return release_json(reader, caller, found);
        });
    }));
    WEAVE_CHECK_OK(m_desk->note_view(caller, "release.viewed", json.at("design"), place));
    return json;
}

Result<std::string> ReleaseDesk::manifest(const Caller& caller, const std::string& loom,
                                          std::int64_t number) {
    return file(caller, loom, number, manifest_name);
}

Result<std::string> ReleaseDesk::file(const Caller& caller, const std::string& loom, std::int64_t number,
                                      const std::string& name) {
    std::string design;
    auto bytes = m_desk->store().read([&](const Reader& reader) -> Result<std::string> {
        WEAVE_TRY(const FoundRelease found, find_release(reader, caller, loom, number));
        WEAVE_TRY(const auto revision, reader.revision(found.release.revision));
        WEAVE_TRY(const auto designs, reader.designs());
        for (const Design& one : designs)
            if (revision && one.id == revision->design) design = one.name;
        WEAVE_CHECK_OK(check_pullable(reader, found));
        if (name == manifest_name) {
            WEAVE_TRY(SignedManifest signed_bytes, signed_manifest(reader, found.release));
            return std::move(signed_bytes.bytes);
        }
        for (const ReleaseFile& one : found.release.files) {
            if (one.name != name) continue;
            WEAVE_TRY(auto content, reader.object(one.object));
            if (!content) return system_fault("the store is damaged: a file of a release is missing");
            return *std::move(content);
        }
        return deny(Denial::absent, "the release has no such file");
    });
    const Json data{{"loom", loom}, {"release", number}, {"file", on_one_line(name)}};
    // No pull without its record: the bytes are given out only once it stands.
    if (!bytes) return m_desk->refuse(caller, {}, {"release.pulled", design, {}, data}, bytes.error());
    WEAVE_CHECK_OK(m_desk->note(caller.login, "release.pulled", design, data));
    return bytes;
}

Result<RevisionClothPtr> ReleaseDesk::cloth_of(const Caller& caller, const std::string& loom,
                                               std::int64_t number) {
    const auto found = [&](const Reader& reader) -> Result<RevisionClothPtr> {
        WEAVE_TRY(const FoundRelease release, find_release(reader, caller, loom, number));
        WEAVE_CHECK_OK(check_pullable(reader, release));
        WEAVE_TRY(const auto revision, reader.revision(release.release.revision));
        return m_shelf->find(reader, revision->document);
    };
    return m_desk->look(caller, {"release.viewed", {}, {}, {{"loom", loom}, {"release", number}}},
                        [&] { return m_desk->store().read(found); });
}

Result<std::string> ReleaseDesk::card(const Caller& caller, const std::string& loom, std::int64_t number,
                                      const CardTile& tile) {
    WEAVE_TRY(const RevisionClothPtr cloth, cloth_of(caller, loom, number));
    return draw_tile(cloth->card, tile);
}

Result<Json> ReleaseDesk::picks(const Caller& caller, const std::string& loom, std::int64_t number,
                                std::int64_t from, std::int64_t count) {
    WEAVE_TRY(const RevisionClothPtr cloth, cloth_of(caller, loom, number));
    WEAVE_TRY(const Json feeders, m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const FoundRelease found, find_release(reader, caller, loom, number));
        return parse_json(found.release.feeders);
    }));
    const auto all = static_cast<std::int64_t>(cloth->picks.size());
    if (from < 1 || from > all || count < 1) return bad_input("counts picks from 1", "from");
    const std::int64_t last = from - 1 + std::min({count, most_listed_picks, all - from + 1});
    Json list = Json::array();
    for (std::int64_t k = from - 1; k < last; ++k) {
        const Pick& pick = cloth->picks[static_cast<std::size_t>(k)];
        const YarnType* yarn = yarn_of_pick(cloth->design, pick);
        list.push_back(
            {{"pick", k + 1},
             {"feeder", pick.feeders.empty() ? Json(nullptr) : feeders.at(pick.feeders.front())},
             {"direction", pick.direction == Direction::left_to_right ? "left_to_right" : "right_to_left"},
             {"yarn", yarn != nullptr ? Json(yarn->name) : Json(nullptr)},
             {"colour", yarn != nullptr ? Json(to_text(yarn->colour)) : Json(nullptr)},
             {"take_up", pick.take_up}});
        if (pick.feeders.size() > 1) list.back()["second_feeder"] = feeders.at(pick.feeders[1]);
    }
    return Json{{"picks", std::move(list)}};
}

}  // namespace weave::loomlink
