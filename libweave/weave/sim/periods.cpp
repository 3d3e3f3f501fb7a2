#include <weave/sim/periods.hpp>

#include <algorithm>
#include <cmath>

namespace weave::sim {

namespace {

constexpr std::size_t most_rounds = 40;
constexpr double longest_step = 0.05;  ///< share of the period

/// How stiffly yarns along an axis hold the period, N/mm, and how many there are: a start for the secant.
struct Along {
    double stiffness = 0;
    std::size_t yarns = 0;
};

Along along_axis(const SimScene& scene, std::size_t axis) {
    Along along;
    for (const SimYarn& yarn : scene.yarns) {
        if (!yarn.is_periodic || yarn.turns[axis] == 0) continue;
        ++along.yarns;
        along.stiffness += yarn.stretch_N / scene.period_mm[axis];
    }
    return along;
}

/// The search for the periods.
class Search {
  public:
    Search(SimScene& scene, const RimForces& forces, const RelaxOptions& options, double tolerance, const Executor& executor,
           const RelaxOnce& once)
        : m_scene(scene), m_forces(forces), m_options(options), m_tolerance(tolerance), m_executor(executor), m_once(once) {
        for (std::size_t k = 0; k < 2; ++k) {
            m_along[k] = along_axis(scene, k);
            // Crimp gives way far sooner than the yarns stretch.
            m_stiffness[k] = std::max(0.05 * m_along[k].stiffness, 1e-9);
        }
    }

    PeriodsResult run() {
        while (true) {
            relax_here();
            ++m_result.rounds;
            m_result.balanced = is_balanced();
            const Ending ending = m_result.last.ending;
            if (m_result.balanced || ending == Ending::stopped || ending == Ending::time || m_result.rounds >= most_rounds ||
                m_iterations >= m_options.most_iterations)
                return std::move(m_result);
            move_on();
        }
    }

  private:
    void relax_here() {
        const Fabric<double> fabric(m_scene);
        Energy<double> energy(fabric, m_executor);
        std::vector<double> state = fabric.state();
        RelaxOptions options = m_options;
        options.most_iterations -= std::min(options.most_iterations, m_iterations);
        options.most_seconds -= m_seconds;
        if (m_options.watch) {
            options.watch = [&](Progress progress) {
                progress.iteration += m_iterations;
                progress.seconds += m_seconds;
                return m_options.watch(progress);
            };
        }
        m_result.friction = relax_with_friction(energy, state, options, m_once);
        m_result.last = m_result.friction.last;
        m_result.force_N = energy.period_gradient(state);
        m_iterations += m_result.last.iterations;
        m_seconds += m_result.last.seconds;
        m_result.last.iterations = m_iterations;
        m_result.last.seconds = m_seconds;
        std::vector<std::vector<Vec3>> control = fabric.control(state);
        for (std::size_t y = 0; y < control.size(); ++y) m_scene.yarns[y].control = std::move(control[y]);
    }

    [[nodiscard]] double missing(std::size_t k) const { return m_result.force_N[k] - *m_forces[k]; }

    [[nodiscard]] bool is_balanced() const {
        for (std::size_t k = 0; k < 2; ++k) {
            const double allowed = m_tolerance * m_result.last.reference_N * std::max<double>(1, double(m_along[k].yarns));
            if (m_forces[k] && std::abs(missing(k)) > allowed) return false;
        }
        return true;
    }

    /// A secant step along each free axis; an axis whose force did not follow its period keeps its stiffness.
    void move_on() {
        std::array<double, 2> period = m_scene.period_mm;
        for (std::size_t k = 0; k < 2; ++k) {
            if (!m_forces[k]) continue;
            const double moved = m_scene.period_mm[k] - m_before[k], change = missing(k) - m_missing[k];
            if (m_result.rounds > 1 && moved * change > 0)
                m_stiffness[k] = std::clamp(change / moved, m_stiffness[k] / 10, m_stiffness[k] * 10);
            m_before[k] = m_scene.period_mm[k];
            m_missing[k] = missing(k);
            const double most = longest_step * period[k];
            period[k] -= std::clamp(missing(k) / m_stiffness[k], -most, most);
        }
        m_scene = with_periods(std::move(m_scene), period);
    }

    SimScene& m_scene;
    const RimForces& m_forces;
    const RelaxOptions& m_options;
    double m_tolerance;
    const Executor& m_executor;
    const RelaxOnce& m_once;
    std::array<Along, 2> m_along;
    std::array<double, 2> m_stiffness{}, m_before{}, m_missing{};
    std::size_t m_iterations = 0;
    double m_seconds = 0;
    PeriodsResult m_result;
};

}  // namespace

SimScene with_periods(SimScene scene, const std::array<double, 2>& period_mm) {
    std::array<double, 2> factor{1, 1};
    for (std::size_t k = 0; k < 2; ++k) {
        if (scene.is_periodic[k] && scene.period_mm[k] > 0) factor[k] = period_mm[k] / scene.period_mm[k];
    }
    const Vec3 by(factor[0], factor[1], 1);
    for (SimYarn& yarn : scene.yarns) {
        for (Vec3& point : yarn.control) point = point.cwiseProduct(by);
        yarn.shift = yarn.shift.cwiseProduct(by);
    }
    for (std::size_t k = 0; k < 2; ++k) scene.period_mm[k] *= factor[k];
    return scene;
}

PeriodsResult relax_periods(SimScene& scene, const RimForces& forces, const RelaxOptions& options, double tolerance,
                            const Executor& executor, const RelaxOnce& once) {
    SlipStart start{{}, scene.period_mm};
    for (const SimYarn& yarn : scene.yarns) start.control.push_back(yarn.control);
    if (scene.friction > 0 && !scene.slip_from) scene.slip_from = std::move(start);
    PeriodsResult result = Search(scene, forces, options, tolerance, executor, once).run();
    scene.slip_from.reset();
    return result;
}

}  // namespace weave::sim
