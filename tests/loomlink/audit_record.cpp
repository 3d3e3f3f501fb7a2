#include "audit_case.hpp"

#include <limits>
#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using weave::loomlink::testing::statement_of;
using weave::loomlink::testing::TestKey;

namespace {

EventRecord example() {
    EventRecord record{7, leaf_hash("before"), statement_of(6), {}};
    record.signature = TestKey(1).sign(statement_bytes(record.statement));
    return record;
}

/// The example's bytes with its first `from` replaced.
std::string with(const std::string& from, const std::string& to) {
    std::string bytes = record_bytes(example()).value();
    const auto at = bytes.find(from);
    REQUIRE(at != std::string::npos);
    return bytes.replace(at, from.size(), to);
}

std::string refusal(const std::string& bytes) {
    INFO(bytes);
    const auto record = parse_record(bytes);
    REQUIRE_FALSE(record);
    return record.error().text();
}

}  // namespace

TEST_CASE("a record comes back as it was written, in canonical bytes") {
    for (std::uint64_t k = 0; k < 4; ++k) {
        EventRecord record = example();
        record.statement = statement_of(k);
        if (k == 1) record.signature.reset();
        if (k == 2) record.statement.subject.reset();
        const std::string bytes = record_bytes(record).value();
        const EventRecord back = parse_record(bytes).value();
        REQUIRE(back.seq == record.seq);
        REQUIRE(back.prev == record.prev);
        REQUIRE(statement_bytes(back.statement) == statement_bytes(record.statement));
        REQUIRE(back.signature == record.signature);
        REQUIRE(record_bytes(back).value() == bytes);
    }
    REQUIRE_THAT(record_bytes(example()).value(),
                 Catch::StartsWith("{\"prev\":\"") && Catch::Contains("\"seq\":7,\"signature\":{\"key\":"));
}

TEST_CASE("what is signed is the statement, its site and request with it") {
    const std::string bytes = statement_bytes(statement_of(6));
    REQUIRE_THAT(bytes, Catch::StartsWith("{\"actor\":\"anna\",\"at\":") &&
                            Catch::Contains("\"site\":\"mill\"") && Catch::Contains("\"request\":\"r6\""));
    REQUIRE(record_bytes(example()).value().find("\"statement\":" + bytes) != std::string::npos);
}

TEST_CASE("what is no record in its one form is refused, with the place") {
    REQUIRE_THAT(refusal(with("\"seq\":7", "\"seq\":7.0")), Catch::Contains("seq"));
    REQUIRE_THAT(refusal(with("\"seq\":7", "\"seq\": 7")), Catch::Contains("canonical"));
    REQUIRE_THAT(refusal(with("\"seq\":7", "\"seq\":-7")), Catch::Contains("seq"));
    REQUIRE_THAT(refusal(with("\"seq\":7", "\"seq\":9007199254740993")), Catch::Contains("seq"));
    REQUIRE_THAT(refusal(with("\"seq\":7", "\"sea\":1,\"seq\":7")), Catch::Contains("sea"));
    REQUIRE_THAT(refusal(with("\"pick\":1234.5", "\"pick\":1.2345e3")), Catch::Contains("canonical"));
    REQUIRE_THAT(refusal(with("\"prev\":\"", "\"prev\":\"0")), Catch::Contains("prev"));
    REQUIRE_THAT(refusal(with("\"actor\":\"anna\"", "\"actor\":\"\"")), Catch::Contains("statement.actor"));
    REQUIRE_THAT(refusal(with("\"actor\":\"anna\",", "")), Catch::Contains("statement.actor"));
    REQUIRE_THAT(refusal(with("revision.submitted", "Revision")), Catch::Contains("statement.kind"));
    REQUIRE_THAT(refusal(with("2026-11-26T", "2026-11-31T")), Catch::Contains("statement.at"));
    REQUIRE_THAT(refusal(with("\"value\":\"", "\"value\":\"0")), Catch::Contains("signature.value"));
    REQUIRE_THAT(refusal(with("\"data\":{", "\"data\":[{")), Catch::Contains("JSON"));
    REQUIRE_THAT(refusal(record_bytes(example()).value() + "\n"), Catch::Contains("canonical"));
    REQUIRE_THAT(refusal("[]"), Catch::Contains("object"));
    refusal("");
}

TEST_CASE("nothing is written that cannot be read") {
    EventRecord record = example();
    record.statement.data["residual"] = std::numeric_limits<double>::quiet_NaN();
    REQUIRE_FALSE(record_bytes(record));
    record = example();
    record.statement.actor = "\xff";
    REQUIRE_FALSE(record_bytes(record));
    record = example();
    record.statement.data["long"] = std::string(longest_record, 'x');
    REQUIRE_FALSE(record_bytes(record));
    record = example();
    record.statement.at = "2026-11-26";
    REQUIRE_FALSE(record_bytes(record));
}

TEST_CASE("a moment has one text, and exists") {
    REQUIRE(is_utc_moment("2028-02-29T23:59:59.999Z"));
    for (const char* text :
         {"2026-02-29T00:00:00.000Z", "2026-13-01T00:00:00.000Z", "2026-01-01T24:00:00.000Z",
          "2026-01-01T00:60:00.000Z", "2026-01-01T00:00:60.000Z", "2026-01-01T00:00:00Z",
          "2026-01-01 00:00:00.000Z", "2026-01-01T00:00:00.000+", "1969-01-01T00:00:00.000Z",
          "2026-0x-01T00:00:00.000Z", ""}) {
        INFO(text);
        REQUIRE_FALSE(is_utc_moment(text));
    }
}

TEST_CASE("a signed head has one form") {
    const TestKey log(3);
    const SignedTreeHead head = weave::loomlink::testing::sign_head(log, {leaf_hash("a"), leaf_hash("b")});
    const std::string bytes = signed_head_bytes(head);
    REQUIRE(parse_signed_head(bytes).value() == head);
    REQUIRE(log.check()(head_bytes(head.head), head.signature));
    REQUIRE_FALSE(parse_signed_head(bytes + " "));
    REQUIRE_FALSE(parse_signed_head("{}"));
    std::string none = bytes;
    none.replace(none.find("\"size\":2"), 8, "\"size\":0");
    REQUIRE_FALSE(parse_signed_head(none));
}
