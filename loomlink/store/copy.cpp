#include <loomlink/store/copy.hpp>

#include <weave/core/sha256.hpp>
#include <weave/sql/database.hpp>

#include <bit>
#include <loomlink/store/backup.hpp>
#include <loomlink/store/migrations.hpp>
#include <loomlink/store/server.hpp>

namespace weave::loomlink {

namespace {

/// A table with its columns, sorted by the first ones; a row stands behind those that it points at.
struct Table {
    const char* name;
    const char* columns;
    int key;  ///< how many columns name a row
};

constexpr Table tables[]{
    {"site", "one, name", 1},
    {"event", "seq, record, leaf, kind, actor, subject", 1},
    {"tree_node", "level, position, hash", 2},
    {"tree_head", "id, last_event, head", 1},
    {"chunk", "id, hash, size, packed, bytes", 1},
    {"object", "id, hash, size", 1},
    {"object_chunk", "object, position, chunk", 2},
    {"person", "id, login, full_name, active, password, event", 1},
    {"person_role", "person, role", 2},
    {"person_key", "id, person, purpose, public_key, sealed, created, revoked", 1},
    {"session", "token, person, expires, csrf", 1},
    {"request", "id, person, answer", 1},
    {"design", "id, name, event", 1},
    {"revision",
     "id, hash, design, number, author, at, message, document, design_sha256, scene_sha256, card_sha256, picks, ends, event", 1},
    {"revision_parent", "revision, position, parent", 2},
    {"revision_author", "revision, person", 2},
    {"branch", "design, name, head, event", 2},
    {"transition", "thing, before, after", 3},
    {"revision_state", "revision, event, state", 2},
    {"decision", "id, revision, person, kind, event", 1},
    {"waiver", "id, revision, rule, reason, person, event", 1},
    {"evidence",
     "id, design_sha256, scene_sha256, coverage, fidelity, parameters, solver, residual, converged, report, signer, event", 1},
    {"comment", "id, revision, person, text, event", 1},
    {"loom", "id, name, event", 1},
    {"loom_profile", "loom, version, object, event", 2},
    {"loom_operator", "loom, person, event", 2},
    {"release", "id, loom, number, revision, profile_version, feeders, manifest, event", 1},
    {"release_file", "release, name, object", 2},
    {"release_signature", "release, key, value, event", 2},
    {"release_state", "release, event, state", 2},
    {"bookmark", "release, pick, person", 1},
    {"fault_report", "id, release, pick, text, person, event", 1},
    {"loaded", "id, release, person, event", 1},
    {"invitation", "code, purpose, name, roles, expires, event, used", 1},
    {"policy", "version, text, event", 1},
    {"trust_document", "number, object, event", 1},
};

std::string question(const Table& table) {
    std::string order = "1";
    for (int k = 2; k <= table.key; ++k) order += ", " + std::to_string(k);
    return std::string("SELECT ") + table.columns + " FROM " + table.name + " ORDER BY " + order;
}

std::string insertion(const Table& table) {
    const std::string columns = table.columns;
    std::string places = "?";
    for (const char c : columns) places += c == ',' ? ", ?" : "";
    return std::string("INSERT INTO ") + table.name + " (" + columns + ") VALUES (" + places + ")";
}

/// Rows one after the other, each value with its kind and size, so that no two tables have the same digest by chance.
class Digest {
  public:
    void add(const sql::Row& row) {
        std::string bytes = m_hash;
        for (int column = 0; column < row.columns(); ++column) add(row.value(column), bytes);
        const Hash hash = sha256(bytes);
        m_hash.assign(reinterpret_cast<const char*>(hash.data()), hash.size());
    }
    friend bool operator==(const Digest&, const Digest&) = default;

  private:
    static void add(const sql::Value& value, std::string& bytes) {
        bytes += static_cast<char>('0' + value.index());
        const auto append = [&](const auto& found) {
            using Found = std::decay_t<decltype(found)>;
            if constexpr (std::is_same_v<Found, std::int64_t>) {
                bytes += std::to_string(found);
            } else if constexpr (std::is_same_v<Found, double>) {
                bytes += std::to_string(std::bit_cast<std::uint64_t>(found));
            } else if constexpr (std::is_same_v<Found, std::string_view>) {
                bytes += std::to_string(found.size()) + ':' += found;
            } else if constexpr (std::is_same_v<Found, sql::Blob>) {
                bytes += std::to_string(found.bytes.size()) + ':' += found.bytes;
            }
        };
        std::visit(append, value);
        bytes += '\n';
    }
    std::string m_hash;
};

Result<Digest> digest_of(sql::Connection& connection, const Table& table) {
    Digest digest;
    WEAVE_CHECK_OK(connection.each(question(table), [&](const sql::Row& row) { digest.add(row); }));
    return digest;
}

Status copy_table(sql::Connection& source, sql::Connection& target, const Table& table) {
    const std::string insert = insertion(table);
    Status outcome;
    WEAVE_CHECK_OK(source.each(question(table), [&](const sql::Row& row) {
        if (!outcome) return;
        std::vector<sql::Value> values;
        values.reserve(static_cast<std::size_t>(row.columns()));
        for (int column = 0; column < row.columns(); ++column) values.push_back(row.value(column));
        outcome = target.rows(insert, values, [](const sql::Row&) {});
    }));
    return outcome;
}

Status copy_rows(sql::Connection& source, sql::Connection& target) {
    for (const Table& table : tables) {
        if (std::string_view(table.name) == "transition") continue;  // the migrations have filled it
        if (Status copied = copy_table(source, target, table); !copied) return std::move(copied).error().under(table.name);
    }
    return {};
}

Status compare(sql::Connection& source, sql::Connection& target) {
    for (const Table& table : tables) {
        WEAVE_TRY(const Digest before, digest_of(source, table));
        WEAVE_TRY(const Digest after, digest_of(target, table));
        if (!(before == after)) return system_fault("came over other than it was; nothing was kept", table.name);
    }
    return {};
}

/// Makes room for a store in a database that holds one, if it may.
Status make_room(sql::Connection& target, bool may_replace) {
    WEAVE_TRY(const bool empty, target.is_empty());
    if (empty) return {};
    WEAVE_TRY(const sql::Stamp stamp, target.stamp());
    if (!may_replace || stamp.application != store_owner.application_id)
        return Error{ErrorCode::refused, "the database is not empty", {}};
    return target.clear();
}

Status fill(sql::Connection& source, sql::Connection& target) {
    for (const sql::Migration& step : migrations(target.engine())) WEAVE_CHECK_OK(target.script(std::string(step.script)));
    WEAVE_CHECK_OK(target.load([&] { return copy_rows(source, target); }));
    WEAVE_CHECK_OK(compare(source, target));
    return target.set_stamp({store_owner.application_id, migrations(target.engine()).back().version});
}

/// All in one transaction of the target.
Status copy_into(sql::Connection& source, const std::string& to, bool may_replace) {
    WEAVE_TRY(const auto target, sql::Connection::open(to, sql::Access::create));
    WEAVE_CHECK_OK(target->begin_write());
    Status status = make_room(*target, may_replace);
    if (status) status = fill(source, *target);
    if (status) status = target->commit();
    target->rollback();
    return status;
}

Result<std::unique_ptr<sql::Connection>> open_source(const std::string& from) {
    WEAVE_TRY(auto source, sql::Connection::open(from, sql::Access::read));
    WEAVE_CHECK_OK(source->begin_read());
    WEAVE_TRY(const sql::Stamp stamp, source->stamp());
    if (stamp.application != store_owner.application_id || stamp.version != migrations().back().version)
        return Error{ErrorCode::refused, "is no store of loomlink of this version", from};
    return source;
}

}  // namespace

Status copy_store(const std::string& from, const std::string& to) {
    WEAVE_TRY(const auto source, open_source(from));
    if (is_database(to)) return copy_into(*source, to, false);
    return make_database(to, [&](const std::string& file) { return copy_into(*source, file, false); });
}

Status remove_copy(const std::string& place) {
    if (!is_database(place)) {
        remove_database(place);
        return {};
    }
    WEAVE_TRY(const auto target, sql::Connection::open(place, sql::Access::write));
    WEAVE_CHECK_OK(target->begin_write());
    Status status = make_room(*target, true);
    if (status) status = target->commit();
    target->rollback();
    return status;
}

Status replace_store(const std::string& from, const std::string& database) {
    WEAVE_CHECK_OK(refuse_in_use(database));
    WEAVE_TRY(const auto source, open_source(from));
    return copy_into(*source, database, true);
}

}  // namespace weave::loomlink
