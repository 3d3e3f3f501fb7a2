#include "curve/random_cloth.hpp"
#include "support/random.hpp"

#include <weave/curve/cloth_curves.hpp>
#include <weave/loom/weft_way.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <tuple>

using namespace weave;
using namespace weave::testing;

namespace {

/// A block from stacks in words, numbers counted within the cell.
Block woven(const std::vector<std::vector<std::string>>& rows, std::uint32_t picks, std::uint32_t ends) {
    return make_block(std::vector<std::uint32_t>(rows.size(), picks),
                      std::vector<std::uint32_t>(rows.front().size(), ends),
                      [&](std::size_t i, std::size_t j) { return parse_stack(rows[i][j]).value(); })
        .value();
}

Block plain_weave() {
    return woven({{"P0 T0", "T0 P0"}, {"T0 P0", "P0 T0"}}, 1, 1);
}

Design open_design() {
    Design design;
    design.scene.boundary_x = Boundary::free;
    design.scene.boundary_y = Boundary::free;
    return design;
}

void check_place(const KeyPoint& key, const Vec3& place) {
    CAPTURE(key.place.transpose(), place.transpose());
    CHECK((key.place - place).norm() < 1e-12);
}

using CrossingSet = std::set<std::tuple<std::size_t, std::size_t, bool>>;

CrossingSet crossings_of(const ClothCurves& curves) {
    CrossingSet set;
    for (const Crossing& c : curves.crossings) set.emplace(c.pick, c.end, c.weft_over);
    return set;
}

/// What must hold of any cloth's curves: crossings name keys in one stack, in the order that they say.
void check_crossings(const ClothCurves& curves, const Block& block) {
    for (const Crossing& c : curves.crossings) {
        const YarnCurve &weft = curves.yarns.at(c.weft), &warp = curves.yarns.at(c.warp);
        REQUIRE(weft.system == System::weft);
        REQUIRE(warp.system == System::warp);
        const KeyPoint &over = weft.keys.at(c.weft_key), &under = warp.keys.at(c.warp_key);
        REQUIRE(over.row == under.row);
        REQUIRE(over.column == under.column);
        REQUIRE(over.row == block.row_of_pick(c.pick));
        REQUIRE(over.column == block.column_of_end(c.end));
        REQUIRE(over.yarn == c.pick);
        REQUIRE(under.yarn == c.end);
        REQUIRE(warp.number == c.end);
        REQUIRE(c.weft_over == block.weft_over(c.pick, c.end));
        REQUIRE((over.place.z() > under.place.z()) == c.weft_over);
        REQUIRE(std::abs(over.place.x() - under.place.x()) < 1e-9);
        REQUIRE(std::abs(over.place.y() - under.place.y()) < 1e-9);
    }
}

}  // namespace

TEST_CASE("Plain weave: every key point where the stacks say") {
    const auto curves = cloth_curves(Design{}, plain_weave()).value();
    CHECK(curves.dx_mm == Approx(0.5));  // 20 rows to the centimetre
    CHECK(curves.dy_mm == Approx(0.5));
    CHECK(curves.dz_mm == Approx(0.3));  // two radii of 0.15
    CHECK(curves.size_mm[0] == Approx(1));
    CHECK(curves.size_mm[1] == Approx(1));
    CHECK(curves.is_periodic == std::array{true, true});
    CHECK(curves.region == Region{0, 1, 0, 1});
    REQUIRE(curves.yarns.size() == 4);
    const YarnCurve &pick = curves.yarns[1], &end = curves.yarns[2];
    CHECK(pick.system == System::weft);
    CHECK(pick.number == 1);
    CHECK(pick.is_periodic);
    CHECK((pick.shift - Vec3(0, 1, 0)).norm() < 1e-12);
    REQUIRE(pick.keys.size() == 2);
    check_place(pick.keys[0], {0.5, 0, 0});
    check_place(pick.keys[1], {0.5, 0.5, 0.3});
    CHECK(pick.keys[1].row == 1);
    CHECK(pick.keys[1].column == 1);
    CHECK(pick.keys[1].yarn == 1);
    CHECK(end.system == System::warp);
    CHECK(end.number == 0);
    CHECK((end.shift - Vec3(1, 0, 0)).norm() < 1e-12);
    REQUIRE(end.keys.size() == 2);
    check_place(end.keys[0], {0, 0, 0});
    check_place(end.keys[1], {0.5, 0, 0.3});
    CHECK(crossings_of(curves) == CrossingSet{{0, 0, true}, {0, 1, false}, {1, 0, false}, {1, 1, true}});
    check_crossings(curves, plain_weave());
}

TEST_CASE("Spacing follows densities, ends in a column and radii, unless the scene says it") {
    Design design;
    design.warp.density_ends_per_cm = 40;
    design.weft.density_picks_per_cm = 8;
    design.warp.yarns[0].radius_mm = 0.1;
    design.scene.warp.radius_scale = 2;
    const Block block = woven({{"P0 P1 P2 T0 T1"}}, 2, 3);
    const auto curves = cloth_curves(design, block).value();
    CHECK(curves.dx_mm == Approx(1.25));
    CHECK(curves.dy_mm == Approx(0.75));
    CHECK(curves.dz_mm == Approx(0.35));
    design.scene.dx_mm = 1;
    design.scene.dy_mm = 2;
    design.scene.dz_mm = 3;
    const auto told = cloth_curves(design, block).value();
    CHECK(told.dx_mm == 1);
    CHECK(told.dy_mm == 2);
    CHECK(told.dz_mm == 3);
}

TEST_CASE("A yarn of one stack is a straight line from repeat to repeat") {
    const auto curves = cloth_curves(Design{}, woven({{"P0 T0"}}, 1, 1)).value();
    REQUIRE(curves.yarns.size() == 2);
    for (const YarnCurve& yarn : curves.yarns) {
        CHECK(yarn.keys.size() == 1);
        CHECK(yarn.is_periodic);
        CHECK(yarn.shift.norm() == Approx(0.5));
    }
    CHECK(curves.crossings.size() == 1);
}

TEST_CASE("Ends that change places are led past one another, through the repeat as well") {
    const Block block = woven({{"P0 P1 T0"}, {"P0 P1 T0"}, {"P1 P0 T0"}}, 1, 2);
    const auto curves = cloth_curves(Design{}, block).value();
    REQUIRE(curves.yarns.size() == 5);
    const std::vector<KeyPoint>&a = curves.yarns[3].keys, &b = curves.yarns[4].keys;
    REQUIRE(a.size() == 6);
    REQUIRE(b.size() == 6);
    for (const std::size_t stack : {0U, 2U, 4U}) {
        CHECK(a[stack].row == stack / 2);
        CHECK(a[stack].place.y() == Approx(0).margin(1e-12));
        CHECK(b[stack].place.y() == Approx(0).margin(1e-12));
    }
    CHECK(a[1].place.y() == 0);  // from row 0 to 1 they keep their places
    for (const std::size_t passing : {3U, 5U}) {
        CHECK(a[passing].row == KeyPoint::none);
        CHECK(a[passing].column == 0);
        CHECK(a[passing].place.y() * b[passing].place.y() < 0);
        CHECK(std::abs(a[passing].place.y()) <= curves.dy_mm / 4 + 1e-12);
        CHECK(std::abs(a[passing].place.y() - b[passing].place.y()) > 0.1 * curves.dy_mm);
    }
    CHECK_FALSE(first_meeting(curves, 0.05));

    Design open = open_design();
    const auto cut = cloth_curves(open, block).value();
    REQUIRE(cut.yarns[3].keys.size() == 5);
    CHECK(cut.yarns[3].keys[3].place.y() != 0);
    CHECK_FALSE(cut.yarns[3].is_periodic);
}

TEST_CASE("Picks that change places are led past one another, each by its own amount") {
    const Block block = woven({{"T0 T1 T2 P0", "T2 T1 T0 P0"}}, 3, 1);
    const auto curves = cloth_curves(Design{}, block).value();
    std::set<double> amounts;
    for (std::size_t pick = 0; pick < 3; ++pick) {
        REQUIRE(curves.yarns[pick].keys.size() % 2 == 0);
        const auto& keys = curves.yarns[pick].keys;
        amounts.insert(keys.size() == 2 ? 0 : keys[keys.size() / 4].place.x());
    }
    CHECK(amounts.size() == 3);
    CHECK_FALSE(first_meeting(curves, 0.02));
}

TEST_CASE("A yarn that no other passes keeps one key point a stack") {
    const Block block = woven({{"P0 P1 P2 T0"}, {"P1 P0 P2 T0"}}, 1, 3);
    const auto curves = cloth_curves(Design{}, block).value();
    CHECK(curves.yarns[2].keys.size() == 4);
    CHECK(curves.yarns[4].keys.size() == 2);
}

TEST_CASE("Yarns that are loose stay, and say where") {
    const Block block = woven({{"P0 P1~ T0"}, {"P0~ P1~ T0"}}, 1, 2);
    const auto curves = cloth_curves(Design{}, block).value();
    REQUIRE(curves.yarns.size() == 4);
    CHECK_FALSE(curves.yarns[2].keys[0].loose);
    CHECK(curves.yarns[2].keys[1].loose);
    CHECK(curves.yarns[3].keys[0].loose);
    CHECK(curves.yarns[3].keys[1].loose);
}

TEST_CASE("A pick without feeder brings no yarn, one with two brings two a little apart") {
    Design design;
    design.weft.feeders = {{"a", 0}, {"b", 0}};
    design.weft.feeder_order = {{}, {1, 0}};
    const auto curves = cloth_curves(design, plain_weave()).value();
    REQUIRE(curves.yarns.size() == 4);
    CHECK(curves.yarns[0].number == 1);
    CHECK(curves.yarns[1].number == 1);
    CHECK(curves.yarns[1].keys[0].place.z() - curves.yarns[0].keys[0].place.z() == Approx(curves.dz_mm / 2));
    CHECK(curves.crossings.size() == 4);
    check_crossings(curves, plain_weave());
}

TEST_CASE("Wraparound: a turn is half an ellipse outside the end that catches it") {
    const Block block = woven({{"P0 T0", "T0 P0", "P0 T0"}, {"T0 P0", "P0 T0", "T0 P0"}}, 1, 1);
    const auto curves = cloth_curves(open_design(), block, {{}, WeftMode::wraparound}).value();
    REQUIRE(curves.yarns.size() == 4);
    const YarnCurve& weft = curves.yarns[0];
    CHECK_FALSE(weft.is_periodic);
    REQUIRE(weft.keys.size() == 9);
    check_place(weft.keys[0], {0, 0, 0.3});
    check_place(weft.keys[2], {0, 1, 0.3});
    const double part = std::sqrt(0.5);
    check_place(weft.keys[3], {0.25 * (1 - part), 1 + 0.25 * part, 0.15 * (1 + part)});
    check_place(weft.keys[4], {0.25, 1.25, 0.15});
    check_place(weft.keys[5], {0.25 * (1 + part), 1 + 0.25 * part, 0.15 * (1 - part)});
    CHECK(weft.keys[4].row == KeyPoint::none);
    CHECK(weft.keys[4].column == KeyPoint::none);
    check_place(weft.keys[6], {0.5, 1, 0});
    check_place(weft.keys[8], {0.5, 0, 0});
    CHECK(weft.keys[6].yarn == 1);
    CHECK(curves.crossings.size() == 6);
    check_crossings(curves, block);
}

TEST_CASE("Wraparound of two layers: one yarn closes both sides, and turns where an end catches it") {
    // Picks 0 and 2 weave the upper layer, 1 and 3 the lower. After pick 1 the outer column does not catch
    // the loop.
    const std::string even = "P1 T1 P0 T0", odd = "T1 P1 T0 P0";
    const Block block = woven({{even, odd, even, odd}, {odd, even, odd, even}}, 2, 2);
    Design design = open_design();
    design.scene.weft_mode = WeftMode::wraparound;
    const auto curves = cloth_curves(design, block).value();
    REQUIRE(curves.yarns.size() == 9);
    const YarnCurve& weft = curves.yarns[0];
    const double dy = curves.dy_mm, dz = curves.dz_mm;
    REQUIRE(weft.keys.size() == 4 + 3 + 3 + 3 + 3 + 3 + 4);
    check_place(weft.keys[3], {0, 3 * dy, 2 * dz});
    check_place(weft.keys[5], {0, 3 * dy + 0.3, dz});  // straight down outside, by both radii
    check_place(weft.keys[7], {0, 3 * dy, 0});
    CHECK(weft.keys[9].column == 1);
    CHECK(weft.keys[11].place.y() == Approx(dy - 0.3));
    CHECK(weft.keys[11].place.x() == Approx(curves.dx_mm / 2));
    CHECK(weft.keys[13].column == 1);
    CHECK(weft.keys[13].yarn == 2);
    const CrossingSet crossings = crossings_of(curves);
    CHECK(crossings.size() == 32 - 4 - 2);  // picks 2 and 3 slip past the last end, end 6 holds them
    for (const auto& [pick, end, over] : crossings) {
        CHECK_FALSE(((pick == 1 || pick == 2) && end < 2));
        CHECK_FALSE((pick >= 2 && end == 7));
        CHECK(over == block.weft_over(pick, end));
    }
    check_crossings(curves, block);
    CHECK_FALSE(first_meeting(curves, 0.1));
}

TEST_CASE("Wraparound in a cloth that repeats along the warp: an even number of picks makes a ring") {
    Design design;
    design.scene.weft_mode = WeftMode::wraparound;
    const Block even = woven({{"P0 T0", "T0 P0", "P0 T0"}, {"T0 P0", "P0 T0", "T0 P0"}}, 1, 1);
    const auto ring = cloth_curves(design, even).value();
    REQUIRE(ring.yarns.size() == 4);
    CHECK(ring.yarns[0].is_periodic);
    CHECK((ring.yarns[0].shift - Vec3(1, 0, 0)).norm() < 1e-12);
    REQUIRE(ring.yarns[0].keys.size() == 12);
    check_place(ring.yarns[0].keys[10], {0.75, -0.25, 0.15});
    CHECK(ring.is_periodic == std::array{true, false});
    CHECK(ring.yarns[1].is_periodic);
    CHECK_FALSE(first_meeting(ring, 0.1));

    const Block odd = woven({{"P0 T0", "T0 P0"}, {"T0 P0", "P0 T0"}, {"P0 T0", "P0 T0"}}, 1, 1);
    const auto open = cloth_curves(design, odd).value();
    CHECK_FALSE(open.yarns[0].is_periodic);
    CHECK(open.yarns[0].number == 0);
    CHECK(open.yarns[1].is_periodic);
}

TEST_CASE("A yarn that is open within the repeat is cut at its end as well") {
    // The third pick starts on the wrong side; the last would end where the first begins.
    Design design;
    design.scene.weft_mode = WeftMode::wraparound;
    design.weft.directions = {Direction::left_to_right, Direction::right_to_left, Direction::right_to_left,
                              Direction::right_to_left};
    const Block block =
        woven({{"P0 T0", "T0 P0"}, {"T0 P0", "P0 T0"}, {"P0 T0", "T0 P0"}, {"T0 P0", "P0 T0"}}, 1, 1);
    const auto curves = cloth_curves(design, block).value();
    REQUIRE(curves.yarns.size() == 3 + 2);  // picks 1-2, 3, 4
    for (std::size_t yarn = 0; yarn < 3; ++yarn) {
        CHECK_FALSE(curves.yarns[yarn].is_periodic);
        for (std::size_t k = 1; k < curves.yarns[yarn].keys.size(); ++k) {
            CHECK((curves.yarns[yarn].keys[k].place - curves.yarns[yarn].keys[k - 1].place).norm() < 1);
        }
    }
}

TEST_CASE("Wraparound has a yarn for each feeder, and turns over several rows stay clear of what they pass") {
    Design design = open_design();
    design.scene.weft_mode = WeftMode::wraparound;
    design.weft.feeders = {{"a", 0}, {"b", 0}};
    design.weft.feeder_order = {{0}, {1}, {1}, {0}};
    const std::string over = "P0 T0", under = "T0 P0";
    const Block block =
        woven({{over, under, over}, {under, over, under}, {over, under, over}, {under, over, under}}, 1, 1);
    const auto curves = cloth_curves(design, block).value();
    REQUIRE(curves.yarns.size() == 5);
    CHECK(curves.yarns[0].number == 0);
    CHECK(curves.yarns[1].number == 1);
    // The turn of a passes rows 1 and 2 farther out than the turn of b.
    double a = 0, b = 0;
    for (const KeyPoint& key : curves.yarns[0].keys) a = std::max(a, key.place.y());
    for (const KeyPoint& key : curves.yarns[1].keys) b = std::max(b, key.place.y());
    CHECK(a > b);
    CHECK_FALSE(first_meeting(curves, 0.05));
}

TEST_CASE("A crossed pick runs from edge to edge") {
    // Both picks lie over all ends: nothing holds the loop.
    Design design = open_design();
    design.scene.weft_mode = WeftMode::wraparound;
    const Block block = woven({{"P0 T0", "P0 T0"}, {"P0 T0", "P0 T0"}}, 1, 1);
    const auto curves = cloth_curves(design, block).value();
    CHECK(curves.crossings.size() == 4);
    CHECK(curves.yarns[0].keys.size() == 7);
}

TEST_CASE("A region is cut out with the numbers and places of the whole") {
    const std::string over = "P0 T0", under = "T0 P0";
    std::vector<std::vector<std::string>> rows(6, std::vector<std::string>(7, over));
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 7; ++j) rows[i][j] = (i + j) % 2 == 0 ? over : under;
    }
    const Block block = woven(rows, 1, 1);
    const Region region{2, 4, 3, 5};
    const auto curves = cloth_curves(Design{}, block, {region, {}}).value();
    CHECK(curves.region == region);
    CHECK(curves.is_periodic == std::array{false, false});
    CHECK(curves.size_mm[0] == Approx(1.5));
    REQUIRE(curves.yarns.size() == 6);
    CHECK(curves.yarns[0].number == 2);
    CHECK(curves.yarns[3].number == 3);
    CHECK_FALSE(curves.yarns[0].is_periodic);
    check_place(curves.yarns[0].keys[0], {1, 1.5, 0});
    check_place(curves.yarns[5].keys[2], {2, 2.5, 0.3});
    CHECK(curves.crossings.size() == 9);
    check_crossings(curves, block);

    // Turns at columns outside are cut, and inside the cloth the picks become yarns of their own.
    const auto wrapped = cloth_curves(Design{}, block, {region, WeftMode::wraparound}).value();
    CHECK(wrapped.yarns.size() == 6);
    const auto at_edge = cloth_curves(Design{}, block, {Region{0, 5, 0, 3}, WeftMode::wraparound}).value();
    CHECK(at_edge.yarns.size() == 4 + 4);  // left turns join 1-2 and 3-4
}

TEST_CASE("Regions outside the cloth are refused, and a cloth without yarns") {
    for (const Region region :
         {Region{0, 2, 0, 0}, Region{1, 0, 0, 0}, Region{0, 0, 0, 9}, Region{0, 0, 1, 0}}) {
        const auto curves = cloth_curves(Design{}, plain_weave(), {region, {}});
        REQUIRE_FALSE(curves);
        CHECK(curves.error().where == "region");
    }
}

TEST_CASE("Every crossing of a random cloth is as its card says, in both weft modes") {
    for_all(
        [](Random& random) {
            const Block block = random_block(random, {}, {}, 6);
            const Design design = random_plan(random);
            const std::vector<Pick> picks = pick_table(design, block);
            std::size_t strands = 0;
            for (const Pick& pick : picks) strands += pick.feeders.size();
            const auto straight = cloth_curves(design, block, {{}, WeftMode::periodic}).value();
            REQUIRE(straight.crossings.size() == strands * block.ends());
            REQUIRE(straight.yarns.size() == strands + block.ends());
            check_crossings(straight, block);

            const auto wrapped = cloth_curves(design, block, {{}, WeftMode::wraparound}).value();
            check_crossings(wrapped, block);
            if (design.scene.boundary_x == Boundary::periodic) return;
            std::size_t in_cloth = 0;
            const WeftWay way = weft_way(block.card_image(), picks);
            for (const PickSpan& span : way.spans) in_cloth += span.last - span.first + 1;
            REQUIRE(wrapped.crossings.size() == in_cloth);
            REQUIRE(wrapped.yarns.size() == block.ends() + way.spans.size() - way.turns.size());
        },
        property_cases() / 10);
}
