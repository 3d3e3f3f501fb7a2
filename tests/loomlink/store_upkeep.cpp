#include "store_case.hpp"

#include <catch2/catch.hpp>

#include <fstream>
#include <loomlink/store/migrations.hpp>
#include <thread>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

std::unique_ptr<sql::Connection> connect(const std::string& place) {
    return sql::Connection::open(place, sql::Access::create).value();
}

}  // namespace

TEST_CASE("a store of version 1, filled as that version did, opens and verifies") {
    const Folder folder;
    {
        const auto connection = connect(folder.store("v1.db"));
        REQUIRE(sql::migrate(*connection, migrations(connection->engine()).first(1), store_owner));
        // a site and its first record, as version 1 wrote them
        REQUIRE(connection->script("INSERT INTO site (one, name) VALUES (1, 'mill')"));
        const std::string record = record_bytes({0, {}, statement_of(1), {}}).value();
        REQUIRE(connection->run(
            "INSERT INTO event (seq, record, leaf, kind, actor, subject) VALUES (0, ?, ?, ?, ?, ?)",
            sql::Blob{record}, leaf_hash(record), statement_of(1).kind, statement_of(1).actor,
            statement_of(1).subject));
        REQUIRE(
            connection->script("INSERT INTO person (id, login, full_name, active, password, event) VALUES "
                               "(1, 'anna', 'Anna', 1, 'x', 0);"
                               "INSERT INTO person_role (person, role) VALUES (1, 'designer')"));
    }
    const Store store = Store::open(folder.store("v1.db")).value();
    REQUIRE(store.read([](const Reader& reader) { return reader.person("anna"); }).value()->roles.size() ==
            1);
    REQUIRE(all_text(verify_store(folder.store("v1.db")).value()).empty());
}

TEST_CASE("a backup of a store in use is a store as of one moment") {
    Mill mill;
    std::atomic<bool> stop = false;
    std::thread writer([&] {
        while (!stop) static_cast<void>(mill.store.write([](Writer& w) { return note(w); }));
    });
    for (int k = 0; k < 3; ++k) {
        const auto copy = mill.folder / ("copy" + std::to_string(k) + ".db");
        REQUIRE(text_of(back_up_store(mill.path, copy)).empty());
        REQUIRE(all_text(verify_store(copy).value()).empty());
    }
    stop = true;
    writer.join();
    REQUIRE_THAT(text_of(back_up_store(mill.path, mill.folder / "copy0.db")), Catch::Contains("exists already"));
}

TEST_CASE("a restore is whole or not at all, and never under a running store") {
    const Folder folder;
    const std::string path = folder.store("s.db");
    const auto copy = folder / "copy.db", aside = folder / "aside.db";
    const auto size = [&](const std::string& place) {
        return Store::open(place).value().read([](const Reader& reader) { return reader.log_size(); }).value();
    };
    {
        Store store = Store::create(path, "mill").value();
        REQUIRE(store.write([](Writer& writer) { return note(writer); }));
        REQUIRE(back_up_store(path, copy));
        REQUIRE(store.write([](Writer& writer) { return note(writer); }));
        REQUIRE_THAT(text_of(restore_store(copy, path, aside)), Catch::Contains("in use"));
        REQUIRE(store.write([](Writer& writer) { return note(writer); }));
    }
    REQUIRE(size(path) == 3);
    REQUIRE(text_of(restore_store(copy, path, aside)).empty());
    REQUIRE(size(path) == 1);
    REQUIRE(size(aside) == 3);  // what was there is kept
    REQUIRE(all_text(verify_store(aside).value()).empty());
    REQUIRE(text_of(restore_store(copy, folder / "new.db", folder / "none.db")).empty());

    REQUIRE_FALSE(std::filesystem::exists(folder / "none.db"));

    tamper_with(copy, "DROP TRIGGER event_no_update; UPDATE event SET actor = 'mallory'");
    REQUIRE_THAT(text_of(restore_store(copy, path, aside)), Catch::Contains("is not whole"));
    REQUIRE(size(path) == 1);
    std::ofstream(folder / "text.db")
        << "no database, but long enough to be read as one, a hundred bytes and more: "
        << std::string(200, '.');
    REQUIRE_FALSE(restore_store(folder / "text.db", path, aside));
    REQUIRE_FALSE(restore_store(folder / "missing.db", path, aside));
    REQUIRE(size(path) == 1);
    for (const auto& entry : std::filesystem::directory_iterator(copy.parent_path()))
        REQUIRE(entry.path().string().find(".part-") == std::string::npos);
}
