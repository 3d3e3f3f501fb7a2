#include <weave/design/edit.hpp>
#include <weave/sim/plan_run.hpp>
#include <weave/sim/points_json.hpp>

#include <algorithm>
#include <utility>

namespace weave::sim {

namespace {

Json to_json(const LiveParameters& parameters) {
    return {{"strain", parameters.strain}, {"stiffness", parameters.stiffness}, {"radius", parameters.radius}};
}
LiveParameters parameters_from(const Json& json) {
    return {json.at("strain"), json.at("stiffness"), json.at("radius")};
}

Json to_json(const RunCost& cost) {
    return {{"iterations", cost.iterations}, {"evaluations", cost.evaluations}, {"seconds", cost.seconds}};
}
RunCost cost_from(const Json& json) {
    return {json.at("iterations"), json.at("evaluations"), json.at("seconds")};
}

Json to_json(const Flip& flip) {
    return {{"pick", flip.pick}, {"end", flip.end}, {"weft_over", flip.weft_over}};
}
Flip flip_from(const Json& json) {
    return {json.at("pick"), json.at("end"), json.at("weft_over")};
}

Json ending_json(const std::optional<Ending>& ending) {
    return ending ? Json(static_cast<int>(*ending)) : Json();
}
std::optional<Ending> ending_from(const Json& json) {
    if (json.is_null()) return {};
    const int number = json;
    if (number < 0 || number > static_cast<int>(Ending::stuck)) throw std::out_of_range("no such ending");
    return static_cast<Ending>(number);
}

Json to_json(const FrictionResult& friction) {
    return {{"rounds", friction.rounds}, {"agreed", friction.agreed}, {"press_N", friction.slip.press_N},
            {"stuck_share", friction.slip.stuck_share}, {"farthest_mm", friction.slip.farthest_mm}};
}
FrictionResult friction_from(const Json& json) {
    FrictionResult friction;
    friction.rounds = json.at("rounds");
    friction.agreed = json.at("agreed");
    friction.slip.press_N = json.at("press_N");
    friction.slip.stuck_share = json.at("stuck_share");
    friction.slip.farthest_mm = json.at("farthest_mm");
    return friction;
}

Json to_json(const std::vector<ForceField>& fields) {
    Json list = Json::array();
    for (const ForceField& field : fields)
        list.push_back({{"centre_mm", field.centre_mm}, {"radius_mm", field.radius_mm}, {"strength_N_per_mm", field.strength_N_per_mm}});
    return list;
}

/// The crossing's card as it is after a flip.
void turn(std::vector<Crossing>& crossings, const Flip& flip) {
    for (Crossing& crossing : crossings) {
        if (crossing.pick == flip.pick && crossing.end == flip.end) crossing.weft_over = flip.weft_over;
    }
}

}  // namespace

Json PlanRun::state() const {
    std::vector<std::vector<Vec3>> places;
    Json frozen = Json::array();
    for (const SimYarn& yarn : m_scene.yarns) {
        places.push_back(yarn.control);
        frozen.push_back(Json::binary(yarn.frozen));
    }
    Json state{{"control", points_json(places)}, {"period_mm", m_scene.period_mm}, {"frozen", std::move(frozen)},
               {"fields", to_json(m_scene.fields)}, {"cost", to_json(m_cost)}, {"relaxed", to_json(m_relaxed)},
               {"begun", m_begun}, {"end", ending_json(m_end)}, {"cut", ending_json(m_cut)},
               {"last", {{"ending", static_cast<int>(m_last.ending)}, {"residual", m_last.residual}, {"energy", m_last.energy},
                         {"reference_N", m_last.reference_N},
                         {"curves_down", m_last.curves_down ? Json(*m_last.curves_down) : Json()}}},
               {"friction", to_json(m_friction)}, {"flips", m_flips}};
    for (const System system : {System::warp, System::weft})
        state[system == System::warp ? "warp" : "weft"] = {{"now", to_json(m_parameters.now(system))},
                                                            {"wanted", to_json(m_parameters.wanted(system))}};
    Json flipped = Json::array();
    for (const Flip& flip : m_flipped) flipped.push_back(to_json(flip));
    state["flipped"] = std::move(flipped);
    Json lines = Json::array();
    for (const PlanLine& line : m_plan.lines) lines.push_back({line.term, line.choice, line.reason});
    state["lines"] = std::move(lines);
    if (m_scene.slip_from)
        state["slip_from"] = {{"control", points_json(m_scene.slip_from->control)}, {"period_mm", m_scene.slip_from->period_mm}};
    if (m_periods)
        state["periods"] = {{"force_N", m_periods->force_N}, {"rounds", m_periods->rounds}, {"balanced", m_periods->balanced}};
    if (m_flipping)
        state["flipping"] = {{"flip", to_json(m_flipping->flip)}, {"control", points_json(m_flipping->before.control)},
                             {"period_mm", m_flipping->before.size_mm}, {"lost_before", m_flipping->lost_before},
                             {"seconds", m_flipping->seconds}};
    return state;
}

Status PlanRun::restore(const Json& state) {
    try {
        const std::vector<std::vector<Vec3>> control = points_from(state.at("control"), m_plan.scene);
        m_scene = with_periods(m_plan.scene, state.at("period_mm").get<std::array<double, 2>>());
        for (std::size_t y = 0; y < control.size(); ++y) {
            SimYarn& yarn = m_scene.yarns[y];
            yarn.control = control[y];
            yarn.frozen = state.at("frozen").at(y).get_binary();
            if (!yarn.frozen.empty() && yarn.frozen.size() != yarn.control.size()) throw std::out_of_range("frozen");
        }
        for (const System system : {System::warp, System::weft}) {
            const Json& led = state.at(system == System::warp ? "warp" : "weft");
            m_parameters.restore(system, parameters_from(led.at("now")), parameters_from(led.at("wanted")));
        }
        if (m_parameters.now(System::warp) != LedParameters(m_plan).now(System::warp) ||
            m_parameters.now(System::weft) != LedParameters(m_plan).now(System::weft))
            m_parameters.apply(m_scene);
        m_scene.fields.clear();
        for (const Json& field : state.at("fields"))
            m_scene.fields.push_back({field.at("centre_mm"), field.at("radius_mm"), field.at("strength_N_per_mm")});
        m_plan.lines.clear();
        for (const Json& line : state.at("lines")) m_plan.lines.push_back({line.at(0), line.at(1), line.at(2)});
        m_scene.slip_from.reset();
        if (state.contains("slip_from"))
            m_scene.slip_from = SlipStart{points_from(state.at("slip_from").at("control"), m_plan.scene), state.at("slip_from").at("period_mm")};
        m_cost = cost_from(state.at("cost"));
        m_relaxed = cost_from(state.at("relaxed"));
        m_begun = state.at("begun");
        m_end = ending_from(state.at("end"));
        m_cut = ending_from(state.at("cut"));
        const Json& last = state.at("last");
        m_last.ending = ending_from(last.at("ending")).value_or(Ending::stopped);
        m_last.residual = last.at("residual");
        m_last.energy = last.at("energy");
        m_last.reference_N = last.at("reference_N");
        m_last.curves_down.reset();
        if (!last.at("curves_down").is_null()) m_last.curves_down = last.at("curves_down").get<bool>();
        m_friction = friction_from(state.at("friction"));
        m_flips = state.at("flips");
        if (state.contains("periods")) {
            m_periods.emplace();
            m_periods->force_N = state.at("periods").at("force_N");
            m_periods->rounds = state.at("periods").at("rounds");
            m_periods->balanced = state.at("periods").at("balanced");
        }
        for (const Json& json : state.at("flipped")) {
            const Flip flip = flip_from(json);
            turn(m_plan.curves.crossings, flip);
            if (!apply_edit(m_design, PutFlip{m_design.root, flip})) throw std::out_of_range("flipped");
            m_flipped.push_back(flip);
        }
        if (state.contains("flipping")) {
            const Json& json = state.at("flipping");
            m_flipping = Flipping{flip_from(json.at("flip")),
                                  {points_from(json.at("control"), m_plan.scene), json.at("period_mm")},
                                  m_plan.curves.crossings, json.at("lost_before"), json.at("seconds")};
            turn(m_plan.curves.crossings, m_flipping->flip);
        }
        m_energy.reset();
        m_looks.reset();
    } catch (const std::exception& broken) {
        return bad_input("this is no state of such a run: " + std::string(broken.what()));
    }
    return {};
}

}  // namespace weave::sim
