#include "site.hpp"

#include <catch2/catch.hpp>

#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using testing::check_forbidden;
using testing::check_forged;
using testing::check_refused;
using testing::Site;

namespace {

/// A terminal that took an index of two releases, the second of which a test may have signed as it likes.
struct Pull {
    Site site;
    std::string manifest = site.manifest(2);
    std::vector<PulledFile> files = Site::files(2);
    std::function<void(ReleaseIndex&)> in_index = [](ReleaseIndex&) {};

    [[nodiscard]] CheckedIndex checked() const {
        ReleaseIndex index = site.index_terms(10, 2, 0);
        index.releases[1].manifest_sha256 = sha256_hex(manifest);
        in_index(index);
        return check_index(site.terminal(), site.sign_index(index), Site::at(1), Site::consistent).value();
    }
    [[nodiscard]] Result<CheckedRelease> pull(std::uint64_t number = 2, int minutes = 2) const {
        return check_release(checked(), number, manifest, files, Site::at(minutes));
    }
    [[nodiscard]] Result<CheckedRelease> signed_by(const std::vector<const KeyPair*>& keys) {
        manifest = Site::sign_manifest(Site::manifest_terms(2), keys);
        return pull();
    }
    /// A manifest that two people did sign.
    [[nodiscard]] Result<CheckedRelease> terms(const std::function<void(ReleaseManifest&)>& change) {
        ReleaseManifest made = Site::manifest_terms(2);
        change(made);
        manifest = Site::sign_manifest(made, {&site.anna, &site.carl});
        return pull();
    }
};

}  // namespace

TEST_CASE("a release whose every byte is right is taken") {
    Pull pull;
    const CheckedRelease release = pull.pull().value();
    CHECK(release.manifest.release == 2);
    CHECK(release.manifest.design == "shoe");
    CHECK(release.manifest.profile_version == 2);
    CHECK(release.manifest.reading == Json({{"lifted_bit", 1}}));
    CHECK(canonical_json(manifest_body(release.manifest)) == canonical_json(release.manifest.document.body));
    CHECK(release.files.size() == 3);
    CHECK(release.files.back().path == "manifest.json");
    CHECK(release.folder == "release-2-" + sha256_hex(pull.manifest).substr(0, 12));
    CHECK(pull.signed_by({&pull.site.anna, &pull.site.ben, &pull.site.carl}));
}

TEST_CASE("a manifest stands on enough different people with a release key") {
    Pull pull;
    const Site& site = pull.site;
    check_forged(pull.signed_by({&site.anna}), "this must be signed by 2 different people, and by 1 is");
    check_forged(pull.signed_by({&site.anna, &site.thief}), "unknown or revoked");
    check_forged(pull.signed_by({&site.anna, &site.stamp}), "does not have the role release");
    check_forged(pull.signed_by({&site.anna, &site.carl, &site.log}), "does not have the role release");
    SignedDocument twice{manifest_body(Site::manifest_terms(2)), {}};
    const Signature anna = sign_body(site.anna, Purpose::release_manifest, twice.body);
    twice.signatures = {anna, anna};
    pull.manifest = write_signed(twice);
    check_forged(pull.pull(), "a key counts once");
    twice.signatures = {anna, sign_body(site.carl, Purpose::statement, twice.body)};
    pull.manifest = write_signed(twice);
    check_forged(pull.pull(), "forged or altered");
}

TEST_CASE("a key that lost its role releases nothing; signed again by others, the release stands") {
    Pull pull;
    Site& site = pull.site;
    TrustDocument terms = site.trust_terms(2);
    terms.keys[2].roles = {Role::evidence};  // Carl's key
    const std::vector<std::string> documents{Site::sign_trust(terms, {&site.anna, &site.ben})};
    const auto judged = [&](const std::string& manifest) {
        CheckedIndex checked = pull.checked();
        checked.state = adopt_trust(checked.state, documents).value();
        checked.index.releases[1].manifest_sha256 = sha256_hex(manifest);
        return check_release(checked, 2, manifest, pull.files, Site::at(2));
    };
    check_forged(judged(pull.manifest), "of carl, which does not have the role release");
    CHECK(judged(Site::sign_manifest(Site::manifest_terms(2), {&site.anna, &site.ben})));
}

TEST_CASE("a key that was revoked releases nothing") {
    Pull pull;
    TrustDocument terms = pull.site.trust_terms(2);
    terms.keys.erase(terms.keys.begin() + 2);
    const std::vector<std::string> documents{Site::sign_trust(terms, {&pull.site.anna, &pull.site.ben})};
    CheckedIndex checked = pull.checked();
    checked.state = adopt_trust(checked.state, documents).value();
    check_forged(check_release(checked, 2, pull.manifest, pull.files, Site::at(2)),
                 "which trust document 2 does not know: unknown or revoked");
}

TEST_CASE("what is not released, superseded or withdrawn cannot be pulled") {
    Pull pull;
    check_forbidden(pull.pull(3), "release 3 is not released for the loom 'loom 7'");
    check_forbidden(pull.pull(0), "is not released");
    pull.in_index = [](ReleaseIndex& index) { index.releases[1].state = ReleaseState::withdrawn; };
    check_forbidden(pull.pull(), "was withdrawn: it must not be woven");
    pull.in_index = [](ReleaseIndex& index) { index.releases[1].state = ReleaseState::superseded; };
    check_forbidden(pull.pull(), "was superseded by a newer one");
}

TEST_CASE("an index that ran out since it was checked releases nothing") {
    const Pull pull;
    CHECK(pull.pull(2, 59));
    check_forbidden(pull.pull(2, 60), "the index does not hold any more");
    check_forbidden(pull.pull(2, -6), "the index does not hold any more");
}

TEST_CASE("mix and match: manifest or file of another release") {
    Pull pull;
    const std::string right = pull.manifest;
    const auto other = check_release(pull.checked(), 2, pull.site.manifest(1), Site::files(1), Site::at(2));
    check_refused(other, "is not the one that the index lists for release 2");
    pull.manifest = pull.site.manifest(1);  // the index itself lists the wrong one
    check_refused(pull.pull(), "is of release 1, not of release 2");
    check_refused(pull.terms([](auto& m) { m.revision_sha256 = Site::revision(1); }),
                  "is of another revision");
    pull.manifest = right;
    pull.files[0] = Site::files(1)[0];
    check_refused(pull.pull(), "shoe.jc5: is not the file that was signed: altered, or of another release");
}

TEST_CASE("a release for another loom or site is refused") {
    Pull pull;
    check_refused(pull.terms([](auto& m) { m.loom = "loom 8"; }), "to the loom 'loom 8', not to 'loom 7'");
    check_refused(pull.terms([](auto& m) { m.site = "other mill"; }),
                  "is a release of the site 'other mill'");
}

TEST_CASE("files that are missing, too many, cut or altered are refused by name") {
    Pull pull;
    const auto sound = pull.files;
    pull.files.pop_back();
    check_forged(pull.pull(), "shoe-picks.csv: is missing");
    pull.files = sound;
    pull.files.push_back({"extra.jc5", "x"});
    check_forged(pull.pull(), "extra.jc5: came with the release but does not belong to it");
    pull.files.back().path = "manifest.json";
    check_forged(pull.pull(), "manifest.json: came with the release");
    pull.files.back() = sound[0];
    check_forged(pull.pull(), "came twice");
    pull.files = sound;
    pull.files[0].bytes.pop_back();
    check_forged(pull.pull(), "cut, or of another release");
    pull.files = sound;
    pull.files[1].bytes[3] ^= 1;
    check_forged(pull.pull(), "shoe-picks.csv: is not the file that was signed");
    pull.files = sound;
    pull.files[1].path = "SHOE-PICKS.CSV";
    check_forged(pull.pull(), "is missing");
}

TEST_CASE("another content under a number that was seen is refused, the same signed by others is not") {
    Pull pull;
    CheckedIndex checked = pull.checked();
    checked.state.releases[1].body_sha256 = sha256_hex("something else");
    check_forbidden(check_release(checked, 2, pull.manifest, pull.files, Site::at(2)),
                    "says other things than the manifest of release 2");
    checked.state.releases[1].body_sha256 =
        sha256_hex(canonical_json(manifest_body(Site::manifest_terms(2))));
    CHECK(check_release(checked, 2, pull.manifest, pull.files, Site::at(2)));
    const std::string again = Site::sign_manifest(Site::manifest_terms(2), {&pull.site.ben, &pull.site.carl});
    checked.index.releases[1].manifest_sha256 = sha256_hex(again);
    CHECK(check_release(checked, 2, again, pull.files, Site::at(2)));
}

TEST_CASE("no file name of a manifest leads anywhere, though people signed it") {
    Pull pull;
    for (const char* path : {"../shoe.jc5", "/etc/cron.d/x", "a/b", "..", ".", "", "a\\b", "CON", "shoe.",
                             "a\nb", ".profile", "manifest.json", "Manifest.JSON", "SHOE-picks.csv"}) {
        INFO(path);
        const auto taken = pull.terms([&](auto& m) { m.files[0].path = path; });
        REQUIRE_FALSE(taken);
        CHECK_THAT(taken.error().text(), Catch::StartsWith("manifest.body.files["));
        CHECK(taken.error().text().find('\n') == std::string::npos);
    }
    CHECK_FALSE(pull.terms([&](auto& m) { m.files[0].path = std::string("shoe\0.jc5", 9); }));
}

TEST_CASE("a manifest in bad form is refused with its place") {
    Pull pull;
    const auto body = [&](const std::function<void(Json&)>& change) {
        Json json = manifest_body(Site::manifest_terms(2));
        change(json);
        pull.manifest = Site::sign(Purpose::release_manifest, json, {&pull.site.anna, &pull.site.carl});
        return pull.pull();
    };
    REQUIRE(body([](Json&) {}));
    check_forged(body([](Json& j) { j["version"] = 2; }), "newer than this program");
    check_forged(body([](Json& j) { j["format"] = "weave-export"; }), "must be weave-release");
    check_forged(body([](Json& j) { j["more"] = 1; }), "is not known here");
    check_forged(body([](Json& j) { j["files"] = Json::array(); }), "1 to 64 files");
    check_forged(body([](Json& j) { j["files"][0]["size"] = most_release_bytes + 1; }), "body.files[0].size");
    check_forged(body([](Json& j) { j["files"][0]["size"] = j["files"][1]["size"] = most_release_bytes; }),
                 "makes the release larger");
    check_forged(body([](Json& j) { j["files"][0]["sha256"] = "AB"; }), "lower-case hexadecimal");
    check_forged(body([](Json& j) { j["reading"] = 1; }), "reading: must be an object");
    check_forged(body([](Json& j) { j["feeders"] = 1; }), "feeders: must be a list");
    check_forged(body([](Json& j) { j["picks"] = 0; }), "body.picks");
    pull.manifest = std::string(most_manifest_bytes + 1, ' ');
    check_forged(pull.pull(), "is too large");
}

TEST_CASE("a flipped bit anywhere in a release is refused") {
    const Pull pull;
    const CheckedIndex checked = pull.checked();
    testing::for_all(
        [&](testing::Random& random) {
            std::string manifest = pull.manifest;
            auto files = pull.files;
            std::string* const parts[] = {&manifest, &files[0].bytes, &files[1].bytes};
            std::string& part = *parts[random.between(0, 2)];
            const std::size_t at = random.between(0, part.size() - 1);
            part[at] = static_cast<char>(part[at] ^ (1 << random.between(0, 7)));
            REQUIRE_FALSE(check_release(checked, 2, manifest, files, Site::at(2)));
            CheckedIndex careless = checked;  // whose index lists whatever came: the signatures still find it
            careless.index.releases[1].manifest_sha256 = sha256_hex(manifest);
            REQUIRE_FALSE(check_release(careless, 2, manifest, files, Site::at(2)));
        },
        testing::property_cases() / 10);
}
