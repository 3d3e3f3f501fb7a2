#include "site.hpp"

#include <weave/core/file.hpp>

#include <catch2/catch.hpp>

#include <loomlink/terminal/folder.hpp>
#include <support/temporary_folder.hpp>
#include <sys/stat.h>

using namespace weave;
using namespace weave::loomlink;
using testing::check_forbidden;
using testing::check_forged;
using testing::check_refused;
using testing::Site;
namespace fs = std::filesystem;

namespace {

/// A terminal with release 2 in its folder.
struct Placed {
    Site site;
    testing::TemporaryFolder home;
    fs::path state_file = home.path / "state.json", releases = home.path / "releases";
    TerminalState state = taken(site.terminal(), site.index_terms(10, 2, 0), 1);
    CheckedRelease release = checked(2).value();
    fs::path folder = place_release(state, release, state_file, releases).value();

    [[nodiscard]] TerminalState taken(const TerminalState& before, const ReleaseIndex& index,
                                      int minutes) const {
        return check_index(before, site.sign_index(index), Site::at(minutes), Site::consistent).value().state;
    }
    [[nodiscard]] Result<CheckedRelease> checked(std::uint64_t number) const {
        const CheckedIndex index =
            check_index(state, site.index(10, 2, 0), Site::at(1), Site::consistent).value();
        return check_release(index, number, site.manifest(number), Site::files(number), Site::at(2));
    }
    void recall(std::uint64_t number) {
        ReleaseIndex index = site.index_terms(20, 2, 10);
        index.releases[number - 1].state = ReleaseState::withdrawn;
        state = taken(state, index, 11);
    }
    /// What verify_files() finds, as NAME: MESSAGE.
    [[nodiscard]] std::vector<std::string> findings() const {
        std::vector<std::string> told;
        const FolderReport report = verify_files(folder, state.trust).value();
        for (const FileFinding& finding : report.findings)
            told.push_back(finding.path + ": " + finding.message);
        return told;
    }
};

using Told = std::vector<std::string>;

}  // namespace

TEST_CASE("a release is put into a folder of its own, and noted before") {
    Placed placed;
    CHECK(placed.folder.parent_path() == placed.releases);
    CHECK(read_file(placed.folder / "shoe.jc5").value() == Site::files(2)[0].bytes);
    CHECK(read_file(placed.folder / "manifest.json").value() == placed.site.manifest(2));
    CHECK(std::distance(fs::directory_iterator(placed.folder), fs::directory_iterator()) == 3);
    CHECK(std::distance(fs::directory_iterator(placed.releases), fs::directory_iterator()) == 1);
    const TerminalState kept = load_state(placed.state_file).value();
    REQUIRE(kept.placed.size() == 1);
    CHECK(kept.placed[0].folder == placed.release.folder);
    CHECK(kept.placed[0].path() == placed.folder);
    CHECK(kept.placed[0].files.size() == 3);
    CHECK(kept.releases[1].body_sha256 == body_sha256(placed.release.manifest.document));
    CHECK(placed.findings().empty());
    CHECK(check_recall(kept, placed.release.manifest));
}

TEST_CASE("two releases stand beside each other, and the same again changes nothing") {
    Placed placed;
    const CheckedRelease first = placed.checked(1).value();
    REQUIRE(place_release(placed.state, first, placed.state_file, placed.releases));
    CHECK(place_release(placed.state, placed.release, placed.state_file, placed.releases).value() ==
          placed.folder);
    CHECK(load_state(placed.state_file).value().placed.size() == 2);
    REQUIRE(write_file(placed.folder / "shoe.jc5", "other"));
    check_forged(place_release(placed.state, placed.release, placed.state_file, placed.releases),
                 "shoe.jc5: differs");
    CHECK(read_file(placed.folder / "shoe.jc5").value() == "other");
}

TEST_CASE("a release that cannot be written leaves nothing, and the note finds nothing to remove") {
    Placed placed;
    const CheckedRelease first = placed.checked(1).value();
    REQUIRE(write_file(placed.home.path / "file", "x"));
    CHECK_FALSE(place_release(placed.state, first, placed.state_file, placed.home.path / "file"));
    CHECK(fs::is_regular_file(placed.home.path / "file"));
    const fs::path litter = placed.releases / (".incoming-" + first.folder);
    fs::create_directory(litter);
    REQUIRE(write_file(litter / "half", "x"));  // as a power failure leaves it
    REQUIRE(place_release(placed.state, first, placed.state_file, placed.releases));
    CHECK_FALSE(fs::exists(litter));
    check_refused(
        place_release(placed.state, first, placed.home.path / "no" / "state", placed.releases / "new"),
        "cannot create");
    CHECK_FALSE(fs::exists(placed.releases / "new"));  // nothing without its note
}

TEST_CASE("each file that differs, is missing or is too many is named") {
    const Placed placed;
    REQUIRE(write_file(placed.folder / "shoe.jc5", Site::files(1)[0].bytes));
    CHECK(placed.findings() == Told{"shoe.jc5: differs from what was signed"});
    REQUIRE(write_file(placed.folder / "shoe.jc5", "short"));
    CHECK(placed.findings() == Told{"shoe.jc5: differs: has 5 bytes, not 18"});
    fs::remove(placed.folder / "shoe.jc5");
    CHECK(placed.findings() == Told{"shoe.jc5: is missing"});
    REQUIRE(write_file(placed.folder / "notes\n.txt", ""));
    CHECK(placed.findings() ==
          Told{"shoe.jc5: is missing", "notes\\x0a.txt: does not belong to the release"});
    fs::create_directory(placed.folder / "shoe.jc5");
    CHECK(placed.findings().front() == "shoe.jc5: is not a file of its own, but a link or something else");
}

TEST_CASE("a link to the right bytes is no file of a release") {
    const Placed placed;
    fs::rename(placed.folder / "shoe.jc5", placed.home.path / "moved");
    fs::create_symlink(placed.home.path / "moved", placed.folder / "shoe.jc5");
    CHECK(placed.findings() == Told{"shoe.jc5: is not a file of its own, but a link or something else"});
    fs::rename(placed.folder / "manifest.json", placed.home.path / "manifest");
    fs::create_symlink(placed.home.path / "manifest", placed.folder / "manifest.json");
    check_forged(verify_files(placed.folder, placed.state.trust), "manifest.json: is not a file of its own");
    fs::remove(placed.folder / "manifest.json");
    fs::create_directory(placed.folder / "manifest.json");
    check_forged(verify_files(placed.folder, placed.state.trust), "manifest.json: is not a file of its own");
}

TEST_CASE("a folder without a manifest that counts is refused as a whole") {
    const Placed placed;
    const fs::path manifest = placed.folder / "manifest.json";
    REQUIRE(write_file(
        manifest, Site::sign_manifest(Site::manifest_terms(2), {&placed.site.anna, &placed.site.thief})));
    check_forged(verify_files(placed.folder, placed.state.trust), "unknown or revoked");
    REQUIRE(write_file(manifest, placed.site.manifest(2) + " "));
    check_forged(verify_files(placed.folder, placed.state.trust), "manifest.json: is not in canonical form");
    REQUIRE(write_file(manifest, std::string(most_manifest_bytes + 1, ' ')));
    check_forged(verify_files(placed.folder, placed.state.trust),
                 "manifest.json: is too large for a manifest");
    REQUIRE(write_file(manifest, placed.site.manifest(1)));  // of another release, soundly signed
    CHECK(placed.findings().size() == 2);
    fs::remove(manifest);
    const auto missing = verify_files(placed.folder, placed.state.trust);
    check_refused(missing, "manifest.json: is not there: name the folder of one release");
    CHECK(missing.error().code == ErrorCode::bad_input);
    TrustDocument terms = placed.site.trust_terms(2);
    terms.keys.erase(terms.keys.begin() + 2);
    REQUIRE(write_file(manifest, placed.site.manifest(2)));
    const TrustDocument newer =
        read_trust(Site::sign_trust(terms, {&placed.site.anna, &placed.site.ben})).value();
    check_forged(verify_files(placed.folder, newer), "trust document 2 does not know: unknown or revoked");
}

TEST_CASE("what this terminal saw of a release is held against its folder") {
    Placed placed;
    ReleaseManifest manifest = placed.release.manifest;
    manifest.loom = "loom 8";
    check_forbidden(check_recall(placed.state, manifest), "is for the loom 'loom 8'");
    manifest = placed.release.manifest;
    manifest.revision_sha256 = Site::revision(1);
    check_forbidden(check_recall(placed.state, manifest), "is another one than this terminal has seen");
    manifest = placed.release.manifest;
    manifest.document.body["picks"] = 5;
    check_forbidden(check_recall(placed.state, manifest), "is another one than this terminal has seen");
    placed.recall(2);
    check_forbidden(check_recall(placed.state, placed.release.manifest), "release 2 was withdrawn");
}

TEST_CASE("what is not recalled stays") {
    Placed placed;
    CHECK(remove_ended(placed.state, ReleaseState::withdrawn).removed.empty());
    CHECK(fs::exists(placed.folder / "shoe.jc5"));
    placed.recall(1);  // which this terminal never pulled
    CHECK(remove_ended(placed.state, ReleaseState::withdrawn).removed.empty());
    CHECK(placed.findings().empty());
}

TEST_CASE("a recalled release goes with its folder") {
    Placed placed;
    placed.recall(2);
    const RecallReport report = remove_ended(placed.state, ReleaseState::withdrawn);
    CHECK(report.removed.size() == 3);
    CHECK(report.removed.front() == (placed.folder / "shoe.jc5").string());
    CHECK(report.kept.empty());
    CHECK(report.state.placed.empty());
    CHECK_FALSE(fs::exists(placed.folder));
    CHECK(remove_ended(report.state, ReleaseState::withdrawn).removed.empty());
    CHECK(remove_ended(placed.state, ReleaseState::withdrawn).kept.empty());  // had the state not been saved
}

TEST_CASE("what was changed, or is not of this terminal, stays and is told") {
    Placed placed;
    placed.recall(2);
    REQUIRE(write_file(placed.folder / "shoe.jc5", "changed by hand"));
    REQUIRE(write_file(placed.folder / "notes.txt", "mine"));
    const RecallReport report = remove_ended(placed.state, ReleaseState::withdrawn);
    CHECK(report.removed.size() == 2);
    REQUIRE(report.kept.size() == 2);
    CHECK(report.kept[0].path == (placed.folder / "shoe.jc5").string());
    CHECK_THAT(report.kept[0].message, Catch::Contains("withdrawn release 2") && Catch::Contains("differs"));
    CHECK_THAT(report.kept[1].message, Catch::Contains("was not put there by this terminal"));
    CHECK(read_file(placed.folder / "shoe.jc5").value() == "changed by hand");
    CHECK(read_file(placed.folder / "notes.txt").value() == "mine");
    REQUIRE(report.state.placed.size() == 1);
    CHECK(report.state.placed[0].files.size() == 1);  // told again until a person has looked
    CHECK(remove_ended(report.state, ReleaseState::withdrawn).kept.size() == 2);
}

TEST_CASE("nothing behind a link is removed") {
    Placed placed;
    placed.recall(2);
    fs::rename(placed.folder, placed.home.path / "elsewhere");
    fs::create_symlink(placed.home.path / "elsewhere", placed.folder);
    const RecallReport report = remove_ended(placed.state, ReleaseState::withdrawn);
    CHECK(report.removed.empty());
    REQUIRE(report.kept.size() == 1);
    CHECK_THAT(report.kept[0].message, Catch::Contains("is a link now"));
    CHECK(fs::exists(placed.home.path / "elsewhere" / "shoe.jc5"));
    CHECK(report.state.placed.size() == 1);
}

TEST_CASE("a recall finds what lies elsewhere, and does not forget what it cannot reach") {
    Placed placed;
    const fs::path other = placed.home.path / "other";
    const fs::path second = place_release(placed.state, placed.release, placed.state_file, other).value();
    CHECK(load_state(placed.state_file).value().placed.size() == 2);
    placed.recall(2);
    fs::rename(placed.releases, placed.home.path / "pulled out");
    const RecallReport report = remove_ended(placed.state, ReleaseState::withdrawn);
    CHECK(report.removed.size() == 3);
    CHECK_FALSE(fs::exists(second));
    REQUIRE(report.kept.size() == 1);
    CHECK(report.kept[0].path == placed.folder.string());
    CHECK_THAT(report.kept[0].message, Catch::Contains("cannot be looked at: there is no folder " + placed.releases.string()));
    REQUIRE(report.state.placed.size() == 1);
    fs::rename(placed.home.path / "pulled out", placed.releases);
    const RecallReport later = remove_ended(report.state, ReleaseState::withdrawn);
    CHECK(later.removed.size() == 3);
    CHECK(later.kept.empty());
    CHECK(later.state.placed.empty());
    CHECK_FALSE(fs::exists(placed.folder));
}

TEST_CASE("what this terminal did not put there is told") {
    const Placed placed;
    const auto told = [&](const TerminalState& before, const TerminalState& after) {
        return foreign_releases(before, after, placed.releases);
    };
    const TerminalState nothing = placed.site.terminal();
    CHECK(told(nothing, placed.state).empty());
    CHECK(told(placed.state, nothing).empty());  // it goes with this pull, or is told by that
    fs::create_directory(placed.releases / "notes");
    fs::create_directory(placed.releases / "release-9-abc");
    REQUIRE(told(placed.state, placed.state).size() == 1);
    CHECK(told(placed.state, placed.state)[0].path == (placed.releases / "release-9-abc").string());
    TerminalState elsewhere = placed.state;
    elsewhere.placed[0].within = placed.home.path / "elsewhere";
    CHECK(told(nothing, elsewhere).size() == 2);
    CHECK(foreign_releases(nothing, nothing, placed.home.path / "nowhere").empty());
}
