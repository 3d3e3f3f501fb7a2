// The package of a release: its files, what the manifest says of them, and that nothing unproved leaves it.

#include "export_case.hpp"
#include "site.hpp"

#include <weave/core/sha256.hpp>
#include <weave/design/document.hpp>
#include <weave/io/bitmap.hpp>
#include <weave/io/wif.hpp>

#include <algorithm>
#include <loomlink/export/read_back.hpp>
#include <loomlink/export/signed_manifest.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::testing;

namespace {

LoomProfile shipped(const std::string& name) {
    return load_profile(std::string(WEAVE_SOURCE_DIR) + "/db/looms/" + name + ".json").value();
}

const CardImage twill = card_of({"XX..XX..", ".XX..XX.", "..XX..XX", "X..XX..X"});

Result<ReleasePackage> package_of(const Design& design, const LoomProfile& profile,
                                  const std::set<ExtraFile>& extras = {},
                                  const FeederMap& map = straight_map(1)) {
    const Evaluation cloth = Evaluator().evaluate(design).value();
    return make_release_package(design, cloth, profile, map, {"my twill", {"TWILL-2-2", "by hand"}}, extras);
}

std::vector<std::string> paths(const ReleasePackage& package) {
    std::vector<std::string> found;
    for (const PackageFile& file : package.files) found.push_back(file.path);
    return found;
}

/// What holds for the manifest of every package.
void check_manifest(const ReleasePackage& package, const Design& design, const LoomProfile& profile) {
    const Json& said = package.manifest;
    CHECK(said.at("design_sha256") == design_sha256(design));
    CHECK(said.at("scene_sha256") == scene_sha256(design));
    CHECK(said.at("card_sha256") == twill.sha256());
    CHECK(said.at("picks") == 4);
    CHECK(said.at("ends") == 8);
    CHECK(said.at("certified") == false);
    CHECK(said.at("label") == "layout-compatible with observed files, not certified by the maker");
    CHECK(said.at("loom").at("sha256") == profile.sha256);
    REQUIRE(said.at("files").size() == package.files.size());
    for (std::size_t k = 0; k < package.files.size(); ++k) {
        const Json& entry = said.at("files")[k];
        CHECK(entry.at("path") == package.files[k].path);
        CHECK(entry.at("size") == package.files[k].bytes.size());
        CHECK(entry.at("sha256") == sha256_hex(package.files[k].bytes));
        CHECK(entry.at("format") == package.files[k].format);
        CHECK(entry.at("certified") == false);
        CHECK(entry.at("label") == said.at("label"));
    }
}

/// Whatever the order of their members.
bool same(const Json& a, const Json& b) {
    return canonical_json(a) == canonical_json(b);
}

}  // namespace

TEST_CASE("a package for each shipped loom: files, hashes and what they say of themselves") {
    const Design design = design_of(twill, {1}, 1);
    for (const std::string name : {"ep-2688", "ep-5376", "jc5-5120", "raw-14x192"}) {
        INFO(name);
        const LoomProfile profile = shipped(name);
        const auto package = package_of(design, profile);
        REQUIRE(package);
        check_manifest(*package, design, profile);
        const std::string format = name.substr(0, name.find('-'));
        CHECK(paths(*package) ==
              std::vector<std::string>{"my-twill." + format, "my-twill-picks.csv", "my-twill-card.png"});
        const Json& file = package->manifest.at("files")[0];
        CHECK(file.at("reading").at("lifted_hook_bit") == (name == "raw-14x192" ? 0 : 1));
        CHECK(file.at("reading").at("cast_out_hook_bit") == (name == "raw-14x192" ? 1 : 0));
        CHECK(file.at("reading").at("pick_1_record") == 0);
        CHECK(file.at("reading").at("seen_from") == "face");
        CHECK(file.at("reading").at("end_1_hooks") == hooks_of_end(profile, 0, 8));
        CHECK(package->manifest.at("hooks").at("body").size() == 1);
        CHECK(package->notes.size() == (format == "raw" ? 0 : 1));
        if (format == "raw") continue;
        CHECK(file.at("name_in_file") == "TWILL-2-");
        CHECK(file.at("name_cut") == true);
        CHECK(package->notes.front() == "the name 'TWILL-2-2' is cut to 'TWILL-2-' in the file");
        CHECK_FALSE(file.at("unknown_fields").empty());
    }
}

TEST_CASE("the EP's manifest names every hook's use, castouts counted from 0") {
    const auto package = package_of(design_of(twill, {1}, 1), shipped("ep-2688"));
    REQUIRE(package);
    const Json& hooks = package->manifest.at("hooks");
    CHECK(hooks.at("body") == Json::parse("[[144,2543]]"));
    CHECK(hooks.at("selvedge") == Json::parse("[[56,139],[2548,2631]]"));
    CHECK(hooks.at("constant_on") == Json::parse("[[54,55]]"));
    CHECK(hooks.at("cast_out") == Json::parse("[[0,53],[140,143],[2544,2547],[2632,2687]]"));
    CHECK(hooks.at("counted_from") == 0);
    const Json& feeders = package->manifest.at("feeders");
    CHECK(feeders.at("encoding") == "one-hot");
    CHECK(feeders.at("map") ==
          Json::parse(R"([{"design_feeder":1,"name":"feeder 1","yarn":"yarn 1","loom_feeder":1}])"));
}

TEST_CASE("the TC2 takes the bilevel TIFF as observed, whose pixels are the card") {
    const LoomProfile profile = shipped("tc2");
    const Design design = design_of(twill, {1}, 1);
    const auto package = package_of(design, profile);
    REQUIRE(package);
    check_manifest(*package, design, profile);
    CHECK(paths(*package) == std::vector<std::string>{"my-twill-card.tif", "my-twill-picks.csv"});
    CHECK(package->manifest.at("conversion").is_null());
    const Json& reading = package->manifest.at("files")[0].at("reading");
    CHECK(reading.at("lifted_end") == "black");
    CHECK(reading.at("pick_1") == "bottom row");
    CHECK(reading.at("end_1") == "left column");
    const std::string& tiff = package->files[0].bytes;
    CHECK(tiff.substr(0, 4) == bytes_of("49 49 2A 00"));
    // Bottom row first: 1 = black = lifted, so pick 4 is the first byte of the strip.
    CHECK(tiff.find(bytes_of("99 33 66 CC")) != std::string::npos);
    CHECK(read_bitmap(tiff)->card == twill);
}

TEST_CASE("a picture stands as the profile says, in all eight ways") {
    const Design design = design_of(twill, {1}, 1);
    for (int way = 0; way < 8; ++way) {
        LoomProfile profile = shipped("tc2");
        profile.output = OutputFormat::png;
        profile.pick_1_at_bottom = way % 2 == 0;
        profile.end_1_at_left = way / 2 % 2 == 0;
        profile.lifted_is_one = way / 4 == 0;
        const auto package = package_of(design, profile);
        REQUIRE(package);
        const BitmapReading reading{way % 2 == 0, way / 2 % 2 == 0, way / 4 == 0};
        CHECK(read_bitmap(package->files[0].bytes, reading)->card == twill);
        const Json& said = package->manifest.at("files")[0].at("reading");
        CHECK(said.at("lifted_end") == (way / 4 == 0 ? "black" : "white"));
        CHECK(said.at("pick_1") == (way % 2 == 0 ? "bottom row" : "top row"));
        CHECK(said.at("end_1") == (way / 2 % 2 == 0 ? "left column" : "right column"));
    }
}

TEST_CASE(
    "a format without public bytes: the bitmap and the pick table, and words that the mill's CAD must "
    "convert") {
    LoomProfile profile = shipped("tc2");
    profile.converts_to = "JC6";
    const auto package = package_of(design_of(twill, {1}, 1), profile);
    REQUIRE(package);
    CHECK(package->files.size() == 2);
    CHECK(package->manifest.at("conversion").at("to") == "JC6");
    REQUIRE(package->notes.size() == 1);
    CHECK(package->notes[0].find("No bytes of JC6 are public") != std::string::npos);
    CHECK(package->notes[0].find("CAD must convert") != std::string::npos);
    CHECK(package->manifest.at("files")[0].at("for") == "the mill's CAD");
}

TEST_CASE("extra files on request, none twice, each the card") {
    const auto package = package_of(design_of(twill, {1}, 1), shipped("ep-2688"),
                                    {ExtraFile::png, ExtraFile::tiff, ExtraFile::bmp, ExtraFile::wif});
    REQUIRE(package);
    CHECK(paths(*package) == std::vector<std::string>{"my-twill.ep", "my-twill-picks.csv",
                                                      "my-twill-card.png", "my-twill-card.tif",
                                                      "my-twill-card.bmp", "my-twill.wif"});
    for (std::size_t k = 2; k < 5; ++k) CHECK(read_bitmap(package->files[k].bytes)->card == twill);
    CHECK(is_wif(package->files[5].bytes));
    const std::string& bmp = package->files[4].bytes;
    CHECK(static_cast<unsigned char>(bmp[10]) == 62);
}

TEST_CASE("the pick table tells the loom's feeders, and foreign names cannot break it") {
    Design design = design_of(twill, {1, 2, 0, 3}, 3);
    design.weft.feeders[1].name = "red, \"thin\"\r\nand more";
    design.weft.yarns[2].name = "=1+1";
    const auto package = package_of(design, shipped("ep-2688"), {}, {{0, 5}, {1, 0}, {2, 1}});
    REQUIRE(package);
    const std::string& csv = package->files[1].bytes;
    CHECK(csv.rfind("pick,row,feeder,feeder name,direction,take-up,yarn,colour,loom feeder\r\n", 0) == 0);
    CHECK(csv.find("\r\n1,1,1,feeder 1,left to right,yes,yarn 1,") != std::string::npos);
    CHECK(csv.find(",6\r\n2,2,2,\"red, \"\"thin\"\"\r\nand more\",") != std::string::npos);
    CHECK(csv.find("\r\n3,3,,,,yes,,,\r\n") != std::string::npos);
    const Json& map = package->manifest.at("feeders").at("map");
    CHECK(map[0].at("loom_feeder") == 6);
    CHECK(map[1].at("loom_feeder") == 1);
}

TEST_CASE(
    "a file that does not read back as it was meant is a fault of the system, which names what differs") {
    const Design design = design_of(twill, {1}, 1);
    const LoomProfile profile = shipped("ep-2688");
    const HookPlan plan = plan_of(design, profile, straight_map(1)).value();
    const WrittenFile file = write_controller_file(plan, profile, {"TWILL", ""}).value();
    const DecodedFile honest = decode_controller_file(file.bytes, profile, 8).value();
    CHECK(check_decoded(honest, file.names, plan, twill, profile));
    const auto with = [&](const auto& spoil) {
        DecodedFile lie = honest;
        spoil(lie);
        return check_decoded(lie, file.names, plan, twill, profile);
    };
    expect_refusal(with([](DecodedFile& read) { read.card.set(2, 5, !read.card.weft_over(2, 5)); }),
                   "the card image");
    expect_refusal(with([](DecodedFile& read) { read.lifts.lift(3, 0); }), "hook 1 in record 4");
    expect_refusal(with([](DecodedFile& read) { read.lifts = LiftTable(4, 2680); }), "the size");
    expect_refusal(with([](DecodedFile& read) { read.feeders[1] = {1}; }), "the feeder of pick 2");
    expect_refusal(with([](DecodedFile& read) { read.feeders.pop_back(); }), "the number of picks");
    expect_refusal(with([](DecodedFile& read) { read.names.name = "OTHER"; }), "the name");
    expect_refusal(with([](DecodedFile& read) { read.names.comment = "more"; }), "the comment");
    expect_refusal(with([](DecodedFile& read) { read.oddities = {"byte 7: is odd"}; }), "byte 7: is odd");
    const Status torn = check_controller_file(file.bytes.substr(0, 5000), file.names, plan, twill, profile);
    expect_refusal(torn, "byte 5000");
    CHECK(torn.error().code == ErrorCode::system);
    std::string odd = file.bytes;
    odd[20] = 7;
    expect_refusal(check_controller_file(odd, file.names, plan, twill, profile), "byte 20: is 07");
}

TEST_CASE("what came of reading back is told to the check of the design, before anybody releases") {
    const Design design = design_of(twill, {1}, 1);
    const Evaluation cloth = Evaluator().evaluate(design).value();
    using Outcome = ReadBack::Outcome;
    const LoomProfile ep = shipped("ep-2688");
    CHECK(read_back(design, cloth, ep, straight_map(1), {"N", ""}).outcome == Outcome::equal);
    const ReadBack unmapped = read_back(design, cloth, ep, {}, {"N", ""});
    CHECK(unmapped.outcome == Outcome::no_file);
    CHECK(unmapped.words.find("mapped to no") != std::string::npos);
    CHECK(read_back(design, cloth, ep, straight_map(1), {"", ""}).outcome == Outcome::no_file);
    CHECK(read_back(design, cloth, shipped("tc2"), straight_map(1), {"N", ""}).outcome == Outcome::no_file);
    const CheckReport report =
        check_for_loom(design, cloth, ep, {}, read_back(design, cloth, ep, straight_map(1), {"N", ""}));
    CHECK(std::count(report.passed.begin(), report.passed.end(), "hooks.read-back") == 1);
}

TEST_CASE("the manifest that people sign has all that the package says, and opens again") {
    const Site site;
    Design design = design_of(twill, {1, 2}, 2);
    for (const std::string name : {"ep-2688", "jc5-5120", "raw-14x192", "tc2"}) {
        INFO(name);
        const LoomProfile profile = shipped(name);
        const bool single = profile.feeders < 2;
        const auto package = package_of(single ? design_of(twill, {1}, 1) : design, profile, {ExtraFile::wif},
                                        straight_map(single ? 1 : 2));
        INFO((package ? "" : package.error().text()));
        REQUIRE(package);
        const auto made = manifest_of(*package, Site::manifest_terms(3));
        REQUIRE(made);
        const auto opened = open_manifest(Site::sign_manifest(*made, {&site.anna, &site.carl}), site.trust());
        INFO((opened ? "" : opened.error().text()));
        REQUIRE(opened);
        CHECK(opened->release == 3);
        CHECK(opened->loom == Site::loom);
        CHECK(opened->revision_sha256 == Site::revision(3));
        CHECK(opened->card_sha256 == twill.sha256());
        CHECK(opened->profile_name == profile.name);
        CHECK(opened->profile_sha256 == profile.sha256);
        CHECK(opened->picks == 4);
        CHECK(opened->ends == 8);
        CHECK(same(opened->feeders, package->manifest.at("feeders").at("map")));
        CHECK(opened->reading.at("feeders").at("encoding") == package->manifest.at("feeders").at("encoding"));
        CHECK(same(opened->reading.at("hooks"), package->manifest.at("hooks")));
        REQUIRE(opened->files.size() == package->files.size());
        for (std::size_t k = 0; k < package->files.size(); ++k) {
            const PackageFile& file = package->files[k];
            CHECK(opened->files[k].path == file.path);
            CHECK(opened->files[k].size == file.bytes.size());
            CHECK(opened->files[k].sha256 == sha256_hex(file.bytes));
            CHECK_FALSE(opened->files[k].certified);
            Json said = opened->reading.at("files").at(file.path);
            CHECK(said.at("read_back") == "equal");
            for (const auto& [member, value] : said.items())
                CHECK(same(package->manifest.at("files")[k].at(member), value));
        }
    }
}

TEST_CASE("a manifest that no terminal would take is refused before anybody signs it") {
    const auto package = package_of(design_of(twill, {1}, 1), shipped("ep-2688"));
    REQUIRE(package);
    const auto with = [&](const auto& spoil) {
        ReleasePackage spoilt = *package;
        spoil(spoilt.manifest);
        return manifest_of(spoilt, Site::manifest_terms(1));
    };
    CHECK(with([](Json&) {}));
    expect_refusal(with([](Json& said) { said["files"][0]["path"] = "CON.ep"; }), "CON.ep");
    expect_refusal(with([](Json& said) { said["files"][0]["path"] = said["files"][1]["path"]; }),
                   "stands twice");
    expect_refusal(with([](Json& said) { said["files"][0]["path"] = "Manifest.json"; }), "stands twice");
    expect_refusal(with([](Json& said) { said["files"][0]["size"] = std::uint64_t{1} << 40; }), "bytes");
    expect_refusal(with([](Json& said) { said["title"] = std::string(1 << 20, 't'); }), "can be read again");
}

TEST_CASE("a pick table or WIF that differs anywhere is found") {
    const Design design = design_of(twill, {1, 2}, 2);
    const Evaluation cloth = Evaluator().evaluate(design).value();
    const auto picks = pick_table(design, *cloth.block);
    const FeederMap map{{0, 1}, {1, 0}};
    const std::string csv = pick_table_csv(design, picks, &map);
    CHECK(check_pick_table(csv, picks, map));
    CHECK_FALSE(check_pick_table(csv, picks, straight_map(2)));
    CHECK_FALSE(check_pick_table(csv + "5,", picks, map));
    CHECK_FALSE(check_pick_table(csv.substr(0, csv.size() - 2), picks, map));
    CHECK_FALSE(check_pick_table(pick_table_csv(design, picks), picks, map));
    CHECK_FALSE(check_pick_table("", picks, map));
    auto other = picks;
    other[1].take_up = !other[1].take_up;
    CHECK_FALSE(check_pick_table(csv, other, map));
    other = picks;
    REQUIRE(picks[3].direction == Direction::right_to_left);
    other[3].direction = Direction::left_to_right;
    CHECK_FALSE(check_pick_table(csv, other, map));
    const std::string wif = write_wif(design, *cloth.block, twill).value();
    CHECK(check_wif(wif, twill, picks));
    CHECK_FALSE(check_wif(wif, card_of({"X"}), picks));
    other[0].feeders = {1};
    CHECK_FALSE(check_wif(wif, twill, other));
    CHECK_FALSE(check_wif("[WIF]", twill, picks));
}

TEST_CASE("a feeder map that names what is not there, and names that a file cannot hold, are refused") {
    const Design design = design_of(twill, {1}, 1);
    const LoomProfile profile = shipped("ep-2688");
    expect_refusal(package_of(design, profile, {}, {{0, 0}, {7, 1}}), "feeder 8");
    expect_refusal(package_of(design, profile, {}, {{0, 6}}), "feeder 7");
    expect_refusal(package_of(design, profile, {}, {}), "mapped to no");
    const Evaluation cloth = Evaluator().evaluate(design).value();
    expect_refusal(make_release_package(design, cloth, profile, straight_map(1), {"x", {" ", ""}}, {}),
                   "needs a name that starts");
}
