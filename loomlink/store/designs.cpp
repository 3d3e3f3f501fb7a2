#include <weave/core/json.hpp>
#include <weave/sql/database.hpp>

#include <loomlink/store/reader.hpp>
#include <loomlink/store/words.hpp>
#include <loomlink/store/writer.hpp>

namespace weave::loomlink {

namespace {

/// Literals are joined by the compiler, so that each statement is one literal, by which it is kept prepared.
#define WEAVE_REVISION_COLUMNS                                                                        \
    "SELECT r.id, r.hash, r.design, r.number, r.author, r.at, r.message, o.hash, r.design_sha256, "   \
    "r.scene_sha256, r.card_sha256, r.picks, r.ends, r.event, (SELECT s.state FROM revision_state s " \
    "WHERE s.revision = r.id ORDER BY s.event DESC LIMIT 1) FROM revision r JOIN object o ON o.id = " \
    "r.document "

Seq seq_of(const sql::Row& row, int column) {
    return static_cast<Seq>(row.integer(column));
}
std::int64_t number_of(Seq seq) {
    return static_cast<std::int64_t>(seq);
}

Revision revision_of(const sql::Row& row) {
    Revision revision;
    revision.id = row.integer(0);
    revision.hash = row.fixed<Hash>(1);
    revision.design = row.integer(2);
    revision.number = row.integer(3);
    revision.author = row.integer(4);
    revision.at = row.bytes(5);
    revision.message = row.bytes(6);
    revision.document = row.fixed<Hash>(7);
    revision.design_sha256 = row.fixed<Hash>(8);
    revision.scene_sha256 = row.fixed<Hash>(9);
    revision.card_sha256 = row.fixed<Hash>(10);
    revision.picks = row.integer(11);
    revision.ends = row.integer(12);
    revision.event = seq_of(row, 13);
    revision.state = words::value_of<RevisionState>(words::revision_states, row.bytes(14));
    return revision;
}

Status fill(sql::Connection& connection, Revision& revision) {
    const auto add_to = [](std::vector<Id>& ids) {
        return [&ids](const sql::Row& row) { ids.push_back(row.integer(0)); };
    };
    WEAVE_CHECK_OK(connection.each("SELECT parent FROM revision_parent WHERE revision = ? ORDER BY position",
                                   add_to(revision.parents), revision.id));
    return connection.each("SELECT person FROM revision_author WHERE revision = ? ORDER BY person",
                           add_to(revision.authors), revision.id);
}

Reader::List<Revision> filled(sql::Connection& connection, Reader::List<Revision> revisions) {
    if (revisions)
        for (Revision& revision : *revisions) WEAVE_CHECK_OK(fill(connection, revision));
    return revisions;
}

Reader::Maybe<Revision> filled(sql::Connection& connection, Reader::Maybe<Revision> revision) {
    if (revision && *revision) WEAVE_CHECK_OK(fill(connection, **revision));
    return revision;
}

Design design_of(const sql::Row& row) {
    return {row.integer(0), row.bytes(1), seq_of(row, 2)};
}

Error no_such(const char* what) {
    return {ErrorCode::refused, std::string("there is no such ") + what, {}};
}

}  // namespace

Hash revision_hash(const Revision& revision, const std::string& design, const std::string& author,
                   const std::vector<Hash>& parents) {
    Json json = {{"design", design},
                 {"parents", Json::array()},
                 {"author", author},
                 {"at", revision.at},
                 {"message", revision.message},
                 {"document", hash_hex(revision.document)},
                 {"design_sha256", hash_hex(revision.design_sha256)},
                 {"scene_sha256", hash_hex(revision.scene_sha256)},
                 {"card_sha256", hash_hex(revision.card_sha256)}};
    for (const Hash& parent : parents) json["parents"].push_back(hash_hex(parent));
    return sha256(canonical_json(json));
}

Reader::List<Design> Reader::designs() const {
    return connection().all("SELECT id, name, event FROM design ORDER BY name", design_of);
}

Reader::Maybe<Design> Reader::design(const std::string& name) const {
    return connection().one("SELECT id, name, event FROM design WHERE name = ?", design_of, name);
}

Reader::List<Branch> Reader::branches(Id design) const {
    return connection().all(
        "SELECT design, name, head, event FROM branch WHERE design = ? ORDER BY name",
        [](const sql::Row& row) {
            return Branch{row.integer(0), row.bytes(1), row.integer(2), seq_of(row, 3)};
        },
        design);
}

Reader::List<Revision> Reader::revisions(Id design) const {
    return filled(
        connection(),
        connection().all(WEAVE_REVISION_COLUMNS "WHERE r.design = ? ORDER BY r.number", revision_of, design));
}

Reader::Maybe<Revision> Reader::revision(Id id) const {
    return filled(connection(), connection().one(WEAVE_REVISION_COLUMNS "WHERE r.id = ?", revision_of, id));
}

Reader::Maybe<Revision> Reader::revision(Id design, std::int64_t number) const {
    return filled(connection(), connection().one(WEAVE_REVISION_COLUMNS "WHERE r.design = ? AND r.number = ?",
                                                 revision_of, design, number));
}

Reader::List<Revision> Reader::revisions_in(RevisionState state) const {
    return filled(connection(),
                  connection().all(WEAVE_REVISION_COLUMNS
                                   "WHERE ? = (SELECT s.state FROM revision_state s WHERE s.revision = r.id "
                                   "ORDER BY s.event DESC LIMIT 1) ORDER BY r.id",
                                   revision_of, std::string(word(state))));
}

Reader::List<Step<RevisionState>> Reader::revision_steps(Id revision) const {
    return connection().all(
        "SELECT state, event FROM revision_state WHERE revision = ? ORDER BY event",
        [](const sql::Row& row) {
            return Step<RevisionState>{words::value_of<RevisionState>(words::revision_states, row.bytes(0)),
                                       seq_of(row, 1)};
        },
        revision);
}

Reader::List<Decision> Reader::decisions(Id revision) const {
    return connection().all(
        "SELECT revision, person, kind, event FROM decision WHERE revision = ? ORDER BY event",
        [](const sql::Row& row) {
            return Decision{row.integer(0), row.integer(1),
                            words::value_of<DecisionKind>(words::decisions, row.bytes(2)), seq_of(row, 3)};
        },
        revision);
}

Reader::List<Waiver> Reader::waivers(Id revision) const {
    return connection().all(
        "SELECT revision, rule, reason, person, event FROM waiver WHERE revision = ? ORDER BY id",
        [](const sql::Row& row) {
            return Waiver{row.integer(0), row.bytes(1), row.bytes(2), row.integer(3), seq_of(row, 4)};
        },
        revision);
}

Reader::List<Evidence> Reader::evidence(const Hash& design_sha256, const Hash& scene_sha256) const {
    return connection().all(
        "SELECT e.id, e.design_sha256, e.scene_sha256, e.coverage, e.fidelity, e.parameters, e.solver, "
        "e.residual, "
        "e.converged, o.hash, e.signer, e.event FROM evidence e JOIN object o ON o.id = e.report "
        "WHERE e.design_sha256 = ? AND e.scene_sha256 = ? ORDER BY e.id",
        [](const sql::Row& row) {
            Evidence evidence{row.integer(0), row.fixed<Hash>(1),  row.fixed<Hash>(2),   row.real(3),
                              row.bytes(4),   row.bytes(5), row.bytes(6),  std::nullopt,
                              false,          row.fixed<Hash>(9),  row.bytes(10), seq_of(row, 11)};
            if (!row.is_null(7)) evidence.residual = row.real(7);
            evidence.converged = row.integer(8) != 0;
            return evidence;
        },
        design_sha256, scene_sha256);
}

Reader::List<Comment> Reader::comments(Id revision) const {
    return connection().all(
        "SELECT revision, person, text, event FROM comment WHERE revision = ? ORDER BY id",
        [](const sql::Row& row) {
            return Comment{row.integer(0), row.integer(1), row.bytes(2), seq_of(row, 3)};
        },
        revision);
}

Result<Id> Writer::add_design(const std::string& name, Seq event) {
    return connection().number("INSERT INTO design (name, event) VALUES (?, ?) RETURNING id", name, number_of(event));
}

Result<Revision> Writer::add_revision(const Revision& given) {
    WEAVE_TRY(const auto design, connection().one(
                                     "SELECT name FROM design WHERE id = ?",
                                     [](const sql::Row& row) { return row.bytes(0); }, given.design));
    if (!design) return no_such("design");
    WEAVE_TRY(const auto author, person(given.author));
    if (!author) return no_such("person");
    std::vector<Hash> parents;
    for (const Id parent : given.parents) {
        WEAVE_TRY(const auto hash, connection().one(
                                       "SELECT hash FROM revision WHERE id = ?",
                                       [](const sql::Row& row) { return row.fixed<Hash>(0); }, parent));
        if (!hash) return no_such("revision");
        parents.push_back(*hash);
    }
    WEAVE_TRY(const Id document, object_id(given.document));
    WEAVE_TRY(
        const std::int64_t last,
        connection().number("SELECT coalesce(max(number), 0) FROM revision WHERE design = ?", given.design));
    WEAVE_TRY(
        const Id id,
        connection().number(
            "INSERT INTO revision (hash, design, number, author, at, message, document, design_sha256, "
            "scene_sha256, card_sha256, picks, ends, event) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING id",
            revision_hash(given, *design, author->login, parents), given.design, last + 1, given.author,
            given.at, given.message, document, given.design_sha256, given.scene_sha256, given.card_sha256,
            given.picks, given.ends, number_of(given.event)));
    std::int64_t position = 0;
    for (const Id parent : given.parents)
        WEAVE_CHECK_OK(
            connection().run("INSERT INTO revision_parent (revision, position, parent) VALUES (?, ?, ?)", id,
                             position++, parent));
    WEAVE_CHECK_OK(set_state(id, RevisionState::draft, given.event));
    WEAVE_TRY(auto made, revision(id));
    if (!made) return system_fault("the revision that was just made is not there");
    return *std::move(made);
}

Status Writer::move_branch(const Branch& to, std::optional<Id> expected) {
    WEAVE_TRY(const auto head, connection().one(
                                   "SELECT head FROM branch WHERE design = ? AND name = ?",
                                   [](const sql::Row& row) { return row.integer(0); }, to.design, to.name));
    if (head != expected)
        return Error{ErrorCode::refused, "somebody else has changed this branch meanwhile", to.name};
    WEAVE_TRY(const auto revision_there, revision(to.head));
    if (!revision_there || revision_there->design != to.design) return no_such("revision of this design");
    return connection().run(
        "INSERT INTO branch (design, name, head, event) VALUES (?, ?, ?, ?) "
        "ON CONFLICT (design, name) DO UPDATE SET head = excluded.head, event = excluded.event",
        to.design, to.name, to.head, number_of(to.event));
}

Status Writer::set_state(Id revision, RevisionState state, Seq event) {
    return connection().run("INSERT INTO revision_state (revision, event, state) VALUES (?, ?, ?)", revision,
                            number_of(event), std::string(word(state)));
}

Status Writer::add_decision(const Decision& decision) {
    return connection().run("INSERT INTO decision (revision, person, kind, event) VALUES (?, ?, ?, ?)",
                            decision.revision, decision.person, std::string(word(decision.kind)),
                            number_of(decision.event));
}

Status Writer::add_waiver(const Waiver& waiver) {
    return connection().run(
        "INSERT INTO waiver (revision, rule, reason, person, event) VALUES (?, ?, ?, ?, ?)", waiver.revision,
        waiver.rule, waiver.reason, waiver.person, number_of(waiver.event));
}

Result<Id> Writer::add_evidence(const Evidence& evidence) {
    WEAVE_TRY(const Id report, object_id(evidence.report));
    return connection().number(
        "INSERT INTO evidence (design_sha256, scene_sha256, coverage, fidelity, parameters, solver, "
        "residual, "
        "converged, report, signer, event) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING id",
        evidence.design_sha256, evidence.scene_sha256, evidence.coverage, evidence.fidelity,
        evidence.parameters, evidence.solver, evidence.residual, std::int64_t{evidence.converged ? 1 : 0},
        report, evidence.signer, number_of(evidence.event));
}

Status Writer::add_comment(const Comment& comment) {
    return connection().run("INSERT INTO comment (revision, person, text, event) VALUES (?, ?, ?, ?)",
                            comment.revision, comment.person, comment.text, number_of(comment.event));
}

}  // namespace weave::loomlink
