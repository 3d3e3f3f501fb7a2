#include <weave/sim/newton.hpp>

#include <weave/sim/relax.hpp>
#include <weave/sim/safe_step.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace weave::sim {

namespace {

/// Above this residual the energy is far from what exact second derivatives tell; their convex part leads on
/// better.
constexpr double exact_below = 1;

/// A direction curves down that does so by this share of what the preconditioner holds it for; one is looked for by so
/// many steps.
constexpr double least_curvature = 1e-3;
/// What a fall must be worth, as a share of that against the force that counts as none.
constexpr double worth = 0.01;
constexpr std::size_t most_search = 80;

/// How far along `direction` from a step of which (size², step·M·direction) is known the radius is reached.
double to_border(double size2, double along, double direction2, double radius) {
    const double root = std::sqrt(std::max(0.0, along * along + direction2 * (radius * radius - size2)));
    return (radius * radius - size2) / (along + root);
}

}  // namespace

RadiusStep step_within(const Executor& executor, const BlockMatrix& matrix, Preconditioner& preconditioner,
                       const std::vector<double>& b, double radius, double tolerance,
                       std::size_t most_iterations) {
    RadiusStep result;
    std::vector<double> residual = b, solved, direction, product;
    result.step.assign(b.size(), 0);
    preconditioner.apply(residual, solved);
    direction = solved;
    double work = dot(executor, residual, solved), size2 = 0, along = 0, direction2 = work;
    const double goal = tolerance * tolerance * work;
    const auto move = [&](double share) {
        executor.each(b.size(), [&](std::size_t i) {
            result.step[i] += share * direction[i];
            residual[i] -= share * product[i];
        });
        size2 += share * (2 * along + share * direction2);
    };
    while (result.iterations < most_iterations && work > goal) {
        matrix.multiply(executor, direction, product);
        ++result.iterations;
        const double curvature = dot(executor, direction, product), share = work / curvature;
        result.curves_down = !(curvature > 0);
        if (result.curves_down || size2 + share * (2 * along + share * direction2) >= radius * radius) {
            const double last = to_border(size2, along, direction2, radius);
            result.fall += last * work - last * last * curvature / 2;
            move(last);
            result.at_border = true;
            break;
        }
        result.fall += share * work / 2;
        move(share);
        preconditioner.apply(residual, solved);
        const double next = dot(executor, residual, solved), turn = next / work;
        along = turn * (along + share * direction2);
        direction2 = next + turn * turn * direction2;
        executor.each(b.size(), [&](std::size_t i) { direction[i] = solved[i] + turn * direction[i]; });
        work = next;
    }
    result.size = std::sqrt(size2);
    return result;
}

std::vector<double> downward_direction(const Executor& executor, const BlockMatrix& matrix,
                                       Preconditioner& preconditioner, double least,
                                       std::size_t most_iterations) {
    std::vector<double> residual(3 * matrix.rows()), solved, direction, product;
    std::mt19937 random(1);
    for (double& entry : residual) entry = static_cast<double>(random()) / 0x80000000U - 1;
    preconditioner.apply(residual, solved);
    direction = solved;
    double work = dot(executor, residual, solved), size2 = work;
    for (std::size_t i = 0; i < most_iterations && work > 0; ++i) {
        matrix.multiply(executor, direction, product);
        const double curvature = dot(executor, direction, product);
        if (curvature < -least * size2) return direction;
        if (!(curvature > 0)) break;
        const double share = work / curvature;
        executor.each(residual.size(), [&](std::size_t k) { residual[k] -= share * product[k]; });
        preconditioner.apply(residual, solved);
        const double next = dot(executor, residual, solved), turn = next / work;
        executor.each(residual.size(),
                      [&](std::size_t k) { direction[k] = solved[k] + turn * direction[k]; });
        size2 = next + turn * turn * size2;
        work = next;
    }
    return {};
}

template <class Real>
void Newton<Real>::make_matrix(const std::vector<Real>& state, Curvature curvature) {
    constexpr float damping = 1e-7F;
    m_hessian.assemble(m_energy, state, curvature, m_matrix);
    m_matrix.add_to_pivots(damping);
    m_preconditioner.factor(m_matrix);
}

/// Looks for a direction in which the energy curves downwards: `m_change`, from `m_before`, and how much of it is a little
/// way; 0 if there is none.
template <class Real>
double Newton<Real>::look_down(const std::vector<Real>& state) {
    constexpr double far = 0.05;  // of the least reach
    m_curves_down = false;
    if (m_hessian.rows() == 0) return 0;
    make_matrix(state, Curvature::exact);
    const std::vector<double> down =
        downward_direction(m_energy.executor(), m_matrix, m_preconditioner, least_curvature, most_search);
    m_curves_down = !down.empty();
    if (down.empty()) return 0;
    m_hessian.to_slots(down, m_change);
    const double size = greatest_force(m_energy.executor(), m_change);
    const double share = far * m_energy.fabric().least_reach() / size;
    const double safe = m_energy.safe_share(state, m_change, 2 * share);
    m_before = state;
    return std::min(share, safe / 2);
}

template <class Real>
Bend Newton<Real>::bend(const std::vector<Real>& state, double force) {
    const double share = look_down(state);
    if (!m_curves_down) return Bend::up;
    std::vector<Real> moved = state;
    const double there = go(moved, share), back = go(moved, -share), here = go(moved, 0);
    const double against = worth * force * share * greatest_force(m_energy.executor(), m_change);
    return (there + back) / 2 < here - against && std::max(there, back) < here ? Bend::down : Bend::open;
}

template <class Real>
bool Newton<Real>::leave_saddle(std::vector<Real>& state, double& value, std::vector<Real>& gradient,
                                double force) {
    const double share = look_down(state);
    if (!m_curves_down) return false;
    const double size = greatest_force(m_energy.executor(), m_change);
    double best = 0, lowest = value - worth * force * share * size;
    for (const double way : {share, -share}) {
        const double there = go(state, way);
        if (there < lowest) best = way;
        lowest = std::min(lowest, there);
    }
    value = go(state, best);
    gradient.swap(m_trial);
    return best != 0;
}

template <class Real>
Bend bend_at(Energy<Real>& energy, const std::vector<Real>& state, double force) {
    Hessian<Real> hessian(energy.fabric());
    BlockMatrix matrix;
    Multigrid preconditioner(energy.executor(), rows_of_yarns(energy.fabric()), places_of(energy.fabric()));
    std::vector<Real> gradient;
    energy.evaluate(state, gradient);
    return Newton<Real>(energy, hessian, matrix, preconditioner).bend(state, force);
}

template <class Real>
double Newton<Real>::go(std::vector<Real>& state, double share) {
    m_energy.executor().each(state.size(), [&](std::size_t i) {
        state[i] = m_before[i] + static_cast<Real>(share) * m_change[i];
    });
    m_energy.fabric().follow(state);
    return m_energy.evaluate(state, m_trial);
}

/// How much the energy should fall by a step that was cut.
template <class Real>
double Newton<Real>::fall_of(const SafeStep& safe) {
    m_hessian.to_rows(m_change, m_work);
    std::vector<double> product;
    m_matrix.multiply(m_energy.executor(), m_work, product);
    return -safe.slope - dot(m_energy.executor(), m_work, product) / 2;
}

template <class Real>
bool Newton<Real>::step(std::vector<Real>& state, double& value, std::vector<Real>& gradient,
                        double residual) {
    constexpr std::size_t most_cg = 500;
    constexpr int most_attempts = 10;
    const bool exact = residual < exact_below;
    make_matrix(state, exact ? Curvature::exact : Curvature::convex);
    if (!exact) m_matrix.add_to_pivots(m_damping);
    m_hessian.to_rows(gradient, m_force);
    for (double& force : m_force) force = -force;
    if (m_radius == 0) {
        m_preconditioner.apply(m_force, m_work);
        m_radius = std::sqrt(dot(m_energy.executor(), m_force, m_work));
    }
    m_before = state;
    const double tolerance = std::clamp(std::sqrt(residual), 1e-3, 0.1);
    for (int attempt = 0; attempt < most_attempts; ++attempt) {
        const RadiusStep found = step_within(m_energy.executor(), m_matrix, m_preconditioner, m_force,
                                             exact ? m_radius : 1e150, tolerance, most_cg);
        m_cg_iterations += found.iterations;
        m_hessian.to_slots(found.step, m_change);
        const SafeStep safe = make_safe(m_energy, state, gradient, m_change, 1);
        const double fall = safe.kept < 1 ? fall_of(safe) : found.fall, there = go(state, 1),
                     gain = value - there;
        const double held = fall > 0 ? gain / fall : -1;
        const bool settles =
            std::abs(gain) <= 1e-12 * std::abs(value) &&
            greatest_force(m_energy.executor(), m_trial) < greatest_force(m_energy.executor(), gradient);
        if (exact) {
            if (held > 0.75 && found.at_border)
                m_radius *= 3;
            else if (held < 0.25 && !settles)
                m_radius = std::max(0.25 * held, 0.1) * std::min(1.0, safe.kept) * found.size;
        } else if (held < 0.25) {
            m_matrix.add_to_pivots(7 * m_damping);
            m_damping = std::min(8 * m_damping, 1e3F);
        } else if (held > 0.75 && safe.kept > 0.5) {
            m_damping = std::max(m_damping / 4, 1e-7F);
        }
        if (held > 1e-4 || settles) {
            value = there;
            gradient.swap(m_trial);
            return true;
        }
        state = m_before;
        m_energy.evaluate(state, m_trial);
    }
    return false;
}

template Bend bend_at(Energy<float>&, const std::vector<float>&, double);
template Bend bend_at(Energy<double>&, const std::vector<double>&, double);
template class Newton<float>;
template class Newton<double>;

}  // namespace weave::sim
