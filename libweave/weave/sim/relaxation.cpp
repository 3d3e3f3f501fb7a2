#include <weave/sim/friction_rounds.hpp>
#include <weave/sim/relaxation.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

/// How far parameters move at once: tension at most doubles above this strain, radii and stiffness by these factors.
constexpr double strain_step = 0.02, radius_factor = 1.2, stiffness_factor = 4;
/// How far yarns give way between two moves.
constexpr double passing_residual = 0.1;
constexpr std::size_t passing_iterations = 60;

double towards(double now, double wanted, double factor) {
    return std::clamp(wanted, now / factor, now * factor);
}

double strain_towards(double now, double wanted) {
    const double step = std::max(strain_step, now - 1);
    return std::clamp(wanted, now - step, now + step);
}

}  // namespace

Relaxation::Relaxation(const Plan& plan, std::size_t threads) : m_executor(threads), m_plan(plan.scene), m_scene(plan.scene) {
    for (std::size_t y = 0; y < plan.scene.yarns.size(); ++y) {
        m_system.push_back(plan.curves.yarns[plan.curve_of[y]].system);
        if (plan.scene.yarns[y].is_fed) m_now[index_of(m_system[y])].strain = plan.scene.yarns[y].strain;
    }
    m_wanted = m_now;
}

Status Relaxation::set(System system, const LiveParameters& wanted) {
    const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
    if (!within(wanted.strain, 1, 2)) return Error{ErrorCode::usage, "must be from 1 to 2", "strain"};
    if (!within(wanted.stiffness, 1e-9, 1e9)) return Error{ErrorCode::usage, "must be from 1e-9 to 1e9", "stiffness"};
    if (!within(wanted.radius, 1e-9, 1e9)) return Error{ErrorCode::usage, "must be from 1e-9 to 1e9", "radius"};
    m_wanted[index_of(system)] = wanted;
    return {};
}

/// Moves the parameters on; whether any moved.
bool Relaxation::approach() {
    bool moved = false;
    for (std::size_t k = 0; k < 2; ++k) {
        LiveParameters &now = m_now[k], before = now;
        now.strain = strain_towards(now.strain, m_wanted[k].strain);
        now.stiffness = towards(now.stiffness, m_wanted[k].stiffness, stiffness_factor);
        now.radius = towards(now.radius, m_wanted[k].radius, radius_factor);
        moved = moved || now.strain != before.strain || now.stiffness != before.stiffness || now.radius != before.radius;
    }
    return moved;
}

void Relaxation::apply() {
    for (std::size_t y = 0; y < m_scene.yarns.size(); ++y) {
        const LiveParameters& now = m_now[index_of(m_system[y])];
        SimYarn& yarn = m_scene.yarns[y];
        yarn.stretch_N = m_plan.yarns[y].stretch_N * now.stiffness;
        yarn.bending_N_mm2 = m_plan.yarns[y].bending_N_mm2 * now.stiffness;
        yarn.radius_mm = m_plan.yarns[y].radius_mm * now.radius;
        if (yarn.is_fed) yarn.strain = now.strain;
    }
}

RelaxResult Relaxation::relax_now(const RelaxOptions& options) {
    const Fabric<double> fabric(m_scene);
    Energy<double> energy(fabric, m_executor);
    std::vector<double> state = fabric.state();
    const RelaxResult result = relax_with_friction(energy, state, options).last;
    std::vector<std::vector<Vec3>> control = fabric.control(state);
    for (std::size_t y = 0; y < control.size(); ++y) m_scene.yarns[y].control = std::move(control[y]);
    return result;
}

RelaxResult Relaxation::run(const RelaxOptions& options) {
    RelaxOptions passing = options;
    passing.residual = std::max(options.residual, passing_residual);
    passing.most_iterations = passing_iterations;
    passing.leaves_saddles = false;
    while (approach()) {
        apply();
        const RelaxResult passed = relax_now(passing);
        if (passed.ending == Ending::stopped || passed.ending == Ending::time) return passed;
    }
    return relax_now(options);
}

}  // namespace weave::sim
