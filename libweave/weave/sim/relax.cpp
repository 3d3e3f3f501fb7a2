#include <weave/sim/relax.hpp>

#include <weave/sim/descent.hpp>
#include <weave/sim/multigrid.hpp>
#include <weave/sim/newton.hpp>
#include <weave/sim/spread.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace weave::sim {

namespace {

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
        reference =
            std::max({reference, tension, yarn.bending_N_mm2 / (segment * segment), 1e-6 * yarn.stretch_N});
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

/// Greatest strain of yarns of fixed length, each taken as a whole.
template <class Real>
double greatest_strain(const Fabric<Real>& fabric, const std::vector<Real>& state) {
    double greatest = 0;
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        if (fabric.scene().yarns[y].is_fed) continue;
        greatest = std::max(greatest, fabric.length_mm(state, y) / fabric.scene().yarns[y].rest_mm - 1);
    }
    return greatest;
}

/// One relaxation under way: steps that learn while yarns have far to go, Newton's where the exact matrix
/// leads home.
template <class Real>
class Relaxing {
  public:
    Relaxing(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options)
        : m_energy(energy),
          m_state(state),
          m_options(options),
          m_hessian(energy.fabric()),
          m_preconditioner(energy.executor(), rows_of_yarns(energy.fabric()), places_of(energy.fabric())),
          m_descent(energy, m_hessian, m_matrix, m_preconditioner),
          m_newton(energy, m_hessian, m_matrix, m_preconditioner) {}

    RelaxResult run() {
        m_value = m_energy.evaluate(m_state, m_gradient);
        if (spread_points(m_energy, m_state)) m_energy.evaluate(m_state, m_gradient);
        m_result.reference_N = reference_force(m_energy, m_state);
        m_gives = greatest_strain(m_energy.fabric(), m_state) > strain_of_a_long_start;
        if (m_gives) m_energy.give_beyond(give);
        m_value = m_energy.evaluate(m_state, m_gradient);
        while (true) {
            m_result.residual = residual_of(m_gradient);
            if (m_gives && m_result.residual <= std::max(residual_that_tightens, m_options.residual)) tighten();
            // Rest is judged by the forces of this state: those of a crushed start would hide what is left.
            if (m_result.residual <= m_options.residual) measure_anew();
            const Progress progress{m_result.iterations, m_result.residual, m_value, seconds_since(m_start)};
            m_result.history.push_back(progress);
            if (m_options.watch && !m_options.watch(progress)) return ended(Ending::stopped);
            if (m_result.residual <= m_options.residual && !leaves_saddle()) return ended(Ending::converged);
            if (m_result.iterations >= m_options.most_iterations) return ended(Ending::iterations);
            if (progress.seconds > m_options.most_seconds) return ended(Ending::time);
            if (!step()) return ended(Ending::stuck);
            ++m_result.iterations;
            if (m_result.iterations % 32 == 0 || (m_result.iterations & (m_result.iterations - 1)) == 0)
                renew_reference();
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

    /// Yarns give way no longer.
    void tighten() {
        m_gives = false;
        m_energy.give_beyond(std::numeric_limits<double>::infinity());
        m_value = m_energy.evaluate(m_state, m_gradient);
        m_descent.forget();
        measure_anew();
    }

    RelaxResult ended(Ending ending) {
        if (m_gives) tighten();
        measure_anew();
        m_result.ending = ending;
        m_result.energy = m_value;
        m_result.cg_iterations = m_newton.cg_iterations();
        m_result.evaluations = m_energy.evaluations();
        m_result.builds = m_energy.neighbours().builds();
        m_result.seconds = seconds_since(m_start);
        return m_result;
    }

    bool leaves_saddle() {
        constexpr int most_saddles = 5;
        if (!m_options.leaves_saddles || m_saddles == most_saddles) return false;
        const bool leaves = m_newton.leave_saddle(m_state, m_value, m_gradient, m_options.residual * m_result.reference_N);
        if (!leaves) {
            m_result.curves_down = m_newton.curves_down();
            return false;
        }
        ++m_saddles;
        m_descent.forget();
        return true;
    }

    /// Near rest the exact matrix leads home. Farther off it is little worth, cloth being far from a
    /// quadratic form, unless steps that learn make no way: then something is so stiff against the rest that
    /// only the matrix knows it.
    bool step() {
        m_best = std::min(m_best, m_result.residual);
        if (--m_left <= 0) choose();
        if (m_by_matrix || m_result.residual < newton_below) {
            m_descent.forget();
            if (m_newton.step(m_state, m_value, m_gradient, m_result.residual)) return true;
            m_left = 0;
        }
        // The second has forgotten what misled the first.
        if (m_descent.step(m_state, m_value, m_gradient) || m_descent.step(m_state, m_value, m_gradient))
            return true;
        return m_newton.step(m_state, m_value, m_gradient, m_result.residual);
    }

    /// Which steps come next. Where those that learn have not halved the residual some of the matrix are tried, if the last of
    /// them paid as well; as time goes by they are trusted again. They go on for a while where they pay far more.
    void choose() {
        const double gain = m_value_before - m_value;
        if (m_by_matrix) {
            m_matrix_gain = gain;
            m_by_matrix = gain > 2 * m_gain && ++m_runs < most_runs;
        } else {
            m_gain = gain;
            m_runs = 0;
            m_by_matrix = m_best >= 0.5 * m_best_before && m_matrix_gain >= gain;
            m_matrix_gain *= 2;
        }
        m_left = m_by_matrix ? newtons_at_once : patience;
        m_value_before = m_value;
        m_best_before = m_best;
    }

    /// A start that lays yarns of fixed length this much too long would be crushed by what draws them in: at first
    /// they draw no harder than a little strain does, until the cloth has given way to that.
    static constexpr double strain_of_a_long_start = 0.25, give = 0.05, residual_that_tightens = 0.1;
    static constexpr double newton_below = 1e-4;
    static constexpr int patience = 50, newtons_at_once = 6, most_runs = 8;

    Energy<Real>& m_energy;
    std::vector<Real>& m_state;
    const RelaxOptions& m_options;
    Hessian<Real> m_hessian;
    BlockMatrix m_matrix;
    Multigrid m_preconditioner;
    Descent<Real> m_descent;
    Newton<Real> m_newton;
    std::vector<Real> m_gradient;
    double m_value = 0;
    bool m_gives = false, m_by_matrix = false;
    int m_left = patience, m_saddles = 0;  ///< steps until the next choice
    /// Least residual, energy at the last choice, and how far it fell by the latest steps of either kind.
    double m_best = 1e300, m_best_before = 1e300, m_value_before = 1e300, m_gain = 0, m_matrix_gain = 1e300;
    int m_runs = 0;
    std::size_t m_referred = 0;  ///< iteration whose state the reference force is of
    RelaxResult m_result;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace

template <class Real>
RelaxResult relax(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options) {
    return Relaxing<Real>(energy, state, options).run();
}

template double greatest_force(const Executor&, const std::vector<float>&);
template double greatest_force(const Executor&, const std::vector<double>&);
template double reference_force(Energy<float>&, const std::vector<float>&);
template double reference_force(Energy<double>&, const std::vector<double>&);
template RelaxResult relax(Energy<float>&, std::vector<float>&, const RelaxOptions&);
template RelaxResult relax(Energy<double>&, std::vector<double>&, const RelaxOptions&);

}  // namespace weave::sim
