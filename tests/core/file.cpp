#include <weave/core/file.hpp>

#include <catch2/catch.hpp>

#include <fstream>
#include <sys/stat.h>
#include <unistd.h>

using namespace weave;
namespace fs = std::filesystem;

namespace {

/// A fresh folder that goes away with the test.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "weave-test-XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(path), fs::directory_iterator()));
    }
};

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
