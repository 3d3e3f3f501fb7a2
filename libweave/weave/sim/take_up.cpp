#include <weave/design/document.hpp>
#include <weave/sim/take_up.hpp>

#include <limits>

namespace weave {

namespace {

bool reports(const Yarns& yarns, const char* name) {
    const auto found = yarns.report.find(name);
    return found != yarns.report.end() && found->is_boolean() && found->get<bool>();
}

Status check_fit(const Yarns& yarns, const Design& design) {
    const std::string own = design_sha256(design);
    if (yarns.design_sha256 != own) {
        const std::string of = yarns.design_sha256.empty()
                                   ? "do not tell their design"
                                   : "are of design " + yarns.design_sha256.substr(0, 12) + "…";
        return bad_input(
            "these yarns " + of + ", and this design is " + own.substr(0, 12) + "…: simulate it anew",
            "design_sha256");
    }
    const Region& region = yarns.region;
    if (region.first_row != 0 || region.first_column != 0 || region.last_row + 1 != yarns.cloth_rows ||
        region.last_column + 1 != yarns.cloth_columns)
        return bad_input("these yarns are only a part of the cloth", "region");
    if (!reports(yarns, "converged"))
        return bad_input("these yarns are not at rest: simulate on", "report.converged");
    if (!reports(yarns, "order_kept"))
        return bad_input("crossings of these yarns are no longer as the card says", "report.order_kept");
    return {};
}

}  // namespace

double take_up_of(const SimulatedYarn& yarn) {
    const Spline& spline = yarn.spline;
    const double cloth =
        spline.is_periodic ? spline.shift.norm() : (spline.control.back() - spline.control.front()).norm();
    return cloth > 0 ? (yarn.length_mm - cloth) / cloth : 0;
}

Result<TakeUps> take_ups_of(const Yarns& yarns, const Design& design, std::size_t ends) {
    WEAVE_CHECK_OK(check_fit(yarns, design));
    TakeUps take_ups(ends, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t y = 0; y < yarns.yarns.size(); ++y) {
        const SimulatedYarn& yarn = yarns.yarns[y];
        if (yarn.system != System::warp) continue;
        if (yarn.number >= ends)
            return bad_input("is an end that the design does not have", "yarns[" + std::to_string(y) + "]");
        take_ups[yarn.number] = take_up_of(yarn);
    }
    return take_ups;
}

}  // namespace weave
