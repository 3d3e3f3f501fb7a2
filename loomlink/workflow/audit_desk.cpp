#include <loomlink/workflow/audit_desk.hpp>

#include <algorithm>
#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/found.hpp>
#include <loomlink/workflow/releases.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_events = 1000;

Json path_json(const std::vector<Hash>& path) {
    Json list = Json::array();
    for (const Hash& hash : path) list.push_back(hash_hex(hash));
    return Json{{"path", std::move(list)}};
}

/// Whose signature stands under a record.
Result<Json> signer_of(const Reader& reader, const EventRecord& record) {
    if (!record.signature) return Json(nullptr);
    WEAVE_TRY(const auto key, reader.key(record.signature->key));
    if (!key || !key->person) return Json(record.signature->key.substr(0, 16));
    WEAVE_TRY(const auto person, reader.person(*key->person));
    return Json(person ? person->full_name : record.signature->key.substr(0, 16));
}

Result<Json> event_json(const Reader& reader, const std::string& bytes) {
    WEAVE_TRY(const EventRecord record, parse_record(bytes));
    const Statement& statement = record.statement;
    WEAVE_TRY(Json signer, signer_of(reader, record));
    return Json{{"seq", record.seq},
                {"at", statement.at},
                {"actor", statement.actor},
                {"kind", statement.kind},
                {"subject", statement.subject ? Json(*statement.subject) : Json(nullptr)},
                {"reason", statement.reason ? Json(*statement.reason) : Json(nullptr)},
                {"data", statement.data},
                {"signed", std::move(signer)},
                {"record", bytes}};
}

constexpr std::size_t most_bundled = 100000;

/// The records of a design that are about one of its revisions, each with its way to the head.
Result<Json> proven_records(const Reader& reader, const FoundRevision& found, std::uint64_t size) {
    WEAVE_TRY(const auto events,
              reader.events({.from = 0, .most = most_bundled, .kind = {}, .subject = found.design.name}));
    Json list = Json::array();
    for (const auto& [seq, bytes] : events) {
        if (seq >= size) break;
        WEAVE_TRY(const EventRecord record, parse_record(bytes));
        const Json& data = record.statement.data;
        const bool is_about = seq == found.revision.event ||
                              (data.contains("revision") && data.at("revision") == found.revision.number);
        if (!is_about) continue;
        WEAVE_TRY(const auto path, reader.inclusion(seq, size));
        list.push_back({{"seq", seq}, {"record", bytes}, {"path", path_json(path).at("path")}});
    }
    return list;
}

Result<Json> manifests_of(const Reader& reader, Id revision) {
    WEAVE_TRY(const auto releases, reader.releases_of(revision));
    Json list = Json::array();
    for (const Release& release : releases) {
        WEAVE_TRY(const SignedManifest manifest, signed_manifest(reader, release));
        list.push_back(manifest.bytes);
    }
    return list;
}

}  // namespace

Result<Json> AuditDesk::revision_bundle(const Caller& caller, const std::string& design,
                                        std::int64_t number) {
    WEAVE_CHECK_OK(need_role(caller, PersonRole::engineer));
    WEAVE_CHECK_OK(m_desk->note(caller.login, "revision.exported", design, {{"revision", number}}));
    WEAVE_TRY(const SignedTreeHead head, current_head(*m_desk));
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const FoundRevision found, find_revision(reader, caller, design, number));
        WEAVE_TRY(const auto document, reader.object(found.revision.document));
        WEAVE_TRY(const auto papers, reader.trust_documents(1));
        Json json{{"format", "weave-revision-bundle"},
                  {"version", 1},
                  {"site", m_desk->site()},
                  {"design", design},
                  {"revision", number},
                  {"sha256", hash_hex(found.revision.hash)},
                  {"document", document.value_or("")},
                  {"head", signed_head_bytes(head)},
                  {"trust", Json::array()}};
        for (const SitePaper& paper : papers) json["trust"].push_back(paper.text);
        WEAVE_TRY(json["records"], proven_records(reader, found, head.head.size));
        WEAVE_TRY(json["manifests"], manifests_of(reader, found.revision.id));
        return json;
    });
}

Result<Json> AuditDesk::events(const Caller& caller, Seq from, std::size_t limit,
                               const std::optional<std::string>& design) {
    WEAVE_CHECK_OK(need_role(caller, PersonRole::engineer));
    WEAVE_CHECK_OK(m_desk->note_view(caller, "log.viewed", design.value_or("")));
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const auto found,
                  reader.events(
                      {.from = from, .most = std::min(limit, most_events), .kind = {}, .subject = design}));
        Json list = Json::array();
        for (const auto& [seq, bytes] : found) {
            WEAVE_TRY(Json entry, event_json(reader, bytes));
            list.push_back(std::move(entry));
        }
        return Json{{"events", std::move(list)}};
    });
}

Result<Json> AuditDesk::head(const Caller& caller) {
    WEAVE_CHECK_OK(need_role(caller, PersonRole::engineer));
    WEAVE_TRY(const SignedTreeHead head, current_head(*m_desk));
    return Json{{"site", head.head.site},
                {"size", head.head.size},
                {"root", hash_hex(head.head.root)},
                {"at", head.head.at},
                {"signature", signature_json(head.signature)}};
}

Result<Json> AuditDesk::inclusion(const Caller& caller, Seq seq, std::uint64_t size) {
    WEAVE_CHECK_OK(need_role(caller, PersonRole::engineer));
    WEAVE_TRY(const auto path,
              m_desk->store().read([&](const Reader& reader) { return reader.inclusion(seq, size); }));
    return path_json(path);
}

Result<Json> AuditDesk::consistency(const Caller& caller, std::uint64_t from, std::uint64_t size) {
    WEAVE_CHECK_OK(need_role(caller, PersonRole::engineer));
    WEAVE_TRY(const auto path,
              m_desk->store().read([&](const Reader& reader) { return reader.consistency(from, size); }));
    return path_json(path);
}

Result<std::string> AuditDesk::bundle(const Caller& caller) {
    WEAVE_CHECK_OK(need_role(caller, PersonRole::engineer));
    WEAVE_CHECK_OK(m_desk->note(caller.login, "log.exported", ""));
    WEAVE_CHECK_OK(current_head(*m_desk));
    WEAVE_TRY(const auto bundle, m_desk->store().read([](const Reader& reader) { return reader.bundle(); }));
    if (!bundle) return system_fault("the log has no head");
    return write_bundle(*bundle);
}

}  // namespace weave::loomlink
