// `check` and `export`: a design held to a loom.

#include "run.hpp"

#include <weave/block/card_image.hpp>
#include <weave/core/sha256.hpp>
#include <weave/io/bitmap.hpp>

#include <algorithm>

using program_tests::loom;
using program_tests::Workshop;
using weave::CardImage;
using weave::Json;

namespace {

/// Imports a card as a design. Rows of text from the top, X = end lifted.
void weave_card(const Workshop& shop, const std::string& file, const std::vector<std::string>& rows) {
    CardImage card(rows.size(), rows[0].size());
    for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < rows[0].size(); ++j) card.set(i, j, rows[rows.size() - 1 - i][j] != 'X');
    shop.put("by-hand.png", *weave::write_bitmap(card, weave::BitmapFormat::png));
    shop.must({"import", "by-hand.png", "-o", file});
}

/// A profile like the shipped one, with one rule judged otherwise.
void put_profile(const Workshop& shop, const std::string& file, const std::string& rule,
                 const std::string& severity) {
    Json profile = *weave::parse_json(*weave::read_file(loom("tc2")));
    profile["severities"][rule] = severity;
    shop.put(file, profile.dump());
}

void check_findings(const Json& report) {
    std::size_t errors = 0, warnings = 0;
    for (const Json& finding : report.at("findings")) {
        CHECK(finding.at("rule").is_string());
        CHECK(!finding.at("message").get<std::string>().empty());
        const std::string severity = finding.at("severity");
        errors += severity == "error" ? 1U : 0U;
        warnings += severity == "warning" ? 1U : 0U;
        for (const char* key : {"pick", "end"}) {
            const Json& number = finding.at(key);
            CHECK((number.is_null() || (number.is_number_unsigned() && number >= 1)));
        }
    }
    CHECK(report.at("errors") == errors);
    CHECK(report.at("warnings") == warnings);
    CHECK(report.at("not_evaluated").is_number_unsigned());
    CHECK(report.at("not_evaluated") == report.at("not_evaluated_rules").size());
}

std::vector<Json> of_rule(const Json& report, const std::string& rule) {
    std::vector<Json> found;
    for (const Json& finding : report.at("findings"))
        if (finding.at("rule") == rule) found.push_back(finding);
    return found;
}

}  // namespace

TEST_CASE("every sample validates on the loom that it names") {
    const Workshop shop;
    const Json samples = shop.json({"samples"}).at("samples");
    REQUIRE(samples.size() >= 18);
    for (const Json& sample : samples) {
        INFO(sample.at("name"));
        shop.must({"samples", sample.at("name"), "-o", "s.weave"});
        const Json report = shop.json({"check", "s.weave", "--loom", loom(sample.at("loom"))});
        check_findings(report);
        CHECK(report.at("errors") == 0);
    }
}

TEST_CASE("an end that never binds is found at its number, and the exit status goes by severity") {
    const Workshop shop;
    weave_card(shop, "loose.weave", {"X.X.", ".XXX", "X.X.", ".XXX"});
    for (const std::string severity : {"error", "warning", "info"}) {
        INFO(severity);
        put_profile(shop, "p.json", "bind.end", severity);
        const bool error = severity == "error";
        const Json report = shop.json({"check", "loose.weave", "--loom", "p.json"}, error ? 1 : 0);
        check_findings(report);
        const std::vector<Json> found = of_rule(report, "bind.end");
        REQUIRE(found.size() == 1);
        CHECK(found[0].at("end") == 3);
        CHECK(found[0].at("pick").is_null());
        CHECK(found[0].at("severity") == severity);
        CHECK(found[0].at("message").get<std::string>().find("end 3") != std::string::npos);
    }
    put_profile(shop, "p.json", "bind.end", "off");
    const Json off = shop.json({"check", "loose.weave", "--loom", "p.json"});
    CHECK(of_rule(off, "bind.end").empty());
    const Json& missing = off.at("not_evaluated_rules");
    CHECK(std::any_of(missing.begin(), missing.end(),
                      [](const Json& rule) { return rule.at("rule") == "bind.end"; }));
}

TEST_CASE("a float that is too long is found, and one as long as allowed is not") {
    const Workshop shop;
    put_profile(shop, "p.json", "float.face", "error");
    shop.must({"preset", "satin", "size=14", "-o", "at-limit.weave"});
    CHECK(of_rule(shop.json({"check", "at-limit.weave", "--loom", "p.json"}), "float.face").empty());
    shop.must({"preset", "satin", "size=15", "-o", "long.weave"});
    const Json report = shop.json({"check", "long.weave", "--loom", "p.json"}, 1);
    check_findings(report);
    const std::vector<Json> found = of_rule(report, "float.face");
    REQUIRE(found.size() == 15);  // each end floats over 14 picks
    std::set<std::size_t> ends;
    for (const Json& finding : found) {
        CHECK(finding.at("severity") == "error");
        CHECK(finding.at("message").get<std::string>().find("14") != std::string::npos);
        ends.insert(finding.at("end").get<std::size_t>());
    }
    CHECK(ends.size() == 15);
    CHECK(*ends.begin() == 1);
    CHECK(*ends.rbegin() == 15);
}

TEST_CASE("check in words says the same, and names the loom") {
    const Workshop shop;
    weave_card(shop, "loose.weave", {"X.X.", ".XXX", "X.X.", ".XXX"});
    put_profile(shop, "p.json", "bind.end", "error");
    const program_tests::Ended ended = shop.run({"check", "loose.weave", "--loom", "p.json"});
    CHECK(ended.exit == 1);
    CHECK(ended.err.empty());
    CHECK(ended.out.find("error  bind.end  ") != std::string::npos);
    CHECK(ended.out.find("end 3") != std::string::npos);
    CHECK(ended.out.find("On TC2, 1320 ends: ") != std::string::npos);
    CHECK(ended.out.find("not evaluated") != std::string::npos);
}

TEST_CASE("export writes card, pick table and manifest, and what the manifest says is so") {
    const Workshop shop;
    shop.must({"samples", "twill-2-2", "-o", "my twill.weave"});
    for (const std::string name : {"tc2", "ep-2688", "jc5-5120"}) {
        INFO(name);
        const Json answer = shop.json({"export", "my twill.weave", "--loom", loom(name), "-o", name});
        CHECK(answer.at("certified") == false);
        CHECK(answer.at("released") == false);
        REQUIRE(answer.at("files").size() == 3);
        std::string card, manifest;
        for (const Json& file : answer.at("files")) {
            const std::string path = file.at("path");
            CHECK(path.rfind(name + "/my-twill-SAMPLE-NOT-RELEASED", 0) == 0);
            CHECK(file.at("sha256") == weave::sha256_hex(shop.get(path)));
            CHECK(file.at("format").is_string());
            if (path.find("-card.") != std::string::npos) card = path;
            if (path.find("-manifest.json") != std::string::npos) manifest = path;
        }
        const Json said = *weave::parse_json(shop.get(manifest));
        CHECK(said.at("status") == "SAMPLE, NOT RELEASED");
        CHECK(said.at("released") == false);
        CHECK(said.at("certified") == false);
        const Json info = shop.json({"info", "my twill.weave"});
        for (const char* key : {"card_sha256", "design_sha256", "picks", "ends"}) {
            INFO(key);
            CHECK(said.at(key) == info.at(key));
        }
        const bool tiff = name == "tc2";
        CHECK(said.at("card") == Json{{"lifted_end", "black"},
                                      {"weft_over_warp", "white"},
                                      {"pick_1", "bottom row"},
                                      {"end_1", "left column"},
                                      {"bit_order", "most significant bit first"},
                                      {"stored_bit_of_black", tiff ? 1 : 0},
                                      {"seen_from", "face"}});
        CHECK(said.at("format") == "weave-export");
        CHECK(said.at("version") == 1);
        CHECK(said.at("read_back") == "equal");
        CHECK(said.at("title") == info.at("title"));
        CHECK(said.at("scene_sha256") == info.at("scene_sha256"));
        const std::string profile = *weave::read_file(loom(name));
        CHECK(said.at("loom").at("name") == weave::parse_json(profile)->at("name"));
        CHECK(said.at("loom").at("maker") == weave::parse_json(profile)->at("maker"));
        CHECK(said.at("loom").at("revision") == weave::parse_json(profile)->at("revision"));
        CHECK_FALSE(said.at("loom").contains("version"));
        CHECK(said.at("loom").at("sha256") ==
              weave::sha256_hex(weave::canonical_json(*weave::parse_json(profile))));
        CHECK(said.at("files")[0].at("format") == (tiff ? "tiff" : "png"));
        CHECK(said.at("files")[1].at("format") == "pick-table-csv");
        for (const Json& file : said.at("files"))
            CHECK(file.at("bytes") == shop.get(name + "/" + file.at("path").get<std::string>()).size());
        for (const Json& file : said.at("files"))
            CHECK(file.at("sha256") ==
                  weave::sha256_hex(shop.get(name + "/" + file.at("path").get<std::string>())));
        CHECK(weave::read_bitmap(shop.get(card))->card.sha256() == info.at("card_sha256"));
    }
    CHECK(shop.names().size() == 1 + 3 * 4);  // the design, and three folders of three files; nothing else
}

TEST_CASE("the manifest says how the card stands, whichever way the loom wants it") {
    const Workshop shop;
    shop.must({"preset", "twill", "up=3", "down=1", "-o", "t.weave"});
    const std::string hash = shop.json({"info", "t.weave"}).at("card_sha256");
    for (const bool bottom : {false, true})
        for (const bool left : {false, true})
            for (const std::string output : {"tiff", "bmp"}) {
                Json profile = *weave::parse_json(*weave::read_file(loom("tc2")));
                profile["file"]["pick_1_at_bottom"] = bottom;
                profile["file"]["end_1_at_left"] = left;
                profile["file"]["output"] = output;
                shop.put("p.json", profile.dump());
                std::filesystem::remove_all(shop.path("out"));
                shop.must({"export", "t.weave", "--loom", "p.json", "-o", "out"});
                const Json said = *weave::parse_json(shop.get("out/t-SAMPLE-NOT-RELEASED-manifest.json"));
                CHECK(said.at("card").at("pick_1") == (bottom ? "bottom row" : "top row"));
                CHECK(said.at("card").at("end_1") == (left ? "left column" : "right column"));
                CHECK(said.at("card").at("stored_bit_of_black") == (output == "tiff" ? 1 : 0));
                const std::string picture = shop.get("out/t-SAMPLE-NOT-RELEASED-card." +
                                                     std::string(output == "tiff" ? "tif" : "bmp"));
                CHECK(weave::read_bitmap(picture, {bottom, left, true})->card.sha256() == hash);
            }
}

TEST_CASE("export refuses what does not validate, says why, and makes no folder") {
    const Workshop shop;
    weave_card(shop, "loose.weave", {"X.X.", ".XXX", "X.X.", ".XXX"});
    put_profile(shop, "p.json", "bind.end", "error");
    const std::set<std::string> before = shop.names();
    const Json report = shop.json({"export", "loose.weave", "--loom", "p.json", "-o", "out"}, 1);
    check_findings(report);
    CHECK(of_rule(report, "bind.end").size() == 1);
    CHECK(shop.names() == before);
}

TEST_CASE("export leaves a folder that holds something as it is") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    std::filesystem::create_directory(shop.path("full"));
    shop.put("full/mine.txt", "keep");
    shop.refused({"export", "p.weave", "--loom", loom("tc2"), "-o", "full"}, 4,
                 {"full", "not an empty folder"});
    CHECK(shop.get("full/mine.txt") == "keep");
    std::filesystem::create_directory(shop.path("empty"));
    shop.must({"export", "p.weave", "--loom", loom("tc2"), "-o", "empty"});
    CHECK(shop.names().size() == 1 + 2 + 4);
}
