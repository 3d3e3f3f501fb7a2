#include <weave/core/sha256.hpp>
#include <weave/keys/hex.hpp>
#include <weave/keys/signed_document.hpp>
#include <weave/keys/utc.hpp>

#include <catch2/catch.hpp>

#include <support/random.hpp>
#include <support/refusals.hpp>

using namespace weave;
using testing::check_refused;

TEST_CASE("a signed document has one sequence of bytes") {
    const KeyPair one = KeyPair::generate(), other = KeyPair::generate();
    SignedDocument document{{{"b", 1}, {"a", "ä"}}, {}};
    for (const auto* pair : {&one, &other})
        document.signatures.push_back(sign_body(*pair, Purpose::evidence, document.body));
    const std::string bytes = write_signed(document);
    std::swap(document.signatures[0], document.signatures[1]);
    CHECK(write_signed(document) == bytes);
    const SignedDocument read = read_signed(bytes, bytes.size()).value();
    CHECK(read.body == Json({{"a", "ä"}, {"b", 1}}));
    CHECK(body_sha256(read) == sha256_hex("{\"a\":\"ä\",\"b\":1}"));
    for (const Signature& signature : read.signatures)
        CHECK(verify_body(signature.key == one.id() ? one.public_key() : other.public_key(),
                          Purpose::evidence, read.body, signature));
    check_refused(read_signed(bytes, bytes.size() - 1), "is too large");
}

TEST_CASE("bytes that mean the same but are not the same are refused") {
    const KeyPair pair = KeyPair::generate();
    const Json body{{"n", 1}};
    const std::string good = write_signed({body, {sign_body(pair, Purpose::evidence, body)}});
    const auto instead = [&](const std::string& part, const std::string& other) {
        std::string bytes = good;
        REQUIRE(bytes.find(part) != std::string::npos);
        bytes.replace(bytes.find(part), part.size(), other);
        return read_signed(bytes, 10000);
    };
    REQUIRE(read_signed(good, 10000));
    check_refused(instead("\"n\":1", "\"n\": 1"), "canonical form");
    check_refused(instead("\"n\":1", "\"n\":1.0"), "canonical form");
    check_refused(instead("\"n\":1", "\"\\u006e\":1"), "canonical form");
    check_refused(instead("\"n\":1", "\"n\":9007199254740993"), "canonical form");
    check_refused(instead("\"n\":1", "\"n\":1,\"n\":1"), "repeats the member");
    check_refused(instead("\"n\":1", "\"n\":1e999"), "is not JSON");
    check_refused(read_signed(good + "\n", 10000), "canonical form");
    check_refused(read_signed("{\"body\":{},\"more\":1,\"signatures\":[]}", 10000), "1 to 64 signatures");
    check_refused(read_signed("{\"body\":[],\"signatures\":[]}", 10000), "body: must be an object");
    check_refused(read_signed("[]", 10000), "must be an object");
    check_refused(read_signed("", 10000), "is not JSON");
    check_refused(read_signed(std::string(1000, '['), 10000), "nests deeper");
}

TEST_CASE("signatures out of order are refused") {
    const KeyPair one = KeyPair::generate(), other = KeyPair::generate();
    const Json body = Json::object();
    Json json = to_json(SignedDocument{
        body, {sign_body(one, Purpose::evidence, body), sign_body(other, Purpose::evidence, body)}});
    REQUIRE(read_signed(canonical_json(json), 10000));
    std::swap(json["signatures"][0], json["signatures"][1]);
    check_refused(read_signed(canonical_json(json), 10000), "out of order");
}

TEST_CASE("moments have one text") {
    for (const char* text : {"2026-11-26T09:30:00.123Z", "1970-01-01T00:00:00.000Z",
                             "9999-12-31T23:59:59.999Z", "2024-02-29T12:00:00.000Z"})
        CHECK(utc_text(parse_utc(text).value()) == text);
    for (const char* text :
         {"", "2026-11-26T09:30:00Z", "2026-11-26 09:30:00.000Z", "2026-02-29T00:00:00.000Z",
          "2026-13-01T00:00:00.000Z", "2026-01-01T24:00:00.000Z", "2026-01-01T00:60:00.000Z",
          "2026-01-01T00:00:60.000Z", "1969-12-31T23:59:59.999Z", "2026-01-01T00:00:00.000z",
          "+026-01-01T00:00:00.000Z", "2026-01-01T00:00:00.0000Z"}) {
        INFO(text);
        CHECK_FALSE(parse_utc(text));
    }
    testing::for_all([](testing::Random& random) {
        const Instant instant{std::chrono::milliseconds(random.between(0, 253402300799999))};
        REQUIRE(parse_utc(utc_text(instant)).value() == instant);
    });
}

TEST_CASE("hexadecimal has one text") {
    std::array<unsigned char, 2> bytes{};
    CHECK((from_hex("0aff", bytes) && bytes[0] == 10 && bytes[1] == 255));
    CHECK(to_hex(bytes) == "0aff");
    for (const char* text : {"0AFF", "0af", "0aff0", "0ag0", "", "0x0a", " aff"})
        CHECK_FALSE(from_hex(text, bytes));
    CHECK(to_hex(bytes) == "0aff");
}
