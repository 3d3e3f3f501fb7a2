#include <weave/sql/database.hpp>

#include <loomlink/store/reader.hpp>
#include <loomlink/store/words.hpp>
#include <loomlink/store/writer.hpp>

namespace weave::loomlink {

namespace {

/// Literals are joined by the compiler, so that each statement is one literal, by which it is kept prepared.
#define WEAVE_RELEASE_COLUMNS                                                                     \
    "SELECT r.id, r.loom, r.number, r.revision, r.profile_version, r.feeders, o.hash, r.event, "  \
    "(SELECT s.state FROM release_state s WHERE s.release = r.id ORDER BY s.event DESC LIMIT 1) " \
    "FROM release r JOIN object o ON o.id = r.manifest "

Seq seq_of(const sql::Row& row, int column) {
    return static_cast<Seq>(row.integer(column));
}
std::int64_t number_of(Seq seq) {
    return static_cast<std::int64_t>(seq);
}

Loom loom_of(const sql::Row& row) {
    return {row.integer(0), row.bytes(1), seq_of(row, 2)};
}

Release release_of(const sql::Row& row) {
    Release release;
    release.id = row.integer(0);
    release.loom = row.integer(1);
    release.number = row.integer(2);
    release.revision = row.integer(3);
    release.profile_version = row.integer(4);
    release.feeders = row.bytes(5);
    release.manifest = row.fixed<Hash>(6);
    release.event = seq_of(row, 7);
    release.state = words::value_of<ReleaseStage>(words::release_states, row.bytes(8));
    return release;
}

Status fill(sql::Connection& connection, Release& release) {
    WEAVE_CHECK_OK(connection.each(
        "SELECT f.name, o.hash, o.size FROM release_file f JOIN object o ON o.id = f.object WHERE f.release "
        "= ? "
        "ORDER BY f.name",
        [&](const sql::Row& row) {
            release.files.push_back({row.bytes(0), row.fixed<Hash>(1), row.integer(2)});
        },
        release.id));
    return connection.each(
        "SELECT key, value, event FROM release_signature WHERE release = ? ORDER BY event, key",
        [&](const sql::Row& row) {
            release.signatures.push_back({row.bytes(0), row.bytes(1), seq_of(row, 2)});
        },
        release.id);
}

Reader::List<Release> filled(sql::Connection& connection, Reader::List<Release> releases) {
    if (releases)
        for (Release& release : *releases) WEAVE_CHECK_OK(fill(connection, release));
    return releases;
}

}  // namespace

Reader::List<Loom> Reader::looms() const {
    return connection().all("SELECT id, name, event FROM loom ORDER BY name", loom_of);
}

Reader::Maybe<Loom> Reader::loom(const std::string& name) const {
    return connection().one("SELECT id, name, event FROM loom WHERE name = ?", loom_of, name);
}

Reader::List<LoomProfileVersion> Reader::profiles(Id loom) const {
    return connection().all(
        "SELECT p.loom, p.version, o.hash, p.event FROM loom_profile p JOIN object o ON o.id = p.object "
        "WHERE p.loom = ? ORDER BY p.version",
        [](const sql::Row& row) {
            return LoomProfileVersion{row.integer(0), row.integer(1), row.fixed<Hash>(2), seq_of(row, 3)};
        },
        loom);
}

Reader::List<Loom> Reader::looms_of(Id operator_person) const {
    return connection().all(
        "SELECT l.id, l.name, l.event FROM loom l JOIN loom_operator p ON p.loom = l.id WHERE p.person = ? "
        "ORDER BY l.name",
        loom_of, operator_person);
}

Reader::List<Person> Reader::operators(Id loom) const {
    WEAVE_TRY(const auto ids,
              connection().all(
                  "SELECT o.person FROM loom_operator o JOIN person p ON p.id = o.person WHERE "
                  "o.loom = ? ORDER BY p.login",
                  [](const sql::Row& row) { return row.integer(0); }, loom));
    std::vector<Person> people;
    for (const Id id : ids) {
        WEAVE_TRY(auto found, person(id));
        if (found) people.push_back(*std::move(found));
    }
    return people;
}

Reader::Maybe<Release> Reader::release(Id id) const {
    auto found = connection().one(WEAVE_RELEASE_COLUMNS "WHERE r.id = ?", release_of, id);
    if (found && *found) WEAVE_CHECK_OK(fill(connection(), **found));
    return found;
}

Reader::List<Release> Reader::releases(Id loom) const {
    return filled(
        connection(),
        connection().all(WEAVE_RELEASE_COLUMNS "WHERE r.loom = ? ORDER BY r.number DESC", release_of, loom));
}

Reader::List<Release> Reader::releases_of(Id revision) const {
    return filled(connection(), connection().all(WEAVE_RELEASE_COLUMNS "WHERE r.revision = ? ORDER BY r.id",
                                                 release_of, revision));
}

Reader::List<Step<ReleaseStage>> Reader::release_steps(Id release) const {
    return connection().all(
        "SELECT state, event FROM release_state WHERE release = ? ORDER BY event",
        [](const sql::Row& row) {
            return Step<ReleaseStage>{words::value_of<ReleaseStage>(words::release_states, row.bytes(0)),
                                      seq_of(row, 1)};
        },
        release);
}

Reader::Maybe<Bookmark> Reader::bookmark(Id release) const {
    return connection().one(
        "SELECT release, pick, person FROM bookmark WHERE release = ?",
        [](const sql::Row& row) {
            return Bookmark{row.integer(0), row.integer(1), row.integer(2)};
        },
        release);
}

Reader::List<FaultReport> Reader::faults(Id release) const {
    return connection().all(
        "SELECT release, pick, text, person, event FROM fault_report WHERE release = ? ORDER BY id",
        [](const sql::Row& row) {
            FaultReport fault{row.integer(0), {}, row.bytes(2), row.integer(3), seq_of(row, 4)};
            if (!row.is_null(1)) fault.pick = row.integer(1);
            return fault;
        },
        release);
}

Reader::List<Loaded> Reader::loaded(Id release) const {
    return connection().all(
        "SELECT release, person, event FROM loaded WHERE release = ? ORDER BY id",
        [](const sql::Row& row) {
            return Loaded{row.integer(0), row.integer(1), seq_of(row, 2)};
        },
        release);
}

Result<Id> Writer::add_loom(const std::string& name, Seq event) {
    return connection().number("INSERT INTO loom (name, event) VALUES (?, ?) RETURNING id", name, number_of(event));
}

Result<std::int64_t> Writer::add_profile(Id loom, const Hash& object, Seq event) {
    WEAVE_TRY(const Id id, object_id(object));
    WEAVE_TRY(const std::int64_t last,
              connection().number("SELECT coalesce(max(version), 0) FROM loom_profile WHERE loom = ?", loom));
    WEAVE_CHECK_OK(
        connection().run("INSERT INTO loom_profile (loom, version, object, event) VALUES (?, ?, ?, ?)", loom,
                         last + 1, id, number_of(event)));
    return last + 1;
}

Status Writer::allow_operator(Id loom, Id person, Seq event) {
    return connection().run(
        "INSERT INTO loom_operator (loom, person, event) VALUES (?, ?, ?) ON CONFLICT (loom, person) DO "
        "NOTHING",
        loom, person, number_of(event));
}

Status Writer::disallow_operator(Id loom, Id person) {
    return connection().run("DELETE FROM loom_operator WHERE loom = ? AND person = ?", loom, person);
}

Result<Release> Writer::add_release(const Release& given) {
    WEAVE_TRY(const Id manifest, object_id(given.manifest));
    WEAVE_TRY(const std::int64_t last,
              connection().number("SELECT coalesce(max(number), 0) FROM release WHERE loom = ?", given.loom));
    WEAVE_TRY(const Id id,
              connection().number(
                  "INSERT INTO release (loom, number, revision, profile_version, feeders, manifest, "
                  "event) VALUES (?, ?, ?, ?, ?, ?, ?) RETURNING id",
                  given.loom, last + 1, given.revision, given.profile_version, given.feeders, manifest,
                  number_of(given.event)));
    for (const ReleaseFile& file : given.files) {
        WEAVE_TRY(const Id object, object_id(file.object));
        WEAVE_CHECK_OK(connection().run("INSERT INTO release_file (release, name, object) VALUES (?, ?, ?)",
                                        id, file.name, object));
    }
    WEAVE_CHECK_OK(set_release_state(id, ReleaseStage::prepared, given.event));
    WEAVE_TRY(auto made, release(id));
    if (!made) return system_fault("the release that was just made is not there");
    return *std::move(made);
}

Status Writer::sign_release(Id release, const ReleaseSignature& signature) {
    return connection().run("INSERT INTO release_signature (release, key, value, event) VALUES (?, ?, ?, ?)",
                            release, signature.key, signature.value, number_of(signature.event));
}

Status Writer::set_release_state(Id release, ReleaseStage state, Seq event) {
    return connection().run("INSERT INTO release_state (release, event, state) VALUES (?, ?, ?)", release,
                            number_of(event), std::string(word(state)));
}

Status Writer::set_bookmark(const Bookmark& bookmark) {
    return connection().run(
        "INSERT INTO bookmark (release, pick, person) VALUES (?, ?, ?) "
        "ON CONFLICT (release) DO UPDATE SET pick = excluded.pick, person = excluded.person",
        bookmark.release, bookmark.pick, bookmark.person);
}

Status Writer::add_fault(const FaultReport& fault) {
    return connection().run(
        "INSERT INTO fault_report (release, pick, text, person, event) VALUES (?, ?, ?, ?, ?)", fault.release,
        fault.pick, fault.text, fault.person, number_of(fault.event));
}

Status Writer::add_loaded(const Loaded& loaded) {
    return connection().run("INSERT INTO loaded (release, person, event) VALUES (?, ?, ?)", loaded.release,
                            loaded.person, number_of(loaded.event));
}

}  // namespace weave::loomlink
