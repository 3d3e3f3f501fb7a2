#include <weave/sim/host_cloth.hpp>

#include <weave/sim/relax.hpp>

namespace weave::sim {

template <class Real>
HostCloth<Real>::HostCloth(Energy<Real>& energy, Slots& start)
    : state(start),
      m_energy(energy),
      m_hessian(energy.fabric()),
      m_preconditioner(energy.executor(), rows_of_yarns(energy.fabric()), places_of(energy.fabric())) {}

template <class Real>
double HostCloth<Real>::reference_force() {
    return sim::reference_force(m_energy, state);
}

template <class Real>
double HostCloth<Real>::go(double share) {
    m_energy.executor().each(state.size(), [&](std::size_t i) {
        state[i] = before[i] + static_cast<Real>(share) * change[i];
    });
    m_energy.fabric().follow(state);
    return evaluate_trial();
}

template <class Real>
double HostCloth<Real>::greatest_force(const Slots& slots) const {
    return sim::greatest_force(m_energy.executor(), slots);
}

template <class Real>
void HostCloth<Real>::stop_uphill(Slots& slots) const {
    for (std::size_t i = 0; i + 2 < slots.size(); i += 3) {
        if (gradient[i] * slots[i] + gradient[i + 1] * slots[i + 1] + gradient[i + 2] * slots[i + 2] > 0)
            slots[i] = slots[i + 1] = slots[i + 2] = 0;
    }
    m_energy.fabric().follow_change(slots);
}

template <class Real>
void HostCloth<Real>::scale(Slots& slots, double share) const {
    for (Real& part : slots) part *= static_cast<Real>(share);
}

template <class Real>
void HostCloth<Real>::find_direction() {
    m_hessian.to_rows(gradient, m_work);
    m_pairs.find_direction(
        m_energy.executor(), m_work, direction, [this](const Rows& a, const Rows& b) { return dot(a, b); },
        [this](const Rows& of, Rows& result) { m_preconditioner.apply(of, result); });
    change_from(direction);
}

template <class Real>
void HostCloth<Real>::remember(double share) {
    LearnedPairs::Pair pair;
    m_hessian.to_rows(change, pair.change);
    for (double& part : pair.change) part *= share;
    m_hessian.to_rows(trial, pair.bend);
    m_hessian.to_rows(gradient, m_work);
    for (std::size_t i = 0; i < m_work.size(); ++i) pair.bend[i] -= m_work[i];
    m_pairs.remember(std::move(pair), m_work, [this](const Rows& a, const Rows& b) { return dot(a, b); });
}

template <class Real>
void HostCloth<Real>::start_from_gradient() {
    m_hessian.to_rows(gradient, residual);
    for (double& force : residual) force = -force;
    step.assign(residual.size(), 0);
}

template <class Real>
void HostCloth<Real>::start_at_random() {
    residual.resize(3 * m_hessian.rows());
    for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = some_number(i);
    step.assign(residual.size(), 0);
}

template <class Real>
double HostCloth<Real>::precondition() {
    m_preconditioner.apply(residual, solved);
    return dot(residual, solved);
}

template <class Real>
void HostCloth<Real>::turn(double share) {
    if (share == 0) {
        direction = solved;
        return;
    }
    m_energy.executor().each(solved.size(), [&](std::size_t i) { direction[i] = solved[i] + share * direction[i]; });
}

template <class Real>
double HostCloth<Real>::curvature() {
    m_matrix.multiply(m_energy.executor(), direction, product);
    return dot(direction, product);
}

template <class Real>
void HostCloth<Real>::move(double share) {
    m_energy.executor().each(step.size(), [&](std::size_t i) {
        step[i] += share * direction[i];
        residual[i] -= share * product[i];
    });
}

template class HostCloth<float>;
template class HostCloth<double>;

}  // namespace weave::sim
