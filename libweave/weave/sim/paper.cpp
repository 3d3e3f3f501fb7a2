#include <weave/sim/paper.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

namespace weave::sim {

namespace {

constexpr double water_gram_per_mm3 = 1e-3;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// 1/mass of every slot, 0 where nothing moves.
template <class Real>
std::vector<double> inverse_masses(const Fabric<Real>& fabric) {
    std::vector<double> inverse(fabric.slots(), 0);
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        const SimYarn& yarn = fabric.scene().yarns[y];
        const YarnPlace& place = fabric.yarns()[y];
        double length =
            yarn.is_periodic ? (yarn.control.front() + yarn.shift - yarn.control.back()).norm() : 0;
        for (std::size_t i = 0; i + 1 < yarn.control.size(); ++i)
            length += (yarn.control[i + 1] - yarn.control[i]).norm();
        const double per_mm = yarn.gram_per_mm > 0
                                  ? yarn.gram_per_mm
                                  : water_gram_per_mm3 * std::numbers::pi * yarn.radius_mm * yarn.radius_mm;
        const double mass = per_mm * std::max(length, yarn.radius_mm) / place.points;
        for (std::size_t slot = place.first_slot; slot < place.first_slot + place.slots; ++slot)
            inverse[slot] = fabric.moves()[slot] != 0 ? 1 / mass : 0;
    }
    return inverse;
}

/// One relaxation in time.
template <class Real>
class Motion {
  public:
    Motion(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options,
           const PaperOptions& paper)
        : m_energy(energy),
          m_state(state),
          m_options(options),
          m_paper(paper),
          m_inverse_mass(inverse_masses(energy.fabric())),
          m_velocity(state.size(), Real(0)) {}

    RelaxResult run() {
        m_value = evaluate(m_state, m_gradient);
        renew_reference();
        while (true) {
            measure();
            if (m_result.residual <= m_options.residual && m_referred != m_result.iterations) {
                renew_reference();
                measure();
            }
            const Progress progress{m_result.iterations, m_result.residual, m_value, seconds_since(m_start)};
            remember(progress);
            if (m_options.watch && !m_options.watch(progress)) return ended(Ending::stopped);
            if (!std::isfinite(m_result.residual) || !std::isfinite(m_value)) return ended(Ending::stuck);
            if (m_result.residual <= m_options.residual) return ended(Ending::converged);
            if (m_result.iterations >= m_options.most_iterations) return ended(Ending::iterations);
            if (progress.seconds > m_options.most_seconds) return ended(Ending::time);
            advance();
            ++m_result.iterations;
            if (m_result.iterations % between_references == 0) renew_reference();
        }
    }

  private:
    double evaluate(const std::vector<Real>& state, std::vector<Real>& gradient) {
        const double value = m_energy.evaluate(state, gradient);
        if (m_paper.balance == Balance::rest_length) follow_the_paper(state, gradient);
        return value;
    }

    /// With L = l/S held while the force is taken, a segment of uneven speed pulls harder than the energy
    /// says, by EA·S·(mean |y'|²/l² - 1)/2 along its length.
    void follow_the_paper(const std::vector<Real>& state, std::vector<Real>& gradient) {
        const Fabric<Real>& fabric = m_energy.fabric();
        m_more.assign(gradient.size(), Real(0));
        m_energy.executor().each(fabric.yarns().size(), [&](std::size_t y) {
            const YarnPlace& place = fabric.yarns()[y];
            const YarnConstants<Real>& yarn = fabric.constants()[y];
            if (yarn.supply != Supply::tension) return;
            for (std::size_t first = place.first_slot; first < place.first_slot + place.segments; ++first) {
                const Speeds<Real> speeds(fabric.gauss(), &state[3 * first]);
                const Real length = guarded(speeds.length, yarn);
                const Real pull = yarn.evenness_N * (speeds.square / (length * length) - 1) / 2;
                SegmentSum<Real> sum;
                for (std::size_t g = 0; g < gauss_points; ++g)
                    sum.add(fabric.gauss().basis[g].slope,
                            speeds.tangent[g] *
                                (fabric.gauss().weight[g] * pull / guarded(speeds.speed[g], yarn)));
                for (std::size_t k = 0; k < 12; ++k) m_more[3 * first + k] += sum.gradient[k];
            }
        });
        fabric.fold(m_more);
        for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] += m_more[i];
    }

    void measure() {
        m_force = greatest_force(m_energy.executor(), m_gradient);
        m_result.residual = m_result.reference_N > 0 ? m_force / m_result.reference_N : 0;
    }

    void renew_reference() {
        m_referred = m_result.iterations;
        m_result.reference_N = reference_force(m_energy, m_state);
    }

    /// Of many thousand steps those that tell something.
    void remember(const Progress& progress) {
        std::vector<Progress>& history = m_result.history;
        const bool nearer = history.empty() || progress.residual < 0.98 * m_least;
        if (!nearer && progress.iteration % between_references != 0) return;
        m_least = nearer ? progress.residual : m_least;
        history.push_back(progress);
    }

    RelaxResult ended(Ending ending) {
        if (m_referred != m_result.iterations) renew_reference();
        measure();
        m_result.ending = ending;
        m_result.energy = m_value;
        m_result.evaluations = m_energy.evaluations();
        m_result.builds = m_energy.neighbours().builds();
        m_result.seconds = seconds_since(m_start);
        m_result.history.push_back({m_result.iterations, m_result.residual, m_value, m_result.seconds});
        return m_result;
    }

    void advance() {
        const std::size_t since = m_result.iterations - m_measured;
        if (m_limit == 0 || since >= (m_gains ? between_doubts : between_limits) || m_force > 2 * m_force_then)
            measure_limit();
        const double step = m_paper.step * m_caution * m_limit;
        const double kept = std::pow(1 - m_paper.damping, m_paper.step * m_caution);
        m_change.resize(m_state.size());
        m_energy.executor().each(m_inverse_mass.size(), [&](std::size_t slot) {
            for (std::size_t i = 3 * slot; i < 3 * slot + 3; ++i) {
                m_velocity[i] = static_cast<Real>(
                    kept * (double(m_velocity[i]) - step * m_inverse_mass[slot] * double(m_gradient[i])));
                m_change[i] = static_cast<Real>(step * double(m_velocity[i]));
            }
        });
        m_energy.fabric().follow_change(m_change);
        keep_apart(step);
        for (std::size_t i = 0; i < m_state.size(); ++i) m_state[i] += m_change[i];
        m_energy.fabric().follow(m_state);
        m_value = evaluate(m_state, m_gradient);
    }

    /// No pair of samples may come nearer by half its distance. The least distance is looked up again only
    /// when the ways since could have used it up, so that this costs the solver next to nothing once yarns
    /// lie apart.
    void keep_apart(double step) {
        double way = farthest_way();
        if (!is_clear(way)) {
            m_clear = least_distance();
            m_travelled = 0;
        }
        if (!is_clear(way) && m_energy.safe_share(m_state, m_change, 1) < 1) {
            m_energy.shorten(m_state, m_change);
            const double share = m_energy.safe_share(m_state, m_change, 1);
            for (std::size_t i = 0; i < m_change.size(); ++i) {
                m_change[i] *= static_cast<Real>(share);
                m_velocity[i] =
                    m_inverse_mass[i / 3] > 0 ? static_cast<Real>(double(m_change[i]) / step) : Real(0);
            }
            way = farthest_way();
        }
        m_travelled += way;
    }

    [[nodiscard]] bool is_clear(double way) const { return 2 * way <= 0.45 * (m_clear - 2 * m_travelled); }

    [[nodiscard]] double farthest_way() const {
        return std::sqrt(m_energy.executor().greatest(m_inverse_mass.size(), [&](std::size_t slot) {
            return static_cast<double>(load(&m_change[3 * slot]).squaredNorm());
        }));
    }

    /// Of samples that may touch, at most a quarter of the least reach: farther ones are not listed.
    [[nodiscard]] double least_distance() {
        const FabricView<Real> fabric = m_energy.view(m_state);
        const double most = m_energy.fabric().least_reach() / 4;
        return std::sqrt(m_energy.executor().least(
            m_energy.fabric().samples(),
            [&](std::size_t a) {
                double least = most * most;
                for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
                    const std::uint32_t b = fabric.neighbours[e];
                    const Vec<Real> apart(fabric.samples.x[a] - fabric.samples.x[b],
                                          fabric.samples.y[a] - fabric.samples.y[b],
                                          fabric.samples.z[a] - fabric.samples.z[b]);
                    least = std::min(least, static_cast<double>(apart.squaredNorm()));
                }
                return least;
            },
            most * most));
    }

    /// Energy of places and of motion: damped yarns only lose it, so where it grows the step is too long for some place that
    /// the last look did not find.
    [[nodiscard]] double mechanical_energy() const {
        const double size = mass_norm(m_velocity);
        return m_value + size * size / 2;
    }

    /// 2/ω by power iteration on M⁻¹H, from differences of the gradient, going on from the last direction.
    void measure_limit() {
        const double mechanical = mechanical_energy();
        m_gains = m_limit > 0 && mechanical > m_mechanical_then;
        m_mechanical_then = mechanical;
        // Who asks for a step beyond the limit gets it.
        if (m_paper.step <= 1) m_caution = m_gains ? std::max(0.3, 0.8 * m_caution) : std::min(1.0, 1.02 * m_caution);
        const bool anew = m_limit == 0 || m_gains || m_force > 2 * m_force_then;
        if (m_direction.empty()) m_direction.assign(m_state.size(), Real(0));
        double square = 0;
        for (int round = 0; round < (anew ? 40 : 4); ++round) {
            if (round == 0) stir();
            const double size = mass_norm(m_direction),
                         reach = greatest_force(m_energy.executor(), m_direction);
            if (!(size > 0) || !(reach > 0)) break;
            const double little =
                1e-6 * m_energy.fabric().least_reach() / reach;  // farther would meet other contacts
            m_trial = m_state;
            for (std::size_t i = 0; i < m_trial.size(); ++i)
                m_trial[i] += static_cast<Real>(little) * m_direction[i];
            m_energy.fabric().follow(m_trial);
            evaluate(m_trial, m_product);
            for (std::size_t i = 0; i < m_product.size(); ++i)
                m_direction[i] = static_cast<Real>(m_inverse_mass[i / 3] *
                                                   double(m_product[i] - m_gradient[i]) / (little * size));
            square = std::max(square, mass_norm(m_direction));
        }
        m_limit = square > 0 ? 2 / std::sqrt(square) : 1;
        m_measured = m_result.iterations;
        m_force_then = m_force;
    }

    /// A little of every direction, or a part of the cloth that has just become the stiffest would not be
    /// found.
    void stir() {
        const double size = greatest_force(m_energy.executor(), m_direction),
                     little = size > 0 ? 1e-3 * size : 1;
        std::uint32_t number = 12345;
        for (std::size_t i = 0; i < m_direction.size(); ++i) {
            number = number * 1664525U + 1013904223U;
            if (m_inverse_mass[i / 3] > 0)
                m_direction[i] += static_cast<Real>(little * (double(number >> 8) / double(1U << 23) - 1));
        }
    }

    [[nodiscard]] double mass_norm(const std::vector<Real>& direction) const {
        return std::sqrt(m_energy.executor().sum(m_inverse_mass.size(), [&](std::size_t slot) {
            return m_inverse_mass[slot] > 0
                       ? double(load(&direction[3 * slot]).squaredNorm()) / m_inverse_mass[slot]
                       : 0.0;
        }));
    }

    static constexpr std::size_t between_references = 100, between_limits = 50, between_doubts = 10;

    Energy<Real>& m_energy;
    std::vector<Real>& m_state;
    const RelaxOptions& m_options;
    const PaperOptions& m_paper;
    std::vector<double> m_inverse_mass;
    std::vector<Real> m_velocity, m_gradient, m_more, m_change, m_trial, m_product, m_direction;
    double m_value = 0, m_force = 0, m_least = 0;
    double m_limit = 0, m_force_then = 0;  ///< 2/ω in ms, and the greatest force when it was measured
    double m_mechanical_then = 0;
    double m_caution = 1;                  ///< share of the step that is taken, less where the yarns gained energy
    bool m_gains = false;                  ///< the yarns had more energy than at the look before
    double m_clear = 0, m_travelled = 0;   ///< least distance when last looked up, and the ways since, mm
    std::size_t m_referred = 0, m_measured = 0;
    RelaxResult m_result;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace

template <class Real>
RelaxResult relax_in_time(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options,
                          const PaperOptions& paper) {
    return Motion<Real>(energy, state, options, paper).run();
}

template RelaxResult relax_in_time(Energy<float>&, std::vector<float>&, const RelaxOptions&,
                                   const PaperOptions&);
template RelaxResult relax_in_time(Energy<double>&, std::vector<double>&, const RelaxOptions&,
                                   const PaperOptions&);

}  // namespace weave::sim
