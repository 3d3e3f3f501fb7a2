#include <weave/core/file.hpp>
#include <weave/core/log.hpp>

#include <catch2/catch.hpp>

#include <csignal>
#include <fcntl.h>
#include <sched.h>
#include <semaphore.h>
#include <support/memory.hpp>
#include <support/temporary_folder.hpp>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace weave;
namespace fs = std::filesystem;

namespace {

using Folder = testing::TemporaryFolder;

}  // namespace

TEST_CASE("a file is written whole, read back and replaced") {
    const Folder folder;
    const fs::path file = folder.path / "design.weave";
    const std::string bytes = std::string("a\0b\n", 4) + std::string(200000, 'x');
    REQUIRE(write_file(file, bytes));
    REQUIRE(read_file(file).value() == bytes);
    REQUIRE(write_file(file, "short"));
    REQUIRE(read_file(file).value() == "short");
    REQUIRE(write_file(file, ""));
    REQUIRE(read_file(file).value().empty());
    REQUIRE(folder.entries() == 1);  // no temporary file stays behind
}

TEST_CASE("a file written in pieces is there once it is finished, and leaves the old one until then") {
    const Folder folder;
    const fs::path file = folder.path / "cloth.yarns";
    REQUIRE(write_file(file, "old"));
    {
        auto given_up = FileInPieces::begin(file);
        REQUIRE(given_up);
        REQUIRE(given_up->write(0, "never finished"));
        CHECK(read_file(file).value() == "old");
    }
    CHECK(read_file(file).value() == "old");
    CHECK(folder.entries() == 1);
    auto pieces = FileInPieces::begin(file);
    REQUIRE(pieces);
    REQUIRE(pieces->write(5, "end"));
    REQUIRE(pieces->write(0, "be"));
    REQUIRE(pieces->finish());
    CHECK(read_file(file).value() == std::string("be\0\0\0end", 8));
    CHECK(folder.entries() == 1);
    CHECK_FALSE(FileInPieces::begin("/dev/null"));
    CHECK_THAT(FileInPieces::begin(folder.path / "no" / "cloth.yarns").error().text(), Catch::Contains("cloth.yarns"));
}

TEST_CASE("a write that fails leaves the old file and nothing else, and names the file") {
    const Folder folder;
    const fs::path missing = folder.path / "no" / "such" / "design.weave";
    const Status failed = write_file(missing, "bytes");
    REQUIRE_FALSE(failed);
    REQUIRE(failed.error().code == ErrorCode::system);
    REQUIRE(failed.error().where == missing.string());
    REQUIRE_FALSE(write_file(folder.path, "bytes"));
    REQUIRE(folder.entries() == 0);
}

TEST_CASE("a symbolic link stays one, and its target gets the content") {
    const Folder folder;
    const fs::path file = folder.path / "real", link = folder.path / "link";
    REQUIRE(write_file(file, "old"));
    fs::create_symlink("real", link);
    REQUIRE(write_file(link, "new"));
    REQUIRE(fs::is_symlink(link));
    REQUIRE(read_file(file).value() == "new");
}

TEST_CASE("a link to a file that is not there yet stays a link, and a loop of links is refused") {
    const Folder folder;
    fs::create_directory(folder.path / "below");
    fs::create_symlink("below/real", folder.path / "link");
    fs::create_symlink("link", folder.path / "link to link");
    REQUIRE(write_file(folder.path / "link to link", "new"));
    CHECK(fs::is_symlink(folder.path / "link to link"));
    CHECK(fs::is_symlink(folder.path / "link"));
    CHECK(read_file(folder.path / "below" / "real").value() == "new");
    fs::create_symlink("loop", folder.path / "loop");
    CHECK_THAT(write_file(folder.path / "loop", "x").error().text(),
               Catch::Contains("loop of symbolic links"));
    CHECK(fs::is_symlink(folder.path / "loop"));
}

TEST_CASE("a replaced file keeps its permissions and owner, and a write-protected one is left alone") {
    const Folder folder;
    const fs::path file = folder.path / "design.weave";
    REQUIRE(write_file(file, "old"));
    for (const mode_t mode : {0600U, 0640U, 0664U, 0755U}) {
        REQUIRE(::chmod(file.c_str(), mode) == 0);
        if (::geteuid() == 0) REQUIRE(::chown(file.c_str(), 12, 34) == 0);
        REQUIRE(write_file(file, "new"));
        struct stat facts {};
        REQUIRE(::stat(file.c_str(), &facts) == 0);
        CHECK((facts.st_mode & 07777) == mode);
        if (::geteuid() == 0) CHECK((facts.st_uid == 12 && facts.st_gid == 34));
    }
    REQUIRE(::chmod(file.c_str(), 0444) == 0);
    const Status refused = write_file(file, "over it");
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == ErrorCode::refused);
    CHECK(refused.error().text() == file.string() + ": is write-protected");
    CHECK(read_file(file).value() == "new");
    CHECK(folder.entries() == 1);
}

TEST_CASE("whether a file can be written shows before, and nothing is written for it") {
    const Folder folder;
    const fs::path file = folder.path / "design.weave", link = folder.path / "link";
    CHECK(check_writable(file));
    CHECK(check_writable("design.weave"));
    CHECK(check_writable("/dev/null"));
    fs::create_symlink("no/such", link);
    REQUIRE(write_file(folder.path / "a file", ""));
    for (const fs::path& wrong : {folder.path, folder.path / "no" / "such", folder.path / "a file" / "x", link}) {
        const Status asked = check_writable(wrong), tried = write_file(wrong, "bytes");
        REQUIRE_FALSE(asked);
        REQUIRE_FALSE(tried);
        CHECK(asked.error().text() == tried.error().text());
    }
    REQUIRE(write_file(file, "old"));
    CHECK(check_writable(file));
    REQUIRE(::chmod(file.c_str(), 0444) == 0);
    const Status refused = check_writable(file);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().text() == file.string() + ": is write-protected");
    CHECK(folder.entries() == 3);
}

TEST_CASE("a name as long as a name may be is written, file and folder") {
    const Folder folder;
    REQUIRE(write_file(folder.path / std::string(255, 'n'), "x"));
    REQUIRE(write_folder(folder.path / std::string(255, 'f'), {{std::string(255, 'n'), "x"}}));
    REQUIRE_FALSE(write_file(folder.path / std::string(256, 'n'), "x"));
    REQUIRE(folder.entries() == 2);
}

TEST_CASE("the log is told of another name that keeps the old content") {
    const Folder folder;
    const fs::path file = folder.path / "a";
    std::vector<std::string> heard;
    set_log_sink([&](LogLevel, std::string_view message) { heard.emplace_back(message); });
    REQUIRE(write_file(file, "old"));
    REQUIRE(write_file(file, "older"));
    CHECK(heard.empty());
    fs::create_hard_link(file, folder.path / "b");
    REQUIRE(write_file(file, "new"));
    set_log_sink({});
    REQUIRE(heard.size() == 1);
    CHECK_THAT(heard[0], Catch::StartsWith(file.string() + ": ") && Catch::Contains("hard link"));
    CHECK(read_file(folder.path / "b").value() == "older");
}

TEST_CASE("a file that is too large is refused by its size, before it is read") {
    const Folder folder;
    const fs::path file = folder.path / "hollow";
    REQUIRE(write_file(file, ""));
    fs::resize_file(file, std::uintmax_t{1} << 30);  // takes no room on the disk
    const double before = testing::peak_mb();
    REQUIRE_THAT(read_file(file, std::uint64_t{1} << 29).error().text(), Catch::Contains("larger than the limit"));
    CHECK(testing::peak_mb() - before < 100);
}

TEST_CASE("what cannot be read is refused with its name") {
    const Folder folder;
    const fs::path file = folder.path / "large";
    REQUIRE(write_file(file, std::string(1001, 'x')));
    REQUIRE(read_file(file, 1001));
    REQUIRE_THAT(read_file(file, 1000).error().text(),
                 Catch::Contains("larger than the limit of 1000") && Catch::Contains(file.string()));
    REQUIRE(read_file(folder.path / "gone").error().code == ErrorCode::bad_input);
    REQUIRE_THAT(read_file(folder.path).error().message, Catch::Contains("not a regular file"));
    const fs::path pipe = folder.path / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    REQUIRE_THAT(read_file(pipe).error().message,
                 Catch::Contains("not a regular file"));  // and does not wait for a writer
}

TEST_CASE("a folder appears whole or not at all") {
    const Folder folder;
    const fs::path out = folder.path / "deep" / "out";
    REQUIRE(write_folder(out, {{"a.png", "one"}, {"b.json", "two"}}));
    REQUIRE(read_file(out / "b.json").value() == "two");
    REQUIRE_FALSE(write_folder(out, {{"c", "three"}}));  // not over what is there
    REQUIRE(read_file(out / "a.png").value() == "one");
    REQUIRE_FALSE(write_folder(folder.path / "twice", {{"a", "1"}, {"a", "2"}}));
    REQUIRE_FALSE(fs::exists(folder.path / "twice"));
    fs::create_directory(folder.path / "empty");
    REQUIRE(write_folder(folder.path / "empty/", {{"a", "1"}}));
    REQUIRE(read_file(folder.path / "empty" / "a").value() == "1");
    REQUIRE(write_file(folder.path / "file", "x"));
    REQUIRE_FALSE(write_folder(folder.path / "file", {{"a", "1"}}));
    REQUIRE_FALSE(write_folder(folder.path / "file" / "below", {{"a", "1"}}));
    REQUIRE(folder.entries() == 3);
}

TEST_CASE("folders that were made for a folder that could not be written are gone again") {
    const Folder folder;
    const fs::path out = folder.path / "a" / "b" / "out";
    REQUIRE_FALSE(write_folder(out, {{"one", "1"}, {"one", "2"}}));
    CHECK(folder.entries() == 0);
    fs::create_directory(folder.path / "a");
    REQUIRE_FALSE(write_folder(out, {{"one", "1"}, {"one", "2"}}));
    CHECK(fs::is_empty(folder.path / "a"));  // which was there before
    CHECK(folder.entries() == 1);
}

TEST_CASE("a link to an empty folder stays a link; the current folder is refused") {
    const Folder folder;
    fs::create_directory(folder.path / "empty");
    fs::create_symlink("empty", folder.path / "link");
    REQUIRE(write_folder(folder.path / "link", {{"a", "1"}}));
    CHECK(fs::is_symlink(folder.path / "link"));
    CHECK(read_file(folder.path / "empty" / "a").value() == "1");
    fs::create_symlink("to come", folder.path / "early");
    REQUIRE(write_folder(folder.path / "early/", {{"a", "1"}}));
    CHECK(fs::is_symlink(folder.path / "early"));
    CHECK(read_file(folder.path / "to come" / "a").value() == "1");

    const fs::path here = folder.path / "here", before = fs::current_path();
    fs::create_directory(here);
    fs::current_path(here);
    for (const char* name : {".", "./", "../here", "../here/."}) {
        INFO(name);
        const Status refused = write_folder(name, {{"a", "1"}});
        REQUIRE_FALSE(refused);
        CHECK(refused.error().code == ErrorCode::refused);
        CHECK_THAT(refused.error().text(), Catch::Contains("in which you are"));
    }
    fs::current_path(before);
    CHECK(fs::is_empty(here));
    CHECK(folder.entries() == 5);
}

namespace {

sem_t caught_mid_write;

/// In a process of its own: `write` meets the limit of what a file may hold, and there, in the middle,
/// everything that is unfinished is dropped and the process ends with 7.
void end_mid_write(void (*write)(const fs::path&), const fs::path& where) {
    REQUIRE(::sem_init(&caught_mid_write, 0, 0) == 0);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        std::thread([] {
            ::sem_wait(&caught_mid_write);
            drop_unfinished_writes();
            ::_exit(7);
        }).detach();
        std::signal(SIGXFSZ, [](int) {
            ::sem_post(&caught_mid_write);
            while (true) ::pause();
        });
        const rlimit limit{1000, 1000};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        write(where);
        ::_exit(1);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    REQUIRE(WEXITSTATUS(status) == 7);
}

}  // namespace

TEST_CASE("a program that is ended while it writes leaves neither a part nor a folder, and the old file") {
    const Folder folder;
    REQUIRE(write_file(folder.path / "file", "old"));
    end_mid_write(
        [](const fs::path& at) {
            static_cast<void>(write_file(at / "file", std::string(5000, 'x')).error());
        },
        folder.path);
    CHECK(read_file(folder.path / "file").value() == "old");
    CHECK(folder.entries() == 1);
    end_mid_write(
        [](const fs::path& at) {
            static_cast<void>(
                write_folder(at / "a" / "b", {{"one", "1"}, {"two", std::string(5000, 'x')}}).error());
        },
        folder.path);
    CHECK(folder.entries() == 1);
}

TEST_CASE("what is no file is written to as it is, or refused with its name and a reason; nothing is lost") {
    const Folder folder;
    const auto failure = [&](const fs::path& place) {
        const Status failed = write_file(place, std::string(100000, 'x'));
        REQUIRE_FALSE(failed);
        CHECK(failed.error().code == ErrorCode::system);
        CHECK(failed.error().where == place.string());
        CHECK(failed.error().text().find('\n') == std::string::npos);
        return failed.error().message;
    };
    CHECK_THAT(failure("/dev/full"), Catch::Contains("No space left"));
    CHECK(fs::is_character_file("/dev/full"));
    CHECK(write_file("/dev/null", "x"));
    CHECK(fs::is_character_file("/dev/null"));
    fs::create_directory(folder.path / "folder");
    REQUIRE(write_file(folder.path / "folder" / "kept", "kept"));
    CHECK(failure(folder.path / "folder") == "is a folder, not a file");
    fs::create_symlink("nowhere/file", folder.path / "astray");
    CHECK_THAT(failure(folder.path / "astray"), Catch::Contains("No such file"));
    CHECK(fs::is_symlink(folder.path / "astray"));
    CHECK(read_file(folder.path / "folder" / "kept").value() == "kept");
    CHECK(folder.entries() == 2);
}

TEST_CASE("a pipe gets the bytes; one that nobody reads any more gives an error and does not end the program") {
    const Folder folder;
    const fs::path pipe = folder.path / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    const std::string bytes(500000, 'x');  // more than a pipe holds
    for (const std::size_t wanted : {bytes.size(), std::size_t{10}}) {
        std::size_t got = 0;
        std::thread reader([&] {
            const int file = ::open(pipe.c_str(), O_RDONLY | O_CLOEXEC);
            char buffer[4096];
            while (got < wanted) {
                const ssize_t more = ::read(file, buffer, std::min(sizeof buffer, wanted - got));
                if (more <= 0) break;
                got += static_cast<std::size_t>(more);
            }
            ::close(file);
        });
        const Status written = write_file(pipe, bytes);
        reader.join();
        CHECK(got == wanted);
        CHECK(bool(written) == (wanted == bytes.size()));
        if (!written) CHECK(written.error().text() == pipe.string() + ": cannot write: Broken pipe");
        CHECK(fs::is_fifo(pipe));
    }
    CHECK(folder.entries() == 1);
}

TEST_CASE("a pipe is written to by the name that the system gives it, which leads to no place") {
    int ends[2];
    REQUIRE(::pipe2(ends, O_CLOEXEC) == 0);
    REQUIRE(write_file("/proc/self/fd/" + std::to_string(ends[1]), "bytes"));
    const Folder folder;
    fs::create_symlink("/proc/self/fd/" + std::to_string(ends[1]), folder.path / "link");
    REQUIRE(write_file(folder.path / "link", " more"));
    char buffer[16];
    const ssize_t got = ::read(ends[0], buffer, sizeof buffer);
    CHECK(std::string(buffer, static_cast<std::size_t>(std::max<ssize_t>(got, 0))) == "bytes more");
    ::close(ends[0]);
    ::close(ends[1]);
    CHECK(fs::is_symlink(folder.path / "link"));
}

TEST_CASE("of two that write one new folder at once, one is refused, as if the other had been there before") {
    const Folder folder;
    std::size_t refusals = 0;
    for (std::size_t round = 0; round < 40; ++round) {
        const fs::path out = folder.path / std::to_string(round);
        Status ended[2];
        std::thread other([&] { ended[1] = write_folder(out, {{"a", "1"}}); });
        ended[0] = write_folder(out, {{"a", "0"}});
        other.join();
        REQUIRE(bool(ended[0]) != bool(ended[1]));
        const Error& error = ended[ended[0] ? 1 : 0].error();
        CHECK(error.code == ErrorCode::refused);
        CHECK(error.message == "exists already and is not an empty folder");
        CHECK(read_file(out / "a").value() == (ended[0] ? "0" : "1"));
        ++refusals;
    }
    CHECK(folder.entries() == refusals);
}

namespace {

/// In a process of its own, where `file` is a mount point: what came of writing it.
enum MountedWrite : int { told_and_kept = 0, wrong = 1, no_mounts_here = 2 };
MountedWrite write_mounted(const fs::path& file) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0 ||
            ::mount(file.c_str(), file.c_str(), nullptr, MS_BIND, nullptr) != 0)
            ::_exit(no_mounts_here);
        const Status status = write_file(file, "new");
        const bool told = !status && status.error().where == file.string() &&
                          status.error().message.find("cannot put into place") != std::string::npos;
        ::_exit(told ? told_and_kept : wrong);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFEXITED(status));
    return static_cast<MountedWrite>(WEXITSTATUS(status));
}

}  // namespace

TEST_CASE("a file that is a mount point keeps its content, and the error names it") {
    const Folder folder;
    const fs::path file = folder.path / "mounted";
    REQUIRE(write_file(file, "old"));
    const MountedWrite came = write_mounted(file);
    if (came == no_mounts_here) WARN("this machine lets a test make no mount point; not tried");
    CHECK(came != wrong);
    CHECK(read_file(file).value() == "old");
    CHECK(folder.entries() == 1);
}
