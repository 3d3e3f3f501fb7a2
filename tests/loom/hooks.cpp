// Hooks that ends share, both sides of the selvedge, the reed, and the count of errors.

#include "../support/random.hpp"
#include "check_case.hpp"

#include <set>

using namespace weave;
using namespace weave::testing;

TEST_CASE("ends that share a hook must work alike; what no file was written for is not read back") {
    Case c;
    CHECK(c.passes("hooks.shared"));
    CHECK(c.lacks("hooks.read-back"));
    c.profile.hook_rule = HookRule::list;
    c.profile.hook_of_end = {0, 1, 0, 1};
    CHECK(c.passes("hooks.shared"));
    c.profile.hook_of_end = {0, 1, 2, 2};
    c.expect_at("hooks.shared", 0, 3);
    CHECK(c.lacks("hooks.read-back"));
    c.profile.hook_of_end = {0, 1};
    CHECK(c.lacks("hooks.shared"));
}

TEST_CASE("what came of reading the controller's file back is reported, where there is such a file") {
    Case c;
    const auto judged = [&](const std::optional<ReadBack>& read_back) {
        return check_for_loom(c.design, c.cloth, c.profile, {}, read_back);
    };
    const auto reason = [](const CheckReport& report) {
        for (const NotEvaluated& rule : report.not_evaluated)
            if (rule.rule == "hooks.read-back") return rule.reason;
        return std::string();
    };
    const auto passed = [](const CheckReport& report) {
        return std::count(report.passed.begin(), report.passed.end(), "hooks.read-back") == 1;
    };
    const ReadBack equal{ReadBack::Outcome::equal, ""},
        differs{ReadBack::Outcome::differs, "hook 7 in record 2"},
        none{ReadBack::Outcome::no_file, "feeder 3 is mapped to no feeder of the loom"};
    CHECK(reason(judged(equal)) == "this loom takes a picture, no file of hooks");
    c.profile.output = OutputFormat::ep;
    CHECK(reason(judged({})) == "needs the file for the controller, which loomlink writes and reads back");
    CHECK(reason(judged(none)) ==
          "there is no file for the controller: feeder 3 is mapped to no feeder of the loom");
    CHECK(passed(judged(equal)));
    CHECK_FALSE(passed(judged(differs)));
    CHECK(reason(judged(differs)).empty());
    CHECK(judged(differs).count(Severity::error) == judged(equal).count(Severity::error) + 1);
}

TEST_CASE("errors are counted, all of them, however many are listed") {
    Case c;
    c.cloth.block = block_of(std::vector<std::string>(300, "01"));
    const CheckReport report = check_for_loom(c.design, c.cloth, c.profile);
    // 300 picks bind, two ends do not.
    CHECK(c.of("bind.end").size() == 2);
    c.cloth.block = block_of(std::vector<std::string>(300, "00"));
    const CheckReport unbound = check_for_loom(c.design, c.cloth, c.profile);
    CHECK(unbound.count(Severity::error) - report.count(Severity::error) == 300);
    CHECK(c.of("bind.pick").size() == 101);
    c.profile.severities["bind.pick"] = Severity::warning;
    const CheckReport milder = check_for_loom(c.design, c.cloth, c.profile);
    CHECK(unbound.count(Severity::error) - milder.count(Severity::error) == 300);
}

TEST_CASE("the selvedge of each side holds every pick by itself") {
    Case c;
    c.profile.body = {{4, 31}};
    c.profile.selvedge = {{0, 1}, {32, 33}};
    c.profile.selvedge_weave = {"0110", "1001"};
    CHECK(c.passes("selvedge.binds"));
    c.profile.selvedge_weave = {"0011", "1100"};
    c.expect_at("selvedge.binds", 0, {});
    const auto found = c.of("selvedge.binds");
    CHECK(found.size() == 4);  // two lines on two sides
    CHECK(found[0].message.find("hooks 1 to 2") != std::string::npos);
    // Ranges with no body hook between them are one side.
    c.profile.selvedge = {{0, 1}, {2, 3}};
    CHECK(c.passes("selvedge.binds"));
}

TEST_CASE("the selvedge binds where the lifts of each hook and pick say so") {
    for_all([](Random& random) {
        Case c;
        const std::size_t width = random.between(1, 5), lines = random.between(1, 4);
        c.profile.body = {{8, 31}};
        c.profile.selvedge = {{0, random.between(0, 6)}, {32, 32 + random.between(0, 6)}};
        c.profile.selvedge_weave.clear();
        for (std::size_t k = 0; k < lines; ++k) {
            std::string line;
            for (std::size_t w = 0; w < width; ++w) line += random.coin() ? '1' : '0';
            c.profile.selvedge_weave.push_back(line);
        }
        c.design.weft.feeder_order.clear();
        for (std::size_t k = random.between(1, 7); k > 0; --k) {
            if (random.between(0, 2) == 0)
                c.design.weft.feeder_order.emplace_back();
            else
                c.design.weft.feeder_order.push_back({0});
        }
        c.cloth.block = block_of(std::vector<std::string>(random.between(1, 9), "01"));
        const std::size_t picks = c.cloth.block->picks();
        const auto carries = [&](std::size_t pick) {
            return !c.design.weft.feeder_order[pick % c.design.weft.feeder_order.size()].empty();
        };
        std::set<std::size_t> ends;  // places that do not bind
        std::set<std::size_t> held;  // lines whose first pick some side does not hold
        std::size_t place = 0;
        for (const HookRange& range : c.profile.selvedge) {
            const std::size_t first = place;
            for (std::size_t hook = range.first; hook <= range.last; ++hook, ++place) {
                std::set<bool> lifts;
                for (std::size_t pick = 0; pick < picks; ++pick) {
                    if (carries(pick)) lifts.insert(selvedge_lifted(c.profile, place, pick));
                }
                if (lifts.size() < 2) ends.insert(hook);
            }
            std::set<std::size_t> lines_seen;
            for (std::size_t pick = 0; pick < picks; ++pick) {
                if (!carries(pick) || !lines_seen.insert(pick % lines).second) continue;
                std::set<bool> sides;
                for (std::size_t at = first; at < place; ++at) {
                    sides.insert(selvedge_lifted(c.profile, at, pick));
                }
                if (sides.size() < 2) held.insert(pick);
            }
        }
        std::set<std::size_t> found_picks;
        std::size_t found_ends = 0;
        for (const Finding& finding : c.of("selvedge.binds")) {
            if (finding.pick)
                found_picks.insert(*finding.pick);
            else
                ++found_ends;
        }
        CHECK(found_picks == held);
        CHECK(found_ends == ends.size());
    });
}

TEST_CASE("the reed holds all ends of the loom: every repeat, the mirror image, and the selvedge") {
    Case c;
    c.profile.selvedge.clear();
    c.profile.selvedge_weave.clear();
    c.profile.hook_rule = HookRule::repeats;
    c.profile.repeats = 2;
    c.cloth.block = block_of({"01010", "10101"});
    c.design.warp.ends_per_dent = 2;
    CHECK(c.passes("reed.dents"));  // ten ends, five dents
    c.design.warp.ends_per_dent = 4;
    CHECK(c.of("reed.dents").at(0).message.find("holds only 2") != std::string::npos);
    c.profile.hook_rule = HookRule::point;  // nine ends
    c.design.warp.ends_per_dent = 3;
    CHECK(c.passes("reed.dents"));
    c.profile.limits.reed_width_mm = 4.6;  // nine ends at 20 to the centimetre are 4.5 mm
    CHECK(c.passes("reed.width"));
    c.profile.selvedge = {{32, 33}};
    c.expect_at("reed.width", {}, {});
    CHECK(c.of("reed.width")[0].message.find("11 ends") != std::string::npos);
}

TEST_CASE("the harness may be off by a hundredth, and the finished width waits for a simulation") {
    Case c;
    c.design.warp.density_ends_per_cm = 20.19;
    CHECK(c.passes("warp.density"));
    c.design.warp.density_ends_per_cm = 20.21;
    CHECK_FALSE(c.passes("warp.density"));
    CHECK(c.lacks("cloth.width"));
}
