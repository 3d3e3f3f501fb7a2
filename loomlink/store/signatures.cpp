#include <loomlink/store/signatures.hpp>

#include <loomlink/keys/trust.hpp>
#include <map>
#include <utility>

namespace weave::loomlink {

namespace {

using KeysById = std::map<std::string, PublicKey>;

Result<KeysById> keys_in(const Reader& reader) {
    KeysById known;
    WEAVE_TRY(const auto people, reader.people());
    std::vector<std::optional<Id>> holders{std::nullopt};
    for (const Person& person : people) holders.emplace_back(person.id);
    for (const auto& holder : holders) {
        WEAVE_TRY(const auto keys, reader.keys(holder));
        for (const PersonKey& key : keys) known[key.id] = key.public_key;
    }
    return known;
}

bool is_good(const KeysById& keys, Purpose purpose, std::string_view bytes, const Signature& signature) {
    const auto key = keys.find(signature.key);
    return key != keys.end() && verify(key->second, purpose, bytes, signature);
}

SignatureCheck check_by(KeysById keys, Purpose purpose) {
    return [keys = std::move(keys), purpose](std::string_view bytes, const RecordSignature& signature) {
        return is_good(keys, purpose, bytes, {signature.key, signature.value});
    };
}

Status inspect_manifests(const Reader& reader, const KeysById& keys, std::vector<AuditFinding>& findings) {
    WEAVE_TRY(const auto looms, reader.looms());
    for (const Loom& loom : looms) {
        WEAVE_TRY(const auto releases, reader.releases(loom.id));
        for (const Release& release : releases) {
            const std::string place = loom.name + ", release " + std::to_string(release.number);
            const auto manifest = reader.object(release.manifest);
            if (!manifest || !*manifest) {
                findings.push_back({release.event, place, "its manifest is missing or damaged"});
                continue;
            }
            for (const ReleaseSignature& one : release.signatures)
                if (!is_good(keys, Purpose::release_manifest, **manifest, {one.key, one.value}))
                    findings.push_back({one.event, place, "a signature of its manifest is not good"});
        }
    }
    return {};
}

/// The text of a member; empty where it is something else.
std::string text_of(const Json& data, const char* member) {
    return data.contains(member) && data.at(member).is_string() ? data.at(member).get<std::string>() : "";
}

Status inspect_evidence(const Reader& reader, const KeysById& keys, std::vector<AuditFinding>& findings) {
    constexpr std::size_t page = 1000;
    EventFilter filter{0, page, "evidence.added", {}};
    while (true) {
        WEAVE_TRY(const auto events, reader.events(filter));
        for (const auto& [seq, bytes] : events) {
            const auto record = parse_record(bytes);
            const Json data = record ? record->statement.data : Json::object();
            const std::string statement =
                data.contains("statement") ? canonical_json(data.at("statement")) : "";
            if (!is_good(keys, Purpose::evidence, statement,
                         {text_of(data, "key"), text_of(data, "signature")}))
                findings.push_back(
                    {seq, "record " + std::to_string(seq), "the signature of its evidence is not good"});
        }
        if (events.size() < page) return {};
        filter.from = events.back().first + 1;
    }
}

Status inspect_trust(const Reader& reader, std::vector<AuditFinding>& findings) {
    WEAVE_TRY(const auto papers, reader.trust_documents(1));
    std::optional<TrustDocument> before;
    for (const SitePaper& paper : papers) {
        auto trust = before ? next_trust(*before, paper.text) : read_trust(paper.text);
        if (!trust) {
            findings.push_back(
                {paper.event, "trust document " + std::to_string(paper.number), trust.error().text()});
            return {};
        }
        before = *std::move(trust);
    }
    return {};
}

}  // namespace

Result<StoreTrust> own_trust(const std::string& store, const PublicKey& log) {
    KeysById people, logs{{key_id(log), log}};
    const Status asked = look_into(store, [&](const Reader& reader) -> Status {
        WEAVE_TRY(people, keys_in(reader));
        WEAVE_TRY(const auto papers, reader.trust_documents(1));
        for (const SitePaper& paper : papers)
            if (const auto trust = read_trust(paper.text))
                for (const TrustedKey& key : trust->keys)
                    if (key.has(Role::log)) logs[key.id()] = key.public_key;
        return {};
    });
    if (!asked) return asked.error();
    return StoreTrust{
        check_by(std::move(logs), Purpose::tree_head), check_by(std::move(people), Purpose::statement), {}};
}

Result<std::vector<AuditFinding>> verify_signatures(const std::string& store) {
    std::vector<AuditFinding> findings;
    const Status asked = look_into(store, [&](const Reader& reader) -> Status {
        WEAVE_TRY(const KeysById keys, keys_in(reader));
        WEAVE_CHECK_OK(inspect_manifests(reader, keys, findings));
        WEAVE_CHECK_OK(inspect_evidence(reader, keys, findings));
        return inspect_trust(reader, findings);
    });
    if (!asked) return asked.error();
    return findings;
}

}  // namespace weave::loomlink
