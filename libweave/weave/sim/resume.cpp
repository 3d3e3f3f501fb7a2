#include <weave/sim/resume.hpp>

#include <weave/core/text.hpp>
#include <weave/curve/spline.hpp>
#include <weave/sim/linking.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/periods.hpp>

#include <algorithm>
#include <map>
#include <utility>

namespace weave::sim {

namespace {

std::string name_of(System system, std::size_t number) {
    return (system == System::warp ? "end " : "pick ") + std::to_string(number + 1);
}

Status check_origin(const Plan& plan, const Yarns& yarns, const std::string& design_sha256,
                    const std::vector<std::string>& scenes) {
    if (yarns.design_sha256 != design_sha256)
        return bad_input("these are the yarns of another design, '" + on_one_line(yarns.title) + "' (" +
                             yarns.design_sha256.substr(0, 12) + "), not of this one (" + design_sha256.substr(0, 12) + ")",
                         "design_sha256");
    if (std::ranges::find(scenes, yarns.scene_sha256) == scenes.end())
        return bad_input("these yarns come from another scene (" + yarns.scene_sha256.substr(0, 12) + ") than this one (" +
                             scenes.front().substr(0, 12) + "): give the same --set, --boundary, --pin and --field",
                         "scene_sha256");
    const Region whole{0, plan.cloth_rows - 1, 0, plan.cloth_columns - 1};
    const Region& wanted = plan.repeats[0] * plan.repeats[1] == 1 ? plan.curves.region : whole;
    if (!(yarns.region == wanted)) return bad_input("these are the yarns of another part of the cloth", "region");
    return {};
}

/// The first of `repeats` equal parts of a spline that goes on for ever.
Spline first_part(const Spline& spline, std::size_t repeats, const Vec3& shift) {
    Spline part = spline;
    part.control.resize(spline.control.size() / repeats);
    part.shift = shift;
    return part;
}

/// Whether a scene's yarns have passed through one another since another state of it, or left the order of the card more
/// often than there.
bool keeps_order(const Plan& plan, const SimScene& before, const SimScene& now) {
    const auto control_of = [](const SimScene& scene) {
        std::vector<std::vector<Vec3>> control;
        for (const SimYarn& yarn : scene.yarns) control.push_back(yarn.control);
        return control;
    };
    const auto lost_in = [&](const SimScene& scene) {
        std::vector<Spline> splines(plan.curves.yarns.size());
        for (std::size_t y = 0; y < scene.yarns.size(); ++y)
            splines[plan.curve_of[y]] = {scene.yarns[y].control, scene.yarns[y].is_periodic, scene.yarns[y].shift};
        return lost_crossings(plan.curves, splines).size();
    };
    if (lost_in(now) > lost_in(before)) return false;
    Linking change = linking_of(now, control_of(now));
    for (const auto& [pair, count] : linking_of(before, control_of(before))) change[pair] -= count;
    return std::ranges::none_of(change, [](const auto& entry) { return passed_through(entry.second); });
}

}  // namespace

SimScene scene_at(const Plan& plan, const StartState& start) {
    SimScene scene = plan.scene;
    for (std::size_t y = 0; y < scene.yarns.size(); ++y) scene.yarns[y].control = start.control[y];
    const std::array<double, 2> wanted = scene.period_mm;
    std::array<double, 2> came = start.size_mm;
    scene.period_mm = came;
    for (std::size_t k = 0; k < 2; ++k) {
        if (!plan.rim_force_N[k]) came[k] = wanted[k];
    }
    for (SimYarn& yarn : scene.yarns) {
        for (Eigen::Index k = 0; k < 2; ++k) yarn.shift[k] *= scene.period_mm[std::size_t(k)] / wanted[std::size_t(k)];
    }
    scene = with_periods(std::move(scene), came);
    for (std::size_t k = 0; k < 2; ++k) {
        if (!scene.is_periodic[k]) scene.period_mm[k] = wanted[k];
    }
    return scene;
}

Result<StartState> start_from(const Plan& plan, const Yarns& yarns, const std::string& design_sha256,
                              const std::vector<std::string>& scenes) {
    WEAVE_CHECK_OK(check_origin(plan, yarns, design_sha256, scenes));
    std::map<std::pair<System, std::size_t>, std::vector<const SimulatedYarn*>> known;
    for (const SimulatedYarn& yarn : yarns.yarns) known[{yarn.system, yarn.number}].push_back(&yarn);
    std::map<std::pair<System, std::size_t>, std::size_t> taken;
    StartState start;
    for (std::size_t k = 0; k < 2; ++k) start.size_mm[k] = yarns.size_mm[k] / static_cast<double>(plan.repeats[k]);
    for (std::size_t y = 0; y < plan.scene.yarns.size(); ++y) {
        const YarnCurve& curve = plan.curves.yarns[plan.curve_of[y]];
        const SimYarn& planned = plan.scene.yarns[y];
        const std::pair key(curve.system, curve.number);
        const std::size_t nth = taken[key]++;  // a pick of two feeders is two yarns, always in the same order
        const auto found = known.find(key);
        const SimulatedYarn* from = found == known.end() || nth >= found->second.size() ? nullptr : found->second[nth];
        const std::size_t along = curve.system == System::warp ? plan.repeats[0] : plan.repeats[1];
        if (from == nullptr || from->spline.is_periodic != planned.is_periodic || from->spline.control.size() % along != 0)
            return bad_input(name_of(curve.system, curve.number) + " is not in these yarns as it is simulated now");
        const Spline part = along == 1 ? from->spline : first_part(from->spline, along, from->spline.shift / double(along));
        start.control.push_back(part.control.size() == planned.control.size() ? part.control
                                                                               : resample(part, planned.control.size()).control);
    }
    return start;
}

std::optional<StartState> refined_start(const Plan& plan, const Plan& coarser, const StartState& state) {
    const SimScene coarse = scene_at(coarser, state);
    StartState start{{}, state.size_mm};
    for (std::size_t y = 0; y < plan.scene.yarns.size(); ++y) {
        const SimYarn &planned = plan.scene.yarns[y], &from = coarse.yarns[y];
        start.control.push_back(resample({from.control, from.is_periodic, from.shift}, planned.control.size()).control);
        for (std::size_t i = 0; i < planned.frozen.size(); ++i) {
            if (planned.frozen[i] != 0) start.control[y][i] = planned.control[i];
        }
    }
    if (!keeps_order(plan, plan.scene, scene_at(plan, start))) return {};
    return start;
}

}  // namespace weave::sim
