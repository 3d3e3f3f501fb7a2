#include <weave/core/json.hpp>
#include <weave/keys/access_token.hpp>
#include <weave/keys/hex.hpp>

#include <catch2/catch.hpp>

#include <sodium.h>
#include <support/random.hpp>
#include <support/refusals.hpp>

using namespace weave;
using testing::check_refused;
using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;

namespace {

Instant noon() {
    return parse_utc("2026-11-26T12:00:00.000Z").value();
}

AccessToken dora() {
    return {"mill", "dora", noon(), noon() + hours(8)};
}

std::string base64(std::string_view bytes) {
    std::string text(2 * bytes.size() + 4, '\0');
    sodium_bin2base64(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                      sodium_base64_VARIANT_URLSAFE_NO_PADDING);
    return text.c_str();
}

/// A token over any body, true or not.
std::string signed_by(const KeyPair& key, const std::string& body, Purpose purpose = Purpose::access_token) {
    const auto value = hex_array<64>(key.sign(purpose, body).value).value();
    return base64(body) + "." + base64({reinterpret_cast<const char*>(value.data()), value.size()});
}

Json body_of_dora() {
    return {{"format", "weave-access-token"}, {"version", 1},
            {"site", "mill"},                 {"person", "dora"},
            {"service", "simd"},              {"issued", "2026-11-26T12:00:00.000Z"},
            {"expires", "2026-11-26T20:00:00.000Z"}};
}

}  // namespace

TEST_CASE("an access token is read as it was signed, by whichever key counts, for as long as it lives") {
    const KeyPair key = KeyPair::generate(), old = KeyPair::generate();
    const std::string text = sign_access_token(key, dora()).value();
    const std::vector<PublicKey> keys{old.public_key(), key.public_key(), KeyPair::generate().public_key()};
    CHECK(text == signed_by(key, canonical_json(body_of_dora())));
    CHECK(text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.") == std::string::npos);
    CHECK(read_access_token(text, keys, noon()).value() == dora());
    CHECK(read_access_token(text, keys, noon() + hours(8) - milliseconds(1)));
    check_refused(read_access_token(text, keys, noon() + hours(8)), "token: has expired: get a new one");
    CHECK(read_access_token(text, keys, noon() - minutes(5)));
    check_refused(read_access_token(text, keys, noon() - minutes(5) - milliseconds(1)), "a time that has not come");
    check_refused(read_access_token(text, {}, noon()), "a key that this server does not know");
    const std::vector<PublicKey> foreign{old.public_key()};
    check_refused(read_access_token(text, foreign, noon()), "a key that this server does not know");
}

TEST_CASE("an access token that was signed but is none is refused, each for its reason") {
    const KeyPair key = KeyPair::generate();
    const std::vector<PublicKey> keys{key.public_key()};
    const auto with = [&](const std::string& member, const Json& value) {
        Json body = body_of_dora();
        body[member] = value;
        return read_access_token(signed_by(key, canonical_json(body)), keys, noon());
    };
    REQUIRE(with("site", "mill"));
    check_refused(with("service", "loomlink"), "is for another service");
    check_refused(with("expires", "2026-11-27T00:00:00.001Z"), "lives longer than an access token may");
    CHECK(with("expires", "2026-11-27T00:00:00.000Z"));
    check_refused(with("expires", "2026-11-26T12:00:00.000Z"), "lives longer");  // or not at all
    check_refused(with("expires", "2026-11-26"), "is not an access token");
    check_refused(with("format", "weave-evidence"), "is not an access token");
    check_refused(with("version", 2), "is not an access token");
    check_refused(with("person", ""), "is not an access token");
    check_refused(with("person", "do\nra"), "is not an access token");
    check_refused(with("more", 1), "is not an access token");
    check_refused(read_access_token(signed_by(key, body_of_dora().dump()), keys, noon()), "is not an access token");
    check_refused(read_access_token(signed_by(key, ""), keys, noon()), "is not an access token");
    check_refused(read_access_token(signed_by(key, canonical_json(body_of_dora()), Purpose::statement), keys, noon()),
                  "a key that this server does not know");
}

TEST_CASE("what is no access token is refused in one way, and nothing of it is repeated") {
    const KeyPair key = KeyPair::generate();
    const std::vector<PublicKey> keys{key.public_key()};
    const std::string good = sign_access_token(key, dora()).value();
    const auto stop = good.find('.');
    const std::string body = good.substr(0, stop), signature = good.substr(stop + 1);
    for (const std::string& text :
         {std::string(), std::string("."), body, body + ".", "." + signature, body + "." + signature + "=", good + ".",
          good + "\n", " " + good, body + "." + signature.substr(1), body + "=." + signature, body + "." + signature + "A",
          good + std::string(most_access_token, 'A'), std::string(1 << 20, '.'), std::string("\0.\0", 3)}) {
        const auto read = read_access_token(text, keys, noon());
        REQUIRE_FALSE(read);
        CHECK(read.error().text() == "token: is not an access token");
    }
    // A stranger's token tells nothing of what it says.
    Json lie = body_of_dora();
    lie["expires"] = "1999-01-01T00:00:00.000Z";
    lie["person"] = "secret";
    const auto read = read_access_token(signed_by(KeyPair::generate(), canonical_json(lie)), keys, noon());
    REQUIRE_FALSE(read);
    CHECK(read.error().text() == "token: is of a key that this server does not know");
}

TEST_CASE("another character anywhere in an access token breaks it") {
    const KeyPair key = KeyPair::generate();
    const std::vector<PublicKey> keys{key.public_key()};
    const std::string good = sign_access_token(key, dora()).value();
    testing::for_all([&](testing::Random& random) {
        std::string text = good;
        text[random.between(0, good.size() - 1)] = static_cast<char>(random.between(0, 255));
        if (text != good) REQUIRE_FALSE(read_access_token(text, keys, noon()));
    });
}

TEST_CASE("no token is made that would not be read") {
    const KeyPair key = KeyPair::generate();
    AccessToken token = dora();
    token.expires = token.issued + longest_access;
    CHECK(sign_access_token(key, token));
    token.expires += milliseconds(1);
    check_refused(sign_access_token(key, token), "at most 12 hours");
    token.expires = token.issued;
    check_refused(sign_access_token(key, token), "more than nothing");
    token = dora();
    token.person = "";
    check_refused(sign_access_token(key, token), "must be names");
    token.person = std::string(200, 'd');
    check_refused(sign_access_token(key, token), "must be names");
    token.person = token.site = std::string(128, 'd');
    CHECK(sign_access_token(key, token).value().size() < most_access_token);
}
