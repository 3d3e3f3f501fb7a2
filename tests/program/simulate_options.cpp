// What a scene may ask of `weave simulate`: rims, pins, fields, flips, going on from an earlier run, and being stopped.

#include "run.hpp"

#include <weave/sim/yarns_file.hpp>

#include <chrono>
#include <csignal>
#include <fstream>

using program_tests::Ended;
using program_tests::Workshop;
using weave::Json;

namespace {

/// The choice of one line of a plan.
std::string choice_of(const Json& said, const std::string& term) {
    for (const Json& line : said.at("plan")) {
        if (line.at("term") == term) return line.at("choice");
    }
    return "";
}

weave::Yarns yarns_in(const Workshop& shop, const std::string& file) {
    weave::Result<weave::Yarns> yarns = weave::read_yarns(shop.get(file));
    REQUIRE(yarns);
    return std::move(yarns).value();
}

}  // namespace

TEST_CASE("the plan tells rims, pins and fields of this run") {
    const Workshop shop;
    shop.must({"samples", "layer-to-layer", "-o", "d.weave"});
    const auto plan = [&](std::vector<std::string> words) {
        words.insert(words.begin(), {"simulate", "d.weave", "--explain"});
        return shop.json(words);
    };
    CHECK(choice_of(plan({}), "boundary y") == "periodic");
    CHECK(choice_of(plan({"--boundary", "x=frozen", "--boundary", "y=free"}), "boundary x") == "frozen");
    CHECK(choice_of(plan({"--boundary", "x=frozen", "--boundary", "y=free"}), "boundary y") == "free");
    CHECK(choice_of(plan({"--boundary", "y=relaxing:0.2"}), "boundary y") == "periodic, relaxing");
    CHECK(choice_of(plan({"--pin", "pick:1", "--pin", "3,2"}), "pins") == "1 yarn, 1 crossing");
    CHECK(choice_of(plan({"--field", "sphere:1,1,0,0.5,2"}), "fields") == "1");
    CHECK(choice_of(plan({"--field", "sphere:1,1,0,0.5,2", "--field", "none"}), "fields") == "off");
}

TEST_CASE("options that make no sense are refused in a line that names them") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    const auto refused = [&](std::vector<std::string> words, int exit, const std::vector<std::string>& pieces) {
        words.insert(words.begin(), {"simulate", "d.weave", "-o", "x.yarns"});
        shop.refused(words, exit, pieces);
    };
    refused({"--boundary", "z=free"}, 2, {"--boundary z=free", "periodic, frozen, free or relaxing"});
    refused({"--boundary", "y=relaxing:much"}, 2, {"--boundary y=relaxing:much"});
    refused({"--boundary", "x=free"}, 1, {"shrink for ever"});
    refused({"--boundary", "x=relaxing"}, 1, {"shrink for ever", "give the force"});
    refused({"--pin", "weft:1"}, 2, {"--pin weft:1", "2 picks and 2 ends"});
    refused({"--pin", "pick:3"}, 2, {"--pin pick:3"});
    refused({"--field", "cube:1,2,3"}, 2, {"--field cube:1,2,3", "sphere:X,Y,Z,RADIUS,STRENGTH"});
    refused({"--field", "sphere:1,2,3,-1,1"}, 2, {"--field sphere:1,2,3,-1,1: must be from 1e-6 to 1e6 mm"});
    refused({"--solver", "magic"}, 2, {"magic"});
    // Where there is a device, test_device_cuda has what it relaxes.
    if (shop.run({"devices"}).out.find("no device") != std::string::npos) refused({"--backend", "cuda"}, 5, {"--backend cuda"});
    refused({"--backend", "cuda", "--solver", "paper"}, 2, {"--backend cuda", "paper"});
    refused({"--backend", "abacus"}, 2, {"--backend abacus"});
    refused({"--flip", "9,1"}, 2, {"--flip 9,1", "2 picks and 2 ends"});
    refused({"--save-design", "g.weave"}, 2, {"--save-design g.weave", "--flip"});
    refused({"--resume", "none.yarns"}, 3, {"none.yarns"});
    refused({"--starts", "0"}, 2, {"--starts"});
    refused({"--starts", "2", "--flip", "1,1"}, 2, {"--starts", "flips"});
    refused({"--seed", "3"}, 2, {"--seed", "--starts"});
    refused({"--threads", "99999"}, 2, {"--threads", "1024"});
    refused({"--symmetry"}, 2, {"--symmetry", "one repeat"});
    refused({"--symmetry", "--flip", "1,1"}, 2, {"--symmetry", "flips"});
    refused({"--symmetry", "--resume", "x.yarns"}, 2, {"--symmetry", "--resume"});
    refused({"--start-from", "draft", "--resume", "x.yarns"}, 2, {"--start-from draft", "--resume"});
    refused({"--start-from", "draft", "--symmetry"}, 2, {"--start-from draft", "other starts"});
    refused({"--start-from", "draft", "--starts", "1"}, 2, {"--start-from draft", "other starts"});
    refused({"--start-from", "nothing"}, 2, {"nothing"});
    refused({"--start-from", "standard"}, 2, {"--start-from standard", "no fewer points"});
    shop.must({"samples", "orthogonal", "-o", "d.weave"});
    const Ended illegal = shop.run({"flip", "d.weave", "--pick", "1", "--end", "1", "-o", "g.weave"});
    if (illegal.exit == 1) refused({"--flip", "1,1", "--save-design", "g.weave"}, 1, {"--flip 1,1", "in the way"});
}

TEST_CASE("a plan that is only explained takes no option that makes no difference to it") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    using Words = std::vector<std::string>;
    for (const Words& words : {Words{"-o", "x.yarns"}, {"--residual", "1e-5"}, {"--starts", "2"}, {"--seed", "3"}, {"--symmetry"},
                               {"--flip", "1,1"}, {"--resume", "x.yarns"}, {"--start-from", "draft"}, {"--steps", "3"}, {"--seconds", "3"}, {"--threads", "1"},
                               {"--solver", "paper"}, {"--save-design", "g.weave"}}) {
        Words all{"simulate", "d.weave", "--explain"};
        all.insert(all.end(), words.begin(), words.end());
        shop.refused(all, 2, {words[0] == "-o" ? "--out" : words[0], "--explain"});
    }
    shop.must({"simulate", "d.weave", "--explain", "--fidelity", "draft", "--points", "3", "--whole"});
    shop.must({"simulate", "d.weave", "--explain", "--backend", "cpu"});
}

TEST_CASE("a cloth that this machine cannot hold is refused before it is laid out, with what has room") {
    std::ifstream table("/proc/meminfo");
    std::uint64_t kibibytes = 0;
    for (std::string name, rest; table >> name >> kibibytes && name != "MemAvailable:";) std::getline(table, rest);
    if (kibibytes > std::uint64_t{60} << 20) {
        WARN("skipped: this machine may hold it");
        return;
    }
    const Workshop shop;
    shop.must({"samples", "shoe-adult", "-o", "shoe.weave"});
    const std::string line =
        shop.refused({"simulate", "shoe.weave", "--fidelity", "reference", "-o", "shoe.yarns"}, 4, {"shoe.weave: this takes about ", "GiB are free", "simulate a part of the cloth, up to ", "have a server do it"});
    CHECK(line.find("planning") == std::string::npos);
}

TEST_CASE("planning and relaxing that take their time are told, the latter with the order of the crossings") {
    const Workshop shop;
    shop.must({"samples", "shoe-adult", "-o", "p.weave"});
    const auto began = std::chrono::steady_clock::now();
    Workshop::Running planning = shop.start({"simulate", "p.weave", "--explain"});
    const bool said = planning.says("planning p.weave ... ");
    ::kill(planning.child, SIGKILL);
    planning.finish();
    CHECK((said || std::chrono::steady_clock::now() - began < std::chrono::seconds(2)));

    shop.must({"samples", "layer-to-layer", "-o", "d.weave"});
    Workshop::Running running = shop.start({"simulate", "d.weave", "--threads", "1", "--solver", "paper", "--residual", "1e-15", "-o", "d.yarns"});
    REQUIRE(running.says("relaxing ... residual"));
    CHECK(running.says("steps, order kept, "));
    ::kill(running.child, SIGINT);
    const Ended ended = running.finish();
    INFO(ended.err);
    CHECK(ended.exit == 1);
}

TEST_CASE("a relaxation goes on from a file, in more points too, and not from one of another design or scene") {
    const Workshop shop;
    shop.must({"samples", "layer-to-layer", "-o", "d.weave"});
    const Json first = shop.json({"simulate", "d.weave", "--threads", "1", "-o", "a.yarns", "--residual", "1e-6"});
    const Json again = shop.json({"simulate", "d.weave", "--threads", "1", "--resume", "a.yarns", "-o", "b.yarns", "--residual", "1e-6"});
    CHECK(again.at("iterations").get<int>() <= 2);
    CHECK(again.at("energy_N_mm").get<double>() == Approx(first.at("energy_N_mm").get<double>()).epsilon(1e-6));
    const Json finer = shop.json({"simulate", "d.weave", "--threads", "1", "--resume", "a.yarns", "--points", "8", "-o", "c.yarns"});
    CHECK(finer.at("points").get<int>() == 2 * first.at("points").get<int>());
    CHECK(finer.at("converged") == true);
    CHECK(finer.at("order_kept") == true);
    CHECK(finer.at("iterations").get<int>() < first.at("iterations").get<int>());

    // Another scene of the same design: from the file's own scene a run with other numbers may start, not the other way.
    CHECK(shop.json({"simulate", "d.weave", "--threads", "1", "--resume", "a.yarns", "--set", "warp.strain=1.02", "-o", "tight.yarns"})
              .at("converged") == true);
    shop.refused({"simulate", "d.weave", "--threads", "1", "--resume", "tight.yarns", "-o", "x.yarns"}, 3, {"tight.yarns", "another scene"});
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.refused({"simulate", "p.weave", "--threads", "1", "--resume", "a.yarns", "-o", "x.yarns"}, 3, {"a.yarns", "another design"});
    shop.must({"tile", "p.weave", "--x", "4", "--y", "4", "-o", "t.weave"});
    shop.must({"simulate", "t.weave", "--threads", "1", "-o", "t.yarns"});
    shop.refused({"simulate", "t.weave", "--threads", "1", "--region", "picks:1-7,ends:1-6", "--resume", "t.yarns", "-o", "x.yarns"}, 3,
                 {"t.yarns", "another part"});
}

TEST_CASE("a run that begins in fewer points shows them first, marked, and then those asked for") {
    const Workshop shop;
    shop.must({"samples", "tl013-wrong", "-o", "d.weave"});
    Workshop::Running running = shop.start({"simulate", "d.weave", "--threads", "1", "--start-from", "draft", "--residual", "1e-15", "-o", "d.yarns"});
    REQUIRE(running.says("in all points"));
    const weave::Yarns shown = yarns_in(shop, "d.yarns");
    CHECK(shown.report.at("goes_on") == "standard");
    CHECK(shown.report.at("fidelity") == "draft");
    CHECK(shop.run({"inspect", "d.yarns"}).out.find("ON THE WAY to standard") != std::string::npos);
    ::kill(running.child, SIGINT);
    running.finish();
    const weave::Yarns kept = yarns_in(shop, "d.yarns");
    CHECK_FALSE(kept.report.contains("goes_on"));
    CHECK(kept.report.at("ending") == "stopped");
    const Json& coarser = kept.report.at("coarser");
    CHECK(coarser.at("taken") == true);
    CHECK(coarser.at("residual").get<double>() <= 1e-2);
    CHECK(2 * coarser.at("points").get<int>() == kept.report.at("points").get<int>());
}

TEST_CASE("reference begins at standard, and a run that ends in fewer points leaves these") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    const Json whole = shop.json({"simulate", "d.weave", "--threads", "1", "--fidelity", "reference", "-o", "d.yarns"});
    CHECK(whole.at("converged") == true);
    CHECK(whole.at("coarser").at("fidelity") == "standard");
    CHECK(whole.at("iterations").get<int>() > whole.at("coarser").at("iterations").get<int>());
    const Json at_once = shop.json({"simulate", "d.weave", "--threads", "1", "--fidelity", "reference", "--start-from", "plan", "-o", "e.yarns"});
    CHECK_FALSE(at_once.contains("coarser"));
    CHECK(whole.at("energy_N_mm").get<double>() == Approx(at_once.at("energy_N_mm").get<double>()).epsilon(1e-4));

    const Json cut = shop.json({"simulate", "d.weave", "--threads", "1", "--fidelity", "reference", "--seconds", "1e-9", "-o", "f.yarns"}, 1);
    CHECK(cut.at("fidelity") == "standard");
    CHECK(cut.at("ending") == "time");
    CHECK(cut.at("goes_on") == "reference");
    CHECK(cut.at("left_undone") == Json::array({"the fidelity asked for, reference"}));
    const std::string words = shop.run({"simulate", "d.weave", "--threads", "1", "--start-from", "draft", "--steps", "2", "-o", "g.yarns"}).out;
    INFO(words);
    CHECK(words.find("standard, which was asked for, was not begun; these are the yarns in the fewer points of draft") != std::string::npos);
    CHECK(words.find("(goal 1e-02)") != std::string::npos);
    CHECK(words.find("CUT SHORT, left undone: the fidelity asked for, standard") != std::string::npos);
    CHECK(shop.run({"inspect", "g.yarns"}).out.find("ON THE WAY to standard") != std::string::npos);
}

TEST_CASE("a tiled cloth resumes as its smallest repeat") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    shop.must({"tile", "d.weave", "--x", "3", "--y", "2", "-o", "t.weave"});
    const Json first = shop.json({"simulate", "t.weave", "--threads", "1", "-o", "t.yarns", "--residual", "1e-6"});
    const Json again = shop.json({"simulate", "t.weave", "--threads", "1", "--resume", "t.yarns", "-o", "u.yarns", "--residual", "1e-6"});
    // Contact samples follow the lengths at the start, so that it is not quite the same cloth.
    CHECK(again.at("energy_N_mm").get<double>() == Approx(first.at("energy_N_mm").get<double>()).epsilon(0.02));
    const Json whole = shop.json({"simulate", "t.weave", "--threads", "1", "--whole", "--resume", "t.yarns", "-o", "w.yarns", "--residual", "1e-6"});
    CHECK(whole.at("energy_N_mm").get<double>() == Approx(6 * again.at("energy_N_mm").get<double>()).epsilon(1e-5));
    CHECK(whole.at("points").get<int>() == 6 * first.at("points").get<int>());
}

TEST_CASE("a run that is stopped leaves a whole file that says so, and another goes on from it") {
    const Workshop shop;
    shop.must({"samples", "tl013-wrong", "-o", "d.weave"});
    for (const int signal : {SIGINT, SIGTERM}) {
        Workshop::Running running =
            shop.start({"simulate", "d.weave", "--threads", "1", "-o", "d.yarns", "--fidelity", "reference", "--start-from", "plan"});
        REQUIRE(running.says("residual"));
        ::kill(running.child, signal);
        const Ended ended = running.finish();
        INFO(ended.err);
        CHECK(ended.exit == 1);
        CHECK(ended.out.find("NOT at rest") != std::string::npos);
        const weave::Yarns yarns = yarns_in(shop, "d.yarns");
        CHECK(yarns.report.at("ending") == "stopped");
        CHECK(yarns.report.at("converged") == false);
        CHECK(shop.names() == std::set<std::string>{"d.weave", "d.yarns"});
    }
    const weave::Yarns before = yarns_in(shop, "d.yarns");
    const Json more = shop.json({"simulate", "d.weave", "--threads", "1", "--resume", "d.yarns", "-o", "e.yarns", "--fidelity", "reference",
                                 "--steps", "1"}, 1);
    CHECK(more.at("points") == before.report.at("points"));
    CHECK(more.at("energy_N_mm").get<double>() <= before.report.at("energy_N_mm").get<double>() * 1.001);
}

namespace {

/// Sends SIGINT once it says this, and what came of it.
Ended interrupted(const Workshop& shop, const std::vector<std::string>& words, const std::string& when) {
    Workshop::Running running = shop.start(words);
    REQUIRE(running.says(when));
    ::kill(running.child, SIGINT);
    Ended ended = running.finish();
    INFO(ended.err);
    CHECK(ended.exit == 1);
    CHECK(ended.err.find("again to end at once, without the state") != std::string::npos);
    CHECK(ended.out.find("INTERRUPTED") != std::string::npos);
    return ended;
}

}  // namespace

TEST_CASE("what an interrupted run has not done is said, though what it did is at rest") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "40", "--y", "40", "-o", "d.weave"});
    const Ended whole = interrupted(shop, {"simulate", "d.weave", "--threads", "1", "--symmetry", "--residual", "1e-8", "-o", "d.yarns"},
                                    "relaxing the whole cloth");
    CHECK(whole.out.find("left undone: the whole cloth beside its smallest repeat") != std::string::npos);
    const Json report = yarns_in(shop, "d.yarns").report;
    CHECK(report.at("converged") == true);
    CHECK(report.at("interrupted") == true);
    CHECK(report.at("left_undone").size() == 1);
    CHECK_FALSE(report.contains("symmetry"));

    shop.must({"samples", "satin-5", "-o", "s.weave"});
    const Ended starts = interrupted(shop, {"simulate", "s.weave", "--threads", "1", "--starts", "1000", "--residual", "1e-6", "-o", "s.yarns"},
                                     "relaxing from other starts");
    const Json of = yarns_in(shop, "s.yarns").report.at("starts");
    CHECK(of.at("asked") == 1000);
    CHECK(of.at("runs").get<int>() < 1000);
    CHECK(starts.out.find(std::to_string(1000 - of.at("runs").get<int>()) + " of 1000 more relaxations") != std::string::npos);
    if (of.at("runs").get<int>() > 0) CHECK(starts.out.find("(of 1000 asked for)") != std::string::npos);
}

TEST_CASE("two signals in a breath are one: the yarns are written all the same") {
    const Workshop shop;
    shop.must({"samples", "tl013-wrong", "-o", "d.weave"});
    Workshop::Running running = shop.start({"simulate", "d.weave", "--threads", "1", "-o", "d.yarns", "--fidelity", "reference", "--start-from", "plan"});
    REQUIRE(running.says("residual"));
    ::kill(running.child, SIGINT);
    ::usleep(20'000);
    ::kill(running.child, SIGINT);
    CHECK(running.finish().exit == 1);
    CHECK(yarns_in(shop, "d.yarns").report.at("interrupted") == true);
    const std::string help = shop.must({"simulate", "--help"}).out;
    CHECK(help.find("half a second") != std::string::npos);
    CHECK(help.find("Exit status") != std::string::npos);
}

TEST_CASE("a flip in the relaxed cloth saves the design that its yarns are of") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "2", "--y", "2", "-o", "d.weave"});
    const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--flip", "2,3", "--save-design", "g.weave", "-o", "g.yarns"});
    INFO(said.at("flips").dump());
    CHECK(said.at("flips").at(0).at("done") == true);
    CHECK(said.at("order_kept") == true);
    const Json info = shop.json({"info", "g.weave"});
    CHECK(said.at("design_sha256") == info.at("design_sha256"));
    shop.must({"flip", "d.weave", "--pick", "2", "--end", "3", "-o", "f.weave"});
    CHECK(info.at("card_sha256") == shop.json({"info", "f.weave"}).at("card_sha256"));
    // The yarns go on as those of the new design, which has no smaller repeat any more.
    const Json again = shop.json({"simulate", "g.weave", "--threads", "1", "--resume", "g.yarns", "-o", "h.yarns"});
    CHECK(again.at("converged") == true);
    CHECK(again.at("order_kept") == true);
    // They begin near its rest: its plan begins a hundred times farther from it.
    const auto at_start = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"simulate", "g.weave", "--threads", "1", "--steps", "0", "-o", "i.yarns"});
        return shop.json(more, 1).at("residual").get<double>();
    };
    CHECK(at_start({"--resume", "g.yarns"}) < 0.01 * at_start({}));
}

TEST_CASE("flips on a cloth with repeats count both runs, and one that there is no time for writes no design") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "2", "--y", "2", "-o", "d.weave"});
    const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--start-from", "draft", "--flip", "2,3", "-o", "g.yarns"});
    CHECK(said.at("coarser").at("fidelity") == "draft");
    CHECK(said.at("iterations").get<int>() > said.at("coarser").at("iterations").get<int>());
    const std::vector<std::string> hasty{"simulate", "d.weave", "--threads", "1", "--seconds", "1e-9", "--flip", "2,3", "--save-design", "h.weave", "-o", "h.yarns"};
    const Json cut = shop.json(hasty, 1);
    CHECK(cut.at("left_undone") == Json::array({"coming to rest", "1 of 1 flip"}));
    CHECK(cut.at("flips").at(0).at("tried") == false);
    CHECK(cut.at("saved_design").is_null());
    CHECK(shop.names().count("h.weave") == 0);
    const std::string words = shop.run(hasty).out;
    CHECK(words.find("stay as they were: not begun, as the time was up") != std::string::npos);
    CHECK(words.find("h.weave is NOT written") != std::string::npos);
}

TEST_CASE("a part of a cloth has frozen rims, says what it covers, and takes flips") {
    const Workshop shop;
    shop.must({"samples", "twill-2-2", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "3", "--y", "3", "-o", "d.weave"});
    const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--region", "picks:3-10,ends:2-9", "-o", "r.yarns"});
    CHECK(said.at("coverage").at("whole") == false);
    CHECK(said.at("coverage").at("picks") == Json({3, 10}));
    CHECK(said.at("coverage").at("ends") == Json({2, 9}));
    CHECK(said.at("converged") == true);
    const weave::Yarns yarns = yarns_in(shop, "r.yarns");
    CHECK(yarns.yarns.size() == 16);
    for (const weave::SimulatedYarn& yarn : yarns.yarns) {
        for (const std::size_t rim : {std::size_t{0}, std::size_t{1}, yarn.planned.size() - 2, yarn.planned.size() - 1})
            CHECK(yarn.spline.control[rim] == yarn.planned[rim]);
    }
    const Json flipped = shop.json({"simulate", "d.weave", "--threads", "1", "--region", "picks:3-10,ends:2-9", "--resume", "r.yarns",
                                    "--flip", "6,5", "--save-design", "g.weave", "-o", "f.yarns"});
    CHECK(flipped.at("flips").at(0).at("done") == true);
    CHECK(flipped.at("order_kept") == true);
    const Ended outside = shop.run({"simulate", "d.weave", "--threads", "1", "--region", "picks:3-10,ends:2-9", "--resume", "r.yarns",
                                    "--flip", "1,1", "-o", "o.yarns"});
    CHECK(outside.exit == 2);
    CHECK(outside.err.find("--flip 1,1") != std::string::npos);
    CHECK(shop.names().count("o.yarns") == 0);
}

TEST_CASE("a free period shrinks to where no force is left on its rim") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--boundary", "y=relaxing", "-o", "r.yarns"});
    CHECK(said.at("converged") == true);
    CHECK(said.at("periods").at("balanced") == true);
    const weave::Yarns yarns = yarns_in(shop, "r.yarns");
    CHECK(yarns.size_mm[1] == Approx(said.at("periods").at("size_mm").at(1).get<double>()));
    const Json again = shop.json({"simulate", "d.weave", "--threads", "1", "--boundary", "y=relaxing", "--resume", "r.yarns", "-o", "s.yarns"});
    CHECK(again.at("periods").at("size_mm").at(1).get<double>() == Approx(yarns.size_mm[1]).epsilon(1e-3));
}

TEST_CASE("a period that does not settle is told with its force, and who looks at the yarns later sees the same cloth") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "d.weave"});
    for (const char* rim : {"y=relaxing:-1000", "x=relaxing:5", "y=relaxing:0.2"}) {
        INFO(rim);
        const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--boundary", rim, "-o", "r.yarns"}, std::string(rim) == "y=relaxing:0.2" ? 0 : 1);
        const Json seen = shop.json({"inspect", "r.yarns"}, said.at("converged").get<bool>() ? 0 : 1);
        CHECK(said.at("converged") == said.at("periods").at("balanced"));
        CHECK((said.at("ending") == "periods") == !said.at("converged").get<bool>());
        CHECK(seen.at("slid_crossings").size() == said.at("slid_crossings").get<std::size_t>());
        CHECK(seen.at("order_kept") == said.at("order_kept"));
    }
    const Ended told = shop.run({"simulate", "d.weave", "--threads", "1", "--boundary", "x=relaxing:5", "-o", "r.yarns"});
    CHECK(told.out.find("the period along x is NOT settled") != std::string::npos);
}

TEST_CASE("pinned yarns and crossings stay where they are planned") {
    const Workshop shop;
    shop.must({"samples", "layer-to-layer", "-o", "d.weave"});
    const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--pin", "pick:2", "--pin", "5,3", "-o", "p.yarns"});
    CHECK(said.at("converged") == true);
    const weave::Yarns yarns = yarns_in(shop, "p.yarns");
    bool moved = false;
    for (const weave::SimulatedYarn& yarn : yarns.yarns) {
        const bool pinned = yarn.system == weave::System::weft && yarn.number == 1;
        if (pinned) CHECK(yarn.spline.control == yarn.planned);
        moved = moved || yarn.spline.control != yarn.planned;
    }
    CHECK(moved);
    for (const weave::Crossing& crossing : yarns.crossings) {
        if (crossing.pick != 4 || crossing.end != 2) continue;
        for (const auto& [index, key] : {std::pair{crossing.weft, crossing.weft_key}, {crossing.warp, crossing.warp_key}}) {
            const weave::SimulatedYarn& yarn = yarns.yarns[index];
            const weave::Spline planned{yarn.planned, yarn.spline.is_periodic, yarn.spline.shift};
            const double at = 4.0 * static_cast<double>(key);
            CHECK((yarn.spline.place(at) - planned.place(at)).norm() < 1e-12);
        }
    }
}

TEST_CASE("a pin on a yarn that the cloth does not have is refused, and told by info and check") {
    const Workshop shop;
    shop.must({"samples", "twill-g", "-o", "d.weave"});
    const Json info = shop.json({"info", "d.weave"});
    const std::size_t picks = info.at("picks"), ends = info.at("ends");
    const std::string loom = std::string(WEAVE_SOURCE_DIR) + "/db/looms/tc2.json";
    const auto pin = [&](const char* system, std::size_t number) {
        Json design = Json::parse(shop.get("d.weave"));
        design["scene"]["pins"] = {{{"system", "pick"}, {"number", 0}}, {{"system", system}, {"number", number}}};
        shop.put("p.weave", design.dump());
    };
    for (const auto& [system, count] : {std::pair{"pick", picks}, {"end", ends}}) {
        INFO(system);
        const std::vector<std::string> pieces{"p.weave: scene.pins[1].number",
                                              "is " + std::to_string(count) + ",",
                                              std::string(system) + "s count from 0 to " + std::to_string(count - 1)};
        pin(system, count);
        shop.refused({"simulate", "p.weave", "-o", "p.yarns"}, 3, pieces);
        shop.refused({"simulate", "p.weave", "--explain"}, 3, pieces);
        for (const std::vector<std::string>& words :
             {std::vector<std::string>{"info", "p.weave"}, {"check", "p.weave", "--loom", loom}}) {
            const Ended ended = shop.run(words);
            CHECK(ended.exit == 0);
            REQUIRE(ended.complaints().size() == 1);
            for (const std::string& piece : pieces) CHECK(ended.complaints()[0].find(piece) != std::string::npos);
        }
        pin(system, count - 1);
        shop.must({"simulate", "p.weave", "--explain"});
        CHECK(shop.run({"info", "p.weave"}).complaints().empty());
    }
}

TEST_CASE("friction of the design or of this run holds yarns nearer to where they started, with both solvers") {
    const Workshop shop;
    shop.must({"samples", "layer-to-layer", "-o", "d.weave"});
    CHECK(choice_of(shop.json({"simulate", "d.weave", "--explain"}), "friction") == "off");
    CHECK(choice_of(shop.json({"simulate", "d.weave", "--explain", "--set", "friction=0.3"}), "friction") == "0.3");
    // Whether its layers lean, which inspect tells by its exit status, is not asked here.
    const auto thickness = [&](const std::string& file) {
        return weave::parse_json(shop.run({"inspect", file, "--json"}).out)->at("thickness_mm").get<double>();
    };
    const Json smooth = shop.json({"simulate", "d.weave", "--threads", "1", "-o", "smooth.yarns"});
    CHECK_FALSE(smooth.contains("friction"));
    for (const char* solver : {"relax", "paper"}) {
        const Json rough = shop.json({"simulate", "d.weave", "--threads", "1", "--set", "friction=0.3", "--solver", solver, "-o", "rough.yarns"});
        INFO(solver << " " << rough.at("friction").dump());
        CHECK(rough.at("converged") == true);
        CHECK(rough.at("order_kept") == true);
        CHECK(rough.at("residual").get<double>() <= 1e-3);
        CHECK(rough.at("friction").at("coefficient") == 0.3);
        CHECK(rough.at("friction").at("agreed") == true);
        CHECK(rough.at("friction").at("rounds").get<int>() >= 2);
        CHECK(rough.at("friction").at("press_N").get<double>() > 0);
        // Without friction its layers sink into one another.
        CHECK(thickness("rough.yarns") > 1.2 * thickness("smooth.yarns"));
    }
    // What is at rest with friction stays there when it is taken up again: slip of some hundredths of a radius holds it.
    const Json again = shop.json({"simulate", "d.weave", "--threads", "1", "--set", "friction=0.3", "--resume", "rough.yarns", "-o", "again.yarns"});
    CHECK(again.at("friction").at("stuck_share").get<double>() > 0.9);
    CHECK(shop.json({"compare", "rough.yarns", "again.yarns"}).at("max_mm").get<double>() < 0.01);
    Json design = Json::parse(shop.get("d.weave"));
    design["scene"]["friction"] = 0.3;
    shop.put("r.weave", design.dump());
    const Json own = shop.json({"simulate", "r.weave", "--threads", "1", "-o", "own.yarns"});
    CHECK(own.at("friction").at("coefficient") == 0.3);
    const Ended said = shop.must({"simulate", "r.weave", "--threads", "1", "-o", "own.yarns"});
    CHECK(said.out.find("friction 0.3: its forces agree") != std::string::npos);
    // A period that relaxes takes it too.
    shop.must({"samples", "plain", "-o", "p.weave"});
    const Json free = shop.json({"simulate", "p.weave", "--threads", "1", "--set", "friction=0.3", "--boundary", "y=relaxing:0.2", "-o", "free.yarns"});
    CHECK(free.at("periods").at("balanced") == true);
    CHECK(free.at("friction").at("agreed") == true);
}

TEST_CASE("further starts tell how much the result owes to its own, also when it is looked at later") {
    const Workshop shop;
    shop.must({"samples", "satin-5", "-o", "d.weave"});
    const Json plain = shop.json({"simulate", "d.weave", "--threads", "1", "--fidelity", "draft", "-o", "p.yarns"});
    CHECK_FALSE(plain.contains("starts"));
    CHECK(shop.json({"inspect", "p.yarns"}).at("starts").is_null());
    const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--fidelity", "draft", "--starts", "2", "-o", "d.yarns"});
    CHECK(said.at("starts").at("runs") == 2);
    CHECK(said.at("starts").at("noise_radii") == 0.05);
    CHECK(said.at("energy_N_mm") == plain.at("energy_N_mm"));  // the yarns are those of the planned start
    CHECK(shop.json({"inspect", "d.yarns"}).at("starts") == said.at("starts"));
    CHECK(shop.must({"inspect", "d.yarns"}).out.find("to its start") != std::string::npos);
    CHECK(shop.must({"inspect", "p.yarns"}).out.find("to its start") == std::string::npos);
    const Json other = shop.json({"simulate", "d.weave", "--threads", "1", "--fidelity", "draft", "--starts", "2", "--seed", "7", "-o", "e.yarns"});
    CHECK(other.at("starts").at("furthest") != said.at("starts").at("furthest"));
}

TEST_CASE("the whole of a tiled cloth, started with noise, is compared with its smallest repeat") {
    const Workshop shop;
    shop.must({"samples", "plain", "-o", "p.weave"});
    shop.must({"tile", "p.weave", "--x", "2", "--y", "2", "-o", "d.weave"});
    const Json said = shop.json({"simulate", "d.weave", "--threads", "1", "--symmetry", "--residual", "1e-5", "-o", "d.yarns"});
    const Json symmetry = said.at("symmetry");
    INFO(symmetry.dump());
    CHECK(symmetry.at("repeats") == Json({2, 2}));
    CHECK(symmetry.at("converged") == true);
    CHECK(symmetry.at("order_kept") == true);
    CHECK(symmetry.at("broken") == (symmetry.at("between_repeats").at("max_radii").get<double>() > 0.1));
    const Json one = shop.json({"simulate", "p.weave", "--threads", "1", "--residual", "1e-5", "-o", "p.yarns"});
    CHECK(said.at("points") == one.at("points"));
    CHECK(symmetry.at("energy_of_repeats_N_mm").get<double>() == Approx(4 * one.at("energy_N_mm").get<double>()).epsilon(1e-6));
    CHECK(shop.json({"inspect", "d.yarns"}).at("symmetry") == symmetry);
    const std::string words = shop.must({"inspect", "d.yarns"}).out;
    CHECK(words.find(symmetry.at("broken") == true ? "SYMMETRY BROKEN" : "Symmetric: relaxed as a whole") != std::string::npos);
    const Json whole = shop.json({"simulate", "d.weave", "--threads", "1", "--symmetry", "--whole", "--residual", "1e-5", "-o", "w.yarns"});
    CHECK(whole.at("points").get<int>() == 4 * one.at("points").get<int>());
    CHECK(whole.at("energy_N_mm") == symmetry.at("energy_N_mm"));
}

TEST_CASE("a block tiled 4 by 4 costs what the single one does, and gives the same yarns") {
    const Workshop shop;
    for (const char* sample : {"plain", "satin-5"}) {
        INFO(sample);
        shop.must({"samples", sample, "-o", "p.weave"});
        shop.must({"tile", "p.weave", "--x", "4", "--y", "4", "-o", "d.weave"});
        const Json one = shop.json({"simulate", "p.weave", "--threads", "1", "-o", "p.yarns"}),
                   many = shop.json({"simulate", "d.weave", "--threads", "1", "-o", "d.yarns"});
        // The same numbers of the same kind of step: no clock is asked, since other work runs beside.
        for (const char* key : {"points", "contacts", "iterations", "evaluations", "residual", "energy_N_mm"}) CHECK(many.at(key) == one.at(key));
        const weave::Yarns small = yarns_in(shop, "p.yarns"), large = yarns_in(shop, "d.yarns");
        REQUIRE(large.yarns.size() == 4 * small.yarns.size());
        std::size_t same = 0;
        for (const weave::SimulatedYarn& yarn : large.yarns) {
            for (const weave::SimulatedYarn& of : small.yarns) {
                if (yarn.system != of.system || yarn.number != of.number) continue;
                REQUIRE(yarn.spline.control.size() == 4 * of.spline.control.size());
                CHECK(std::equal(of.spline.control.begin(), of.spline.control.end(), yarn.spline.control.begin()));
                ++same;
            }
        }
        CHECK(same == small.yarns.size());
    }
}
