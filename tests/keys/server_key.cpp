#include <weave/core/file.hpp>
#include <weave/core/log.hpp>
#include <weave/keys/private_file.hpp>
#include <weave/keys/server_key.hpp>

#include <catch2/catch.hpp>

#include <support/refusals.hpp>
#include <support/temporary_folder.hpp>
#include <sys/stat.h>
#include <unistd.h>

using namespace weave;
using testing::check_refused;
namespace fs = std::filesystem;

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

TEST_CASE("a secret that others may read is warned of, with its file, and used all the same") {
    const testing::TemporaryFolder folder;
    const fs::path path = folder.path / "token";
    std::string told;
    set_log_sink([&](LogLevel level, std::string_view message) {
        CHECK(level == LogLevel::warning);
        told += message;
    });
    REQUIRE(write_file(path, "a-secret\n"));
    for (const auto& [mode, is_told] : {std::pair{0600, false}, {0400, false}, {0640, true}, {0644, true}, {0602, true}}) {
        INFO(mode);
        REQUIRE(::chmod(path.c_str(), static_cast<mode_t>(mode)) == 0);
        told.clear();
        warn_if_not_private(path);
        CHECK(told.empty() == !is_told);
        if (is_told) CHECK_THAT(told, Catch::Contains(path.string()) && Catch::Contains("chmod 600") && !Catch::Contains("a-secret"));
    }
    told.clear();
    warn_if_not_private(folder.path / "missing");  // whose absence is told by who reads it
    warn_if_not_private("/dev/null");
    CHECK(told.empty());
    set_log_sink({});
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
