// Who is given access to simd, for how long, and what the log says of it.

#include "flow_case.hpp"

#include <weave/keys/access_token.hpp>
#include <weave/keys/codes.hpp>

namespace weave::loomlink::testing {

namespace {

/// The newest record of a kind.
Statement newest(FlowSite& site, const std::string& kind) {
    return got(site.flow->store().read([&](const Reader& reader) -> Result<Statement> {
        std::optional<Statement> found;
        WEAVE_TRY(const auto events, reader.events({1, 1000, {}, {}}));
        for (const auto& [seq, bytes] : events)
            if (auto record = parse_record(bytes); record && record->statement.kind == kind) found = record->statement;
        if (!found) return bad_input("there is no record " + kind);
        return *found;
    }));
}

}  // namespace

TEST_CASE("who may simulate gets a token that simd can read, and the log tells of it") {
    FlowSite site;
    Accounts& accounts = site.flow->accounts();
    const std::vector<PublicKey> keys{site.keys.access.public_key()};
    for (const char* name : {"ada", "dora", "eve", "abe", "enno"}) {
        INFO(name);
        const Json given = got(accounts.access_token(site.people.at(name), site.ask(), 8));
        const auto text = given.at("token").get<std::string>();
        const AccessToken token = got(read_access_token(text, keys, site.time));
        CHECK(token == AccessToken{"mill", name, site.time, site.time + std::chrono::hours(8)});
        CHECK(given.at("expires") == utc_text(token.expires));
        const Statement told = newest(site, "access.given");
        CHECK(told.actor == name);
        CHECK(told.subject == name);
        CHECK(told.data.at("token_sha256") == token_hash(text));
        CHECK(told.data.at("expires") == given.at("expires"));
        CHECK(statement_bytes(told).find(text) == std::string::npos);
        CHECK(site.dump().find(text) == std::string::npos);
    }
    CHECK(denied(accounts.access_token(site.people.at("otto"), site.ask(), 8)) == Denial::rights);
    CHECK(newest(site, "refused").data.at("what") == "access.given");
    const Json key = accounts.access_key();
    CHECK(key.at("public") == to_hex(site.keys.access.public_key()));
    CHECK(key.at("key") == site.keys.access.id());
    CHECK(key.at("site") == "mill");
}

TEST_CASE("a token lives for hours, is told once, and nobody gets them by the dozen") {
    FlowSite site;
    Accounts& accounts = site.flow->accounts();
    const Caller& dora = site.people.at("dora");
    for (const std::int64_t hours : {std::int64_t{0}, std::int64_t{-1}, std::int64_t{13}}) {
        INFO(hours);
        const auto refused = accounts.access_token(dora, site.ask(), hours);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().code == ErrorCode::bad_input);
    }
    site.time += std::chrono::minutes(10);
    const Ask once = site.ask();
    const Json day = got(accounts.access_token(dora, once, 12));
    const std::vector<PublicKey> keys{site.keys.access.public_key()};
    CHECK(read_access_token(day.at("token").get<std::string>(), keys, site.time + std::chrono::hours(12) - std::chrono::milliseconds(1)));
    CHECK_FALSE(read_access_token(day.at("token").get<std::string>(), keys, site.time + std::chrono::hours(12)));
    CHECK(denied(accounts.access_token(dora, once, 12)) == Denial::conflict);
    for (int k = 0; k < 4; ++k) got(accounts.access_token(dora, site.ask(), 1));
    CHECK(denied(accounts.access_token(dora, site.ask(), 1)) == Denial::often);
    got(accounts.access_token(site.people.at("abe"), site.ask(), 1));
    site.time += std::chrono::minutes(1);
    got(accounts.access_token(dora, site.ask(), 1));
    CHECK(denied(accounts.access_token(dora, site.ask(), 1)) == Denial::often);
}

TEST_CASE("who was disabled, or lost the role, gets no token more") {
    FlowSite site;
    Accounts& accounts = site.flow->accounts();
    const Caller dora = site.people.at("dora"), enno = site.people.at("enno");
    got(accounts.access_token(dora, site.ask(), 1));
    got(accounts.set_active(site.people.at("ada"), site.ask(), "dora", false));
    CHECK(denied(accounts.access_token(dora, site.ask(), 1)) == Denial::who);
    got(accounts.set_roles(site.people.at("ada"), site.ask(), "enno", {"operator"}));
    CHECK(denied(accounts.access_token(enno, site.ask(), 1)) == Denial::rights);
}

}  // namespace weave::loomlink::testing
