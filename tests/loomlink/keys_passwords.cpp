#include "site.hpp"

#include <catch2/catch.hpp>

#include <loomlink/keys/codes.hpp>
#include <loomlink/keys/password.hpp>
#include <loomlink/keys/secret_bytes.hpp>
#include <set>

using namespace weave;
using namespace weave::loomlink;
using testing::check_refused;

TEST_CASE("a password is taken or refused in words") {
    const auto tried = [](const std::string& word) {
        return check_password(word, "anna", "Anna of the Mill");
    };
    CHECK(tried("twelve chars"));
    CHECK(tried("пароль ткача"));  // twelve characters, more bytes
    CHECK(tried(std::string(1023, 'a') + "b"));
    check_refused(tried("eleven char"), "is too short: it takes 12 characters or more");
    check_refused(tried("ääääääääääb"), "is too short");  // eleven, whatever its bytes
    check_refused(tried(""), "is too short");
    check_refused(tried("aaaaaaaaaaaaaaaa"), "one character over and over");
    check_refused(tried("ääääääääääääää"), "one character over and over");
    check_refused(tried("anna OF the mill"), "is your name");
    check_refused(check_password("Maria.Weaver", "maria.weaver", "M"), "is your name");
    check_refused(tried(std::string(1025, 'a')), "more than 1024 bytes");
    check_refused(tried(std::string("twelve\0chars and more", 21)), "cannot be typed everywhere");
    check_refused(tried("twelve chars\x7f"), "cannot be typed everywhere");
    check_refused(tried("twelve chars\xff"), "cannot be typed everywhere");
    CHECK(tried("eleven char").error().text().find("eleven") == std::string::npos);
}

TEST_CASE("a password hash fits its password alone, and never the same twice") {
    const PasswordHasher hasher(test_cost());
    const std::string hash = hasher.hash("twelve chars");
    CHECK(hash.starts_with("$argon2id$"));
    CHECK(hasher.matches(hash, "twelve chars"));
    CHECK_FALSE(hasher.matches(hash, "twelve charz"));
    CHECK_FALSE(hasher.matches(hash, ""));
    CHECK(hasher.hash("twelve chars") != hash);
    CHECK_FALSE(hasher.matches("not a hash", "twelve chars"));
    CHECK_FALSE(hasher.matches("", "twelve chars"));
}

TEST_CASE("of a person who does not exist no password is right") {
    const PasswordHasher hasher(test_cost());
    CHECK_FALSE(hasher.matches({}, "twelve chars"));
    CHECK_FALSE(hasher.matches({}, ""));
}

TEST_CASE("a hash of another cost, or what is none, is stale") {
    const PasswordHasher cheap(test_cost()), dearer(GuessCost{2, std::size_t{64} << 10});
    const std::string hash = cheap.hash("twelve chars");
    CHECK_FALSE(cheap.is_stale(hash));
    CHECK(dearer.is_stale(hash));
    CHECK(dearer.matches(hash, "twelve chars"));  // all the same
    CHECK(cheap.is_stale("not a hash"));
}

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
