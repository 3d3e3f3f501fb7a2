#include <weave/sim/order.hpp>

#include <catch2/catch.hpp>

#include <cmath>

using namespace weave;
using namespace weave::sim;

namespace {

/// One weft that runs along y over one warp along x.
ClothCurves one_crossing(double weft_way) {
    ClothCurves curves;
    YarnCurve weft, warp;
    weft.system = System::weft;
    warp.system = System::warp;
    for (int i = -2; i <= 2; ++i) {
        KeyPoint key;
        key.place = Vec3(0, weft_way * i, 0.3);
        weft.keys.push_back(key);
        key.place = Vec3(i, 0, -0.3);
        warp.keys.push_back(key);
    }
    curves.yarns = {weft, warp};
    curves.crossings = {{.weft = 0, .weft_key = 2, .warp = 1, .warp_key = 2, .pick = 0, .end = 0, .weft_over = true}};
    return curves;
}

/// The yarns of the plan as they lie after the cloth has been turned about the warp by `angle`; `gap`: 1 as planned, -1
/// with the yarns passed through one another.
std::size_t lost_after(double weft_way, double angle, double gap) {
    const ClothCurves curves = one_crossing(weft_way);
    std::vector<Spline> splines;
    for (const YarnCurve& curve : curves.yarns) {
        Spline spline;
        for (const KeyPoint& key : curve.keys) {
            const double y = key.place.y(), z = gap * key.place.z();
            spline.control.push_back({key.place.x(), std::cos(angle) * y - std::sin(angle) * z,
                                      std::sin(angle) * y + std::cos(angle) * z});
        }
        splines.push_back(spline);
    }
    return lost_crossings(curves, splines).size();
}

}  // namespace

TEST_CASE("cloth that stands on edge or hangs over keeps its order, and yarns that passed are found in it") {
    for (const double way : {1.0, -1.0}) {
        for (const double degrees : {0.0, 40.0, 80.0, 90.0, 110.0, -95.0}) {
            CAPTURE(way, degrees);
            const double angle = degrees * 3.14159265358979 / 180;
            CHECK(lost_after(way, angle, 1) == 0);
            CHECK(lost_after(way, angle, -1) == 1);
        }
    }
}
