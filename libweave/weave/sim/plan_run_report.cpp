#include <weave/sim/order.hpp>
#include <weave/sim/plan_run.hpp>
#include <weave/sim/result.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace weave::sim {

namespace {

/// How far the strain of the yarns of each system is from what was asked for, where nothing is held: S - 1 where they are
/// fed, else 0.
Json strain_deviation(const Yarns& repeat, const SimScene& scene) {
    std::array<double, 2> greatest{};
    for (std::size_t y = 0; y < repeat.yarns.size(); ++y) {
        const SimYarn& yarn = scene.yarns[y];
        double& most = greatest[repeat.yarns[y].system == System::warp ? 0 : 1];
        const std::vector<double>& strain = repeat.yarns[y].strain;
        const std::size_t segments = strain.size() - (yarn.is_periodic ? 0 : 1);
        for (std::size_t i = 0; i < strain.size(); ++i) {
            if (is_held_at(yarn, std::min(i, segments - 1))) continue;
            most = std::max(most, std::abs(strain[i] - (yarn.is_fed ? yarn.strain - 1 : 0)));
        }
    }
    return {{"warp", greatest[0]}, {"weft", greatest[1]}};
}

}  // namespace

Yarns PlanRun::yarns() {
    if (!m_in_leg && m_energy) return measured(*m_energy, m_state);
    // The solver's own must not be touched while it works, for its next bits depend on what lies in it.
    SimScene scene = m_scene;
    std::vector<std::vector<Vec3>> now = control();
    for (std::size_t y = 0; y < now.size(); ++y) scene.yarns[y].control = std::move(now[y]);
    const Fabric<double> fabric(scene);
    Energy<double> energy(fabric, *m_executor);
    std::vector<double> state = fabric.state(), gradient;
    energy.evaluate(state, gradient);
    if (scene.friction > 0) energy.renew_friction(state, stick_share);
    return measured(energy, state);
}

/// The planned places in the periods reached, so that whoever compares them with the yarns looks at the same
/// cloth: what the yarns say of themselves is that of these periods.
Plan PlanRun::in_periods_reached() const {
    Plan plan = m_plan;
    ClothCurves& curves = plan.curves;
    Vec3 grown(1, 1, 1);
    for (std::size_t k = 0; k < 2; ++k) {
        if (!m_scene.is_periodic[k]) continue;
        grown[static_cast<int>(k)] = m_scene.period_mm[k] / curves.size_mm[k];
        curves.size_mm[k] = m_scene.period_mm[k];
    }
    for (YarnCurve& curve : curves.yarns) {
        for (KeyPoint& key : curve.keys) key.place = key.place.cwiseProduct(grown);
        curve.shift = curve.shift.cwiseProduct(grown);
    }
    for (SimYarn& yarn : plan.scene.yarns) {
        for (Vec3& place : yarn.control) place = place.cwiseProduct(grown);
        yarn.shift = yarn.shift.cwiseProduct(grown);
    }
    return plan;
}

Yarns PlanRun::measured(Energy<double>& energy, std::vector<double>& state) const {
    const Plan plan = in_periods_reached();
    const Fabric<double>& fabric = energy.fabric();
    Yarns repeat = yarns_in_state(m_design, plan, energy, state);
    const Contacts contacts = contacts_of(energy, state);
    const CrossingOrder order = crossing_order(plan.curves, splines_of(fabric.control(state)));
    const Json deviation = strain_deviation(repeat, fabric.scene());
    Yarns yarns = copied_back(std::move(repeat), plan, m_design);
    yarns.report = report(plan, fabric);
    yarns.report.update({{"design_sha256", yarns.design_sha256},
                         {"scene_sha256", yarns.scene_sha256},
                         {"contacts", contacts.seen / 2},
                         {"smallest_curvature", smallest_curvature(energy, state)},
                         {"strain_deviation", deviation},
                         {"order_kept", order.lost.empty()},
                         {"lost_crossings", order.lost.size()},
                         {"slid_crossings", order.slid.size()},
                         {"max_overlap", contacts.overlap}});
    return yarns;
}

Json PlanRun::report(const Plan& plan, const Fabric<double>& fabric) const {
    const bool balanced = !m_periods || m_periods->balanced;
    Json report{{"design_sha256", ""},
                {"scene_sha256", ""},
                {"coverage", coverage_of(plan)},
                {"solver", std::string(sim::name_of(m_goal.solver))},
                {"backend", std::string(sim::name_of(m_relaxer.choice().backend))},
                {"fidelity", std::string(sim::name_of(plan.fidelity))},
                {"points_per_key", plan.points_per_key},
                {"converged", m_last.ending == Ending::converged && balanced && m_parameters.have_arrived()},
                {"ending", m_last.ending == Ending::converged && !balanced ? "periods" : std::string(sim::name_of(m_last.ending))},
                {"goal", goal()},
                {"residual", m_last.residual},
                {"reference_N", m_last.reference_N},
                {"energy_N_mm", m_last.energy},
                {"points", fabric.points()},
                {"contacts", 0},
                {"iterations", m_cost.iterations},
                {"evaluations", m_cost.evaluations},
                {"seconds", m_cost.seconds},
                {"smallest_curvature", ""},
                {"strain_deviation", Json()},
                {"order_kept", false},
                {"crossings", plan.curves.crossings.size()},
                {"lost_crossings", 0},
                {"slid_crossings", 0},
                {"max_overlap", 0.0},
                {"plan", lines_json(plan)},
                {"peak_bytes", peak_bytes()}};
    if (!m_flips.empty()) report["flips"] = m_flips;
    if (m_scene.friction > 0) {
        report["friction"] = {{"coefficient", m_scene.friction}, {"rounds", m_friction.rounds},
                              {"agreed", m_friction.agreed}, {"press_N", m_friction.slip.press_N},
                              {"stuck_share", m_friction.slip.stuck_share},
                              {"farthest_slip_mm", m_friction.slip.farthest_mm}};
    }
    if (m_periods) {
        const auto asked = [&](std::size_t k) { return plan.rim_force_N[k] ? Json(*plan.rim_force_N[k]) : Json(); };
        report["periods"] = {{"size_mm", plan.curves.size_mm}, {"force_N", m_periods->force_N},
                             {"asked_N", {asked(0), asked(1)}},
                             {"rounds", m_periods->rounds}, {"balanced", m_periods->balanced}};
    }
    return report;
}

/// Sign of the least second derivative of the energy at rest, where the residual does not leave it open. What is not at
/// rest is not looked at.
std::string PlanRun::smallest_curvature(Energy<double>& energy, std::vector<double>& state) const {
    if (m_last.ending != Ending::converged) return "not looked";
    if (m_last.curves_down == false) return "positive";
    const Bend bend = bend_at(energy, state, goal() * m_last.reference_N);
    return bend == Bend::up ? "positive" : bend == Bend::down ? "negative" : "unclear";
}

}  // namespace weave::sim
