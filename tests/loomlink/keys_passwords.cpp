#include "site.hpp"

#include <catch2/catch.hpp>

#include <loomlink/keys/password.hpp>

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
