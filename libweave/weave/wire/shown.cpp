#include <weave/wire/shown.hpp>

#include <weave/design/picks.hpp>

#include <algorithm>

namespace weave::wire {

namespace {

/// The radius that a yarn is led to: a layout holds for all frames of the way there.
double shown_radius(const sim::PlanRun& now, std::size_t yarn) {
    constexpr double least = 1e-9, most = 1e9;  // that a layout can tell
    const sim::Plan& plan = now.plan();
    const System system = plan.curves.yarns[plan.curve_of[yarn]].system;
    return std::clamp(plan.scene.yarns[yarn].radius_mm * now.parameters().wanted(system).radius, least, most);
}

}  // namespace

Layout layout_of(const sim::Run& run) {
    const sim::PlanRun& now = run.now();
    const sim::Plan& plan = now.plan();
    const Design& design = now.design();
    Layout layout;
    layout.fidelity = plan.fidelity;
    layout.is_periodic = now.scene().is_periodic;
    layout.repeats = {plan.repeats[0], plan.repeats[1]};
    for (std::size_t y = 0; y < plan.curve_of.size(); ++y) {
        const YarnCurve& curve = plan.curves.yarns[plan.curve_of[y]];
        const sim::SimYarn& yarn = now.scene().yarns[y];
        const bool warp = curve.system == System::warp;
        LayoutYarn shown;
        shown.system = curve.system;
        shown.number = curve.number;
        shown.beam = warp ? design.warp.beam_order.at(curve.number) : 0;
        shown.radius_mm = shown_radius(now, y);
        shown.colour = warp ? colour_of_end(design, curve.number) : design.weft.yarns[curve.type].colour;
        shown.points = yarn.control.size();
        shown.is_periodic = yarn.is_periodic;
        shown.turns = {static_cast<std::uint64_t>(yarn.turns[0]), static_cast<std::uint64_t>(yarn.turns[1])};
        layout.yarns.push_back(shown);
    }
    return layout;
}

Frame frame_of(const sim::Run& run) {
    const sim::PlanRun& now = run.now();
    Frame frame;
    frame.head.size_mm = now.scene().period_mm;
    double smallest = 1e300;
    for (std::size_t y = 0; y < now.scene().yarns.size(); ++y) smallest = std::min({smallest, now.scene().yarns[y].radius_mm, shown_radius(now, y)});
    frame.head.quantum_mm = quantum_for(smallest);
    frame.head.is_coarse = run.is_coarse();
    for (const std::vector<Vec3>& points : now.control()) {
        frame.counts.push_back(static_cast<std::uint32_t>(points.size()));
        frame.points.insert(frame.points.end(), points.begin(), points.end());
    }
    return frame;
}

}  // namespace weave::wire
