#include "site.hpp"

#include <catch2/catch.hpp>

#include <loomlink/keys/sealed_key.hpp>

using namespace weave;
using namespace weave::loomlink;
using testing::check_refused;

namespace {

constexpr const char* password = "correct horse battery";
constexpr const char* shut = "the password does not open this signing key";

}  // namespace

TEST_CASE("a sealed key signs with its password, and its secret is nowhere in what is stored") {
    const SealedKey key = make_sealed_key("anna", password, test_cost());
    const std::string stored = write_sealed_key(key);
    const SealedKey again = read_sealed_key(stored).value();
    CHECK(write_sealed_key(again) == stored);
    const Signature signature = sign_with(again, password, Purpose::release_manifest, "m").value();
    CHECK(signature.key == key.id());
    CHECK(verify(key.public_key, Purpose::release_manifest, "m", signature));
    CHECK(stored.find(password) == std::string::npos);
    const SealedKey twin = make_sealed_key("anna", password, test_cost());
    CHECK(twin.public_key != key.public_key);
    CHECK(twin.salt != key.salt);
    CHECK(twin.nonce != key.nonce);
}

TEST_CASE("a sealed key opens at the cost that people pay") {
    const SealedKey key = make_sealed_key("anna", password, login_cost());
    CHECK(sign_with(key, password, Purpose::statement, "m"));
    CHECK(key_cost().passes >= 3);
    CHECK(key_cost().memory_bytes >= std::size_t{256} << 20);
    CHECK(login_cost().memory_bytes >= std::size_t{64} << 20);
}

TEST_CASE("a wrong password and a key that was altered are refused in the same words") {
    const SealedKey key = make_sealed_key("anna", password, test_cost());
    const auto refusal = [](const SealedKey& tried, const char* word) {
        const auto signature = sign_with(tried, word, Purpose::statement, "m");
        REQUIRE_FALSE(signature);
        CHECK(signature.error().code == ErrorCode::refused);
        return signature.error().message;
    };
    CHECK(refusal(key, "correct horse batterz") == shut);
    CHECK(refusal(key, "") == shut);
    SealedKey changed = key;
    changed.person = "ben";  // the key given to somebody else
    CHECK(refusal(changed, password) == shut);
    changed = key;
    changed.public_key = KeyPair::generate().public_key();
    CHECK(refusal(changed, password) == shut);
    changed = key;
    changed.cost.passes += 1;
    CHECK(refusal(changed, password) == shut);
    for (std::size_t k = 0; k < key.sealed.size(); ++k) {
        changed = key;
        changed.sealed[k] ^= 1;
        CHECK(refusal(changed, password) == shut);
    }
    changed = key;
    changed.salt[3] ^= 16;
    CHECK(refusal(changed, password) == shut);
    changed = key;
    changed.nonce[3] ^= 16;
    CHECK(refusal(changed, password) == shut);
}

TEST_CASE("another password seals the same key anew") {
    const SealedKey key = make_sealed_key("anna", password, test_cost());
    const SealedKey changed = change_password(key, password, "another good one", test_cost()).value();
    CHECK(changed.public_key == key.public_key);
    CHECK(changed.person == "anna");
    CHECK(changed.salt != key.salt);
    check_refused(sign_with(changed, password, Purpose::statement, "m"), shut);
    CHECK(sign_with(changed, "another good one", Purpose::statement, "m"));
    check_refused(change_password(key, "wrong", "another good one", test_cost()), shut);
}

TEST_CASE("what is no sealed key is refused with its place, and so is a cost that nobody would spend") {
    const std::string stored = write_sealed_key(make_sealed_key("anna", password, test_cost()));
    const Json sound = parse_json(stored).value();
    const auto with = [&](const char* member, const Json& value) {
        Json json = sound;
        json[member] = value;
        return read_sealed_key(canonical_json(json));
    };
    check_refused(with("memory", std::uint64_t{1} << 40), "is no cost that this program spends");
    check_refused(with("passes", 1000000), "is no cost that this program spends");
    check_refused(with("version", 2), "newer than this program");
    check_refused(with("key", std::string(64, '0')), "key: is not the id of this public key");
    check_refused(with("public", std::string(64, '0')), "public: is not a sound public key");
    check_refused(with("salt", "00"), "salt: must be 32 lower-case hexadecimal characters");
    check_refused(with("person", "a\nb"), "person: must be a name");
    check_refused(with("more", 1), "more: is not known here");
    check_refused(read_sealed_key(stored.substr(0, stored.size() - 1)), "is not JSON");
    check_refused(read_sealed_key(std::string(10000, ' ')), "too large");
}
