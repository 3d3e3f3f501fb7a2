#include "woven.hpp"

#include <weave/core/text.hpp>
#include <weave/sim/compare.hpp>
#include <weave/sim/yarns_file.hpp>

#include <catch2/catch.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <support/random.hpp>

using namespace weave;
using sim::Alignment;
using sim::testing::straight_cloth;
using weave::testing::for_all;
using weave::testing::Random;

namespace {

double uniform(Random& random, double low, double high) {
    return low + (high - low) * static_cast<double>(random.between(0, 1 << 30)) / (1 << 30);
}

Alignment random_motion(Random& random, bool mirrored) {
    Alignment motion;
    motion.mirrored = mirrored;
    const Vec3 axis(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 0.1, 1));
    motion.rotation =
        Eigen::AngleAxisd(uniform(random, 0, std::numbers::pi), axis.normalized()).toRotationMatrix();
    motion.translation = {uniform(random, -50, 50), uniform(random, -50, 50), uniform(random, -50, 50)};
    return motion;
}

/// A twill, which is not its own mirror image, as far as sines go.
Yarns twill() {
    Yarns yarns = weave::testing::plain_weave();
    for (SimulatedYarn& yarn : yarns.yarns) {
        const auto count = static_cast<double>(yarn.spline.control.size());
        for (std::size_t k = 0; k < yarn.spline.control.size(); ++k)
            yarn.spline.control[k].z() =
                0.15 *
                std::sin(4 * std::numbers::pi *
                         (static_cast<double>(k) / count - static_cast<double>(yarn.number) / 8)) *
                (yarn.system == System::warp ? 1 : -1);
    }
    return yarns;
}

/// The curves as a scan would give them: points of its own choice, some of them from the other end.
MeasuredCloth scan(const Yarns& yarns, const Alignment& motion, Random& random) {
    MeasuredCloth measured;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        MeasuredYarn scanned;
        const std::size_t points = random.between(24, 48);
        const auto segments = static_cast<double>(yarn.spline.segments());
        for (std::size_t k = 0; k <= points; ++k)
            scanned.places.push_back(
                motion(yarn.spline.place(segments * static_cast<double>(k) / static_cast<double>(points))));
        if (random.coin()) std::ranges::reverse(scanned.places);
        measured.yarns.push_back(std::move(scanned));
    }
    return measured;
}

Comparison compared(const Yarns& yarns, const MeasuredCloth& measured) {
    auto comparison = compare(yarns, measured);
    if (!comparison) FAIL(comparison.error().text());
    return *comparison;
}

}  // namespace

TEST_CASE("yarns that were only moved, turned and mirrored are found where they are") {
    const Yarns yarns = twill();
    for_all(
        [&](Random& random) {
            const bool mirrored = random.coin();
            const Comparison found = compared(yarns, scan(yarns, random_motion(random, mirrored), random));
            CHECK(found.rms_mm < 1e-6);
            CHECK(found.max_mm < 1e-5);
            CHECK(found.alignment.mirrored == mirrored);
            CHECK(found.matched_by == MatchedBy::order);
            CHECK(found.per_yarn.size() == yarns.yarns.size());
        },
        8);
}

TEST_CASE("a known displacement gives that deviation, yarn by yarn") {
    const Yarns yarns = straight_cloth({});
    for_all(
        [&](Random& random) {
            const double by = uniform(random, 0.005, 0.05);
            MeasuredCloth measured = scan(yarns, {}, random);
            for (std::size_t y = 0; y < measured.yarns.size(); ++y) {  // picks by turns up and down, ends not
                if (yarns.yarns[y].system == System::warp) continue;
                const std::size_t row =
                    yarns.yarns[y].number / 3;  // of four: neither a shift nor a tilt makes this less
                for (Vec3& place : measured.yarns[y].places) place.z() += row == 0 || row == 3 ? by : -by;
            }
            const Comparison found = compared(yarns, measured);
            CHECK(found.rms_mm == Approx(by * std::sqrt(0.5)).epsilon(0.02));
            for (const YarnDeviation& yarn : found.per_yarn) {
                CHECK(yarn.measured == yarn.simulated);
                CHECK(yarn.rms_mm ==
                      Approx(yarns.yarns[yarn.simulated].system == System::weft ? by : 0).margin(0.12 * by));
                CHECK(yarn.max_mm >= yarn.rms_mm * (1 - 1e-9));
            }
        },
        8);
}

TEST_CASE("without a count in common each yarn is matched with the nearest, and the rest are named") {
    const Yarns yarns = twill();
    for_all(
        [&](Random& random) {
            const bool mirrored = random.coin();
            Alignment motion;
            motion.mirrored = mirrored;
            motion.translation = {uniform(random, -0.1, 0.1), uniform(random, -0.1, 0.1), 3};
            const MeasuredCloth all = scan(yarns, motion, random);
            std::vector<std::size_t> order(yarns.yarns.size());
            std::iota(order.begin(), order.end(), std::size_t{0});
            random.shuffle(order);
            MeasuredCloth some;
            for (const std::size_t y : order) {
                if (y != 3) some.yarns.push_back(all.yarns[y]);
            }
            const Comparison found = compared(yarns, some);
            CHECK(found.matched_by == MatchedBy::nearness);
            CHECK(found.rms_mm < 1e-6);
            CHECK(found.simulated_alone == std::vector<std::size_t>{3});
            CHECK(found.measured_alone.empty());
        },
        6);
}

TEST_CASE("yarns in another order are matched by order, and it is told how much nearer the nearest lie") {
    Yarns yarns = twill();
    for (SimulatedYarn& yarn : yarns.yarns) {  // so that no turn lays it on itself
        const auto number = static_cast<double>(yarn.number);
        const double by = 0.02 * number * number * (yarn.system == System::weft ? 1 : 0.5);
        for (Vec3& place : yarn.spline.control) place[yarn.system == System::weft ? 0 : 1] += by;
    }
    for_all(
        [&](Random& random) {
            MeasuredCloth measured = scan(yarns, {}, random);
            std::ranges::reverse(measured.yarns);
            const Comparison found = compared(yarns, measured);
            CHECK(found.matched_by == MatchedBy::order);
            CHECK(found.rms_mm > 0.01);
            REQUIRE(found.by_nearness);
            CHECK(found.by_nearness->rms_mm < 1e-6);
            CHECK_FALSE(found.unit);
            const auto nearest = compare(yarns, measured, MatchedBy::nearness);
            REQUIRE(nearest);
            CHECK(nearest->matched_by == MatchedBy::nearness);
            CHECK(nearest->rms_mm < 1e-6);
            CHECK_FALSE(nearest->by_nearness);
        },
        2);
}

TEST_CASE("a scan in another unit is told by how well it fits there") {
    const Yarns yarns = twill();
    const std::pair<double, const char*> units[]{{1e3, "µm"}, {0.1, "cm"}, {1 / 25.4, "inches"}};
    for (const auto& [scale, name] : units) {
        CAPTURE(name);
        Random random(5);
        MeasuredCloth measured = scan(yarns, {}, random);
        for (MeasuredYarn& yarn : measured.yarns) {
            for (Vec3& place : yarn.places) place *= scale;
        }
        const Comparison found = compared(yarns, measured);
        REQUIRE(found.unit);
        CHECK(found.unit->unit == name);
        CHECK(found.unit->mm == Approx(1 / scale));
        CHECK(found.unit->rms_mm < 1e-6);
        CHECK(found.unit->matched_by == MatchedBy::order);
    }
    Random random(6);
    const Comparison right = compared(yarns, scan(yarns, {}, random));
    CHECK_FALSE(right.unit);
    CHECK_FALSE(right.by_nearness);
}

TEST_CASE("order is refused where there are not as many yarns") {
    const Yarns yarns = twill();
    Random random(7);
    MeasuredCloth measured = scan(yarns, {}, random);
    measured.yarns.pop_back();
    CHECK_FALSE(compare(yarns, measured, MatchedBy::order));
    CHECK(compare(yarns, measured));
}

TEST_CASE("a yarn that lies a period aside is the same yarn") {
    Random random(7);
    const Yarns yarns = twill();
    MeasuredCloth measured = scan(yarns, {}, random);
    for (Vec3& place : measured.yarns[2].places) place.x() += yarns.size_mm[0];
    for (Vec3& place : measured.yarns[12].places) place.y() -= yarns.size_mm[1];
    CHECK(compared(yarns, measured).max_mm < 1e-5);
}

TEST_CASE("a .yarns file is matched by pick and end, whatever its order") {
    Yarns yarns = twill();
    for (SimulatedYarn& yarn : yarns.yarns)
        yarn.strain.resize(yarn.spline.control.size()), yarn.contact_N.resize(yarn.spline.control.size());
    Yarns other = yarns;
    std::ranges::reverse(other.yarns);
    other.crossings.clear();
    const auto bytes = write_yarns(other);
    REQUIRE(bytes);
    const auto measured = read_measured_cloth(*bytes);
    REQUIRE(measured);
    const Comparison found = compared(yarns, *measured);
    CHECK(found.matched_by == MatchedBy::name);
    CHECK(found.max_mm < 1e-9);
    for (const YarnDeviation& yarn : found.per_yarn)
        CHECK(yarn.simulated == yarns.yarns.size() - 1 - yarn.measured);
    CHECK_FALSE(read_measured_cloth(bytes->substr(0, bytes->size() - 1)));
}

TEST_CASE("the nearest place of a curve is the nearest of many") {
    for_all(
        [](Random& random) {
            Spline spline;
            spline.is_periodic = random.coin();
            spline.shift = {4, uniform(random, -1, 1), 0};
            for (std::size_t k = random.between(2, 40); k > 0; --k)
                spline.control.push_back(
                    {uniform(random, 0, 4), uniform(random, -1, 1), uniform(random, -1, 1)});
            const sim::CurveFinder finder(spline);
            const Vec3 place(uniform(random, -3, 7), uniform(random, -2, 2), uniform(random, -2, 2));
            const sim::OnCurve found = finder.nearest(place);
            CHECK((found.place - place).norm() == Approx(found.distance));
            const double low = spline.is_periodic ? -2.0 * static_cast<double>(spline.segments()) : 0,
                         high = (spline.is_periodic ? 3.0 : 1.0) * static_cast<double>(spline.segments());
            double least = 1e9;
            for (double t = low; t <= high; t += 0.02)
                least = std::min(least, (spline.place(t) - place).norm());
            CHECK(found.distance <=
                  least * 1.1 + 1e-9);  // a quarter of a wild segment may hide a hair's breadth
        },
        200);
}

TEST_CASE(
    "Kabsch finds the motion, of either handedness, and never answers with a mirror where none was asked "
    "for") {
    for_all(
        [](Random& random) {
            const Alignment motion = random_motion(random, random.coin());
            std::vector<Vec3> from, to;
            for (int k = 0; k < 12; ++k) {
                from.push_back({uniform(random, -3, 3), uniform(random, -3, 3), uniform(random, -3, 3)});
                to.push_back(motion(from.back()));
            }
            const Alignment found = sim::kabsch(from, to, motion.mirrored);
            for (int k = 0; k < 12; ++k)
                CHECK((found(from[static_cast<std::size_t>(k)]) - to[static_cast<std::size_t>(k)]).norm() <
                      1e-9);
            CHECK(sim::kabsch(from, to, !motion.mirrored).rotation.determinant() == Approx(1));
        },
        500);
}

TEST_CASE("measured yarns of no length, or none at all, are no trouble") {
    const Yarns yarns = straight_cloth({});
    MeasuredCloth measured;
    CHECK_FALSE(compare(yarns, measured));
    measured.yarns.push_back({{Vec3(0.01, 1, 0.1), Vec3(0.01, 1, 0.1)}, 1});
    const Comparison found = compared(yarns, measured);
    CHECK(std::isfinite(found.rms_mm));
    CHECK(found.per_yarn.size() == 1);
    CHECK_FALSE(compare(Yarns{}, measured));
}
