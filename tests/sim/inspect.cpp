#include "woven.hpp"

#include <weave/samples/samples.hpp>
#include <weave/sim/inspect.hpp>
#include <weave/sim/simulate.hpp>
#include <weave/sim/strands.hpp>
#include <weave/sim/take_up.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <support/random.hpp>

using namespace weave;
using sim::testing::straight_cloth;
using sim::testing::StraightCloth;
using weave::testing::for_all;
using weave::testing::Random;

namespace {

Inspection looked_over(const Yarns& yarns) {
    auto inspection = inspect(yarns);
    if (!inspection) FAIL(inspection.error().text());
    return *inspection;
}

double uniform(Random& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random.between(0, 1 << 30)) / (1 << 30);
}

bool plain_over(std::size_t, std::size_t, std::size_t row, std::size_t column) {
    return (row + column) % 2 == 0;
}

/// One layer of plain weave whose wefts lie `pitch` apart and level, the warp at `height` above and below
/// them.
Yarns level_plain_weave(double pitch, double height) {
    StraightCloth wish;
    wish.layers = 1;
    wish.pitch_mm = pitch;
    wish.over = plain_over;
    Yarns yarns = straight_cloth(wish);
    for (SimulatedYarn& yarn : yarns.yarns) {
        if (yarn.system == System::weft) {
            for (Vec3& place : yarn.spline.control) place.z() = 0;
            continue;
        }
        std::vector<Vec3> places = yarn.spline.control;
        for (std::size_t k = 0; k < places.size(); ++k)
            places[k].z() = k % 2 == 1 ? 0 : (k / 2 + yarn.number) % 2 == 0 ? -height : height;
        yarn.spline = weave::testing::spline_through(places, true, yarn.spline.shift);
    }
    return yarns;
}

}  // namespace

TEST_CASE("take-up of a sine and of circle arcs is that of their formulas") {
    constexpr double pi = std::numbers::pi;
    for (const double amplitude : {0.05, 0.2, 0.6}) {
        SimulatedYarn yarn;
        std::vector<Vec3> places;
        for (int k = 0; k < 64; ++k)
            places.push_back({2.0 * k / 64, 0, amplitude * std::sin(2 * pi * k / 64)});
        yarn.spline = weave::testing::spline_through(places, true, Vec3(2, 0, 0));
        yarn.length_mm = sim::testing::length_of(yarn.spline);
        const double steep = std::pow(amplitude * pi, 2);  // (2πa/P)², P = 2
        const double length =
            4 / pi * std::sqrt(1 + steep) * std::comp_ellint_2(std::sqrt(steep / (1 + steep)));
        CHECK(take_up_of(yarn) == Approx(length / 2 - 1).epsilon(1e-4));
    }
    SimulatedYarn arc;
    std::vector<Vec3> places;
    for (int k = 0; k <= 32; ++k) places.push_back({std::cos(pi * (32 - k) / 32), 0, std::sin(pi * k / 32)});
    arc.spline = {places, false, {0, 0, 0}};
    arc.length_mm = pi;
    CHECK(take_up_of(arc) == Approx(pi / 2 - 1));
}

TEST_CASE("the crimp of a weft that wraps round counts its way there and back, in cloth that is periodic along the warp") {
    Yarns yarns = straight_cloth({.rows = 2, .columns = 4, .layers = 1});
    // One yarn of both picks: pick 1 to the right, pick 2 back, and on to the next repeat.
    SimulatedYarn& weft = yarns.yarns[0];
    weft.spline.control.clear();
    for (int k = 0; k < 8; ++k) weft.spline.control.push_back(Vec3(0, 0.5 * k, 0.125));
    for (int k = 0; k < 8; ++k) weft.spline.control.push_back(Vec3(1, 3.5 - 0.5 * k, 0.125));
    weft.spline.shift = Vec3(2, 0, 0);
    weft.planned = weft.spline.control;
    weft.strain.assign(16, 0.01);
    weft.contact_N.assign(16, 0);
    weft.length_mm = 1.1 * sim::testing::length_of(weft.spline);
    weft.planned_length_mm = 2;
    for (Crossing& crossing : yarns.crossings) {
        if (crossing.weft == 1) crossing.weft_key = 7 - crossing.weft_key;
        crossing.weft = 0;
        if (crossing.pick == 0) crossing.weft_key = crossing.end;
        crossing.warp -= 1;
    }
    yarns.yarns.erase(yarns.yarns.begin() + 1);
    const Result<Inspection> inspection = inspect(yarns);
    REQUIRE(inspection);
    REQUIRE(inspection->weft_crimp);
    CHECK(inspection->weft_crimp->mean == Approx(0.1).margin(0.03));  // turns are rounded
}

TEST_CASE("take-up is told by beam, and whether ends that run alike take up alike") {
    StraightCloth wish;
    wish.layers = 1;
    wish.over = plain_over;
    Yarns yarns = straight_cloth(wish);
    const double extra[]{0.1, 0.3, 0.2, 0.2};
    for (SimulatedYarn& yarn : yarns.yarns) {
        if (yarn.system != System::warp) continue;
        yarn.length_mm *= 1 + extra[yarn.number];
        yarn.beam = yarn.number < 2 ? 0 : 1;
    }
    const Inspection found = looked_over(yarns);
    REQUIRE(found.take_up.size() == 4);
    for (std::size_t end = 0; end < 4; ++end) CHECK(found.take_up[end].take_up == Approx(extra[end]));
    REQUIRE(found.beams.size() == 2);
    CHECK(found.beams[0].spread.mean == Approx(0.2));
    CHECK(found.beams[0].spread.most_of == 1);
    REQUIRE(found.beams[0].alike);  // a plain weave's ends run alike, one pick later
    CHECK(*found.beams[0].alike == Approx(0.2));
    CHECK(*found.beams[1].alike == Approx(0).margin(1e-12));
    REQUIRE(found.warp_crimp);
    CHECK(found.warp_crimp->mean == Approx(0.2));
    CHECK(found.weft_crimp->most == Approx(0).margin(1e-12));
}

TEST_CASE("a cloth as planned has no finding, wherever it lies and however it settles as a whole") {
    for_all(
        [](Random& random) {
            StraightCloth wish;
            wish.layers = random.between(1, 4);
            wish.rows = random.between(2, 6);
            wish.columns = random.between(2, 6);
            if (random.coin()) wish.over = plain_over;
            Yarns yarns = straight_cloth(wish);
            const bool plain = wish.over == plain_over;
            const Vec3 by(uniform(random, -5, 5), uniform(random, -5, 5), uniform(random, -5, 5));
            const double lean = uniform(random, -0.5, 0.5), flat = uniform(random, 0.3, 2);
            for (SimulatedYarn& yarn : yarns.yarns) {
                for (Vec3& place : yarn.spline.control)
                    place += by + Vec3(lean * place.z(), -lean * place.z(), (flat - 1) * place.z());
            }
            const Inspection found = looked_over(yarns);
            CHECK(found.leaning.empty());
            CHECK((plain || found.changed.empty()));
            CHECK(found.moved.empty());
        },
        300);
}

TEST_CASE(
    "a layer that leans is found with its picks, its way and how far; thin yarns with room are let wander") {
    Yarns yarns = straight_cloth({});
    const auto lean = [&](double mm) {
        Yarns leaning = yarns;
        for (SimulatedYarn& yarn : leaning.yarns) {
            if (yarn.system == System::weft && yarn.number % 3 == 1)
                sim::testing::shift(yarn, Vec3(mm, 0, 0));
        }
        return leaning;
    };
    const Inspection found = looked_over(lean(-0.5));
    // Straight ends that all lie in one sheet only by their neighbours: here every yarn is a sheet of its
    // own.
    CHECK(found.sheets.size() > 1);
    CHECK(found.leaning.empty());

    for (Crossing& crossing : yarns.crossings)
        crossing.weft_over = plain_over(0, 0, crossing.pick, crossing.end);
    const Inspection bound = looked_over(lean(-0.5));
    CHECK(bound.sheets.size() == 1);
    REQUIRE(bound.leaning.size() == 1);
    CHECK(bound.leaning[0].system == System::weft);
    CHECK(bound.leaning[0].layer == 1);
    CHECK(bound.leaning[0].mm == Approx(-0.5));
    CHECK(bound.leaning[0].widths == Approx(2.5));
    CHECK(bound.leaning[0].same_way == 1);
    CHECK(bound.leaning[0].numbers == std::vector<std::size_t>{1, 4, 7, 10});
    CHECK(looked_over(lean(0.3))
              .leaning.empty());  // more than a width, less than two fifths of the way to the next row
    CHECK(looked_over(lean(0.45)).leaning.size() == 1);
    const std::string words = inspection_text(lean(-0.5), bound);
    CHECK(words.find("LEANS: the 2nd pick from below in each row (picks 2, 5, 8, 11) has gone 0.50 mm "
                     "towards the earlier picks") != std::string::npos);
}

TEST_CASE("yarns that moved and neighbours that bunched are told with place, way and distance") {
    StraightCloth wish;
    wish.layers = 1;
    wish.rows = wish.columns = 8;
    wish.over = plain_over;
    Yarns yarns = straight_cloth(wish);
    sim::testing::shift(yarns.yarns[2], Vec3(0.6, 0, 0));  // pick 3 towards pick 4
    const Inspection found = looked_over(yarns);
    REQUIRE(found.moved.size() == 1);
    CHECK(found.moved[0].yarn == YarnNumber{System::weft, 2});
    CHECK(found.moved[0].way.x() == Approx(0.6 - 0.6 / 8));  // less what the picks moved on the mean
    REQUIRE(found.bunched.size() == 1);
    CHECK(found.bunched[0].first.number == 2);
    CHECK(found.bunched[0].second.number == 3);
    CHECK(found.bunched[0].mm == Approx(0.4));
    CHECK_FALSE(found.bunched[0].touching);
    CHECK_FALSE(found.bunched[0].next_repeat);

    yarns = straight_cloth(wish);
    sim::testing::shift(yarns.yarns[7],
                        Vec3(0.8, 0, 0));  // the last pick touches the first of the next repeat
    const Inspection over_the_rim = looked_over(yarns);
    REQUIRE(over_the_rim.bunched.size() == 1);
    CHECK(over_the_rim.bunched[0].touching);
    CHECK(over_the_rim.bunched[0].next_repeat);
}

TEST_CASE("an end jams where two picks lie no further apart than Peirce's least") {
    // Level picks: an end that presses on them keeps a straight piece while the pitch exceeds d1 + d2 = 0.4.
    CHECK(looked_over(level_plain_weave(0.45, 0.2)).jammed.empty());
    const Inspection found = looked_over(level_plain_weave(0.39, 0.2));
    const auto ends = std::ranges::count_if(
        found.jammed, [](const JammedYarn& yarn) { return yarn.yarn.system == System::warp; });
    CHECK(ends == 4);
    REQUIRE(!found.jammed.empty());
    CHECK(found.jammed[0].room == Approx(0.39 / 0.4 - 1).epsilon(1e-3));
    CHECK(found.jammed[0].places == found.jammed[0].of);
    // Pressed together to half their width they have room again.
    const Inspection soft = looked_over(level_plain_weave(0.39, 0.1));
    CHECK(std::ranges::none_of(soft.jammed,
                               [](const JammedYarn& yarn) { return yarn.yarn.system == System::warp; }));
}

TEST_CASE("a crossing that changed is named") {
    Yarns yarns = level_plain_weave(1, 0.2);
    CHECK(looked_over(yarns).changed.empty());
    yarns.crossings[5].weft_over = !yarns.crossings[5].weft_over;
    const Inspection found = looked_over(yarns);
    REQUIRE(found.changed.size() == 1);
    CHECK(found.changed[0].pick == yarns.crossings[5].pick);
    CHECK(found.changed[0].end == yarns.crossings[5].end);
    CHECK(inspection_json(yarns, found).at("order_kept") == false);
    CHECK(inspection_text(yarns, found).find("CHANGED: 1 crossing") != std::string::npos);
}

TEST_CASE("sheets are the sets of yarns that lead to one another, as all ways show") {
    for_all(
        [](Random& random) {
            const std::size_t wefts = random.between(1, 5), warps = random.between(1, 5), all = wefts + warps;
            Yarns yarns;
            for (std::size_t y = 0; y < all; ++y)
                yarns.yarns.push_back(sim::testing::straight_yarn(y < wefts ? System::weft : System::warp,
                                                                  y < wefts ? y : y - wefts, Vec3(0, 0, 0), 1,
                                                                  1, 0.1));
            std::vector<std::vector<char>> leads(all, std::vector<char>(all, 0));
            for (std::size_t weft = 0; weft < wefts; ++weft) {
                for (std::size_t warp = wefts; warp < all; ++warp) {
                    if (random.between(0, 3) == 0) continue;
                    const bool over = random.between(0, 3) != 0;
                    yarns.crossings.push_back({weft, 0, warp, 0, weft, warp - wefts, over});
                    (over ? leads[warp][weft] : leads[weft][warp]) = 1;
                }
            }
            for (std::size_t k = 0; k < all; ++k) {
                for (std::size_t i = 0; i < all; ++i) {
                    for (std::size_t j = 0; j < all; ++j)
                        leads[i][j] = leads[i][j] || (leads[i][k] && leads[k][j]);
                }
            }
            const std::vector<std::size_t> sheets = sim::sheets_of(yarns);
            for (std::size_t i = 0; i < all; ++i) {
                for (std::size_t j = 0; j < all; ++j) {
                    const bool same = i == j || (leads[i][j] && leads[j][i]);
                    CHECK((sheets[i] == sheets[j]) == same);
                    if (leads[i][j] && !same) CHECK(sheets[i] < sheets[j]);
                }
            }
        },
        2000);
}

TEST_CASE("yarns that cannot be looked over are refused with the place") {
    Yarns yarns = straight_cloth({});
    yarns.crossings[7].warp_key = 5;  // of 4
    auto refused = inspect(yarns);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().where == "crossings[7]");
    yarns = straight_cloth({});
    for (const Json& wrong : {Json("2"), Json(0), Json(-1), Json(65), Json(nullptr)}) {
        yarns.report["points_per_key"] = wrong;
        auto missing = inspect(yarns);
        REQUIRE_FALSE(missing);
        CHECK(missing.error().where == "report.points_per_key");
    }
    Yarns empty;
    empty.report["points_per_key"] = 2;
    CHECK(looked_over(empty).take_up.empty());
}

TEST_CASE("yarns of any places and lengths are looked over to an end") {
    for_all(
        [](Random& random) {
            StraightCloth wish;
            wish.rows = wish.columns = random.between(1, 3);
            wish.layers = random.between(1, 3);
            Yarns yarns = straight_cloth(wish);
            const double wild[]{0, 1e-300, -1e9, 1e9, 0.5, 1e-9};
            for (std::size_t k = random.between(1, 40); k > 0; --k) {
                SimulatedYarn& yarn = yarns.yarns[random.between(0, yarns.yarns.size() - 1)];
                std::vector<Vec3>& places = random.coin() ? yarn.planned : yarn.spline.control;
                places[random.between(0, places.size() - 1)][static_cast<int>(random.between(0, 2))] =
                    wild[random.between(0, 5)];
                if (random.between(0, 9) == 0) yarn.spline.is_periodic = false;
                if (random.between(0, 9) == 0) yarn.spline.shift = {0, 0, 0};
                if (random.between(0, 9) == 0)
                    yarns.size_mm[random.between(0, 1)] = std::abs(wild[random.between(0, 5)]);
            }
            const auto found = inspect(yarns);
            if (!found) return;
            CHECK(std::isfinite(found->thickness_mm));
            CHECK_FALSE(inspection_json(yarns, *found).dump().empty());
            CHECK_FALSE(inspection_text(yarns, *found).empty());
        },
        100);
}

TEST_CASE("TL013: the wrong version leans in its upper section, the corrected one does not") {
    for (const bool wrong : {true, false}) {
        const Design design = find_sample(wrong ? "tl013-wrong" : "tl013-corrected")->make();
        auto cloth = evaluate(design);
        REQUIRE(cloth);
        sim::SimulationRequest request;
        request.fidelity = sim::Fidelity::draft;
        auto plan = sim::make_plan(design, *cloth->block, request);
        REQUIRE(plan);
        sim::SimulationOptions options;
        options.threads = 1;
        const Yarns yarns = sim::simulate(design, *plan, options);
        const Inspection found = looked_over(yarns);
        CHECK(found.changed.empty());
        INFO(inspection_text(yarns, found));
        if (!wrong) {
            CHECK(found.leaning.empty());
            continue;
        }
        REQUIRE(!found.leaning.empty());
        const LeaningLayer& worst = found.leaning.front();
        CHECK(worst.system == System::weft);
        CHECK(worst.layer == 3);  // the weft of the zigzag's upper section
        CHECK(worst.numbers.size() == 16);
        CHECK(worst.mm > 0.6);
        CHECK(worst.same_way == 1);
    }
}
