#include <weave/keys/codes.hpp>
#include <weave/keys/secret_bytes.hpp>

#include <catch2/catch.hpp>

#include <set>
#include <support/refusals.hpp>

using namespace weave;
using testing::check_refused;

TEST_CASE("codes can be read out and typed as one likes") {
    std::set<std::string> hashes;
    for (int k = 0; k < 1000; ++k) {
        const std::string code = make_code();
        REQUIRE(code.size() == 29);
        REQUIRE(code.find_first_of("01ilo") == std::string::npos);
        REQUIRE(code.find_first_not_of("23456789abcdefghjkmnpqrstuvwxyz-") == std::string::npos);
        hashes.insert(code_hash(code).value());
    }
    CHECK(hashes.size() == 1000);
    CHECK(code_hash("ABCD efgh-jkmn  pqrs-tuvw-xyz2").value() ==
          code_hash("abcd-efgh-jkmn-pqrs-tuvw-xyz2").value());
    CHECK(code_hash("abcd-efgh-jkmn-pqrs-tuvw-xyz3").value() !=
          code_hash("abcd-efgh-jkmn-pqrs-tuvw-xyz2").value());
    check_refused(code_hash("abcd-efgh-jkmn-pqrs-tuvw-xyz"), "is no code");
    check_refused(code_hash("abcd-efgh-jkmn-pqrs-tuvw-xyz1"), "is no code");
    check_refused(code_hash("abcd-efgh-jkmn-pqrs-tuvw-xyz2" + std::string(1000, '-')), "is no code");
    check_refused(code_hash(""), "is no code");
}

TEST_CASE("every character of the alphabet comes in codes") {
    std::set<char> seen;
    for (int k = 0; k < 200; ++k)
        for (const char c : make_code()) seen.insert(c);
    CHECK(seen.size() == 32);  // 31 and the hyphen
}

TEST_CASE("tokens are long, new each time, and stored as their hash") {
    std::set<std::string> tokens;
    for (int k = 0; k < 1000; ++k) tokens.insert(make_token());
    CHECK(tokens.size() == 1000);
    for (const std::string& token : tokens) REQUIRE(token.size() == 43);
    CHECK(token_hash("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_CASE("secrets compare as a whole, and are wiped") {
    CHECK(equal_secrets("abc", "abc"));
    CHECK_FALSE(equal_secrets("abc", "abd"));
    CHECK_FALSE(equal_secrets("abc", "abcd"));
    CHECK(equal_secrets("", ""));
    std::string secret(100, 's');
    const char* memory = secret.data();
    wipe(secret);
    CHECK(secret.empty());
    CHECK(memory[50] == 0);  // within its capacity still
    SecretBytes one(32), other(16);
    CHECK(one.data()[31] == 0);
    one.data()[0] = 7;
    other = std::move(one);
    CHECK((other.size() == 32 && other.data()[0] == 7));
}
