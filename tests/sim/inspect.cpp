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

/// `rows` by `columns` cut out of a larger plain weave, with its rims frozen: rows from 10 and columns
/// from 20.
Yarns cut_out(std::size_t rows, std::size_t columns) {
    StraightCloth wish;
    wish.layers = 1;
    wish.rows = rows;
    wish.columns = columns;
    wish.over = plain_over;
    Yarns yarns = straight_cloth(wish);
    for (SimulatedYarn& yarn : yarns.yarns) {
        yarn.number += yarn.system == System::weft ? 10 : 20;
        yarn.spline.is_periodic = false;
        for (std::vector<Vec3>* places : {&yarn.spline.control, &yarn.planned}) {
            for (Vec3& place : *places) place += Vec3(10, 20, 0);
        }
    }
    for (Crossing& crossing : yarns.crossings) crossing.pick += 10, crossing.end += 20;
    yarns.is_periodic = {false, false};
    yarns.region = {10, 9 + rows, 20, 19 + columns};
    yarns.cloth_rows = yarns.cloth_columns = 60;
    return yarns;
}

/// Lifts the outermost three control points of each end, which bends it as far as its first two rows.
void lift_rims(Yarns& yarns) {
    for (SimulatedYarn& yarn : yarns.yarns) {
        if (yarn.system == System::weft) continue;
        for (std::size_t i = 0; i < 3; ++i)
            yarn.spline.control[i].z() += 1, yarn.spline.control[yarn.spline.control.size() - 1 - i].z() += 1;
    }
}

}  // namespace

TEST_CASE("a part of a cloth is called one, and what lies near its frozen rims is not measured") {
    const Yarns calm = cut_out(12, 14);
    Yarns yarns = calm;
    lift_rims(yarns);
    const Inspection found = looked_over(yarns), still = looked_over(calm);
    CHECK_FALSE(found.part.is_whole);
    CHECK(found.part.picks == NumberSpan{10, 21});
    CHECK(found.part.ends == NumberSpan{20, 33});
    CHECK(found.picks == 12);
    CHECK(found.measured_picks == 8);
    CHECK(found.measured_ends == 10);
    REQUIRE(found.warp_crimp);
    CHECK(found.warp_crimp->most == Approx(0).margin(1e-9));
    REQUIRE(found.thickness_mm);
    CHECK(*found.thickness_mm == Approx(*still.thickness_mm));
    REQUIRE(found.take_up.size() == 10);
    CHECK(found.take_up.front().end == 22);
    CHECK(found.take_up.back().end == 31);
    const std::string words = inspection_text(yarns, found);
    INFO(words);
    CHECK(words.find("only a PART of the cloth, picks 11 to 22 and ends 21 to 34 (rows 11 to 22 of 60, "
                     "columns 21 to 34 of "
                     "60)") != std::string::npos);
    CHECK(words.find("its 2 outermost rows and columns are left out below: 8 picks and 10 ends are left") !=
          std::string::npos);
    const Json json = inspection_json(yarns, found);
    CHECK(json.at("coverage").at("whole") == false);
    CHECK(json.at("coverage").at("picks") == Json({11, 22}));
    CHECK(json.at("coverage").at("rows") == Json({11, 22}));
    CHECK(json.at("measured").at("left_out_rows") == 2);

    // A whole cloth whose rims are free is measured to the rim.
    yarns.region = {0, 11, 0, 13};
    yarns.cloth_rows = 12;
    yarns.cloth_columns = 14;
    const Inspection whole = looked_over(yarns);
    CHECK(whole.part.is_whole);
    CHECK(whole.measured_picks == 12);
    CHECK(*whole.thickness_mm > *still.thickness_mm + 0.7);
}

TEST_CASE("a part that is all rim measures nothing, and says so") {
    for (const std::size_t size :
         {std::size_t{4}, std::size_t{7}}) {  // none inside, and fewer than four rows
        const Yarns yarns = cut_out(size, size);
        const Inspection found = looked_over(yarns);
        CHECK_FALSE(found.thickness_mm);
        CHECK_FALSE(found.warp_crimp);
        CHECK(found.take_up.empty());
        CHECK(found.jammed.empty());
        const std::string words = inspection_text(yarns, found);
        CHECK(words.find("Thickness not measured") != std::string::npos);
        CHECK(words.find("Crimp warp not measured, weft not measured") != std::string::npos);
        CHECK((words.find("nothing is left") != std::string::npos) == (size == 4));
        CHECK(inspection_json(yarns, found).at("thickness_mm").is_null());
    }
}

TEST_CASE("places that jam near a frozen rim are not told") {
    Yarns yarns = level_plain_weave(0.39, 0.2);
    CHECK_FALSE(looked_over(yarns).jammed.empty());
    yarns.is_periodic = {false, false};
    yarns.report["plan"] = {{{"term", "boundary x"}, {"choice", "frozen"}},
                            {{"term", "boundary y"}, {"choice", "frozen"}}};
    CHECK(looked_over(yarns).jammed.empty());  // it has four rows and columns
}

TEST_CASE(
    "whether the rest holds, and how far strain departs from what was asked for, is told and carried on") {
    Yarns yarns = level_plain_weave(1, 0.2);
    const auto says = [&](const char* words) {
        return inspection_text(yarns, looked_over(yarns)).find(words) != std::string::npos;
    };
    const auto carried = [&] { return inspection_json(yarns, looked_over(yarns)).at("smallest_curvature"); };
    CHECK(carried().is_null());
    CHECK_FALSE(says("The rest"));
    yarns.report["curves_down"] = false;  // of earlier versions, which did not tell whether they had looked
    CHECK(carried().is_null());
    yarns.report["curves_down"] = true;
    CHECK(carried() == "negative");
    CHECK(says("The rest is a SADDLE: a little push would lead on"));
    yarns.report["smallest_curvature"] = "positive";
    CHECK(carried() == "positive");
    CHECK(says("The energy curves up in every direction looked at"));
    yarns.report["smallest_curvature"] = "unclear";
    CHECK(says("not clear at this residual"));
    CHECK_FALSE(says("SADDLE"));
    yarns.report["smallest_curvature"] = "not looked";
    CHECK(says("Nobody looked whether the rest holds"));
    yarns.report["strain_deviation"] = {{"warp", 0.0003}, {"weft", nullptr}};
    CHECK(says("Strain departs from what was asked for by at most 0.03 points in the warp\n"));
    CHECK(inspection_json(yarns, looked_over(yarns)).at("strain_deviation").at("warp") == 0.0003);
    yarns.report["strain_deviation"] = {{"warp", 0.0003}, {"weft", 1.4}};
    CHECK(says("0.03 points in the warp, 140 points in the weft\n"));
}

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

    for (SimulatedYarn& yarn : yarns.yarns) yarn.beam = yarn.system == System::warp && yarn.number == 0 ? 1 : 0;
    const std::string words = inspection_text(yarns, looked_over(yarns));
    CHECK(words.find("beam 2: 1 end, 10.0 %, with no other to compare it with") != std::string::npos);
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
            REQUIRE(found->thickness_mm);
            CHECK(std::isfinite(*found->thickness_mm));
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

TEST_CASE("a cloth of one layer has no distance of layers, and ends that lie loose are counted") {
    const auto words_of = [](std::size_t layers) {
        StraightCloth wish;
        wish.layers = layers;
        wish.over = plain_over;
        Yarns yarns = straight_cloth(wish);
        for (SimulatedYarn& yarn : yarns.yarns) {
            for (Vec3& place : yarn.spline.control) place.z() *= 0.5;
        }
        yarns.report["coverage"] = {{"of", {{"picks", 4 * layers}, {"ends", 4 * layers + 3}}}};
        return inspection_text(yarns, looked_over(yarns));
    };
    CHECK(words_of(1).find("of their planned distance") == std::string::npos);
    CHECK(words_of(1).find("4 picks and 7 ends (4 of them cross others)") != std::string::npos);
    CHECK(words_of(3).find("its layers at 50 % of their planned distance") != std::string::npos);
}
