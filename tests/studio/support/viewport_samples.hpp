#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/simulate.hpp>
#include <studio/viewport/tube_model.hpp>
#include <support/straight_yarn.hpp>

#include <catch2/catch.hpp>

namespace weave::studio::test {

inline Design sample_design() {
    return find_sample("angle-interlock-b")->make();
}

inline ClothCurves sample_curves() {
    const Design design = sample_design();
    return cloth_curves(design, *evaluate(design)->block).value();
}

/// angle-interlock-b relaxed at draft, once for all tests.
inline std::shared_ptr<const Yarns> sample_yarns() {
    static const auto yarns = [] {
        const Design design = sample_design();
        sim::SimulationRequest request;
        request.fidelity = sim::Fidelity::draft;
        const auto plan = sim::make_plan(design, *evaluate(design)->block, request);
        REQUIRE(plan);
        return std::make_shared<const Yarns>(sim::simulate(design, *plan, {}));
    }();
    return yarns;
}

using testing::straight_yarn;

/// A red end along x over a blue pick along y, both 10 mm long, crossing in the middle; and a second end, on
/// the right, that crosses the pick as well.
inline std::shared_ptr<const Yarns> crossed_yarns() {
    auto yarns = std::make_shared<Yarns>();
    yarns->size_mm = {10, 10};
    yarns->yarns = {straight_yarn(System::weft, 6, {5, 0, 0}, {5, 10, 0}, {0x20, 0x40, 0xe0}),
                    straight_yarn(System::warp, 11, {0, 5, 1}, {10, 5, 1}, {0xe0, 0x20, 0x20}),
                    straight_yarn(System::warp, 12, {0, 8, 1}, {10, 8, 1}, {0xe0, 0x20, 0x20})};
    for (SimulatedYarn& yarn : yarns->yarns) {  // a point where they cross
        const Vec3 from = yarn.spline.control.front(), to = yarn.spline.control.back();
        const double at = 0.5;
        yarn.spline.control = {from, from + at * (to - from), to};
        yarn.planned = yarn.spline.control;
        yarn.strain = {0, 0.05, 0.1};
        yarn.contact_N = {2, 2, 2};
    }
    yarns->crossings = {{0, 1, 1, 1, 6, 11, false}, {0, 2, 2, 1, 6, 12, false}};
    yarns->report["points_per_key"] = 1;
    return yarns;
}

inline std::shared_ptr<TubeModel> model_of(std::shared_ptr<const Yarns> yarns,
                                           ColourBy colour = ColourBy::yarn) {
    auto model = TubeModel::relaxed(std::move(yarns), colour);
    if (!model) FAIL(model.error().text());
    return std::make_shared<TubeModel>(std::move(model).value());
}

}  // namespace weave::studio::test
