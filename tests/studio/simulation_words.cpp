// Plain sentences on the state of a simulation.

#include <catch2/catch.hpp>

#include <studio/jobs/state_words.hpp>

using namespace weave;
using namespace weave::studio;

namespace {

RunState state_in(RunPhase phase) {
    RunState state;
    state.phase = phase;
    state.progress.step = 214;
    state.progress.residual = 0.0412;
    state.progress.goal = 1e-3;
    return state;
}

std::string said(const RunState& state) {
    return state_words(state).toStdString();
}

}  // namespace

TEST_CASE("a run that settles says how far it is, and how long it will take") {
    RunState state = state_in(RunPhase::running);
    CHECK(said(state) == "Still settling: residual 0.041");
    state.progress.seconds_left = 11.2;
    CHECK(said(state) == "Still settling: residual 0.041, about 12 s to go");
    state.progress.lost_crossings = 0;
    CHECK(said(state) == "Still settling: residual 0.041, about 12 s to go");
    state.progress.lost_crossings = 3;
    CHECK(said(state) ==
          "Still settling: residual 0.041, about 12 s to go; 3 crossings no longer lie as the card says");
    state.progress.lost_crossings = 1;
    state.progress.is_coarse = true;
    CHECK(said(state) ==
          "Still settling, as a draft first: residual 0.041, about 12 s to go; 1 crossing no longer lies as "
          "the card says");
    state.progress.is_flipping = true;
    CHECK(said(state) == "Leading two yarns past one another …");
}

TEST_CASE("a run that came to rest says so, with what is wrong in the cloth") {
    RunState state = state_in(RunPhase::at_rest);
    CHECK(said(state) == "At rest within 0.001 after 214 steps");
    auto inspection = std::make_shared<Inspection>();
    inspection->jammed = {{{System::weft, 13}, 2, 4, {6, 7}, -0.1}, {{System::warp, 2}, 1, 4, {5, 6}, -0.05}};
    state.inspection = inspection;
    CHECK(said(state) ==
          "At rest within 0.001 after 214 steps; 2 yarns are jammed, tightest at pick 14, end 7");
    inspection->changed = {{2, 4, true, true}, {3, 3, true, true}, {7, 1, false, true}};
    inspection->jammed.erase(inspection->jammed.begin());
    CHECK(said(state) ==
          "At rest within 0.001 after 214 steps; 3 crossings no longer lie as the card says (pick "
          "3, end 5 …); 1 yarn is jammed at pick 6, end 3");
    state.progress.step = 1;
    state.inspection.reset();
    CHECK(said(state) == "At rest within 0.001 after 1 step");
}

TEST_CASE("a run that stands or is over says why") {
    CHECK(said(state_in(RunPhase::idle)) == "Not simulated yet");
    CHECK(said(state_in(RunPhase::planning)) == "Laying out the yarns …");
    CHECK(said(state_in(RunPhase::stopped)) == "Stopped after 214 steps: residual 0.041");
    RunState state = state_in(RunPhase::paused);
    CHECK(said(state) == "Paused after 214 steps: residual 0.041");
    auto yarns = std::make_shared<Yarns>();
    yarns->report = {{"ending", "stuck"}};
    state.yarns = yarns;
    CHECK(said(state).starts_with("It gets no further: still at residual 0.041 after 214 steps. "));
    state.progress.step = 0;
    CHECK(said(state) == "Laid out as planned: nothing has moved yet");
    state = state_in(RunPhase::failed);
    state.error = invalid("end 3 is fed\nat constant tension", "scene.boundary_x");
    CHECK(said(state) == "Failed: scene.boundary_x: end 3 is fed\\x0aat constant tension");
}

TEST_CASE("a run of the design before a change says so, as long as it shows cloth") {
    CHECK(dated_words(state_in(RunPhase::at_rest)) == "The design before the change: At rest within 0.001 after 214 steps");
    CHECK(dated_words(state_in(RunPhase::paused)).startsWith("The design before the change: Paused"));
    CHECK(dated_words(state_in(RunPhase::stopped)) == "Stopped after 214 steps: residual 0.041");
}

TEST_CASE("times are told as roughly as they are known") {
    CHECK(duration_words(0.2) == "less than 1 s");
    CHECK(duration_words(12) == "about 12 s");
    CHECK(duration_words(99.2) == "about 100 s");
    CHECK(duration_words(181) == "about 4 min");
    CHECK(duration_words(7201) == "about 3 h");
}

TEST_CASE("what a weaver wants to know of the cloth comes with its place, gravest first") {
    Inspection inspection;
    inspection.changed = {{2, 4, true, true}, {0, 0, false, true}, {7, 1, false, true}, {8, 1, false, true}};
    inspection.jammed = {{{System::warp, 6}, 2, 4, {12, 13}, -0.1}};
    inspection.moved = {{{System::weft, 3}, 0.31, 1.4, {0, 0, 1}, 0, 8}};
    inspection.thickness_mm = 0.925;
    inspection.warp_crimp = Spread{0.04, 0.044, 0.05, 0, 5};
    inspection.beams = {{0, 4, {0.03, 0.04, 0.05, 1, 2}, {}, 0, 0}};
    const std::vector<StateLine> lines = inspection_words(inspection);
    REQUIRE(lines.size() == 9);
    CHECK(lines[0].text == "The pick should lie over the end at pick 3, end 5, and does not");
    CHECK(lines[0].place == ClothPlace{2, 4});
    CHECK(lines[3].text == "… and 1 more that no longer lie as the card says");
    CHECK(lines[4].text == "Jammed: end 7 has no straight piece left between picks 13 and 14");
    CHECK(lines[4].place == ClothPlace{12, 6});
    CHECK(lines[5].text == "Moved: pick 4 lies 0.31 mm (1.4 widths) from its place at end 9");
    CHECK(lines[5].place == ClothPlace{3, 8});
    CHECK(lines[6].text.startsWith("Thickness 0.9"));
    CHECK(lines[7].text == "Warp crimp 4.4 %, from 4.0 % to 5.0 % (end 6)");
    CHECK(lines[8].text == "Take-up of beam 1: 4.0 %, from 3.0 % (end 2) to 5.0 % (end 3)");
}

TEST_CASE("a plan says what it models, and what it is expected to take") {
    PlanSummary plan;
    plan.points = 2048;
    plan.yarns = 32;
    plan.expected_bytes = std::uint64_t{56} << 20;
    plan.lines = {{"friction", "off", "its coefficient is 0"}};
    const std::vector<QString> words = plan_words(plan);
    REQUIRE(words.size() == 2);
    CHECK(words[0] == "2048 control points on 32 yarns; about 56 MiB of memory while it relaxes");
    CHECK(words[1] == "friction: off – its coefficient is 0");
}
