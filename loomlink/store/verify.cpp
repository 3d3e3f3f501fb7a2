#include <loomlink/store/migrations.hpp>
#include <loomlink/store/unpack.hpp>
#include <loomlink/store/verify_steps.hpp>
#include <set>

namespace weave::loomlink {

namespace {

Status inspect_pages(Inspection& inspection) {
    const auto find = [&](const std::string& place, const std::string& cause) { inspection.find(place, cause); };
    WEAVE_CHECK_OK(inspection.connection.inspect_pages(find));
    return inspection.connection.inspect_links(find);
}

/// What the migrations made: the schema, and the table of which state may follow which.
Result<std::set<std::string>> rules_of(sql::Connection& connection) {
    WEAVE_TRY(auto rules, connection.rules());
    WEAVE_CHECK_OK(connection.each(
        "SELECT 'transition ' || thing || ' ' || before || ' to ' || after FROM transition",
        [&](const sql::Row& row) { rules.insert(row.bytes(0)); }));
    return rules;
}

/// The rules that keep history are part of the schema: a store that lacks one was opened by something else.
Status inspect_schema(Inspection& inspection) {
    WEAVE_TRY(const auto fresh, inspection.connection.scratch());
    for (const sql::Migration& step : migrations(fresh->engine())) WEAVE_CHECK_OK(fresh->script(std::string(step.script)));
    WEAVE_TRY(const auto expected, rules_of(*fresh));
    WEAVE_TRY(const auto found, rules_of(inspection.connection));
    const auto name_of = [](const std::string& entry) { return entry.substr(0, entry.find(':')); };
    for (const std::string& entry : expected)
        if (!found.contains(entry)) inspection.find(name_of(entry), "is not part of the store any more");
    for (const std::string& entry : found)
        if (!expected.contains(entry)) inspection.find(name_of(entry), "does not belong to the store");
    return {};
}

Status inspect_chunks(Inspection& inspection) {
    return inspection.connection.each(
        "SELECT id, hash, size, packed, bytes FROM chunk ORDER BY id", [&](const sql::Row& row) {
            const auto plain = unpack_chunk(row.bytes(4), row.integer(3) != 0, row.integer(2));
            if (!plain || sha256(*plain) != row.fixed<Hash>(1))
                inspection.find("chunk " + std::to_string(row.integer(0)), "is not what its hash says");
        });
}

Status inspect_object(Inspection& inspection, Id id, const Hash& hash, std::int64_t size) {
    std::string bytes;
    std::int64_t next = 0;
    bool whole = true;
    WEAVE_CHECK_OK(inspection.connection.each(
        "SELECT p.position, c.bytes, c.packed, c.size FROM object_chunk p JOIN chunk c ON c.id = p.chunk "
        "WHERE p.object = ? ORDER BY p.position",
        [&](const sql::Row& row) {
            const auto plain = unpack_chunk(row.bytes(1), row.integer(2) != 0, row.integer(3));
            whole = whole && plain && row.integer(0) == next++;
            if (whole) bytes += *plain;
        },
        id));
    if (!whole || static_cast<std::int64_t>(bytes.size()) != size || sha256(bytes) != hash)
        inspection.find("object " + hash_hex(hash), "is not what its hash says");
    return {};
}

Status inspect_objects(Inspection& inspection) {
    WEAVE_TRY(
        const auto objects,
        inspection.connection.all("SELECT id, hash, size FROM object ORDER BY id", [](const sql::Row& row) {
            return std::tuple(row.integer(0), row.fixed<Hash>(1), row.integer(2));
        }));
    for (const auto& [id, hash, size] : objects) WEAVE_CHECK_OK(inspect_object(inspection, id, hash, size));
    return {};
}

Status inspect_revision(Inspection& inspection, const Design& design, const Revision& revision) {
    const Reader reader(inspection.connection);
    const std::string place = "revision " + std::to_string(revision.number) + " of " + design.name;
    WEAVE_TRY(const auto author, reader.person(revision.author));
    std::vector<Hash> parents;
    for (const Id id : revision.parents) {
        WEAVE_TRY(const auto parent, reader.revision(id));
        parents.push_back(parent ? parent->hash : Hash{});
    }
    if (!author || revision_hash(revision, design.name, author->login, parents) != revision.hash)
        inspection.find(place, "is not what its hash says");
    return {};
}

Status inspect_revisions(Inspection& inspection) {
    const Reader reader(inspection.connection);
    WEAVE_TRY(const auto designs, reader.designs());
    for (const Design& design : designs) {
        WEAVE_TRY(const auto revisions, reader.revisions(design.id));
        for (const Revision& revision : revisions)
            WEAVE_CHECK_OK(inspect_revision(inspection, design, revision));
    }
    return {};
}

/// The rules that the triggers hold, asked of the rows themselves.
Status inspect_rules(Inspection& inspection) {
    WEAVE_CHECK_OK(inspection.connection.each(
        "SELECT d.event, p.login FROM decision d JOIN revision_author a USING (revision, person) "
        "JOIN person p ON p.id = d.person WHERE d.kind = 'approve'",
        [&](const sql::Row& row) {
            inspection.find_in(static_cast<Seq>(row.integer(0)), row.bytes(1) + " approved own work");
        }));
    WEAVE_CHECK_OK(
        inspection.connection.each("SELECT event FROM revision_state s WHERE NOT EXISTS (SELECT 1 FROM "
                                   "transition WHERE thing = 'revision' AND "
                                   "after = s.state AND before = coalesce((SELECT state FROM revision_state "
                                   "b WHERE b.revision = s.revision AND "
                                   "b.event < s.event ORDER BY b.event DESC LIMIT 1), ''))",
                                   [&](const sql::Row& row) {
                                       inspection.find_in(static_cast<Seq>(row.integer(0)),
                                                          "gave a revision a state that cannot follow");
                                   }));
    return inspection.connection.each(
        "SELECT event FROM release_state s WHERE NOT EXISTS (SELECT 1 FROM transition WHERE thing = "
        "'release' AND "
        "after = s.state AND before = coalesce((SELECT state FROM release_state b WHERE b.release = "
        "s.release AND "
        "b.event < s.event ORDER BY b.event DESC LIMIT 1), ''))",
        [&](const sql::Row& row) {
            inspection.find_in(static_cast<Seq>(row.integer(0)), "gave a release a state that cannot follow");
        });
}

Status inspect_version(sql::Connection& connection) {
    WEAVE_TRY(const sql::Stamp stamp, connection.stamp());
    if (stamp.application != store_owner.application_id) return Error{ErrorCode::refused, "is no store of loomlink", {}};
    if (stamp.version != migrations(connection.engine()).back().version)
        return Error{
            ErrorCode::refused,
            "is a store of version " + std::to_string(stamp.version) + "; open it with a program of that version",
            {}};
    return {};
}

}  // namespace

Status look_into(const std::string& place, const std::function<Status(const Reader&)>& ask) {
    WEAVE_TRY(auto connection, sql::Connection::open(place, sql::Access::read));
    WEAVE_CHECK_OK(connection->begin_read());  // one view for all questions, while others write
    return ask(Reader(*connection));
}

Result<std::vector<AuditFinding>> verify_store(const std::string& place, const StoreTrust& trust) {
    WEAVE_TRY(auto connection, sql::Connection::open(place, sql::Access::read));
    WEAVE_CHECK_OK(connection->begin_read());  // one view for all steps, while others write
    if (Status status = inspect_version(*connection); !status)
        return std::move(status).error().in(place);
    Inspection inspection{*connection, trust, {}};
    for (const auto step : {inspect_pages, inspect_schema, inspect_chunks, inspect_objects, inspect_log,
                            inspect_revisions, inspect_rules}) {
        const Status status = step(inspection);  // damage may stop a step; the others go on
        if (!status) inspection.find("store", status.error().text());
    }
    return std::move(inspection.findings);
}

}  // namespace weave::loomlink
