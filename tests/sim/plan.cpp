// What a plan leaves out, and what it refuses.

#include <weave/block/block.hpp>
#include <weave/sim/plan.hpp>
#include <weave/sim/simulate.hpp>

#include <catch2/catch.hpp>
#include <set>
#include <tuple>
#include <utility>

using namespace weave;
using namespace weave::sim;

namespace {

/// Plain weave of so many rows and columns of one pick and one end; with a loose end on top of the first column's.
Block plain(std::size_t rows, std::size_t columns, bool has_loose_end = false) {
    std::vector<std::uint32_t> p(columns, 1);
    if (has_loose_end) p[0] = 2;
    return make_block(std::vector<std::uint32_t>(rows, 1), p, [&](std::size_t i, std::size_t j) {
               const std::string stack = (i + j) % 2 == 0 ? "P0 T0" : "T0 P0";
               return parse_stack(has_loose_end && j == 0 ? stack + " - P1~" : stack).value();
           }).value();
}

Design design_of(double dy_mm = 0.5) {
    Design design;
    design.scene.dy_mm = dy_mm;
    return design;
}

std::string refusal(const Design& design, const Block& block, const SimulationRequest& request = {}) {
    const Result<Plan> plan = make_plan(design, block, request);
    return plan ? "" : plan.error().text();
}

}  // namespace

TEST_CASE("an end that is loose all along is left out, and the others lie as if it were not there") {
    const Design design = design_of();
    SimulationRequest request;
    request.reduce = false;
    const Plan with = make_plan(design, plain(4, 4, true), request).value(), without = make_plan(design, plain(4, 4), request).value();
    CHECK(with.curves.yarns.size() == without.curves.yarns.size() + 1);
    REQUIRE(with.scene.yarns.size() == without.scene.yarns.size());
    SimulationOptions options;
    options.threads = 1;
    options.residual = 1e-8;
    const Yarns one = simulate(design, with, options), other = simulate(design, without, options);
    REQUIRE(one.report.at("converged") == true);
    REQUIRE(one.yarns.size() == other.yarns.size());
    for (std::size_t y = 0; y < one.yarns.size(); ++y) CHECK(one.yarns[y].spline.control == other.yarns[y].spline.control);
}

TEST_CASE("yarns of a repeat that is copied back keep their numbers, though its last end is loose and its last pick empty") {
    Design design = design_of();
    design.weft.feeder_order = {{0}, {0}, {}};
    // Rows of one pick, but each second of two, the last of which has no weft; columns alike with a loose end.
    const Block block = make_block({1, 2, 1, 2}, {1, 2, 1, 2}, [](std::size_t i, std::size_t j) {
                            std::string stack = (i + j) % 2 == 0 ? "P0 T0" : "T0 P0";
                            if (i % 2 == 1) stack += " T1~";
                            if (j % 2 == 1) stack += " P1~";
                            return parse_stack(stack).value();
                        }).value();
    SimulationOptions options;
    options.threads = 1;
    SimulationRequest request;
    const auto numbers = [&](bool reduce) {
        request.reduce = reduce;
        const Plan plan = make_plan(design, block, request).value();
        REQUIRE((plan.repeats[0] * plan.repeats[1] > 1) == reduce);
        const Yarns yarns = simulate(design, plan, options);
        std::set<std::pair<System, std::size_t>> found;
        for (const SimulatedYarn& yarn : yarns.yarns) found.emplace(yarn.system, yarn.number);
        std::set<std::pair<std::size_t, std::size_t>> crossed;
        for (const Crossing& crossing : yarns.crossings) crossed.emplace(crossing.pick, crossing.end);
        const Json& coverage = yarns.report.at("coverage");
        return std::tuple(found, crossed, coverage.at("picks"), coverage.at("ends"));
    };
    CHECK(numbers(true) == numbers(false));
}

TEST_CASE("a part of which nothing can move is refused, whatever its size") {
    const Design design = design_of();
    const Block block = plain(8, 8);
    SimulationRequest request;
    for (const auto& [rows, columns] : {std::pair(1, 1), std::pair(1, 8), std::pair(8, 1), std::pair(2, 2), std::pair(2, 5)}) {
        request.region = Region{0, static_cast<std::size_t>(rows) - 1, 0, static_cast<std::size_t>(columns) - 1};
        CHECK(refusal(design, block, request).find("nothing of this part can move") != std::string::npos);
    }
    request.region = Region{0, 3, 0, 3};
    CHECK(refusal(design, block, request).empty());
    Design held = design;
    held.scene.boundary_x = held.scene.boundary_y = Boundary::frozen;
    CHECK(refusal(held, plain(2, 2)).find("nothing can move: frozen rims") != std::string::npos);
}

TEST_CASE("yarns that are too thick for their piece are refused before anything is listed") {
    Design design = design_of();
    design.scene.warp.radius_scale = 10;
    CHECK(refusal(design, plain(2, 2)).empty());
    design.scene.warp.radius_scale = 1e6;
    CHECK(refusal(design, plain(2, 2)).find("too thick for this piece") != std::string::npos);
}
