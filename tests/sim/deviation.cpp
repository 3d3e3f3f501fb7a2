// How far states lie apart, and whether yarns have passed through one another.

#include "scenes.hpp"

#include <weave/sim/deviation.hpp>
#include <weave/sim/linking.hpp>

#include <catch2/catch.hpp>

using namespace weave;
using namespace weave::sim;
using namespace weave::sim::testing;

namespace {

std::vector<Spline> splines_of(const SimScene& scene) {
    std::vector<Spline> splines;
    for (const SimYarn& yarn : scene.yarns) splines.push_back({yarn.control, yarn.is_periodic, yarn.shift});
    return splines;
}

std::vector<std::vector<Vec3>> control_of(const SimScene& scene) {
    std::vector<std::vector<Vec3>> control;
    for (const SimYarn& yarn : scene.yarns) control.push_back(yarn.control);
    return control;
}

}  // namespace

TEST_CASE("deviation is measured across the yarns, whatever their points and where the cloth lies") {
    const SimScene scene = plain_weave({});
    const std::vector<Spline> rest = splines_of(scene);
    CHECK(deviation_of(rest, rest, true).max_mm == 0);

    std::vector<Spline> finer, slid, drifted = rest;
    for (const Spline& spline : rest) {
        finer.push_back(resample(spline, 3 * spline.control.size()));
        Spline other = finer.back();
        std::rotate(other.control.begin(), other.control.begin() + 1, other.control.end());
        other.control.back() += other.shift;
        slid.push_back(other);
    }
    CHECK(deviation_of(finer, rest, false).max_mm < 1e-12);
    CHECK(deviation_of(slid, rest, false).max_mm < 1e-9);
    for (Spline& spline : drifted) {
        for (Vec3& point : spline.control) point += Vec3(0.3, -0.02, 0.1);
    }
    CHECK(deviation_of(drifted, rest, true).max_mm < 1e-6);
    CHECK(deviation_of(drifted, rest, false).max_mm > 0.1);

    std::vector<Spline> moved = rest;
    for (Vec3& point : moved[2].control) point.z() += 0.05;
    const Deviation one = deviation_of(moved, rest, false);
    CHECK(one.max_mm == Approx(0.05).epsilon(0.1));
    CHECK(one.yarn == 2);
    CHECK(one.rms_mm == Approx(0.05 / 2).epsilon(0.1));  // one yarn of four
}

TEST_CASE("linking stays while yarns move and changes when one passes through another") {
    weave::testing::for_all(
        [](Random& random) {
            SimScene scene = plain_weave({.count = 2});
            const auto before = linking_of(scene, control_of(scene));
            // Two crossings of either order for each warp and weft in turn; images double nothing.
            CHECK(std::abs(before.at({2, 0})) == 1);
            CHECK(before.at({2, 0}) == -before.at({3, 0}));
            CHECK(before.at({2, 0}) == -before.at({2, 1}));
            CHECK(before.count({1, 0}) == 0);
            for (SimYarn& yarn : scene.yarns) shake(random, yarn, 0.01);
            const Vec3 whole(uniform(random, -3, 3), uniform(random, -3, 3), 0);
            for (Vec3& point : scene.yarns[1].control) point += Vec3(scene.period_mm[0], 0, 0);
            for (SimYarn& yarn : scene.yarns) {
                for (Vec3& point : yarn.control) point += whole;
            }
            CHECK(linking_of(scene, control_of(scene)) == before);
            for (Vec3& point : scene.yarns[3].control) point.z() += 1;
            CHECK(linking_of(scene, control_of(scene)) != before);
        },
        50);
}
