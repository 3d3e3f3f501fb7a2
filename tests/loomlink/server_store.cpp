// A store on a server: its tables, its rights, its clock, its standby, and what comes in place of it.

#include "server_case.hpp"

#include <weave/core/log.hpp>

#include <loomlink/store/copy.hpp>
#include <loomlink/store/migrations.hpp>
#include <loomlink/store/server.hpp>
#include <loomlink/terminal/check.hpp>
#include <fstream>
#include <set>
#include <support/random.hpp>

namespace weave::loomlink::testing {

namespace {

/// Table, column, kind and whether it may be empty, as both engines tell them.
std::set<std::string> columns_of(sql::Connection& connection) {
    const bool is_file = connection.engine() == sql::Engine::sqlite;
    std::set<std::string> columns;
    REQUIRE(connection.each(
        is_file ? "SELECT m.name || '.' || c.name, c.type, c.\"notnull\" OR c.pk > 0 FROM sqlite_schema m JOIN pragma_table_info(m.name) c "
                  "WHERE m.type = 'table'"
                : "SELECT table_name || '.' || column_name, CASE data_type WHEN 'bigint' THEN 'INTEGER' WHEN 'text' THEN 'TEXT' WHEN "
                  "'bytea' THEN 'BLOB' WHEN 'double precision' THEN 'REAL' ELSE data_type END, is_nullable = 'NO' FROM "
                  "information_schema.columns WHERE table_schema = current_schema() AND table_name <> 'store_version'",
        [&](const sql::Row& row) {
            columns.insert(row.bytes(0) + " " + row.bytes(1) + (row.integer(2) != 0 ? " always" : ""));
        }));
    return columns;
}

/// How many rules of each kind stand on each table: unique ones, links, and checks.
std::set<std::string> rules_of(sql::Connection& connection) {
    const bool is_file = connection.engine() == sql::Engine::sqlite;
    std::set<std::string> rules;
    const auto take = [&](const sql::Row& row) {
        rules.insert(row.bytes(0) + " " + row.bytes(1) + " " + std::to_string(row.integer(2)));
    };
    REQUIRE(connection.each(
        is_file ? "SELECT m.name, 'links', count(DISTINCT f.id) FROM sqlite_schema m JOIN pragma_foreign_key_list(m.name) f WHERE m.type = "
                  "'table' GROUP BY m.name"
                : "SELECT conrelid::regclass::text, 'links', count(*) FROM pg_constraint WHERE contype = 'f' GROUP BY conrelid",
        take));
    REQUIRE(connection.each(
        is_file ? "SELECT m.name, 'checks', (length(m.sql) - length(replace(m.sql, 'CHECK (', ''))) / 7 FROM sqlite_schema m WHERE m.type = "
                  "'table' AND m.sql LIKE '%CHECK (%'"
                : "SELECT conrelid::regclass::text, 'checks', count(*) FROM pg_constraint WHERE contype = 'c' AND conrelid NOT IN (0, "
                  "'store_version'::regclass) GROUP BY conrelid",
        take));
    return rules;
}

/// Every table that a file has came over with all its rows, whatever list a move goes by.
void check_same_counts(const std::string& file, const std::string& database) {
    const auto source = got(sql::Connection::open(file, sql::Access::read)), target = got(sql::Connection::open(database, sql::Access::read));
    const auto tables = got(source->all("SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite_%'", [](const sql::Row& row) { return row.bytes(0); }));
    CHECK(tables.size() > 30);
    for (const std::string& table : tables) {
        INFO(table);
        const std::string count = "SELECT count(*) FROM " + table;
        CHECK(got(source->number(count)) == got(target->number(count)));
    }
}

std::string place_of_new(PostgresServer& server) {
    return server.place(server.make_database());
}

}  // namespace

TEST_CASE("both databases have the same versions, tables, columns and rules", "[server]") {
    if (there_is_no_server()) return;
    const auto files = migrations(sql::Engine::sqlite), servers = migrations(sql::Engine::postgres);
    REQUIRE(files.size() == servers.size());
    const Folder folder;
    const std::string place = place_of_new(PostgresServer::shared());
    { const Store made = got(Store::create(folder / "s.db", "mill")); }
    { const Store made = got(Store::create(place, "mill")); }
    const auto file = got(sql::Connection::open(folder / "s.db", sql::Access::read));
    const auto server = got(sql::Connection::open(place, sql::Access::read));
    CHECK(columns_of(*file).size() > 150);
    CHECK(columns_of(*file) == columns_of(*server));
    CHECK(rules_of(*file).size() > 40);
    CHECK(rules_of(*file) == rules_of(*server));
}

TEST_CASE("a role with the rights of roles.sql serves a store, and can neither change what is kept nor the rules", "[server]") {
    if (there_is_no_server()) return;
    PostgresServer& server = PostgresServer::shared();
    const std::string database = server.make_database(), owner = server.place(database, "mill_owner");
    server.run("CREATE ROLE mill_owner LOGIN");
    server.run("CREATE ROLE loomlink LOGIN");
    server.run("ALTER DATABASE " + database + " OWNER TO mill_owner");
    { const Store made = got(Store::create(owner, "mill")); }
    const std::string rights = read_file(std::string(WEAVE_SOURCE_DIR) + "/db/roles.sql").value();
    REQUIRE(text_of(got(sql::Connection::open(owner, sql::Access::write))->script(rights)) == "");
    const std::string place = server.place(database, "loomlink");
    {
        Store store = got(Store::open(place));
        got(store.write([](Writer& writer) -> Result<Seq> {
            WEAVE_TRY(const Seq event, note(writer));
            WEAVE_CHECK_OK(writer.add_person({0, "anna", "Anna", true, "hash", {PersonRole::designer}, event}));
            WEAVE_TRY(auto anna, writer.person("anna"));
            anna->active = false;
            WEAVE_CHECK_OK(writer.update_person(*anna));
            WEAVE_CHECK_OK(writer.put_object("card"));
            return event;
        }));
    }
    CHECK(all_text(got(verify_store(place))) == "");
    const auto connection = got(sql::Connection::open(place, sql::Access::write));
    for (const char* script :
         {"UPDATE event SET actor = 'mallory'", "DELETE FROM event", "TRUNCATE event", "DROP TABLE event CASCADE",
          "ALTER TABLE event DISABLE TRIGGER USER", "DROP TRIGGER is_kept ON event", "DROP FUNCTION keep() CASCADE",
          "SET session_replication_role = replica", "UPDATE person SET login = 'mallory'", "DELETE FROM person",
          "UPDATE person_key SET public_key = ''", "UPDATE store_version SET version = 1", "CREATE TABLE mine (x bigint)",
          "CREATE OR REPLACE FUNCTION keep() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RETURN NEW; END $$"}) {
        const Status refused = connection->script(script);
        INFO(script);
        REQUIRE_FALSE(refused);
        CHECK_THAT(refused.error().message, Catch::Contains("may not do that"));
    }
}

TEST_CASE("a clock that is off by an hour serves no store on a server, and is told", "[server]") {
    if (there_is_no_server()) return;
    using namespace std::chrono;
    const auto connection = got(sql::Connection::open(PostgresServer::shared().place(), sql::Access::write));
    const auto now = duration_cast<milliseconds>(system_clock::now().time_since_epoch());
    CHECK(check_clock(*connection, now));
    CHECK(check_clock(*connection, now + minutes(4)));
    CHECK_THAT(text_of(check_clock(*connection, now + hours(1))), Catch::Contains("clock of this machine is 3") && Catch::Contains("ahead of"));
    CHECK_THAT(text_of(check_clock(*connection, now - hours(1))), Catch::Contains("behind") && Catch::Contains("NTP"));
}

TEST_CASE("a full disk of the server is told, costs nothing that was kept, and once there is room the store goes on", "[server]") {
    if (there_is_no_server()) return;
    PostgresServer server;
    const std::string database = server.make_database();
    Store store = got(Store::create(server.place(database), "mill"));
    got(store.write([](Writer& writer) { return note(writer); }));
    std::ofstream(server.full_disk()) << "full";
    std::string bytes(1'000'000, ' ');
    weave::testing::Random random(1);
    for (char& byte : bytes) byte = static_cast<char>(random.between(0, 255));  // too much for the pages that are there
    const auto put = [&] { return store.write([&](Writer& writer) { return writer.put_object(bytes); }); };
    CHECK_THAT(text_of(put()), Catch::Contains("the disk of the server is full; nothing was stored"));
    CHECK_FALSE(store.last_write());
    CHECK(log_size_of(store) == 1);
    std::filesystem::remove(server.full_disk());
    CHECK(text_of(put()) == "");
    CHECK(store.last_write());
    CHECK(all_text(got(verify_store(server.place(database)))) == "");
}

TEST_CASE("a standby serves reading, shows at once what was acknowledged, and is left out while it lags", "[server]") {
    if (there_is_no_server()) return;
    PostgresServer primary;
    const std::string database = primary.make_database();
    { const Store made = got(Store::create(primary.place(database), "mill")); }
    PostgresServer standby(primary, "first");
    std::string told;
    set_log_sink([&](LogLevel, std::string_view line) { (told += line) += "\n"; });
    Store store = got(Store::open(primary.place(database), standby.place(database)));
    const auto note_and_look = [&] {
        const Seq seq = got(store.write([](Writer& writer) { return note(writer); }));
        REQUIRE(log_size_of(store) == seq + 1);
    };
    for (int k = 0; k < 20; ++k) note_and_look();
    INFO(told);
    CHECK(told.find("lags") == std::string::npos);
    const auto connection = got(sql::Connection::open(standby.place(database), sql::Access::standby));
    CHECK(got(connection->number("SELECT count(*) FROM pg_stat_activity WHERE application_name = 'weave' AND pid <> pg_backend_pid()")) > 0);
    CHECK_THAT(text_of(connection->run("INSERT INTO site (one, name) VALUES (1, 'x')")), Catch::Contains("standby"));

    standby.run("SELECT pg_wal_replay_pause()");
    for (int k = 0; k < 5; ++k) note_and_look();
    CHECK(told.find("the standby lags behind the primary") != std::string::npos);
    standby.run("SELECT pg_wal_replay_resume()");
    for (int k = 0; k < 500 && told.find("from the standby again") == std::string::npos; ++k) note_and_look();
    CHECK(told.find("from the standby again") != std::string::npos);
    standby.kill();
    note_and_look();
    set_log_sink({});
}

TEST_CASE("two primaries are refused, and a server that lost what was acknowledged", "[server]") {
    if (there_is_no_server()) return;
    PostgresServer old;
    const std::string database = old.make_database();
    { const Store made = got(Store::create(old.place(database), "mill")); }
    PostgresServer young(old, "first");
    Store store = got(Store::open(old.place_with(young, database)));
    got(store.write([](Writer& writer) { return note(writer); }));
    young.promote();  // while the old one lives
    const auto refused = Store::open(old.place_with(young, database));
    CHECK_THAT(text_of(refused), Catch::Contains("two of the servers take writes") && Catch::Contains("RUNBOOK"));

    got(store.write([](Writer& writer) { return note(writer); }));  // on the old one, which the young one never gets
    old.kill();
    const auto lost = store.write([](Writer& writer) { return note(writer); });
    CHECK_THAT(text_of(lost), Catch::Contains("another log than before") && Catch::Contains("old primary, or a standby that lagged"));
    CHECK_FALSE(store.last_write());
    CHECK_THAT(text_of(store.read([](const Reader& reader) { return reader.log_size(); })), Catch::Contains("another log"));
}

TEST_CASE("a loom that has heard of one of two primaries refuses the other", "[server]") {
    if (there_is_no_server()) return;
    PostgresServer old;
    FlowSite site;
    const std::string database = old.make_database();
    site.set_policy();
    site.set_up_loom();
    site.flow.reset();
    REQUIRE(copy_store(site.path, old.place(database)));
    PostgresServer young(old, "first");
    young.promote();
    const auto one = site.another(old.place(database)), other = site.another(young.place(database));
    const auto trust = got(one->trust().documents(1)).at("documents")[0].get<std::string>();
    TerminalState loom = got(first_state("EP 1", trust, got(read_trust(trust)).fingerprint()));
    const auto ask = [&](Workflow& flow) {
        const std::uint64_t seen = loom.tree_head ? loom.tree_head->head.size : 0;
        return flow.releases().index(site.people.at("otto"), "EP 1", 1, seen);
    };
    const auto take = [&](const Json& answer) {
        const auto consistent = [&](const LogHead& older, const LogHead& newer) -> Status {
            std::vector<Hash> proof;
            for (const Json& hash : answer.at("consistency")) proof.push_back(*parse_hash(hash.get<std::string>()));
            return verify_consistency(older.size, *parse_hash(older.root), newer.size, *parse_hash(newer.root), proof)
                       ? Status()
                       : bad_input("the proof does not fit");
        };
        return check_index(loom, answer.at("index").get<std::string>(), site.time, consistent);
    };
    loom = got(take(got(ask(*one)))).state;
    loom = got(take(got(ask(*other)))).state;  // nothing has parted them yet
    const auto design = [&](Workflow& flow, const std::string& name) {
        got(flow.designs().add(site.people.at("dora"), site.ask(), name));
    };
    design(*other, "shoe");
    site.time += std::chrono::minutes(1);
    loom = got(take(got(ask(*other)))).state;
    const auto shorter = ask(*one);  // it cannot even prove how its log came to be longer
    if (shorter) CHECK_THAT(text_of(take(*shorter)), Catch::Contains("an old log is shown"));
    for (const char* name : {"boot", "sock", "hat", "glove"}) design(*one, name);
    const auto longer = take(got(ask(*one)));
    REQUIRE_FALSE(longer);
    CHECK_THAT(longer.error().text(), Catch::Contains("does not go on from the one seen before") || Catch::Contains("history was rewritten"));
    got(take(got(ask(*other))));
}

TEST_CASE("a store goes to a server and back with every row as it was", "[server]") {
    if (there_is_no_server()) return;
    FlowSite site;
    site.set_policy();
    site.set_up_loom();
    got(site.flow->designs().add(site.people.at("dora"), site.ask(), "shoe"));
    site.save("dora", {});
    site.approve(1);
    got(site.flow->releases().release(site.people.at("abe"), site.ask("abe"), {"shoe", 1, "EP 1", {1}, {}, "go"}));
    got(site.flow->log_head());
    site.flow.reset();
    const std::string database = place_of_new(PostgresServer::shared()), back = site.folder / "back.db";
    const auto tells = [](const std::string& place) {
        std::pair<std::string, std::vector<KeptThing>> told;
        REQUIRE(look_into(place, [&](const Reader& reader) -> Status {
            WEAVE_TRY(const std::uint64_t size, reader.log_size());
            WEAVE_TRY(const Hash root, reader.root(size));
            told.first = std::to_string(size) + " " + hash_hex(root);
            WEAVE_TRY(told.second, reader.kept());
            return {};
        }));
        return told;
    };
    REQUIRE(text_of(copy_store(site.path, database)) == "");
    CHECK(tells(database) == tells(site.path));
    check_same_counts(site.path, database);
    CHECK(all_text(got(verify_store(database))) == "");
    CHECK(all_text(got(verify_tables(database))) == "");
    CHECK_THAT(text_of(copy_store(site.path, database)), Catch::Contains("not empty"));
    REQUIRE(text_of(copy_store(database, back)) == "");
    CHECK(tells(back) == tells(site.path));
    CHECK(all_text(got(verify_store(back))) == "");
    CHECK_THAT(text_of(copy_store(database, back)), Catch::Contains("exists already"));
    // It goes on from there.
    const std::string moved = std::exchange(site.path, database);
    site.open();
    CHECK(site.save("dora", 1, "twill two") == 2);
    site.flow.reset();
    site.path = moved;
}

TEST_CASE("what a server cannot keep stops a move, which leaves nothing behind", "[server]") {
    if (there_is_no_server()) return;
    const Folder folder;
    {
        Store store = got(Store::create(folder / "s.db", "mill"));
        got(store.write([](Writer& writer) -> Result<Id> {
            WEAVE_TRY(const Seq event, note(writer));
            return writer.add_person({0, std::string("an\0na", 5), "Anna", true, "hash", {}, event});
        }));
    }
    const std::string database = place_of_new(PostgresServer::shared());
    CHECK_THAT(text_of(copy_store(folder / "s.db", database)), Catch::Contains("person") && Catch::Contains("NUL"));
    CHECK(got(got(sql::Connection::open(database, sql::Access::read))->is_empty()));
}

}  // namespace weave::loomlink::testing
