// migrate-store: a site's store goes into a database and back, and the same people go on with it.

#include "commands_case.hpp"
#include "server_case.hpp"

#include <atomic>
#include <thread>

namespace weave::loomlink::testing {

namespace fs = std::filesystem;

namespace {

std::string place_of_new(PostgresServer& server) {
    return server.place(server.make_database());
}

}  // namespace

TEST_CASE("a site goes from its file into a database and back, and people and looms go on", "[commands][server]") {
    if (there_is_no_server()) return;
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.approve("1");
    mill.release("1");
    mill.done("emil", {"audit", "head", "-o", mill.at("head.json")});
    const std::string database = place_of_new(PostgresServer::shared());
    const auto migrate = [&](const std::string& to) { return mill.run({"migrate-store", mill.site_folder, to, "--json"}); };
    CHECK(migrate(database).code == 4);  // it is being served
    mill.stop();

    const Ended moved = migrate(database);
    INFO(moved.out << moved.err);
    REQUIRE(moved.code == 0);
    CHECK(moved.json().at("to") == database);
    CHECK(fs::exists(mill.site_folder / "loomlink.db.moved"));
    CHECK_FALSE(fs::exists(mill.site_folder / "loomlink.db"));
    CHECK(mill.run({"verify", mill.site_folder, "--retained", mill.at("head.json")}).code == 0);
    CHECK(migrate(database).code == 4);  // it is there already
    mill.start();
    CHECK(mill.done("emil", {"design", "show", "cloth", "1"}).at("state") == "released");
    mill.save("satin-5");
    CHECK(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    CHECK(mill.run({"verify", mill.at("backup"), "--retained", mill.at("head.json")}).code == 0);
    CHECK(fs::exists(mill.at("backup") / "loomlink.db"));
    mill.stop();

    {
        const Store other = got(Store::open(database + "&application_name=theirs"));  // as a program on another machine does
        CHECK_THAT(migrate("file").err, Catch::Contains("in use"));
    }
    const Ended back = migrate("file");
    INFO(back.out << back.err);
    REQUIRE(back.code == 0);
    CHECK_FALSE(fs::exists(mill.site_folder / "store.url"));
    CHECK(mill.run({"verify", mill.site_folder, "--retained", mill.at("head.json")}).code == 0);
    mill.start();
    CHECK(mill.done("emil", {"design", "show", "cloth", "2"}).at("state") == "draft");
    mill.stop();
}

TEST_CASE("a move that cannot be leaves the site where it is", "[commands][server]") {
    if (there_is_no_server()) return;
    CommandMill mill;
    mill.set_up();
    mill.stop();
    const auto migrate = [&](const std::string& to) { return mill.run({"migrate-store", mill.site_folder, to}); };
    CHECK(migrate("somewhere").code == 3);
    CHECK(migrate("postgresql:///mill?host=/nowhere").code == 5);
    const Ended secret = migrate("postgresql://mill:secret@localhost/mill");
    CHECK(secret.code == 3);
    CHECK(secret.err.find("secret") == std::string::npos);
    CHECK_THAT(secret.err, Catch::Contains("passfile"));
    PostgresServer& server = PostgresServer::shared();
    const std::string full = server.make_database();
    server.run("CREATE TABLE theirs (x bigint)", full);
    CHECK_THAT(migrate(server.place(full)).err, Catch::Contains("not empty"));
    CHECK(mill.run({"migrate-store", mill.at("nothing"), "file"}).code == 3);
    tamper_with(SiteFolder{mill.site_folder}.store().value(),
                "INSERT INTO person_role SELECT id, 'engineer' FROM person WHERE login = 'dora'");
    const Ended forged = migrate(place_of_new(server));
    CHECK(forged.code == 4);
    CHECK_THAT(forged.err, Catch::Contains("person dora"));
    REQUIRE(write_file(mill.site_folder / "loomlink.db.moved", "of an earlier move"));
    const std::string unused = server.make_database();
    const Ended in_the_way = migrate(server.place(unused));
    CHECK(in_the_way.code == 4);
    CHECK_THAT(in_the_way.err, Catch::Contains("loomlink.db.moved: is in the way"));
    CHECK(server.number("SELECT count(*) FROM pg_tables WHERE schemaname = 'public'", unused) == 0);
    CHECK(fs::exists(mill.site_folder / "loomlink.db"));
    CHECK_FALSE(fs::exists(mill.site_folder / "store.url"));
}

TEST_CASE("a store whose last program has just ended is moved, and a move that is refused late leaves nothing behind", "[commands][server]") {
    if (there_is_no_server()) return;
    CommandMill mill;
    mill.set_up();
    mill.stop();
    const auto migrate = [&](const std::string& to) { return mill.run({"migrate-store", mill.site_folder, to}); };
    PostgresServer& server = PostgresServer::shared();
    const std::string name = server.make_database(), database = server.place(name);
    const auto connect = [&] { return sql::Connection::open(database, sql::Access::read).value(); };
    {
        // Somebody writes on past the program's lock, which is seen when all has been copied.
        Store other = got(Store::open(SiteFolder{mill.site_folder}.own_store()));
        std::atomic<bool> is_over = false;
        std::thread writer([&] {
            const Statement viewed{"mill", "log.viewed", "2026-11-26T09:30:00.000Z", "emil", {}, {}, "r1"};
            while (!is_over) static_cast<void>(other.write([&](Writer& store) { return store.append(viewed); }));
        });
        const Ended late = migrate(database);
        is_over = true;
        writer.join();
        CHECK_THAT(late.err, Catch::Contains("was written to meanwhile") || Catch::Contains("has another log than"));
        CHECK(server.number("SELECT count(*) FROM pg_tables WHERE schemaname = 'public'", name) == 0);
    }
    const Ended moved = migrate(database);
    INFO(moved.err);
    REQUIRE(moved.code == 0);

    std::thread late_comer([&] {
        const auto is_copied = [&] {
            for (const auto& entry : fs::directory_iterator(mill.site_folder))
                if (entry.path().filename().string().starts_with("loomlink.db.part-")) return true;
            return false;
        };
        while (!is_copied()) std::this_thread::yield();
        const auto session = connect();
        std::this_thread::sleep_for(std::chrono::seconds(8));
    });
    const Ended refused = migrate("file");
    late_comer.join();
    CHECK_THAT(refused.err, Catch::Contains("is in use"));
    CHECK_FALSE(fs::exists(mill.site_folder / "loomlink.db"));

    std::thread ending([session = connect()]() mutable {
        std::this_thread::sleep_for(std::chrono::seconds(1));
        session.reset();
    });
    const Ended back = migrate("file");
    ending.join();
    INFO(back.err);
    CHECK(back.code == 0);
}

TEST_CASE("a new site is made in a database where the configuration names one", "[commands][server]") {
    if (there_is_no_server()) return;
    CommandMill mill;
    const std::string database = place_of_new(PostgresServer::shared());
    const Ended made = mill.run({"init", mill.at("second"), "--store", database, "--host", "localhost", "--json"});
    INFO(made.err);
    REQUIRE(made.code == 0);
    CHECK_FALSE(fs::exists(mill.at("second") / "loomlink.db"));
    CHECK(read_file(mill.at("second") / "store.url").value() == database + "\n");
    CHECK(mill.run({"verify", mill.at("second")}).code == 0);
    CHECK(mill.run({"serve", mill.at("second"), "--store", place_of_new(PostgresServer::shared()), "--port", "0"}).code == 4);
    CHECK(mill.run({"init", mill.at("third"), "--store", "postgresql:///none?host=/nowhere", "--host", "localhost"}).code == 5);
    CHECK_FALSE(fs::exists(mill.at("third")));  // nothing is left of what could not be made
    fs::create_directory(mill.at("fourth"));
    CHECK(mill.run({"serve", mill.at("fourth"), "--store", "postgresql:///none?host=/nowhere", "--port", "0"}).code == 5);
    CHECK(fs::is_directory(mill.at("fourth")));  // somebody else's folder stays
    CHECK_FALSE(fs::exists(mill.at("fourth") / "log.key"));
    CHECK(mill.run({"init", mill.at("third"), "--store", "/srv/file.db", "--host", "localhost"}).code == 3);
    REQUIRE(write_file(mill.at("second") / "store.url", "no place\n"));
    CHECK_THAT(mill.run({"verify", mill.at("second")}).err, Catch::Contains("store.url"));
}

}  // namespace weave::loomlink::testing
