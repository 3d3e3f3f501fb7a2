// Simulation through the program: a design becomes yarns, a picture of them, and files for other programs.

#include "run.hpp"

#include <weave/core/sha256.hpp>
#include <weave/sim/yarns_file.hpp>

using program_tests::Ended;
using program_tests::Workshop;
using weave::Json;

TEST_CASE("simulate relaxes a design, says how it ended, and its yarns are drawn and exported") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    const Json said = shop.json({"simulate", "d.weave", "-o", "d.yarns", "--residual", "1e-6"});
    for (const char* key : {"design_sha256", "scene_sha256", "coverage", "plan", "contacts", "iterations", "seconds", "peak_bytes"}) {
        INFO(key);
        CHECK(said.contains(key));
    }
    CHECK(said.at("converged") == true);
    CHECK(said.at("order_kept") == true);
    CHECK(said.at("residual").get<double>() <= 1e-6);
    CHECK(said.at("design_sha256") == shop.json({"info", "d.weave"}).at("design_sha256"));
    CHECK(said.at("yarns_sha256") == weave::sha256_hex(shop.get("d.yarns")));
    const weave::Result<weave::Yarns> yarns = weave::read_yarns(shop.get("d.yarns"));
    REQUIRE(yarns);
    CHECK(yarns->yarns.size() == 4);
    CHECK(yarns->crossings.size() == 4);
    for (const weave::SimulatedYarn& yarn : yarns->yarns) CHECK(yarn.length_mm > yarn.planned_length_mm);
    shop.must({"render", "d.yarns", "--view", "3d", "--repeat", "2x2", "--size", "400x300", "-o", "d.png"});
    CHECK(shop.get("d.png").rfind("\x89PNG", 0) == 0);
    shop.must({"export-yarns", "d.yarns", "-o", "d.vtp"});
    shop.must({"export-yarns", "d.yarns", "-o", "d.obj"});
    CHECK(shop.get("d.vtp").find("PolyData") != std::string::npos);
}

TEST_CASE("a tiled cloth is simulated as its smallest repeat and copied back") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    shop.must({"tile", "d.weave", "--x", "3", "--y", "2", "-o", "t.weave"});
    const Json one = shop.json({"simulate", "d.weave", "-o", "d.yarns", "--residual", "1e-8"});
    const Json many = shop.json({"simulate", "t.weave", "-o", "t.yarns", "--residual", "1e-8"});
    CHECK(many.at("points") == one.at("points"));
    const weave::Yarns small = weave::read_yarns(shop.get("d.yarns")).value(), large = weave::read_yarns(shop.get("t.yarns")).value();
    REQUIRE(large.yarns.size() == 6 + 4);
    CHECK(large.crossings.size() == 24);
    for (const weave::SimulatedYarn& yarn : large.yarns) {
        const bool warp = yarn.system == weave::System::warp;
        const weave::SimulatedYarn& of = small.yarns[(warp ? 2 : 0) + yarn.number % 2];
        CHECK(yarn.length_mm == Approx(of.length_mm * (warp ? 3 : 2)));
    }
    // The repeat's rest is one of the whole cloth: it stays there. From the raw start the whole may find another.
    const Json whole = shop.json({"simulate", "t.weave", "-o", "w.yarns", "--residual", "1e-7", "--whole", "--resume", "t.yarns"});
    CHECK(whole.at("points").get<std::size_t>() == 6 * one.at("points").get<std::size_t>());
    CHECK(whole.at("iterations").get<int>() <= 1);
    CHECK(whole.at("energy_N_mm").get<double>() == Approx(6 * one.at("energy_N_mm").get<double>()).epsilon(1e-9));
}

TEST_CASE("what cannot be simulated is refused with its reason") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    const auto refused = [&](const std::vector<std::string>& words, int exit, const std::string& reason) {
        const Ended ended = shop.run(words);
        INFO(ended.err);
        CHECK(ended.exit == exit);
        CHECK(ended.err.find(reason) != std::string::npos);
    };
    refused({"simulate", "d.weave"}, 2, "-o OUT.yarns");
    refused({"simulate", "d.weave", "-o", "x", "--fidelity", "best"}, 2, "draft, standard or reference");
    refused({"simulate", "d.weave", "-o", "x", "--set", "warp.colour=1"}, 2, "warp.colour=1");
    refused({"simulate", "d.weave", "-o", "x", "--set", "warp.strain=0.5"}, 2, "--set warp.strain=0.5: must be from 1 to 2");
    refused({"simulate", "d.weave", "-o", "x", "--region", "picks:1-9,ends:1-2"}, 2, "within 2 picks and 2 ends");
    refused({"render", "d.weave", "--view", "3d", "-o", "x.png"}, 3, "d.weave");
    Json design = Json::parse(shop.get("d.weave"));
    design["scene"]["boundary_x"] = "free";
    shop.put("free.weave", design.dump());
    refused({"simulate", "free.weave", "-o", "x"}, 1, "shrink for ever");
    refused({"simulate", "d.weave", "-o", "x", "--set", "friction=-1"}, 2, "--set friction=-1: must be from 0 to 100");
    refused({"simulate", "d.weave", "-o", "x", "--field", "sphere:0,0,0,-1,5"}, 2, "--field sphere:0,0,0,-1,5: must be");
    refused({"simulate", "d.weave", "-o", "x", "--boundary", "x=free", "--boundary", "x=frozen"}, 2, "--boundary x=frozen: this rim is said twice");
    CHECK_FALSE(shop.has("x"));
    const Json plan = shop.json({"simulate", "d.weave", "--explain"});
    CHECK(plan.at("yarns") == 4);
    CHECK(plan.at("plan").size() >= 6);
    CHECK(plan.at("points") == 32);
    CHECK(plan.at("expected_bytes").get<std::uint64_t>() > 32 * 1024);
    CHECK(shop.must({"simulate", "d.weave", "--explain"}).out.find("points: 32 (4 yarns, about ") != std::string::npos);
}
