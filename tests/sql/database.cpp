#include <weave/sql/database.hpp>

#include <catch2/catch.hpp>

#include <array>

using namespace weave;

namespace {

using Four = std::array<unsigned char, 4>;

std::unique_ptr<sql::Connection> with_table() {
    auto connection = sql::Connection::open(":memory:", sql::Access::create).value();
    REQUIRE(connection->script("CREATE TABLE kept (number INTEGER PRIMARY KEY, value ANY) STRICT"));
    return connection;
}

}  // namespace

TEST_CASE("what is bound comes back as it was, whatever is in it") {
    const auto connection = with_table();
    const std::string odd = std::string("'; DROP TABLE kept; --\0\xff", 25);
    const auto kept = [&](const auto& value) {
        const auto number = connection->insert("INSERT INTO kept (value) VALUES (?)", value).value();
        return connection
            ->one(
                "SELECT value FROM kept WHERE number = ?", [](const sql::Row& row) { return row.json(0); },
                number)
            .value()
            .value();
    };
    REQUIRE(kept(std::int64_t{-5}) == -5);
    REQUIRE(kept(0.25) == 0.25);
    REQUIRE(kept(std::string("fünf")) == "fünf");
    REQUIRE(kept(sql::Blob{std::string_view("\x00\xfe", 2)}) == "00fe");
    REQUIRE(kept(Four{1, 2, 3, 255}) == "010203ff");
    REQUIRE(kept(std::optional<std::int64_t>()).is_null());
    REQUIRE(kept(sql::Blob{odd}).get<std::string>().size() == 50);
    REQUIRE(connection->number("SELECT count(*) FROM kept").value() == 7);
}

TEST_CASE("a BLOB of a fixed size is that size or zeros") {
    const auto connection = with_table();
    const auto read = [&](const char* text) {
        return connection->one(text, [](const sql::Row& row) { return row.fixed<Four>(0); }).value().value();
    };
    REQUIRE(read("SELECT x'01020304'") == Four{1, 2, 3, 4});
    REQUIRE(read("SELECT x'010203'") == Four{});
    REQUIRE(read("SELECT x'0102030405'") == Four{});
    REQUIRE(read("SELECT NULL") == Four{});
}

TEST_CASE("an error says of what kind it is, and leaves the connection fit for more") {
    const auto connection = with_table();
    REQUIRE(connection->run("INSERT INTO kept VALUES (1, 2)"));
    REQUIRE(connection->run("INSERT INTO kept VALUES (1, 3)").error().code == ErrorCode::refused);
    REQUIRE(connection->run("INSERT INTO nothing VALUES (1)").error().code == ErrorCode::system);
    REQUIRE(connection->run("SELECT \"no column\"").error().code == ErrorCode::system);
    REQUIRE(connection->number("SELECT value FROM kept").value() == 2);
    REQUIRE_FALSE(connection->in_transaction());
    REQUIRE(sql::Connection::open("/nowhere/at/all", sql::Access::create).error().code == ErrorCode::system);
}
