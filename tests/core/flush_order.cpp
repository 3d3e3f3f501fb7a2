// What is flushed to disk, and when: here the system's own calls are stood in for, so that their order is
// seen.

#include <weave/core/file.hpp>

#include <catch2/catch.hpp>

#include <cstdio>
#include <fcntl.h>
#include <string>
#include <sys/syscall.h>
#include <unistd.h>
#include <vector>

namespace fs = std::filesystem;

namespace {

std::vector<std::string>* calls =
    nullptr;  ///< of the write that is watched, as `flush PATH` and `rename FROM TO`

std::string path_of(int file) {
    std::error_code code;
    return fs::read_symlink("/proc/self/fd/" + std::to_string(file), code).string();
}

}  // namespace

// The library finds these before those of the C library.
extern "C" int fsync(int file) {
    if (calls != nullptr) {
        const std::string path = path_of(file);
        std::error_code code;
        const bool is_file = fs::is_regular_file(path, code);
        calls->push_back("flush " + path + (is_file ? " " + std::to_string(fs::file_size(path, code)) : ""));
    }
    return static_cast<int>(::syscall(SYS_fsync, file));
}

extern "C" int rename(const char* from, const char* to) noexcept {
    if (calls != nullptr) calls->push_back(std::string("rename ") + from + " " + to);
    return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace {

/// The calls that `write` makes below a fresh folder, whose path is `HERE` in them and a temporary name
/// `PART`.
template <class Write>
std::vector<std::string> watched(Write write) {
    std::string pattern = (fs::temp_directory_path() / "weave-test-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    const std::string here = fs::canonical(pattern).string();
    std::vector<std::string> seen;
    calls = &seen;
    write(fs::path(here));
    calls = nullptr;
    fs::remove_all(here);
    for (std::string& call : seen) {
        for (std::size_t at = call.find(here); at != std::string::npos; at = call.find(here))
            call.replace(at, here.size(), "HERE");
        const std::string part = ".weave-part-";
        for (std::size_t at = call.find(part); at != std::string::npos; at = call.find(part)) {
            const std::size_t end = call.find_first_not_of("0123456789", at + part.size());
            call.replace(at, (end == std::string::npos ? call.size() : end) - at, "PART");
        }
    }
    return seen;
}

}  // namespace

TEST_CASE("a file is on the disk whole before it takes its name, and the name before the write is done") {
    const std::vector<std::string> expected{"flush HERE/PART 5", "rename HERE/PART HERE/design",
                                            "flush HERE"};
    CHECK(watched([](const fs::path& here) { CHECK(weave::write_file(here / "design", "bytes")); }) ==
          expected);
}

TEST_CASE("a folder's files and their names are on the disk before it takes its own") {
    const std::vector<std::string> expected{"flush HERE/PART/a 3", "flush HERE/PART/b 4", "flush HERE/PART",
                                            "rename HERE/PART HERE/out", "flush HERE"};
    CHECK(watched([](const fs::path& here) {
              CHECK(weave::write_folder(here / "out", {{"a", "one"}, {"b", "four"}}));
          }) == expected);
}
