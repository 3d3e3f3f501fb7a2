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

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t stop = std::min(text.find('\n', at), text.size());
        lines.push_back(text.substr(at, stop - at));
        at = stop + 1;
    }
    return lines;
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

TEST_CASE("a design where cloth is looked at is told as one, with what makes cloth of it") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "plain.weave"});
    for (const std::vector<std::string>& words : {std::vector<std::string>{"inspect", "plain.weave"},
                                                  {"compare", "plain.weave", "plain.weave"},
                                                  {"render", "plain.weave", "--view", "3d", "-o", "plain.png"},
                                                  {"check", "plain.weave", "--loom", WEAVE_SOURCE_DIR "/db/looms/tc2.json", "--yarns", "plain.weave"}}) {
        INFO(words[0]);
        shop.refused(words, 3, {"plain.weave: is a design, not cloth", "weave simulate"});
    }
    shop.put("other", "no such thing\n");
    shop.refused({"inspect", "other"}, 3, {"other: byte 0: this is not a .yarns file"});
    shop.put("empty", "");
    shop.refused({"inspect", "empty"}, 3, {"empty"});
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
    CHECK(told.at("by_nearness").is_null());
    CHECK(told.at("unit_hint").is_null());
}

TEST_CASE("compare says when the file's order or its unit seems wrong") {
    const Workshop shop;
    relax_twill(shop);
    weave::Yarns yarns = weave::read_yarns(shop.get("t.yarns")).value();
    std::string micrometres;
    for (const std::string& line : lines_of(scan_of(yarns))) {
        double x = 0, y = 0, z = 0;
        char out[120];
        if (std::sscanf(line.c_str(), "%lf %lf %lf", &x, &y, &z) < 3) {
            micrometres += line + "\n";
            continue;
        }
        std::snprintf(out, sizeof out, "%.6f %.6f %.6f\n", 1000 * x, 1000 * y, 1000 * z);
        micrometres += out;
    }
    shop.put("um.txt", micrometres);
    CHECK(shop.json({"compare", "t.yarns", "um.txt"}).at("unit_hint").at("mm") == 0.001);
    CHECK(shop.must({"compare", "t.yarns", "um.txt"}).out.find("multiply them by 0.001") !=
          std::string::npos);

    std::ranges::reverse(yarns.yarns);
    shop.put("turned.txt", scan_of(yarns));
    const Json told = shop.json({"compare", "t.yarns", "turned.txt"});
    CHECK(told.at("matched_by") == "order");
    CHECK(told.at("by_nearness").at("rms_mm").get<double>() < 1e-5);
    CHECK(shop.must({"compare", "t.yarns", "turned.txt"}).out.find("--match nearness") != std::string::npos);
    CHECK(shop.json({"compare", "t.yarns", "turned.txt", "--match", "nearness"}).at("rms_mm").get<double>() <
          1e-5);
    shop.refused({"compare", "t.yarns", "turned.txt", "--match", "luck"}, 2, {"--match"});
}

TEST_CASE("a part of a cloth is looked over as one, and measured away from its frozen rims") {
    const Workshop shop;
    shop.must({"samples", "satin-e", "-o", "one.weave"});
    shop.must({"tile", "one.weave", "--x", "4", "--y", "4", "-o", "s.weave"});
    shop.must({"simulate", "one.weave", "-o", "whole.yarns", "--fidelity", "draft"});
    shop.must({"simulate", "s.weave", "-o", "part.yarns", "--fidelity", "draft", "--region",
               "picks:21-60,ends:11-30"});
    const Json whole = shop.json({"inspect", "whole.yarns"}), part = shop.json({"inspect", "part.yarns"});
    CHECK(part.at("coverage").at("of").at("picks") == 80);
    for (const char* system : {"warp", "weft"}) {
        INFO(system);
        CHECK(part.at("crimp").at(system).at("mean").get<double>() ==
              Approx(whole.at("crimp").at(system).at("mean").get<double>()).margin(0.005));
    }
    CHECK(shop.must({"inspect", "part.yarns"}).out.find("picks 21 to 60 of 80 and ends 11 to 30 of 40") !=
          std::string::npos);
}

TEST_CASE("coverage counts from 1 and is of the whole cloth, though one repeat was simulated") {
    const Workshop shop;
    shop.must({"samples", "twill-2-2", "-o", "one.weave"});
    shop.must({"tile", "one.weave", "--x", "2", "--y", "3", "-o", "t.weave"});
    const Json said =
        shop.json({"simulate", "t.weave", "-o", "t.yarns", "--fidelity", "draft"}).at("coverage");
    const Json info = shop.json({"info", "t.weave"});
    CHECK(said.at("whole") == true);
    CHECK(said.at("rows") == Json({1, info.at("rows")}));
    CHECK(said.at("columns") == Json({1, info.at("columns")}));
    CHECK(said.at("picks") == Json({1, info.at("picks")}));
    CHECK(said.at("ends") == Json({1, info.at("ends")}));
    CHECK(said.at("of").at("picks") == info.at("picks"));
    weave::Yarns old = weave::read_yarns(shop.get("t.yarns")).value();
    CHECK(shop.json({"inspect", "t.yarns"}).at("coverage") == said);
    // Earlier versions told one repeat, its rows and columns from 0.
    old.report["coverage"] = {{"rows", {0, 3}}, {"columns", {0, 3}}, {"picks", {1, 4}},
                              {"ends", {1, 4}}, {"repeats", {2, 3}}, {"whole", true}};
    shop.put("old.yarns", weave::write_yarns(old).value());
    const Json again = shop.json({"inspect", "old.yarns"}).at("coverage");
    CHECK(again.at("picks") == said.at("picks"));
    CHECK(again.at("rows") == said.at("rows"));
}

TEST_CASE("check tells the yarn that a relaxed cloth takes, and its width once that was let go") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.must({"simulate", "p.weave", "-o", "held.yarns", "--fidelity", "draft"});
    const auto check = [&](const char* yarns) {
        return shop.json({"check", "p.weave", "--loom", program_tests::loom("tc2"), "--yarns", yarns}, 0);
    };
    const auto messages = [](const Json& report, const char* rule) {
        std::string all;
        for (const Json& finding : report.at("findings"))
            if (finding.at("rule") == rule) all += finding.at("message").get<std::string>() + "\n";
        for (const Json& missing : report.at("not_evaluated_rules"))
            if (missing.at("rule") == rule) all += "NOT " + missing.at("reason").get<std::string>();
        return all;
    };
    const Json held = check("held.yarns");
    CHECK(messages(held, "consumption").find("beam 'beam 1': 2 ends take ") == 0);
    CHECK(messages(held, "consumption").find("for a metre of cloth") != std::string::npos);
    CHECK(messages(held, "consumption").find("2 picks of the design take") != std::string::npos);
    CHECK(messages(held, "cloth.width").find("NOT the simulation was given the width, 1.0 mm") == 0);
    shop.must({"simulate", "p.weave", "-o", "free.yarns", "--fidelity", "draft", "--boundary", "y=relaxing"});
    CHECK(messages(check("free.yarns"), "cloth.width").find("1.0 mm in the reed: it draws in by") !=
          std::string::npos);
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
    // Where a profile sets no limit the spread of each beam is told all the same.
    for (const char* shipped : {"tc2", "ep-2688", "ep-5376", "jc5-5120"})
        CHECK(rule(program_tests::loom(shipped)) == "found");

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
