#include <weave/sim/descent.hpp>

#include <weave/sim/safe_step.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

constexpr std::size_t most_pairs = 16;
/// Steps that a matrix serves: few at the start, where contacts come and go.
constexpr std::size_t first_steps = 12, steps_at_first = 3, steps_later = 40;
/// Share of each pivot that keeps the matrix from being singular: a cloth that floats moves as a whole.
constexpr float damping = 1e-5F;
/// Farther than this many times the step that was asked for none goes.
constexpr double longest = 8;

}  // namespace

template <class Real>
void Descent<Real>::forget() {
    m_pairs.clear();
    m_steps_of_matrix = steps_later;
}

template <class Real>
void Descent<Real>::renew(const std::vector<Real>& state) {
    m_hessian.assemble(m_energy, state, Curvature::convex, m_matrix);
    m_matrix.add_to_pivots(damping);
    m_preconditioner.factor(m_matrix);
    m_steps_of_matrix = 0;
}

/// The two loops over what is remembered, with the preconditioner between them, scaled by the latest pair.
template <class Real>
void Descent<Real>::find_direction() {
    const Executor& executor = m_energy.executor();
    m_work = m_slope;
    std::vector<double> share(m_pairs.size());
    for (std::size_t p = m_pairs.size(); p-- > 0;) {
        const Pair& pair = m_pairs[p];
        share[p] = dot(executor, pair.change, m_work) / pair.product;
        executor.each(m_work.size(), [&](std::size_t i) { m_work[i] -= share[p] * pair.bend[i]; });
    }
    m_preconditioner.apply(m_work, m_direction);
    if (!m_pairs.empty()) {
        const Pair& latest = m_pairs.back();
        m_preconditioner.apply(latest.bend, m_work);
        const double scale = latest.product / dot(executor, latest.bend, m_work);
        executor.each(m_work.size(), [&](std::size_t i) { m_direction[i] *= scale; });
    }
    for (std::size_t p = 0; p < m_pairs.size(); ++p) {
        const Pair& pair = m_pairs[p];
        const double less = share[p] - dot(executor, pair.bend, m_direction) / pair.product;
        executor.each(m_work.size(), [&](std::size_t i) { m_direction[i] += less * pair.change[i]; });
    }
    executor.each(m_work.size(), [&](std::size_t i) { m_direction[i] = -m_direction[i]; });
}

/// Energy at a share of the change; the state goes there and its gradient into m_trial.
template <class Real>
double Descent<Real>::go(std::vector<Real>& state, double share) {
    m_energy.executor().each(state.size(), [&](std::size_t i) {
        state[i] = m_before[i] + static_cast<Real>(share) * m_change[i];
    });
    m_energy.fabric().follow(state);
    return m_energy.evaluate(state, m_trial);
}

/// Keeps a share of the change and how it changed the gradient, unless the energy hardly curves upwards along
/// it.
template <class Real>
void Descent<Real>::remember(double share, const std::vector<Real>& gradient) {
    constexpr double least_bend = 1e-3;
    Pair pair;
    m_hessian.to_rows(m_change, pair.change);
    for (double& part : pair.change) part *= share;
    m_hessian.to_rows(m_trial, pair.bend);
    m_hessian.to_rows(gradient, m_work);
    for (std::size_t i = 0; i < m_work.size(); ++i) pair.bend[i] -= m_work[i];
    const Executor& executor = m_energy.executor();
    pair.product = dot(executor, pair.change, pair.bend);
    if (!(pair.product > least_bend * std::abs(dot(executor, pair.change, m_work)))) return;
    m_pairs.push_back(std::move(pair));
    if (m_pairs.size() > most_pairs) m_pairs.pop_front();
}

template <class Real>
bool Descent<Real>::step(std::vector<Real>& state, double& value, std::vector<Real>& gradient) {
    if (m_steps == 0 || m_steps_of_matrix >= (m_steps < first_steps ? steps_at_first : steps_later))
        renew(state);
    ++m_steps;
    ++m_steps_of_matrix;
    m_hessian.to_rows(gradient, m_slope);
    find_direction();
    m_hessian.to_slots(m_direction, m_change);
    SafeStep safe = make_safe(m_energy, state, gradient, m_change, longest);
    if (!(safe.slope < 0)) {
        forget();
        return false;
    }
    m_before = state;
    double share = 1;
    for (int cut = 0; cut < 10; ++cut) {
        double there = go(state, share);
        const double slope_there = dot(m_energy.executor(), m_trial, m_change), gain = value - there;
        const bool falls = gain >= -1e-4 * share * safe.slope,
                   settles = std::abs(gain) < 1e-12 * std::abs(value) &&
                             std::abs(slope_there) < std::abs(safe.slope);
        if (!falls && !settles) {
            const double lowest = -safe.slope * share * share / (2 * (-gain - safe.slope * share));
            share = std::clamp(lowest, 0.1 * share, 0.5 * share);
            continue;
        }
        // It still falls there nearly as steeply as here: twice as far, if that is lower.
        if (slope_there < 0.7 * safe.slope && cut == 0 && safe.farthest > 1) {
            const std::vector<Real> at = state, kept = m_trial;
            const double farther = std::min(safe.farthest, 2 * share), value_there = go(state, farther);
            if (value_there < there) {
                there = value_there;
                share = farther;
            } else {
                state = at;
                m_energy.evaluate(state, m_trial);
            }
        }
        remember(share, gradient);
        value = there;
        gradient.swap(m_trial);
        return true;
    }
    state = m_before;
    value = m_energy.evaluate(state, gradient);
    forget();
    return false;
}

template class Descent<float>;
template class Descent<double>;

}  // namespace weave::sim
