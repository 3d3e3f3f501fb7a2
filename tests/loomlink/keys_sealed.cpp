#include "site.hpp"
#include "temporary_folder.hpp"

#include <weave/core/file.hpp>

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <fstream>
#include <loomlink/keys/private_file.hpp>
#include <loomlink/keys/sealed_key.hpp>
#include <loomlink/keys/server_key.hpp>
#include <sys/stat.h>

using namespace weave;
using namespace weave::loomlink;
using testing::check_refused;
namespace fs = std::filesystem;

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

TEST_CASE("a server key lies in a file of its own that nobody else may read, and is never replaced") {
    const testing::TemporaryFolder folder;
    const fs::path path = folder.path / "log.key";
    ::umask(0);
    const KeyPair pair = create_server_key(path, ServerKeyRole::log).value();
    ::umask(022);
    struct stat facts {};
    REQUIRE(::stat(path.c_str(), &facts) == 0);
    CHECK((facts.st_mode & 07777) == 0600);
    CHECK(facts.st_nlink == 1);
    CHECK(folder.entries() == 1);
    CHECK(load_server_key(path, ServerKeyRole::log).value().public_key() == pair.public_key());
    check_refused(load_server_key(path, ServerKeyRole::stamp), "is a key for another use");
    check_refused(create_server_key(path, ServerKeyRole::log), "exists already");
    CHECK(load_server_key(path, ServerKeyRole::log).value().public_key() == pair.public_key());
    CHECK(folder.entries() == 1);
    check_refused(create_server_key(folder.path / "no" / "where", ServerKeyRole::log), "cannot create");
}

TEST_CASE("a server key that others may read, a link to one, or another's is not loaded") {
    const testing::TemporaryFolder folder;
    const fs::path path = folder.path / "stamp.key";
    REQUIRE(create_server_key(path, ServerKeyRole::stamp));
    for (const mode_t mode : {0640U, 0604U, 0620U, 0602U, 0610U, 0644U}) {
        REQUIRE(::chmod(path.c_str(), mode) == 0);
        check_refused(load_server_key(path, ServerKeyRole::stamp), "its mode must be 0600");
    }
    REQUIRE(::chmod(path.c_str(), 0400) == 0);
    CHECK(load_server_key(path, ServerKeyRole::stamp));
    fs::create_symlink(path, folder.path / "link");
    check_refused(load_server_key(folder.path / "link", ServerKeyRole::stamp), "is a symbolic link");
    check_refused(load_server_key(folder.path, ServerKeyRole::stamp), "is not a regular file");
    check_refused(load_server_key(folder.path / "gone", ServerKeyRole::stamp), "cannot open");
    if (::geteuid() == 0) {
        REQUIRE(::chown(path.c_str(), 12, 34) == 0);
        check_refused(load_server_key(path, ServerKeyRole::stamp), "belongs to another user");
    }
}

TEST_CASE("a damaged server key is found, whichever byte it is") {
    const testing::TemporaryFolder folder;
    const fs::path path = folder.path / "log.key", broken = folder.path / "broken";
    REQUIRE(create_server_key(path, ServerKeyRole::log));
    const std::string bytes = read_file(path).value();
    REQUIRE(create_private_file(broken, bytes));
    for (std::size_t k = 0; k < bytes.size(); ++k) {
        std::string changed = bytes;
        changed[k] = static_cast<char>(changed[k] ^ 1);
        REQUIRE(write_file(broken, changed));
        INFO("byte " << k);
        CHECK_FALSE(load_server_key(broken, ServerKeyRole::log));
    }
    REQUIRE(write_file(broken, bytes + "\n"));
    check_refused(load_server_key(broken, ServerKeyRole::log), "is a damaged server key");
    REQUIRE(write_file(broken, std::string(1000, 'x')));
    check_refused(load_server_key(broken, ServerKeyRole::log), "larger than the limit");
}
