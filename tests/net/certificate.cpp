#include "service.hpp"

#include <weave/core/file.hpp>

#include <sys/stat.h>

using namespace weave;
using namespace weave::net;
using weave::net::testing::Folder;

namespace {

mode_t mode_of(const std::filesystem::path& path) {
    struct stat facts {};
    REQUIRE(::stat(path.c_str(), &facts) == 0);
    return facts.st_mode & 07777;
}

}  // namespace

TEST_CASE("a certificate is made for names and addresses, and its key is the owner's alone") {
    const Folder folder;
    const mode_t old = ::umask(0);
    const auto made = make_certificate(folder.tls(), {"loom.example", "127.0.0.1", "::1"});
    ::umask(old);
    REQUIRE(made);
    REQUIRE(mode_of(folder.tls().key) == 0600);
    REQUIRE(mode_of(folder.tls().certificate) == 0644);
    REQUIRE(std::distance(std::filesystem::directory_iterator(folder.path), {}) == 2);
    const auto read = read_certificate(folder.tls().certificate);
    REQUIRE(read);
    REQUIRE(read->fingerprint == made->fingerprint);
    REQUIRE(read->fingerprint.size() == 64);
    REQUIRE(read->names == std::vector<std::string>{"loom.example", "127.0.0.1", "::1"});
    const auto now = std::chrono::system_clock::now();
    REQUIRE(read->from < now);
    REQUIRE(read->until > now + std::chrono::hours(24 * 820));
    REQUIRE(read->until - read->from < std::chrono::hours(24 * 825));
}

TEST_CASE("a key that is there is not replaced, and no half of a pair stays") {
    const Folder folder;
    REQUIRE(write_file(folder.tls().key, "mine"));
    const auto refused = make_certificate(folder.tls(), {"a"});
    REQUIRE_FALSE(refused);
    REQUIRE(refused.error().code == ErrorCode::refused);
    REQUIRE(read_file(folder.tls().key).value() == "mine");
    const TlsFiles apart{folder.path / "missing" / "c.pem", folder.path / "k.pem"};
    REQUIRE_FALSE(make_certificate(apart, {"a"}));
    REQUIRE_FALSE(std::filesystem::exists(apart.key));
}

TEST_CASE("names that would say something else in a certificate are refused") {
    const Folder folder;
    for (const char* name :
         {"", "a b", "a,DNS:b", "*", "a\n", "URI:x", "-a", ".a", "caf\xc3\xa9", "1.2.3.4/8"}) {
        INFO(name);
        const auto made = make_certificate(folder.tls(), {"good", name});
        REQUIRE_FALSE(made);
        REQUIRE(made.error().code == ErrorCode::usage);
    }
    REQUIRE_FALSE(make_certificate(folder.tls(), {}));
    REQUIRE(std::filesystem::is_empty(folder.path));
    REQUIRE(write_file(folder.path / "x", "-----BEGIN CERTIFICATE-----\nAAAA\n-----END CERTIFICATE-----\n"));
    REQUIRE_FALSE(read_certificate(folder.path / "x"));
}
