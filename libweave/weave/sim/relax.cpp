#include <weave/sim/multigrid.hpp>
#include <weave/sim/relax.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace weave::sim {

namespace {

/// Below this residual the matrix is exact.
constexpr double exact_below = 1;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

std::string_view name_of(Ending ending) {
    constexpr std::string_view names[]{"converged", "stopped", "iterations", "time", "stuck"};
    return names[static_cast<std::size_t>(ending)];
}

template <class Real>
double greatest_force(const Executor& executor, const std::vector<Real>& gradient) {
    return std::sqrt(executor.greatest(gradient.size() / 3, [&](std::size_t slot) {
        return static_cast<double>(load(&gradient[3 * slot]).squaredNorm());
    }));
}

template <class Real>
double reference_force(Energy<Real>& energy, const std::vector<Real>& state) {
    const Fabric<Real>& fabric = energy.fabric();
    double reference = 0;
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        const SimYarn& yarn = fabric.scene().yarns[y];
        const double tension = yarn.is_fed ? yarn.stretch_N * (yarn.strain - 1) : 0;
        const double segment = 2 * yarn.radius_mm;
        reference = std::max({reference, tension, yarn.bending_N_mm2 / (segment * segment), 1e-6 * yarn.stretch_N});
    }
    std::vector<Real> force;
    energy.evaluate(state, force, {.elastic = false, .contact = true});
    std::vector<double> touching;
    for (std::size_t slot = 0; slot < fabric.slots(); ++slot) {
        const auto size = static_cast<double>(load(&force[3 * slot]).norm());
        if (size > 0) touching.push_back(size);
    }
    if (!touching.empty()) {
        const auto middle = touching.begin() + static_cast<std::ptrdiff_t>(touching.size() / 2);
        std::nth_element(touching.begin(), middle, touching.end());
        reference = std::max(reference, *middle);
    }
    return reference;
}

namespace {

/// One relaxation under way.
template <class Real>
class Newton {
  public:
    Newton(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options)
        : m_energy(energy),
          m_state(state),
          m_options(options),
          m_hessian(energy.fabric()),
          m_preconditioner(energy.executor(), strands_of(energy.fabric()), places_of(energy.fabric())) {}

    RelaxResult run() {
        m_value = m_energy.evaluate(m_state, m_gradient);
        m_result.reference_N = reference_force(m_energy, m_state);
        m_value = m_energy.evaluate(m_state, m_gradient);
        while (true) {
            m_result.residual = residual_of(m_gradient);
            // Rest is judged by the forces of this state: those of a crushed start would hide what is left.
            if (m_result.residual <= m_options.residual) measure_anew();
            const Progress progress{m_result.iterations, m_result.residual, m_value, seconds_since(m_start)};
            m_result.history.push_back(progress);
            if (m_options.watch && !m_options.watch(progress)) return ended(Ending::stopped);
            if (m_result.residual <= m_options.residual) return ended(Ending::converged);
            if (m_result.iterations >= m_options.most_iterations) return ended(Ending::iterations);
            if (progress.seconds > m_options.most_seconds) return ended(Ending::time);
            if (!step()) return ended(Ending::stuck);
            ++m_result.iterations;
            if (m_result.iterations % 8 == 0) renew_reference();
        }
    }

  private:
    [[nodiscard]] double residual_of(const std::vector<Real>& gradient) const {
        const double force = greatest_force(m_energy.executor(), gradient);
        return m_result.reference_N > 0 ? force / m_result.reference_N : 0;
    }

    /// The residual with the reference of this very state.
    void measure_anew() {
        if (m_referred != m_result.iterations) renew_reference();
        m_result.residual = residual_of(m_gradient);
    }

    void renew_reference() {
        m_referred = m_result.iterations;
        std::vector<Real> gradient = m_gradient;
        m_result.reference_N = reference_force(m_energy, m_state);
        m_energy.evaluate(m_state, gradient);
    }

    RelaxResult ended(Ending ending) {
        measure_anew();
        m_result.ending = ending;
        m_result.energy = m_value;
        m_result.evaluations = m_energy.evaluations();
        m_result.builds = m_energy.neighbours().builds();
        m_result.seconds = seconds_since(m_start);
        return m_result;
    }

    /// A step by the exact matrix where that is nearly convex, else by its convex part.
    bool step() {
        m_hessian.to_rows(m_gradient, m_force);
        for (double& force : m_force) force = -force;
        m_result.curves_down = false;
        if (m_result.residual < exact_below && m_convex_steps == 0) {
            const bool done = step_with(Curvature::exact);
            // Yarns still have far to go, or lie on a saddle: what is convex leads on faster.
            if (!done || m_was_cut || m_result.curves_down) m_convex_steps = convex_run;
            if (done) return true;
        }
        m_convex_steps -= m_convex_steps > 0 ? 1 : 0;
        return step_with(Curvature::convex);
    }

    /// Damped matrix, step by conjugate gradients, then as much of it as is safe and pays. A direction of negative
    /// curvature tells how much damping the exact matrix lacks.
    bool step_with(Curvature curvature) {
        m_hessian.assemble(m_energy, m_state, curvature, m_matrix);
        double& damping = curvature == Curvature::exact ? m_exact_damping : m_damping;
        m_damped = 0;
        for (int attempt = 0; attempt < 20; ++attempt) {
            if (curvature == Curvature::exact && damping > most_exact_damping) break;
            damp(damping);
            // More damping changes little of what the preconditioner sees.
            if (attempt == 0) m_preconditioner.factor(m_matrix);
            const double tolerance = std::clamp(std::sqrt(m_result.residual), 1e-3, 0.1);
            const CgResult cg = conjugate_gradients(m_energy.executor(), m_matrix, m_preconditioner, m_force, tolerance,
                                                    most_cg, m_change_rows);
            m_result.cg_iterations += cg.iterations;
            if (cg.negative) {
                m_result.curves_down = true;
                damping += std::max(1.5 * lack(cg.negative_direction), damping);
                continue;
            }
            if (make_safe(damping, attempt < most_solves) && accept_step(damping)) return true;
            damping = std::max(8 * damping, 1e-6);
        }
        if (curvature == Curvature::exact) damping = most_exact_damping / 8;
        return false;
    }

    /// Adds `damping` times the mean of each pivot to the diagonal, less what has been added.
    void damp(double damping) {
        if (m_damped == 0) {
            m_scale.resize(m_matrix.rows());
            for (std::size_t row = 0; row < m_matrix.rows(); ++row) {
                const float* pivot = m_matrix.value(m_matrix.diagonal(row));
                m_scale[row] = std::max(1e-12F, (std::abs(pivot[0]) + std::abs(pivot[4]) + std::abs(pivot[8])) / 3);
            }
        }
        for (std::size_t row = 0; row < m_matrix.rows(); ++row) {
            float* pivot = m_matrix.value(m_matrix.diagonal(row));
            const float add = static_cast<float>(damping - m_damped) * m_scale[row];
            for (int k = 0; k < 9; k += 4) pivot[k] += add;
        }
        m_damped = damping;
    }

    /// How far below nothing the matrix curves along a direction, in units of the damping.
    double lack(const std::vector<double>& direction) {
        m_matrix.multiply(m_energy.executor(), direction, m_product);
        double curvature = 0, size = 0;
        for (std::size_t i = 0; i < direction.size(); ++i) {
            curvature += direction[i] * m_product[i];
            size += direction[i] * direction[i] * double(m_scale[i / 3]);
        }
        return size > 0 ? std::max(0.0, -curvature / size) : 0;
    }

    /// Makes a step such that no yarns can pass through one another: as a whole shorter, or shorter only where it must
    /// be, whichever promises more. Yarn hardly stretches, so a step that is cut at places may be worth little: then
    /// more damping, which shortens it evenly, serves better. False if it `may_damp` and asks for that.
    bool make_safe(double& damping, bool may_damp) {
        m_hessian.to_slots(m_change_rows, m_change);
        m_slope = slope_of(m_change_rows);
        m_was_cut = false;
        const double safe = m_energy.safe_share(m_state, m_change, 1);
        if (safe >= 1) return m_slope < 0;
        m_was_cut = safe < 0.5;
        const double wanted = -m_slope / 2, whole = -m_slope * safe * (1 - safe / 2);
        std::vector<Real> cut = m_change;
        m_energy.shorten(m_state, cut);
        std::vector<double> cut_rows;
        m_hessian.to_rows(cut, cut_rows);
        const double slope = slope_of(cut_rows), curvature = curvature_of(cut_rows),
                     share = curvature > 0 ? std::min(1.0, -slope / curvature) : 1,
                     parts = -share * slope - share * share * curvature / 2;
        if (std::max(whole, parts) < least_kept * wanted && damping < most_damping) {
            if (may_damp) return false;
            damping = std::max(4 * damping, 1e-6);
        }
        if (parts > whole) {
            for (Real& change : cut) change *= static_cast<Real>(share);
            for (double& change : cut_rows) change *= share;
            m_slope = share * slope;
            m_change.swap(cut);
            m_change_rows.swap(cut_rows);
        }
        return m_slope < 0;
    }

    [[nodiscard]] double slope_of(const std::vector<double>& change) const {
        double slope = 0;
        for (std::size_t i = 0; i < change.size(); ++i) slope -= m_force[i] * change[i];
        return slope;
    }

    double curvature_of(const std::vector<double>& change) {
        m_matrix.multiply(m_energy.executor(), change, m_product);
        double curvature = 0;
        for (std::size_t i = 0; i < change.size(); ++i) curvature += change[i] * m_product[i];
        return curvature;
    }

    bool accept_step(double& damping) {
        const double most = m_energy.safe_share(m_state, m_change, longest_stretch);
        double share = std::min(1.0, most);
        m_before = m_state;
        for (int halving = 0; halving < 8; ++halving, share /= 2) {
            const double value = try_share(share);
            const double gain = m_value - value, noise = 1e-12 * std::abs(m_value);
            const bool falls = gain >= -1e-4 * share * m_slope;
            const bool settles = std::abs(gain) <= noise && residual_of(m_trial) < m_result.residual;
            if (!falls && !settles) continue;
            const double expected = -share * m_slope * (1 - share / 2);
            if (halving == 0 && gain > 0.5 * expected && !m_was_cut) damping = damping < 1e-8 ? 0 : damping / 4;
            if (halving > 1 || gain < 0.1 * expected) damping = std::max(4 * damping, 1e-6);
            const bool goes_on = falls && halving == 0 && gain > 1.5 * expected;
            take(value);
            if (goes_on) stretch(share, most);
            return true;
        }
        m_state = m_before;
        m_energy.evaluate(m_state, m_trial);
        return false;
    }

    double try_share(double share) {
        m_state = m_before;
        for (std::size_t i = 0; i < m_state.size(); ++i) m_state[i] += static_cast<Real>(share) * m_change[i];
        m_energy.fabric().follow(m_state);
        return m_energy.evaluate(m_state, m_trial);
    }

    void take(double value) {
        m_value = value;
        m_gradient.swap(m_trial);
    }

    /// The energy fell by more than the matrix told, so it curves less along the step: twice as far, while that pays.
    void stretch(double share, double most) {
        std::vector<Real> best = m_state;
        while (share < most) {
            const double longer = std::min(2 * share, most), before = m_value;
            const double value = try_share(longer);
            if (value >= before) break;
            take(value);
            best = m_state;
            if (before - value < -0.1 * (longer - share) * m_slope) break;
            share = longer;
        }
        if (best != m_state) {
            m_state = best;
            m_energy.evaluate(m_state, m_gradient);
        }
    }

    static constexpr double longest_stretch = 64, most_exact_damping = 1;
    static constexpr int convex_run = 4, most_solves = 3;
    static constexpr double least_kept = 0.2, most_damping = 0.1;
    static constexpr std::size_t most_cg = 1500;

    Energy<Real>& m_energy;
    std::vector<Real>& m_state;
    const RelaxOptions& m_options;
    Hessian<Real> m_hessian;
    BlockMatrix m_matrix;
    Multigrid m_preconditioner;
    std::vector<Real> m_gradient, m_trial, m_change, m_before;
    double m_slope = 0;
    std::vector<double> m_force, m_change_rows, m_product;
    std::vector<float> m_scale;
    double m_value = 0, m_damping = 1e-3, m_exact_damping = 0, m_damped = 0;
    int m_convex_steps = 0;
    bool m_was_cut = false;  ///< the step would have gone further than is safe
    std::size_t m_referred = 0;  ///< iteration whose state the reference force is of
    RelaxResult m_result;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace

template <class Real>
RelaxResult relax(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options) {
    return Newton<Real>(energy, state, options).run();
}

template double greatest_force(const Executor&, const std::vector<float>&);
template double greatest_force(const Executor&, const std::vector<double>&);
template double reference_force(Energy<float>&, const std::vector<float>&);
template double reference_force(Energy<double>&, const std::vector<double>&);
template RelaxResult relax(Energy<float>&, std::vector<float>&, const RelaxOptions&);
template RelaxResult relax(Energy<double>&, std::vector<double>&, const RelaxOptions&);

}  // namespace weave::sim
