// Every rule of validation: a design that breaks it is found at the right place, one that keeps it is not.

#include "check_case.hpp"

#include <limits>
#include <set>

using namespace weave;
using namespace weave::testing;

TEST_CASE("every rule is judged exactly once: found, passed or not evaluated") {
    for (const bool turning : {false, true}) {
        for (const Insertion insertion : {Insertion::shuttle, Insertion::rapier, Insertion::air_jet}) {
            Case c;
            c.profile.insertion = insertion;
            if (turning) c.design.scene.weft_mode = WeftMode::wraparound;
            const CheckReport report = check_for_loom(c.design, c.cloth, c.profile);
            std::multiset<std::string> seen(report.passed.begin(), report.passed.end());
            for (const auto& n : report.not_evaluated) seen.insert(n.rule);
            std::set<std::string> found;
            for (const auto& f : report.findings) found.insert(f.rule);
            seen.insert(found.begin(), found.end());
            for (const Rule& rule : rules()) {
                INFO(rule.id);
                CHECK(seen.count(rule.id) == 1);
            }
            CHECK(seen.size() == rules().size());
            CHECK(report.count(Severity::error) == 0);
        }
    }
}

TEST_CASE("floats are runs of the card image, also through the repeat, on both faces") {
    Case c;
    c.cloth.block = block_of({"111011", "010101", "101010", "010101"});
    c.expect_at("float.face", 0, 4);  // 5 ends from end 5 through the repeat to end 3
    CHECK(c.of("float.face").size() == 1);
    CHECK(c.of("float.face")[0].message.find("5 ends, from end 5 through the repeat to 3") !=
          std::string::npos);
    CHECK(c.passes("float.back"));
    c.cloth.block = block_of({"10", "10", "10", "10", "01"});
    c.expect_at("float.face", 0, 1);  // end 2 over picks 1 to 4
    c.expect_at("float.back", 0, 0);
    c.profile.limits.float_face = 4;
    CHECK(c.passes("float.face"));
    c.profile.limits.float_back = 0;
    CHECK(c.lacks("float.back"));
}

TEST_CASE("in wraparound the width does not repeat") {
    Case c;
    c.cloth.block = block_of({"110011", "010101", "101010", "010101"});
    CHECK(c.of("float.face").size() == 1);
    c.design.scene.weft_mode = WeftMode::wraparound;
    CHECK(c.of("float.face").empty());
}

TEST_CASE("picks and ends that do not bind are found, unless they are loose") {
    Case c;
    c.cloth.block = block_of({"0111", "0000", "0101", "0010"});
    c.expect_at("bind.pick", 1, {});
    c.expect_at("bind.end", {}, 0);
    CHECK(c.of("bind.end").size() == 1);
    c.cloth.block = std::make_shared<const Block>(
        make_block({1, 1}, {1, 1}, [](std::size_t row, std::size_t column) {
            const bool weft_up = (row + column) % 2 == 0;
            if (column == 1) return Stack({Slot::weft(0), Slot::warp(0, true)});
            return weft_up ? Stack({Slot::warp(0), Slot::weft(0)}) : Stack({Slot::weft(0), Slot::warp(0)});
        }).value());
    CHECK(c.passes("bind.end"));
    CHECK(c.of("bind.pick").size() == 2);  // a trimmed end binds no pick
}

TEST_CASE("hooks: too many ends, cast-out hooks") {
    Case c;
    CHECK(c.passes("hooks.fit"));
    CHECK(c.passes("hooks.castout"));
    c.profile.cast_out = {{2, 2}};
    c.expect_at("hooks.castout", {}, 2);
    c = Case{};
    c.profile.body = {{0, 2}};
    c.expect_at("hooks.fit", {}, 3);
}

TEST_CASE("selvedge, picks and title") {
    Case c;
    CHECK(c.passes("selvedge.binds"));
    c.profile.selvedge_weave = {"01", "00"};
    c.expect_at("selvedge.binds", 1, {});
    // Picks that only take up carry no weft: they neither hold an end nor need to be held.
    c.design.weft.feeder_order = {{0}, {}};
    c.design.weft.take_up = {true, true};
    c.expect_at("selvedge.binds", {}, {});
    c.profile.selvedge_weave = {"01", "00", "10", "11"};
    CHECK(c.passes("selvedge.binds"));
    c.design.weft.feeder_order = {{0}};
    c.profile.selvedge_weave.clear();
    CHECK(c.lacks("selvedge.binds"));
    CHECK(c.lacks("selvedge.needed"));
    c.profile.insertion = Insertion::rapier;
    CHECK(c.passes("selvedge.needed"));
    c.profile.selvedge.clear();
    c.expect_at("selvedge.needed", {}, {});
    c.profile.limits.picks = 3;
    c.expect_at("picks.limit", 3, {});
    c.design.title = "A long title";
    c.expect_at("name.limit", {}, {});
    c.design.title = "Short";
    CHECK(c.passes("name.limit"));
}

TEST_CASE("feeders: per pick, none, range") {
    Case c;
    c.design.weft.feeders = {{"a", 0}, {"b", 0}};
    c.design.weft.feeder_order = {{0}, {0, 1}, {}, {0}};
    c.expect_at("feeders.per-pick", 1, {});
    c.expect_at("feeders.range", 1, {});
    CHECK(c.passes("feeders.none"));
    c.design.weft.take_up = {true, true, false, true};
    c.expect_at("feeders.none", 2, {});
    c.profile.feeders = 2;
    c.profile.feeders_per_pick = 2;
    CHECK(c.passes("feeders.per-pick"));
    CHECK(c.passes("feeders.range"));
}

TEST_CASE("lifts: balance, share, face down") {
    Case c;
    CHECK(c.passes("lift.balance"));
    CHECK(c.passes("lift.share"));
    CHECK(c.passes("lift.face-down"));
    c.cloth.block = block_of({"0101", "1110", "0000", "1011"});
    c.expect_at("lift.balance", 2, {});
    c.expect_at("lift.share", 2, {});
    c.cloth.block = block_of({"0001", "1110", "0000", "0001"});
    c.expect_at("lift.face-down", {}, {});
    c.profile.limits.lift_share.reset();
    CHECK(c.lacks("lift.share"));
}

TEST_CASE("turns: caught, crossed, box, cut") {
    Case c;
    CHECK(c.lacks("turn.caught"));
    CHECK(c.passes("turn.box"));
    c.design.scene.weft_mode = WeftMode::wraparound;
    CHECK(c.passes("turn.caught"));
    CHECK(c.passes("turn.crossed"));
    c.cloth.block = block_of({"0101", "0101", "1010"});
    c.expect_at("turn.caught", 1, {});
    c.expect_at("repeat.doubled", {}, {});
    c.design.scene.boundary_x = Boundary::frozen;
    c.cloth.block = block_of({"0001", "0111", "1111"});  // right turn at end 3, left turn at end 1: fine
    CHECK(c.passes("turn.crossed"));
    c.cloth.block = block_of({"1000", "0000", "0001"});  // right turn back to end 1, left turn on to end 4
    c.expect_at("turn.crossed", 1, {});
    c.design.weft.directions = {Direction::left_to_right, Direction::left_to_right, Direction::right_to_left};
    c.expect_at("turn.box", 1, {});
    c.profile.insertion = Insertion::rapier;
    c.expect_at("turn.cut", {}, {});
    c.expect_at("insertion.match", {}, {});
    CHECK(c.lacks("turn.box"));
}

TEST_CASE("take-up: stops, regulator, beams") {
    Case c;
    c.cloth.block = block_of(plain, 2);
    CHECK(c.passes("take-up.stop"));
    CHECK(c.passes("take-up.regulator"));
    c.profile.regulator_hooks.clear();
    c.expect_at("take-up.regulator", 0, {});
    c.design.weft.take_up = {true};
    c.expect_at("take-up.stop", 0, {});
    CHECK(c.lacks("take-up.beam"));
    CHECK(c.lacks("consumption"));
    c.relaxed.emplace().take_up = {0.1, 0.11, 0.1, 0.2};
    c.expect_at("take-up.beam", {}, 3);
    c.design.warp.beams = {{"a"}, {"b"}};
    c.design.warp.beam_order.once = {0, 0, 0, 1};
    CHECK(c.passes("take-up.beam"));
    c.relaxed->take_up.at(2) = std::numeric_limits<double>::quiet_NaN();
    CHECK(c.lacks("take-up.beam"));  // end 3 binds, so it should have a take-up
    c.relaxed->take_up.pop_back();
    CHECK(c.lacks("take-up.beam"));
}

TEST_CASE(
    "without a limit of the loom the take-up of each beam is told, and warned of beyond the usual "
    "difference") {
    Case c;
    c.profile.limits.take_up_difference.reset();
    c.design.warp.beams = {{"a"}, {"b"}};
    c.design.warp.beam_order.once = {0, 0, 0, 1};
    c.relaxed.emplace().take_up = {0.1, 0.105, 0.095, 0.2};
    CHECK(c.passes("take-up.beam"));
    const std::vector<Finding> told = c.of("take-up.beam");
    REQUIRE(told.size() == 2);  // one a beam
    CHECK(told[0].severity == Severity::info);
    CHECK(told[0].end == 1);
    CHECK(told[0].message.find("'a' end 2 takes up 10.5 % and end 3 only 9.5 % of 3 ends") !=
          std::string::npos);
    CHECK(told[1].end == 3);
    c.relaxed->take_up[1] = 0.1051;
    CHECK_FALSE(c.passes("take-up.beam"));
    const std::vector<Finding> warned = c.of("take-up.beam");
    REQUIRE(warned.size() == 2);
    CHECK(warned[0].severity == Severity::warning);
    CHECK(warned[0].message.find("the profile sets no limit") != std::string::npos);
    CHECK(warned[1].severity == Severity::info);
    c.profile.severities["take-up.beam"] = Severity::off;
    CHECK(c.of("take-up.beam").empty());
}

TEST_CASE("a relaxed cloth tells the yarn that each beam and each feeder gives") {
    Case c;
    c.design.warp.beams = {{"ground"}, {"pile"}, {"idle"}};
    c.design.warp.beam_order.once = {0, 0, 0, 1};
    c.design.warp.yarns[0].linear_density_tex = 100;
    c.design.weft.yarns[0].linear_density_tex = 50;
    RelaxedCloth& relaxed = c.relaxed.emplace();
    CHECK(c.lacks("consumption"));  // no lengths
    relaxed.end_mm = {2.2, 2.1, 2.3, 5};
    relaxed.feeder_mm = {10};
    relaxed.length_mm = 2;
    relaxed.width_mm = 2;
    const std::vector<Finding> told = c.of("consumption");
    REQUIRE(told.size() == 3);  // two beams with ends, one feeder
    INFO(told[0].message);
    // 6.6 mm on 2 mm of cloth: 3.3 m on a metre, of 100 g a kilometre.
    CHECK(told[0].message.find(
              "beam 'ground': 3 ends take 3.30 m (0.33 g) for a metre of cloth, 6.6 mm (0.7 mg) for one "
              "repeat of the design; each from 1.050 m (end 2) to 1.150 m (end 3)") != std::string::npos);
    CHECK(told[1].message.find("beam 'pile': 1 end takes ") != std::string::npos);
    CHECK(told[2].message.find("4 picks of the design take 5.00 m (0.25 g)") != std::string::npos);
    CHECK(told[0].severity == Severity::info);
    c.profile.hook_rule = HookRule::repeats;
    c.profile.repeats = 2;
    CHECK(c.of("consumption")[0].message.find("6 ends take 6.60 m (0.66 g)") != std::string::npos);
    CHECK(c.of("consumption")[2].message.find("take 10.00 m (0.50 g)") != std::string::npos);
    relaxed.end_mm[1] = std::numeric_limits<double>::quiet_NaN();
    CHECK(c.lacks("consumption"));  // end 2 binds
    relaxed.end_mm[1] = 2.1;
    relaxed.feeder_mm.push_back(1);
    CHECK(c.lacks("consumption"));
}

TEST_CASE("the finished width is told against that in the reed, if the simulation found it") {
    Case c;  // 4 ends at 20 to the centimetre: 2 mm in the reed
    RelaxedCloth& relaxed = c.relaxed.emplace();
    relaxed.width_mm = 1.9;
    CHECK(c.lacks("cloth.width"));
    relaxed.width_found = true;
    const std::vector<Finding> told = c.of("cloth.width");
    REQUIRE(told.size() == 1);
    CHECK(told[0].severity == Severity::info);
    CHECK(told[0].message.find(
              "1.9 mm wide, and 2.0 mm in the reed, which takes 50.0 mm: it draws in by 5.0 %") !=
          std::string::npos);
    relaxed.width_mm = 0;
    CHECK(c.lacks("cloth.width"));
}

TEST_CASE("reed and density") {
    Case c;
    CHECK(c.passes("reed.width"));
    CHECK(c.passes("reed.dents"));
    CHECK(c.passes("warp.density"));
    c.profile.limits.reed_width_mm = 1.9;
    c.design.warp.ends_per_dent = 3;
    c.profile.density_ends_per_cm = 10;
    c.expect_at("reed.width", {}, {});
    c.expect_at("reed.dents", {}, {});
    c.expect_at("warp.density", {}, {});
}

TEST_CASE("lost flips, severities of the profile, and many findings in one place") {
    Case c;
    c.design.root = "cloth";
    c.cloth.lost_flips = {{"cloth", {1, 2, true}, "pick 1 stands in the way"}};
    c.expect_at("flips.apply", 1, 2);
    c.profile.severities["flips.apply"] = Severity::info;
    CHECK(c.of("flips.apply")[0].severity == Severity::info);
    c.profile.severities["flips.apply"] = Severity::off;
    CHECK(c.lacks("flips.apply"));
    CHECK(c.of("flips.apply").empty());
    c.cloth.block = block_of(std::vector<std::string>(300, "0000"));
    const auto found = c.of("bind.pick");
    CHECK(found.size() == 101);
    CHECK(found.back().message.find("200 more places") != std::string::npos);
    CHECK(c.passes("block.constraints"));
}
