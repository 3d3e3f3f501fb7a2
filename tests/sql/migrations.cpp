#include <weave/sql/migrations.hpp>

#include <catch2/catch.hpp>

#include <array>

using namespace weave;

namespace {

constexpr sql::Owner owner{0x57765454, "tests"};

std::unique_ptr<sql::Connection> fresh() {
    return sql::Connection::open(":memory:", sql::Access::create).value();
}

std::int64_t version_of(sql::Connection& connection) {
    return connection.number("PRAGMA user_version").value();
}

/// Steps to tell migrations by; they stand for those to come.
constexpr std::array<sql::Migration, 3> steps{
    {{1, "CREATE TABLE thread (id INTEGER PRIMARY KEY) STRICT; INSERT INTO thread VALUES (7)"},
     {2, "ALTER TABLE thread ADD COLUMN colour TEXT NOT NULL DEFAULT 'red'"},
     {3,
      "CREATE TABLE cone (thread INTEGER NOT NULL REFERENCES thread (id)) STRICT;"
      "INSERT INTO cone VALUES (7)"}}};

}  // namespace

TEST_CASE("a database of every older version is brought up to date with what it holds") {
    for (std::size_t from = 0; from <= steps.size(); ++from) {
        const auto connection = fresh();
        if (from > 0) REQUIRE(sql::migrate(*connection, std::span(steps).first(from), owner));
        REQUIRE(sql::migrate(*connection, steps, owner));
        REQUIRE(version_of(*connection) == 3);
        REQUIRE(
            connection
                ->number(
                    "SELECT count(*) FROM thread JOIN cone ON cone.thread = thread.id WHERE colour = 'red'")
                .value() == 1);
    }
}

TEST_CASE("a migration is done whole or not at all, and never backwards") {
    const auto connection = fresh();
    auto broken = steps;
    broken[1].script = "ALTER TABLE thread ADD COLUMN colour TEXT; SELECT nonsense";
    REQUIRE_FALSE(sql::migrate(*connection, broken, owner));
    REQUIRE(version_of(*connection) == 1);
    REQUIRE(connection->number("SELECT count(*) FROM pragma_table_info('thread')").value() == 1);
    broken = steps;
    broken[2].script =
        "PRAGMA defer_foreign_keys = ON; CREATE TABLE cone (thread INTEGER REFERENCES thread (id)) STRICT; "
        "INSERT INTO cone VALUES (8)";
    REQUIRE_THAT(sql::migrate(*connection, broken, owner).error().message, Catch::Contains("dangling"));
    REQUIRE(version_of(*connection) == 2);
    REQUIRE(sql::migrate(*connection, steps, owner));
    REQUIRE_THAT(sql::migrate(*connection, std::span(steps).first(2), owner).error().message,
                 Catch::Contains("version 3"));
}

TEST_CASE("another program's database is left alone") {
    const auto theirs = fresh();
    REQUIRE(theirs->script("CREATE TABLE thread (id INTEGER)"));
    REQUIRE(sql::migrate(*theirs, steps, owner).error().code == ErrorCode::refused);
    const auto others = fresh();
    REQUIRE(sql::migrate(*others, steps, {7, "the others"}));
    const Status refused = sql::migrate(*others, steps, owner);
    REQUIRE(refused.error().message == "is another program's database, not a store of tests");
    REQUIRE(others->number("PRAGMA application_id").value() == 7);
}
