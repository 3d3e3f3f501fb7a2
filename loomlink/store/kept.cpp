#include <weave/sql/database.hpp>

#include <algorithm>
#include <loomlink/keys/trust.hpp>
#include <loomlink/store/reader.hpp>
#include <utility>

namespace weave::loomlink {

namespace {

#define WEAVE_OF_REVISION "'revision ' || r.number || ' of ' || d.name"
#define WEAVE_REVISIONS "JOIN revision r ON r.id = x.revision JOIN design d ON d.id = r.design"
#define WEAVE_OF_RELEASE "'release ' || r.number || ' of ' || l.name"
#define WEAVE_RELEASES "JOIN release r ON r.id = x.release JOIN loom l ON l.id = r.loom"

/// Each question tells the place first, then the values. The retelling of the log (workflow/retelling.hpp) makes the
/// same of the records.
constexpr const char* questions[]{
    "SELECT 'session ' || lower(hex(s.token)), p.login FROM session s JOIN person p ON p.id = s.person",
    "SELECT 'invitation of record ' || event, purpose, name, roles, expires, code, used FROM invitation",
    "SELECT 'policy ' || version, text, event FROM policy",
    "SELECT 'design ' || name, event FROM design",
    "SELECT " WEAVE_OF_REVISION
    ", r.hash, p.login, r.at, r.message, o.hash, r.design_sha256, r.scene_sha256, r.card_sha256, r.picks, "
    "r.ends, r.event FROM revision r JOIN design d ON d.id = r.design JOIN person p ON p.id = r.author "
    "JOIN object o ON o.id = r.document",
    "SELECT p.login || ', author of ' || " WEAVE_OF_REVISION ", 1 FROM revision_author x " WEAVE_REVISIONS
    " JOIN person p ON p.id = x.person",
    "SELECT 'branch ' || b.name || ' of ' || d.name, r.number, b.event FROM branch b JOIN design d ON d.id = "
    "b.design JOIN revision r ON r.id = b.head",
    "SELECT 'state of ' || " WEAVE_OF_REVISION " || ' by record ' || x.event, x.state FROM revision_state "
    "x " WEAVE_REVISIONS,
    "SELECT 'decision of record ' || x.event, r.number, d.name, p.login, x.kind FROM decision "
    "x " WEAVE_REVISIONS " JOIN person p ON p.id = x.person",
    "SELECT 'waiver of record ' || x.event, r.number, d.name, p.login, x.rule, x.reason FROM waiver "
    "x " WEAVE_REVISIONS " JOIN person p ON p.id = x.person",
    "SELECT 'comment of record ' || x.event, r.number, d.name, p.login, x.text FROM comment "
    "x " WEAVE_REVISIONS " JOIN person p ON p.id = x.person",
    "SELECT 'evidence of record ' || e.event, e.design_sha256, e.scene_sha256, e.coverage, e.fidelity, "
    "e.parameters, e.solver, e.residual, e.converged, o.hash, e.signer FROM evidence e JOIN object o ON o.id "
    "= e.report",
    "SELECT 'loom ' || name, event FROM loom",
    "SELECT 'profile ' || x.version || ' of ' || l.name, o.hash, x.event FROM loom_profile x JOIN loom l ON "
    "l.id = x.loom JOIN object o ON o.id = x.object",
    "SELECT p.login || ', operator of ' || l.name, x.event FROM loom_operator x JOIN loom l ON l.id = x.loom "
    "JOIN person p ON p.id = x.person",
    "SELECT " WEAVE_OF_RELEASE
    ", v.number, d.name, r.profile_version, r.feeders, o.hash, r.event FROM release r JOIN loom l ON l.id = "
    "r.loom JOIN revision v ON v.id = r.revision JOIN design d ON d.id = v.design JOIN object o ON o.id = "
    "r.manifest",
    "SELECT x.name || ', file of ' || " WEAVE_OF_RELEASE ", o.hash FROM release_file x " WEAVE_RELEASES
    " JOIN object o ON o.id = x.object",
    "SELECT 'signature of ' || " WEAVE_OF_RELEASE
    " || ' by record ' || x.event, x.key FROM release_signature "
    "x " WEAVE_RELEASES,
    "SELECT 'state of ' || " WEAVE_OF_RELEASE " || ' by record ' || x.event, x.state FROM release_state "
    "x " WEAVE_RELEASES,
    "SELECT 'place in ' || " WEAVE_OF_RELEASE ", x.pick, p.login FROM bookmark x " WEAVE_RELEASES
    " JOIN person p ON p.id = x.person",
    "SELECT 'fault of record ' || x.event, r.number, l.name, x.pick, x.text, p.login FROM fault_report "
    "x " WEAVE_RELEASES " JOIN person p ON p.id = x.person",
    "SELECT 'loading of record ' || x.event, r.number, l.name, p.login FROM loaded x " WEAVE_RELEASES
    " JOIN person p ON p.id = x.person",
};

/// The SHA-256 of what a trust document says, as the record that tells of it has it.
Json body_of(const SitePaper& paper) {
    const auto trust = read_trust(paper.text);
    return trust ? Json(trust->fingerprint()) : Json(nullptr);
}

KeptThing person_thing(const Person& person) {
    std::vector<std::string> roles;
    for (const PersonRole role : person.roles) roles.emplace_back(word(role));
    return kept_thing(
        "person " + person.login,
        {person.full_name, person.active, hash_hex(sha256(person.password)), roles, person.event});
}

Json or_null(const std::optional<Seq>& seq) {
    return seq ? Json(*seq) : Json(nullptr);
}

KeptThing key_thing(const PersonKey& key, const std::string& holder) {
    return kept_thing("key " + key.id, {holder.empty() ? Json(nullptr) : Json(holder), key.purpose,
                                        hash_hex(key.public_key),
                                        key.sealed ? Json(hash_hex(sha256(*key.sealed))) : Json(nullptr),
                                        key.created, or_null(key.revoked)});
}

}  // namespace

KeptThing kept_thing(std::string place, const Json& values) {
    return {std::move(place), values.dump(-1, ' ', false, Json::error_handler_t::replace)};
}

Reader::List<KeptThing> Reader::kept() const {
    std::vector<KeptThing> things;
    for (const char* question : questions)
        WEAVE_CHECK_OK(connection().each(question, [&](const sql::Row& row) {
            Json values = Json::array();
            for (int column = 1; column < row.columns(); ++column) values.push_back(row.json(column));
            things.push_back(kept_thing(row.bytes(0), values));
        }));
    WEAVE_TRY(const auto everybody, people());
    for (const Person& person : everybody) {
        things.push_back(person_thing(person));
        WEAVE_TRY(const auto own, keys(person.id));
        for (const PersonKey& key : own) things.push_back(key_thing(key, person.login));
    }
    WEAVE_TRY(const auto machines, keys(std::nullopt));
    for (const PersonKey& key : machines) things.push_back(key_thing(key, ""));
    WEAVE_TRY(const auto papers, trust_documents(1));
    for (const SitePaper& paper : papers)
        things.push_back(
            kept_thing("trust document " + std::to_string(paper.number), {body_of(paper), paper.event}));
    std::sort(things.begin(), things.end());
    return things;
}

}  // namespace weave::loomlink
