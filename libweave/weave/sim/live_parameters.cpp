#include <weave/sim/live_parameters.hpp>

#include <algorithm>

namespace weave::sim {

namespace {

/// How far parameters move at once: tension at most doubles above this strain, radii and stiffness by these factors.
constexpr double strain_step = 0.02, radius_factor = 1.2, stiffness_factor = 4;

double towards(double now, double wanted, double factor) {
    return std::clamp(wanted, now / factor, now * factor);
}

double strain_towards(double now, double wanted) {
    const double step = std::max(strain_step, now - 1);
    return std::clamp(wanted, now - step, now + step);
}

}  // namespace

LedParameters::LedParameters(const Plan& plan) {
    for (std::size_t y = 0; y < plan.scene.yarns.size(); ++y) {
        const SimYarn& yarn = plan.scene.yarns[y];
        const System system = plan.curves.yarns[plan.curve_of[y]].system;
        m_yarns.push_back({system, yarn.stretch_N, yarn.bending_N_mm2, yarn.radius_mm});
        if (yarn.is_fed) m_now[index_of(system)].strain = yarn.strain;
    }
    m_wanted = m_now;
}

Status LedParameters::ask(System system, const LiveParameters& wanted) {
    const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
    if (!within(wanted.strain, 1, 2)) return Error{ErrorCode::usage, "must be from 1 to 2", "strain"};
    if (!within(wanted.stiffness, 1e-9, 1e9)) return Error{ErrorCode::usage, "must be from 1e-9 to 1e9", "stiffness"};
    if (!within(wanted.radius, 1e-9, 1e9)) return Error{ErrorCode::usage, "must be from 1e-9 to 1e9", "radius"};
    m_wanted[index_of(system)] = wanted;
    return {};
}

bool LedParameters::approach() {
    const std::array<LiveParameters, 2> before = m_now;
    for (std::size_t k = 0; k < 2; ++k) {
        LiveParameters& now = m_now[k];
        now.strain = strain_towards(now.strain, m_wanted[k].strain);
        now.stiffness = towards(now.stiffness, m_wanted[k].stiffness, stiffness_factor);
        now.radius = towards(now.radius, m_wanted[k].radius, radius_factor);
    }
    return m_now != before;
}

void LedParameters::apply(SimScene& scene) const {
    for (std::size_t y = 0; y < scene.yarns.size(); ++y) {
        const Planned& planned = m_yarns[y];
        const LiveParameters& now = m_now[index_of(planned.system)];
        SimYarn& yarn = scene.yarns[y];
        yarn.stretch_N = planned.stretch_N * now.stiffness;
        yarn.bending_N_mm2 = planned.bending_N_mm2 * now.stiffness;
        yarn.radius_mm = planned.radius_mm * now.radius;
        if (yarn.is_fed) yarn.strain = now.strain;
    }
}

void LedParameters::restore(System system, const LiveParameters& now, const LiveParameters& wanted) {
    m_now[index_of(system)] = now;
    m_wanted[index_of(system)] = wanted;
}

}  // namespace weave::sim
