#include <weave/sim/planned_yarns.hpp>

#include <weave/design/picks.hpp>

namespace weave::sim {

namespace {

std::vector<Vec3> places_of(const std::vector<KeyPoint>& keys) {
    std::vector<Vec3> places;
    places.reserve(keys.size());
    for (const KeyPoint& key : keys) places.push_back(key.place);
    return places;
}

}  // namespace

SimulatedYarn labelled_yarn(const Design& design, const YarnCurve& curve) {
    const bool is_warp = curve.system == System::warp;
    const YarnType& type = (is_warp ? design.warp.yarns : design.weft.yarns)[curve.type];
    const SystemScene& system = is_warp ? design.scene.warp : design.scene.weft;
    SimulatedYarn yarn;
    yarn.system = curve.system;
    yarn.number = curve.number;
    yarn.beam = is_warp ? design.warp.beam_order.at(curve.number) : 0;
    yarn.radius_mm = type.radius_mm * system.radius_scale.value_or(1);
    yarn.colour = is_warp ? colour_of_end(design, curve.number) : type.colour;
    return yarn;
}

Yarns planned_yarns(const Design& design, const ClothCurves& curves) {
    Yarns yarns;
    yarns.title = design.title;
    yarns.size_mm = curves.size_mm;
    yarns.is_periodic = curves.is_periodic;
    yarns.region = curves.region;
    yarns.crossings = curves.crossings;
    yarns.cloth_rows = curves.region.last_row + 1;
    yarns.cloth_columns = curves.region.last_column + 1;
    for (const YarnCurve& curve : curves.yarns) {
        SimulatedYarn yarn = labelled_yarn(design, curve);
        yarn.spline = interpolate(places_of(curve.keys), curve.is_periodic, curve.shift);
        yarn.planned = yarn.spline.control;
        yarn.strain.assign(yarn.planned.size(), 0);
        yarn.contact_N.assign(yarn.planned.size(), 0);
        yarns.yarns.push_back(std::move(yarn));
    }
    yarns.report["points_per_key"] = 1;
    return yarns;
}

}  // namespace weave::sim
