// Relaxed cloth looked over, compared with a scan, and held to a loom.

#include "run.hpp"

#include <weave/sim/yarns_file.hpp>

#include <cstdio>

using program_tests::Ended;
using program_tests::Workshop;
using weave::Json;

namespace {

/// A twill as it comes to rest, in t.yarns of t.weave.
void relax_twill(const Workshop& shop) {
    shop.must({"samples", "twill-2-2", "-o", "t.weave"});
    shop.must({"simulate", "t.weave", "-o", "t.yarns", "--fidelity", "draft"});
}

/// The yarns as a scan: right-handed axes, 0.5 mm higher.
std::string scan_of(const weave::Yarns& yarns) {
    std::string text = "# right-handed\n";
    for (const weave::SimulatedYarn& yarn : yarns.yarns) {
        const std::size_t points = 8 * yarn.spline.segments();
        text += std::to_string(points + 1) + "\n";
        for (std::size_t k = 0; k <= points; ++k) {
            const weave::Vec3 place = yarn.spline.place(static_cast<double>(k) / 8);
            char line[120];
            std::snprintf(line, sizeof line, "%.9f %.9f %.9f\n", place.y(), place.x(), place.z() + 0.5);
            text += line;
        }
    }
    return text;
}

}  // namespace

TEST_CASE("inspect tells a weaver what came out, in words and to programs") {
    const Workshop shop;
    relax_twill(shop);
    const Ended said = shop.must({"inspect", "t.yarns"});
    for (const char* word :
         {"At rest", "every crossing lies as the card says", "Thickness", "Crimp warp", "beam 1"}) {
        INFO(word);
        CHECK(said.out.find(word) != std::string::npos);
    }
    CHECK(std::count(said.out.begin(), said.out.end(), '\n') < 20);
    const Json told = shop.json({"inspect", "t.yarns"});
    CHECK(told.at("take_up").size() == told.at("ends").get<std::size_t>());
    CHECK(told.at("take_up")[0].at("end") == 1);
    CHECK(told.at("take_up")[0].at("take_up").get<double>() > 0);
    CHECK(told.at("crimp").at("weft").at("mean").get<double>() > 0);
    CHECK(told.at("thickness_mm").get<double>() > 0);
    CHECK(told.at("order_kept") == true);
    CHECK(told.at("sheets").size() == 1);
    for (const char* key : {"moved", "jammed", "leaning", "bunched", "changed_crossings", "beams"})
        CHECK(told.at(key).is_array());
}

TEST_CASE("cloth that is not at rest is a finding of inspect") {
    const Workshop shop;
    shop.must({"samples", "satin-5", "-o", "s.weave"});
    CHECK(shop.run({"simulate", "s.weave", "-o", "s.yarns", "--steps", "1"}).exit == 1);
    CHECK(shop.json({"inspect", "s.yarns"}, 1).at("converged") == false);
    CHECK(shop.run({"inspect", "s.yarns"}).out.find("NOT at rest") != std::string::npos);
}

TEST_CASE("inspect and compare refuse what they cannot read, with the place") {
    const Workshop shop;
    relax_twill(shop);
    const std::string good = shop.get("t.yarns");
    shop.put("short.yarns", good.substr(0, good.size() / 2));
    shop.refused({"inspect", "short.yarns"}, 3, {"short.yarns"});
    shop.refused({"inspect", "t.weave", "--json"}, 3, {"t.weave"});
    shop.refused({"inspect", "none.yarns"}, 3, {"none.yarns"});
    shop.refused({"inspect"}, 2, {});
    weave::Yarns yarns = weave::read_yarns(good).value();
    yarns.report.erase("points_per_key");
    shop.put("old.yarns", weave::write_yarns(yarns).value());
    shop.refused({"inspect", "old.yarns"}, 3, {"old.yarns: report.points_per_key"});
    shop.put("bad.txt", "2\n0 0 0\n1 1 word\n");
    shop.refused({"compare", "t.yarns", "bad.txt"}, 3, {"bad.txt: line 3", "word"});
    shop.put("empty.txt", "");
    shop.refused({"compare", "t.yarns", "empty.txt"}, 3, {"empty.txt"});
    shop.refused({"compare", "t.yarns", "short.yarns"}, 3, {"short.yarns"});
    shop.refused({"compare", "t.yarns"}, 2, {});
}

TEST_CASE("compare lays a scan on the yarns and tells how far they are apart") {
    const Workshop shop;
    relax_twill(shop);
    const weave::Yarns yarns = weave::read_yarns(shop.get("t.yarns")).value();
    shop.put("scan.txt", scan_of(yarns));
    const Json told = shop.json({"compare", "t.yarns", "scan.txt"});
    CHECK(told.at("rms_mm").get<double>() < 1e-5);
    CHECK(told.at("matched_by") == "order");
    CHECK(told.at("alignment").at("mirrored") == true);
    REQUIRE(told.at("per_yarn").size() == yarns.yarns.size());
    CHECK(told.at("per_yarn")[0].at("kind") == "pick");
    CHECK(told.at("per_yarn")[0].at("number") == 1);
    CHECK(told.at("per_yarn")[0].at("line") == 2);
    const Ended said = shop.must({"compare", "t.yarns", "scan.txt"});
    CHECK(said.out.find("right-handed") != std::string::npos);
    CHECK(shop.json({"compare", "t.yarns", "t.yarns"}).at("matched_by") == "name");
}

TEST_CASE("check judges the take-up within a beam once it has relaxed yarns") {
    const Workshop shop;
    shop.must({"samples", "twill-g", "-o", "t.weave"});
    shop.must({"simulate", "t.weave", "-o", "t.yarns", "--fidelity", "draft"});
    Json profile = Json::parse(weave::read_file(program_tests::loom("tc2")).value());
    const auto rule = [&](const std::string& loom) {
        const Json told = shop.json({"check", "t.weave", "--loom", loom, "--yarns", "t.yarns"}, 0);
        for (const Json& finding : told.at("findings")) {
            if (finding.at("rule") == "take-up.beam") return std::string("found");
        }
        for (const Json& passed : told.at("passed_rules")) {
            if (passed == "take-up.beam") return std::string("passed");
        }
        return std::string("not evaluated");
    };
    profile["limits"]["take_up_difference"] = 0.5;
    shop.put("easy.json", profile.dump());
    CHECK(rule("easy.json") == "passed");
    profile["limits"]["take_up_difference"] = 0.001;
    shop.put("strict.json", profile.dump());
    CHECK(rule("strict.json") == "found");

    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.refused({"check", "p.weave", "--loom", "easy.json", "--yarns", "t.yarns"}, 3,
                 {"t.yarns: design_sha256", "are of design"});
    weave::Yarns yarns = weave::read_yarns(shop.get("t.yarns")).value();
    yarns.report["converged"] = false;
    shop.put("restless.yarns", weave::write_yarns(yarns).value());
    shop.refused({"check", "t.weave", "--loom", "easy.json", "--yarns", "restless.yarns"}, 3,
                 {"restless.yarns", "not at rest"});
    CHECK(shop.run({"simulate", "t.weave", "-o", "part.yarns", "--fidelity", "draft", "--region",
                    "picks:1-8,ends:1-8"})
              .exit <= 1);
    shop.refused({"check", "t.weave", "--loom", "easy.json", "--yarns", "part.yarns"}, 3,
                 {"part.yarns", "a part of the cloth"});
}
