#include <weave/sql/database.hpp>

#include <loomlink/store/reader.hpp>
#include <loomlink/store/words.hpp>
#include <loomlink/store/writer.hpp>

namespace weave::loomlink {

namespace {

Person person_of(const sql::Row& row) {
    return {row.integer(0),
            row.bytes(1),
            row.bytes(2),
            row.integer(3) != 0,
            row.bytes(4),
            {},
            static_cast<Seq>(row.integer(5))};
}

PersonKey key_of(const sql::Row& row) {
    PersonKey key{
        row.bytes(0), {}, row.bytes(2), row.fixed<Hash>(3), {}, static_cast<Seq>(row.integer(5)), {}};
    if (!row.is_null(1)) key.person = row.integer(1);
    if (!row.is_null(4)) key.sealed = row.bytes(4);
    if (!row.is_null(6)) key.revoked = static_cast<Seq>(row.integer(6));
    return key;
}

Status fill_roles(sql::Connection& connection, Person& person) {
    return connection.each(
        "SELECT role FROM person_role WHERE person = ? ORDER BY role",
        [&](const sql::Row& row) {
            person.roles.push_back(words::value_of<PersonRole>(words::roles, row.bytes(0)));
        },
        person.id);
}

Reader::Maybe<Person> with_roles(sql::Connection& connection, Reader::Maybe<Person> person) {
    if (person && *person) WEAVE_CHECK_OK(fill_roles(connection, **person));
    return person;
}

Status set_roles(sql::Connection& connection, Id person, const std::vector<PersonRole>& roles) {
    WEAVE_CHECK_OK(connection.run("DELETE FROM person_role WHERE person = ?", person));
    for (const PersonRole role : roles)
        WEAVE_CHECK_OK(connection.run("INSERT INTO person_role (person, role) VALUES (?, ?) ON CONFLICT DO NOTHING",
                                      person, std::string(word(role))));
    return {};
}

/// What an UPDATE must have met.
Status met(const sql::Connection& connection, const char* what) {
    if (connection.changes() == 1) return {};
    return Error{ErrorCode::refused, std::string("there is no such ") + what, {}};
}

}  // namespace

Reader::List<Person> Reader::people() const {
    WEAVE_TRY(
        auto people,
        connection().all("SELECT id, login, full_name, active, password, event FROM person ORDER BY login",
                         person_of));
    for (Person& person : people) WEAVE_CHECK_OK(fill_roles(connection(), person));
    return people;
}

Reader::Maybe<Person> Reader::person(Id id) const {
    return with_roles(
        connection(),
        connection().one("SELECT id, login, full_name, active, password, event FROM person WHERE id = ?",
                         person_of, id));
}

Reader::Maybe<Person> Reader::person(const std::string& login) const {
    return with_roles(
        connection(),
        connection().one("SELECT id, login, full_name, active, password, event FROM person WHERE login = ?",
                         person_of, login));
}

Reader::Maybe<PersonKey> Reader::key(const std::string& id) const {
    return connection().one(
        "SELECT id, person, purpose, public_key, sealed, created, revoked FROM person_key WHERE id = ?",
        key_of, id);
}

Reader::List<PersonKey> Reader::keys(std::optional<Id> person) const {
    return connection().all(
        "SELECT id, person, purpose, public_key, sealed, created, revoked FROM person_key WHERE person IS NOT DISTINCT FROM ? "
        "ORDER BY created, id",
        key_of, person);
}

Reader::Maybe<Session> Reader::session(const Hash& token, const std::string& now) const {
    return connection().one(
        "SELECT token, person, expires, csrf FROM session WHERE token = ? AND expires > ?",
        [](const sql::Row& row) {
            return Session{row.fixed<Hash>(0), row.integer(1), row.bytes(2), row.bytes(3)};
        },
        token, now);
}

Reader::Maybe<std::string> Reader::answer(const std::string& request, Id person) const {
    WEAVE_TRY(const auto found,
              connection().one(
                  "SELECT person, answer FROM request WHERE id = ?",
                  [](const sql::Row& row) { return std::pair(row.integer(0), row.bytes(1)); }, request));
    if (!found) return std::optional<std::string>();
    if (found->first != person)
        return Error{ErrorCode::refused, "the request id was used by somebody else", {}};
    return std::optional(found->second);
}

Result<Id> Writer::add_person(const Person& person) {
    WEAVE_TRY(const Id id,
              connection().number(
                  "INSERT INTO person (login, full_name, active, password, event) VALUES (?, ?, ?, ?, ?) RETURNING id",
                  person.login, person.full_name, std::int64_t{person.active ? 1 : 0}, person.password,
                  static_cast<std::int64_t>(person.event)));
    WEAVE_CHECK_OK(set_roles(connection(), id, person.roles));
    return id;
}

Status Writer::update_person(const Person& person) {
    WEAVE_CHECK_OK(connection().run(
        "UPDATE person SET full_name = ?, active = ?, password = ?, event = ? WHERE id = ? AND login = ?",
        person.full_name, std::int64_t{person.active ? 1 : 0}, person.password,
        static_cast<std::int64_t>(person.event), person.id, person.login));
    WEAVE_CHECK_OK(met(connection(), "person"));
    return set_roles(connection(), person.id, person.roles);
}

Status Writer::add_key(const PersonKey& key) {
    const auto sealed = key.sealed ? std::optional(sql::Blob{*key.sealed}) : std::nullopt;
    return connection().run(
        "INSERT INTO person_key (id, person, purpose, public_key, sealed, created) VALUES (?, ?, ?, ?, ?, ?)",
        key.id, key.person, key.purpose, key.public_key, sealed, static_cast<std::int64_t>(key.created));
}

Status Writer::reseal_key(const std::string& id, const std::string& sealed) {
    WEAVE_CHECK_OK(connection().run("UPDATE person_key SET sealed = ? WHERE id = ? AND revoked IS NULL",
                                    sql::Blob{sealed}, id));
    return met(connection(), "key that counts");
}

Status Writer::revoke_key(const std::string& id, Seq event) {
    WEAVE_CHECK_OK(connection().run("UPDATE person_key SET revoked = ? WHERE id = ? AND revoked IS NULL",
                                    static_cast<std::int64_t>(event), id));
    return met(connection(), "key that counts");
}

Status Writer::add_session(const Session& session) {
    return connection().run("INSERT INTO session (token, person, expires, csrf) VALUES (?, ?, ?, ?)",
                            session.token, session.person, session.expires, session.csrf);
}

Status Writer::end_session(const Hash& token) {
    return connection().run("DELETE FROM session WHERE token = ?", token);
}

Status Writer::end_sessions(Id person) {
    return connection().run("DELETE FROM session WHERE person = ?", person);
}

Status Writer::drop_expired_sessions(const std::string& now) {
    return connection().run("DELETE FROM session WHERE expires <= ?", now);
}

Status Writer::record_answer(const std::string& request, Id person, const std::string& answer) {
    return connection().run("INSERT INTO request (id, person, answer) VALUES (?, ?, ?)", request, person,
                            answer);
}

}  // namespace weave::loomlink
