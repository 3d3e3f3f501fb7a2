// What every hook does on every pick: the profile's rules, feeders, take-up, and what is refused.

#include "export_case.hpp"

using namespace weave;
using namespace weave::loomlink;
using namespace weave::testing;

namespace {

using Hooks = std::vector<std::size_t>;

/// Twelve hooks: 0 to 7 for ends, 8 and 9 selvedge, 10 always lifted, 11 stops the take-up.
LoomProfile twelve() {
    LoomProfile profile = plain_loom(OutputFormat::raw, 12);
    profile.body = {{0, 7}};
    profile.selvedge = {{8, 9}};
    profile.selvedge_weave = {"01", "10"};
    profile.constant_on = {{10, 10}};
    profile.regulator_hooks = {11};
    profile.feeders = 3;
    return profile;
}

}  // namespace

TEST_CASE("straight, point, repeats and a list put the ends on their hooks, from either side") {
    LoomProfile profile = plain_loom(OutputFormat::raw, 12);
    profile.body = {{1, 4}, {7, 10}};
    const Design design = design_of(card_of({"X..", ".X.", "..X"}), {0});
    const auto lifts = [&](std::size_t pick) { return lifted(plan_of(design, profile, {}).value(), pick); };
    CHECK(lifts(0) == Hooks{1});
    CHECK(lifts(2) == Hooks{3});
    profile.end_1_at_left = false;
    CHECK(lifts(0) == Hooks{10});
    CHECK(lifts(2) == Hooks{8});
    profile.hook_rule = HookRule::point;
    CHECK(lifts(0) == Hooks{4, 10});
    CHECK(lifts(2) == Hooks{8});
    profile.end_1_at_left = true;
    CHECK(lifts(0) == Hooks{1, 7});
    CHECK(lifts(1) == Hooks{2, 4});
    CHECK(lifts(2) == Hooks{3});
    profile.hook_rule = HookRule::repeats;
    profile.repeats = 2;
    CHECK(lifts(0) == Hooks{1, 4});
    CHECK(lifts(2) == Hooks{3, 8});
    profile.hook_rule = HookRule::list;
    profile.body.clear();
    profile.hook_of_end = {9, 0, 5};
    CHECK(lifts(0) == Hooks{9});
    CHECK(lifts(1) == Hooks{0});
    CHECK(lifts(2) == Hooks{5});
}

TEST_CASE("selvedge, constant-on and regulator hooks; lead-in picks lift only what always lifts") {
    LoomProfile profile = twelve();
    profile.lead_in_picks = 2;
    Design design = design_of(card_of({"X.......", ".X......", "..X....."}), {1, 0, 2});
    design.weft.take_up = {true, true, false};
    const auto plan = plan_of(design, profile, straight_map(3));
    REQUIRE(plan);
    CHECK(plan->lead_in == 2);
    CHECK(plan->lifts.picks() == 5);
    CHECK(lifted(*plan, 0) == Hooks{10});
    CHECK(lifted(*plan, 1) == Hooks{10});
    CHECK(lifted(*plan, 2) == Hooks{0, 9, 10});
    CHECK(lifted(*plan, 3) == Hooks{1, 8, 10});
    CHECK(lifted(*plan, 4) == Hooks{2, 9, 10, 11});
    CHECK(plan->feeders == std::vector<Hooks>{{}, {}, {0}, {}, {1}});
    CHECK(plan->uses[10] == HookUse::constant_on);
}

TEST_CASE("feeders: one-hot, binary, hooks and binary hooks, after the map") {
    LoomProfile profile = plain_loom(OutputFormat::raw, 12);
    profile.body = {{0, 3}};
    profile.feeders = 6;
    const Design design = design_of(card_of({"....", "....", "...."}), {1, 2, 0});
    const FeederMap map{{0, 4}, {1, 2}};  // the loom's fifth and third
    const auto plan = [&] { return plan_of(design, profile, map).value(); };
    profile.feeder_encoding = FeederEncoding::one_hot;
    profile.feeder_hooks = {7, 6, 5, 4, 3, 2};
    CHECK(plan().function_words == std::vector<std::uint64_t>{1 << 3, 1 << 5, 0});
    profile.feeder_encoding = FeederEncoding::binary;
    profile.feeder_hooks = {0, 8, 63};
    CHECK(plan().function_words == std::vector<std::uint64_t>{1 | std::uint64_t{1} << 63, 1 | 1 << 8, 0});
    profile.feeder_encoding = FeederEncoding::hooks;
    profile.feeder_hooks = {4, 5, 6, 7, 8, 9};
    CHECK(lifted(plan(), 0) == Hooks{8});
    CHECK(lifted(plan(), 1) == Hooks{6});
    CHECK(lifted(plan(), 2).empty());
    CHECK(plan().uses[9] == HookUse::feeder);
    profile.feeder_encoding = FeederEncoding::binary_hooks;
    profile.feeder_hooks = {9, 10, 11};
    CHECK(lifted(plan(), 0) == Hooks{9, 11});
    CHECK(lifted(plan(), 1) == Hooks{9, 10});
    CHECK(plan().uses[9] == HookUse::feeder);
    CHECK(plan().uses[8] == HookUse::cast_out);
    CHECK(plan().function_words == std::vector<std::uint64_t>(3));
}

TEST_CASE("feeders that are not mapped, not there, shared by two yarns or too many at once are refused") {
    LoomProfile profile = twelve();
    Design design = design_of(card_of({"X.......", ".X......"}), {1, 2});
    expect_refusal(plan_of(design, profile, {{0, 0}}),
                   "pick 2 takes feeder 2 of the design, which is mapped to no");
    expect_refusal(plan_of(design, profile, {{0, 0}, {1, 3}}),
                   "mapped to feeder 4, but the loom has 3 feeders");
    expect_refusal(plan_of(design, profile, {{0, 1}, {1, 1}}), "carry different yarns");
    design.weft.feeders[1].yarn = design.weft.feeders[0].yarn;
    CHECK(plan_of(design, profile, {{0, 1}, {1, 1}}));
    design.weft.feeder_order = {{0, 2}, {1}};
    const FeederMap all = straight_map(3);
    expect_refusal(plan_of(design, profile, all), "pick 1 takes 2 feeders, but this loom takes 1");
    profile.feeders_per_pick = 2;
    CHECK(plan_of(design, profile, all));
    expect_refusal(plan_of(design, profile, {{0, 0}, {1, 0}, {2, 0}}), "twice");
    profile.feeder_encoding = FeederEncoding::binary;
    profile.feeder_hooks = {0, 1};
    expect_refusal(plan_of(design, profile, all), "pick 1 takes 2 feeders, but this loom takes 1");
}

TEST_CASE("a cloth that does not go on the loom is refused") {
    LoomProfile profile = twelve();
    const auto refused = [&](const std::vector<std::string>& picks, const std::string& words) {
        expect_refusal(plan_of(design_of(card_of(picks), {0}), profile, {}), words);
    };
    refused({"X........"}, "9 ends, but this loom carries at most 8");
    profile.limits.picks = 2;
    CHECK(plan_of(design_of(card_of({"X", "."}), {0}), profile, {}));
    refused({"X", ".", "X"}, "holds at most 2");
    profile.lead_in_picks = 1;
    refused({"X", "."}, "3 picks with the lead-in");
    profile = twelve();
    profile.cast_out = {{2, 2}};
    refused({"..."}, "end 3 is tied to hook 3, which is no body hook");
    profile = twelve();
    profile.cast_out = {{10, 10}};
    refused({"X"}, "hook 11 is cast out, but would lift");
    profile = twelve();
    profile.regulator_hooks = {12};
    refused({"X"}, "hooks that it does not have");
    profile = twelve();
    profile.areas = {{"all", 11}};
    refused({"X"}, "do not add up");
    profile = twelve();
    profile.lead_in_picks = std::size_t{1} << 29;
    refused({"X"}, "more than");
}

TEST_CASE("ends that share a hook must work alike") {
    LoomProfile profile = plain_loom(OutputFormat::raw, 8);
    profile.body.clear();
    profile.hook_rule = HookRule::list;
    profile.hook_of_end = {0, 1, 0};
    CHECK(plan_of(design_of(card_of({"X.X", ".X."}), {0}), profile, {}));
    expect_refusal(plan_of(design_of(card_of({"X.X", ".XX"}), {0}), profile, {}),
                   "end 1 shares hook 1 with an end that is lifted on pick 2");
}
