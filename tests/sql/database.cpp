#include <weave/sql/database.hpp>

#include <catch2/catch.hpp>

#include <array>
#include <support/postgres_server.hpp>

using namespace weave;
using weave::testing::PostgresServer;

namespace {

using Four = std::array<unsigned char, 4>;

/// An empty database of each engine that is here.
std::vector<std::string> places() {
    std::vector<std::string> places{":memory:"};
    if (PostgresServer::is_installed())
        places.push_back(PostgresServer::shared().place(PostgresServer::shared().make_database()));
    else
        WARN("skipped on PostgreSQL: no server, or built without libpq");
    return places;
}

std::unique_ptr<sql::Connection> with_table(const std::string& place) {
    auto connection = sql::Connection::open(place, sql::Access::create).value();
    const std::string strict = connection->engine() == sql::Engine::sqlite ? " STRICT" : "";
    const std::string blob = connection->engine() == sql::Engine::sqlite ? "BLOB" : "bytea";
    const std::string real = connection->engine() == sql::Engine::sqlite ? "REAL" : "double precision";
    REQUIRE(connection->script("CREATE TABLE kept (number INTEGER PRIMARY KEY, whole INTEGER, broken " + real + ", words TEXT, bytes " + blob +
                               ")" + strict));
    return connection;
}

}  // namespace

TEST_CASE("what is bound comes back as it was, whatever is in it") {
    for (const std::string& place : places()) {
        const auto connection = with_table(place);
        const std::string odd = std::string("'; DROP TABLE kept; --?\xff\0", 25), text = "fünf '; DROP TABLE kept; -- $1 ?";
        std::int64_t number = 0;
        const auto kept = [&](const char* column, const auto& value) {
            ++number;
            const std::string insert = std::string("INSERT INTO kept (number, ") + column + ") VALUES (?, ?) RETURNING number";
            REQUIRE(connection->number(insert, number, value).value() == number);
            return connection
                ->one(
                    std::string("SELECT ") + column + " FROM kept WHERE number = ?1 AND ?1 = number",
                    [](const sql::Row& row) { return row.json(0); }, number)
                .value()
                .value();
        };
        INFO(place);
        CHECK(kept("whole", std::int64_t{-5}) == -5);
        CHECK(kept("broken", 0.1) == 0.1);
        CHECK(kept("broken", -1e300) == -1e300);
        CHECK(kept("words", text) == text);
        CHECK(kept("words", std::string()) == "");
        CHECK(kept("bytes", sql::Blob{std::string_view("\x00\xfe", 2)}) == "00fe");
        CHECK(kept("bytes", sql::Blob{}) == "");
        CHECK(kept("bytes", Four{1, 2, 3, 255}) == "010203ff");
        CHECK(kept("whole", std::optional<std::int64_t>()).is_null());
        CHECK(kept("bytes", sql::Blob{odd}).get<std::string>().size() == 50);
        CHECK(connection->number("SELECT count(*) FROM kept WHERE words <> '?'").value() == 2);
        CHECK(connection->run("UPDATE kept SET words = 'x' WHERE words IS NOT NULL"));
        CHECK(connection->changes() == 2);
    }
}

TEST_CASE("a BLOB of a fixed size is that size or zeros") {
    for (const std::string& place : places()) {
        const auto connection = with_table(place);
        const auto read = [&](const std::string& bytes) {
            return connection->one("SELECT bytes FROM kept WHERE number = ?", [](const sql::Row& row) { return row.fixed<Four>(0); },
                                   connection->number("INSERT INTO kept (number, bytes) VALUES ((SELECT count(*) FROM kept), ?) RETURNING number",
                                                      sql::Blob{bytes})
                                       .value())
                .value()
                .value();
        };
        CHECK(read("\x01\x02\x03\x04") == Four{1, 2, 3, 4});
        CHECK(read("\x01\x02\x03") == Four{});
        CHECK(read("12345") == Four{});
        CHECK(connection->one("SELECT NULL", [](const sql::Row& row) { return row.fixed<Four>(0); }).value().value() == Four{});
    }
}

TEST_CASE("an error says of what kind it is, and leaves the connection fit for more") {
    for (const std::string& place : places()) {
        const auto connection = with_table(place);
        INFO(place);
        CHECK(connection->run("INSERT INTO kept (number, whole) VALUES (1, 2)"));
        CHECK(connection->run("INSERT INTO kept (number, whole) VALUES (1, 3)").error().code == ErrorCode::refused);
        CHECK(connection->run("INSERT INTO nothing VALUES (1)").error().code == ErrorCode::system);
        CHECK(connection->run("SELECT \"no column\"").error().code == ErrorCode::system);
        CHECK(connection->number("SELECT whole FROM kept").value() == 2);
        CHECK_FALSE(connection->in_transaction());
        CHECK(connection->is_usable());
    }
    CHECK(sql::Connection::open("/nowhere/at/all", sql::Access::create).error().code == ErrorCode::system);
}

TEST_CASE("rows come one by one, and what throws at one of them leaves the connection fit for more") {
    for (const std::string& place : places()) {
        const auto connection = with_table(place);
        for (std::int64_t k = 0; k < 100; ++k) REQUIRE(connection->run("INSERT INTO kept (number) VALUES (?)", k));
        std::int64_t sum = 0;
        REQUIRE(connection->each("SELECT number FROM kept ORDER BY number", [&](const sql::Row& row) { sum += row.integer(0); }));
        CHECK(sum == 4950);
        const auto throwing = [&] {
            return connection->each("SELECT number FROM kept", [](const sql::Row&) { throw std::runtime_error("slip"); });
        };
        CHECK_THROWS_WITH(throwing(), "slip");
        CHECK(connection->number("SELECT count(*) FROM kept").value() == 100);
    }
}

TEST_CASE("one writes at a time, and who waits too long is told so") {
    for (const std::string& kind : places()) {
        const auto file = std::filesystem::temp_directory_path() / ("weave-sql-" + std::to_string(::getpid()) + ".db");
        const std::string place = kind == ":memory:" ? file.string() : kind;
        const auto first = sql::Connection::open(place, sql::Access::create).value();
        const auto second = sql::Connection::open(place, sql::Access::write, std::chrono::milliseconds(50)).value();
        REQUIRE(first->begin_write());
        CHECK_THAT(second->begin_write().error().message, Catch::Contains("in use by another program"));
        CHECK_FALSE(second->in_transaction());
        CHECK(second->begin_read());
        second->rollback();
        REQUIRE(first->commit());
        CHECK(second->begin_write());
        CHECK(second->commit());
        for (const char* more : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + more);
    }
}

TEST_CASE("a database is cleared whole, and tells its schema") {
    for (const std::string& place : places()) {
        const auto connection = with_table(place);
        const auto rules = connection->rules().value();
        CHECK_FALSE(rules.empty());
        CHECK_FALSE(connection->is_empty().value());
        REQUIRE(connection->begin_write());
        CHECK(connection->clear());
        CHECK(connection->is_empty().value());
        connection->rollback();
        CHECK(connection->rules().value() == rules);
        REQUIRE(connection->script("CREATE INDEX by_words ON kept (words)"));
        CHECK(connection->rules().value() != rules);
    }
}
