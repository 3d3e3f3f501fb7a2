#include "site.hpp"

#include <weave/core/file.hpp>

#include <catch2/catch.hpp>

#include <loomlink/terminal/state.hpp>
#include <support/random.hpp>
#include <support/temporary_folder.hpp>
#include <sys/stat.h>

using namespace weave;
using namespace weave::loomlink;
using testing::check_refused;
using testing::Site;
namespace fs = std::filesystem;

namespace {

/// A state with something in every member.
TerminalState full_state(const Site& site) {
    TerminalState state =
        check_index(site.terminal(), site.index(10, 2, 0), Site::at(1), Site::consistent).value().state;
    state.releases[1].body_sha256 = sha256_hex("body");
    state.placed = {
        {2, "/loom/at the wall", "release-2-0123456789ab", {{"shoe.jc5", sha256_hex("a")}, {"manifest.json", sha256_hex("b")}}}};
    return state;
}

}  // namespace

TEST_CASE("a state reads as it was written") {
    const Site site;
    for (const TerminalState& state : {site.terminal(), full_state(site)}) {
        const std::string bytes = write_state(state);
        const TerminalState again = read_state(bytes).value();
        CHECK(write_state(again) == bytes);
        CHECK(again.loom == "loom 7");
        CHECK(again.trust.fingerprint() == state.trust.fingerprint());
        CHECK(again.stamps == state.stamps);
        CHECK(again.releases == state.releases);
        CHECK(again.placed == state.placed);
        CHECK(again.tree_head == state.tree_head);
        CHECK(again.last_seen == state.last_seen);
    }
}

TEST_CASE("a terminal begins with the trust that a person named, not with what comes first") {
    const Site site, impostor;
    check_refused(first_state("loom 7", impostor.trust_bytes(), site.trust().fingerprint()),
                  "not the one that was given");
    check_refused(first_state("loom 7", site.trust_bytes(), ""),
                  "has the fingerprint " + site.trust().fingerprint());
    CHECK(first_state("loom 7", site.trust_bytes(), site.trust().fingerprint()));
}

TEST_CASE("a state that could lead astray is refused with its place") {
    const Site site;
    const Json sound = parse_json(write_state(full_state(site))).value();
    const auto changed = [&](const std::function<void(Json&)>& change) {
        Json json = sound;
        change(json);
        return read_state(canonical_json(json));
    };
    REQUIRE(changed([](Json&) {}));
    check_refused(changed([](Json& j) { j["placed"][0]["folder"] = ".."; }),
                  "placed[0].folder: the file name '..'");
    check_refused(changed([](Json& j) { j["placed"][0]["folder"] = "../../home"; }), "leads into a folder");
    for (const char* path : {"loom", "", "/loom/../home", "/loom//x", "./loom"})
        check_refused(changed([&](Json& j) { j["placed"][0]["within"] = path; }), "placed[0].within: is not the whole path");
    check_refused(changed([](Json& j) { j["placed"][0]["files"][0]["path"] = "/etc/passwd"; }),
                  "placed[0].files[0].path");
    check_refused(changed([](Json& j) { j["placed"].push_back(j["placed"][0]); }),
                  "is the folder of another release");
    check_refused(changed([](Json& j) { j["releases"][1]["number"] = 1; }),
                  "must be greater than the number before");
    check_refused(changed([](Json& j) { j["stamps"].push_back(j["stamps"][0]); }),
                  "must come after the key before it");
    check_refused(changed([](Json& j) { j["tree_head"]["head"]["size"] = 3; }),
                  "tree_head: the signature of key");
    check_refused(changed([](Json& j) { j["trust"]["body"]["site"] = "other"; }),
                  "trust: the signature of key");
    check_refused(changed([](Json& j) { j["version"] = 2; }), "newer than this program");
    check_refused(changed([](Json& j) { j["more"] = 1; }), "is not known here");
    check_refused(changed([](Json& j) { j.erase("trust"); }), "trust: is missing");
    check_refused(read_state(std::string(most_state_bytes + 1, ' ')), "is too large");
    check_refused(read_state("{"), "is not JSON");
}

TEST_CASE("the file of a state is its owner's alone, from the first write on") {
    const Site site;
    const testing::TemporaryFolder folder;
    const fs::path path = folder.path / "state.json";
    const auto mode = [&] {
        struct stat facts {};
        REQUIRE(::stat(path.c_str(), &facts) == 0);
        return facts.st_mode & 07777;
    };
    ::umask(0);
    REQUIRE(save_state(path, site.terminal()));
    CHECK(mode() == 0600);
    REQUIRE(save_state(path, full_state(site)));
    ::umask(022);
    CHECK(mode() == 0600);
    CHECK(folder.entries() == 1);
    CHECK(load_state(path).value().releases.size() == 2);
    REQUIRE(::chmod(path.c_str(), 0644) == 0);
    check_refused(load_state(path), "its mode must be 0600");
    check_refused(save_state(path, site.terminal()), "its mode must be 0600");
    REQUIRE(::chmod(path.c_str(), 0600) == 0);
    REQUIRE(write_file(path, "{}"));
    check_refused(load_state(path), "state.json: format: is missing");
    fs::remove(path);
    fs::create_symlink(folder.path / "elsewhere", path);
    check_refused(save_state(path, site.terminal()), "is a symbolic link");
    check_refused(load_state(path), "is a symbolic link");
}

TEST_CASE("a damaged state is refused or still a sound one") {
    const Site site;
    const std::string bytes = write_state(full_state(site));
    testing::for_all(
        [&](testing::Random& random) {
            std::string changed = bytes;
            const std::size_t at = random.between(0, bytes.size() - 1);
            changed[at] = static_cast<char>(changed[at] ^ (1 << random.between(0, 7)));
            const auto state = read_state(changed);
            if (state) REQUIRE(read_state(write_state(*state)));
            REQUIRE_FALSE(read_state(bytes.substr(0, at)));
        },
        testing::property_cases() / 10);
}
