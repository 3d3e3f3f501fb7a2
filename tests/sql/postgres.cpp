#include <weave/sql/postgres.hpp>

#include <catch2/catch.hpp>

#include <support/postgres_server.hpp>
#include <thread>
#include <unistd.h>

using namespace weave;
using weave::testing::PostgresServer;

namespace {

bool there_is_no_server() {
    if (!PostgresServer::is_installed()) WARN("skipped: no PostgreSQL server, or built without libpq");
    return !PostgresServer::is_installed();
}

std::string why_not(const std::string& place, sql::Access access = sql::Access::write) {
    const auto opened = sql::Connection::open(place, access);
    return opened ? "" : opened.error().text();
}

}  // namespace

TEST_CASE("a place is a file, or a database by its connection string") {
    CHECK(sql::engine_of("/srv/mill/loomlink.db") == sql::Engine::sqlite);
    CHECK(sql::engine_of("postgresql.db") == sql::Engine::sqlite);
    CHECK(sql::engine_of("postgresql://db.mill.example/mill") == sql::Engine::postgres);
    CHECK(sql::engine_of("postgres:///mill") == sql::Engine::postgres);
}

TEST_CASE("a connection string holds no password, and no error repeats one") {
    if (there_is_no_server()) return;
    for (const std::string place : {"postgresql://anna:secret@localhost/mill", "postgresql:///mill?password=secret",
                                    "postgresql:///mill?sslpassword=secret"}) {
        CHECK_THAT(why_not(place), Catch::Contains("must hold no password"));
        CHECK_THAT(why_not(place), !Catch::Contains("secret"));
    }
    for (const std::string place : {"postgresql://[secret", "postgresql:///mill?secret=secret"}) {
        CHECK_THAT(why_not(place), Catch::Contains("no connection string"));
        CHECK_THAT(why_not(place), !Catch::Contains("secret"));
    }
    CHECK_THAT(why_not("postgresql:///mill?host=/nowhere"), Catch::Contains("no connection to the server"));
}

TEST_CASE("the servers that a place names are told apart") {
    if (there_is_no_server()) return;
    const auto two = sql::servers_of("postgresql://anna@a.example:5433,b.example:5434/mill?sslmode=require").value();
    REQUIRE(two.size() == 2);
    CHECK_THAT(two[0], Catch::Contains("host=a%2Eexample&port=5433") && Catch::Contains("dbname=mill") && Catch::Contains("user=anna"));
    CHECK_THAT(two[1], Catch::Contains("host=b%2Eexample&port=5434") && Catch::Contains("sslmode=require"));
    CHECK(sql::servers_of("postgresql:///mill").value().size() == 1);
}

TEST_CASE("a text with a NUL character is refused whole, not cut") {
    if (there_is_no_server()) return;
    PostgresServer& server = PostgresServer::shared();
    const auto connection = sql::Connection::open(server.place(server.make_database()), sql::Access::write).value();
    const Status refused = connection->run("SELECT ?", std::string("a\0b", 3));
    REQUIRE_FALSE(refused);
    CHECK_THAT(refused.error().message, Catch::Contains("NUL"));
    CHECK(connection->run("SELECT ?", std::string("\xff")).error().code == ErrorCode::bad_input);
    CHECK(connection->number("SELECT 7").value() == 7);
}

TEST_CASE("a connection whose server went is good for nothing more, and says so") {
    if (there_is_no_server()) return;
    PostgresServer server;
    const auto connection = sql::Connection::open(server.place(), sql::Access::write).value();
    REQUIRE(connection->begin_write());
    REQUIRE(connection->script("CREATE TABLE t (x integer)"));
    server.kill();
    const Status lost = connection->commit();
    REQUIRE_FALSE(lost);
    CHECK(lost.error().code == ErrorCode::system);
    CHECK_THAT(lost.error().message, Catch::Contains("may have been stored"));
    CHECK_FALSE(connection->is_usable());
    CHECK_FALSE(connection->run("SELECT 1"));
    server.start();
    CHECK(sql::Connection::open(server.place(), sql::Access::write));
}

TEST_CASE("a commit that no standby confirms is an error, be it by silence or by a warning") {
    if (there_is_no_server()) return;
    PostgresServer server;
    server.run("CREATE TABLE t (x integer)");
    server.configure("synchronous_standby_names = 'gone'");
    server.reload();
    const auto open = [&](int patience) {
        return sql::Connection::open(server.place(), sql::Access::write, std::chrono::milliseconds(patience)).value();
    };
    const auto commit_on = [](sql::Connection& connection) {
        REQUIRE(connection.begin_write());
        REQUIRE(connection.run("INSERT INTO t VALUES (1)"));
        return connection.commit();
    };
    const auto ignored = open(200);
    for (int waits = 0; waits < 500 && server.number("SELECT count(*) FROM pg_settings WHERE name = 'synchronous_standby_names' AND setting = 'gone'") == 0; ++waits)
        ::usleep(10'000);
    const Status silent = commit_on(*ignored);
    REQUIRE_FALSE(silent);
    CHECK_THAT(silent.error().message, Catch::Contains("did not confirm") && Catch::Contains("synchronous_standby_names"));
    CHECK_FALSE(ignored->is_usable());
    // It waits on, and with it whoever wants to write.
    const Status locked = open(200)->begin_write();
    REQUIRE_FALSE(locked);
    CHECK_THAT(locked.error().message, Catch::Contains("waits for a synchronous standby"));

    const std::string end_waiting = "SELECT count(pg_cancel_backend(pid)) FROM pg_stat_activity WHERE wait_event = 'SyncRep'";
    CHECK(server.number(end_waiting) == 1);
    const auto warned = open(60'000);
    std::thread administrator([&] {
        while (server.number(end_waiting) == 0) ::usleep(10'000);
    });
    const Status warning = commit_on(*warned);
    administrator.join();
    REQUIRE_FALSE(warning);
    CHECK_THAT(warning.error().message, Catch::Contains("no standby has confirmed it"));
    CHECK(server.number("SELECT count(*) FROM t") == 2);  // both stand on the primary alone
}
