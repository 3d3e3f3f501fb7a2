#include <weave/sim/relax.hpp>

#include <weave/sim/host_cloth.hpp>
#include <weave/sim/relaxing.hpp>
#include <weave/sim/spread.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <type_traits>

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

double force_of_yarns(const SimScene& scene) {
    double reference = 0;
    for (const SimYarn& yarn : scene.yarns) {
        const double tension = yarn.is_fed ? yarn.stretch_N * (yarn.strain - 1) : 0;
        const double segment = 2 * yarn.radius_mm;
        reference =
            std::max({reference, tension, yarn.bending_N_mm2 / (segment * segment), 1e-6 * yarn.stretch_N});
    }
    return reference;
}

template <class Real>
double reference_force(Energy<Real>& energy, const std::vector<Real>& state) {
    const Fabric<Real>& fabric = energy.fabric();
    double reference = force_of_yarns(fabric.scene());
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

template <class Real>
double greatest_strain(const Fabric<Real>& fabric, const std::vector<Real>& state) {
    double greatest = 0;
    for (std::size_t y = 0; y < fabric.yarns().size(); ++y) {
        if (fabric.scene().yarns[y].is_fed) continue;
        greatest = std::max(greatest, fabric.length_mm(state, y) / fabric.scene().yarns[y].rest_mm - 1);
    }
    return greatest;
}

namespace {

/// Leads a relaxation on the processor: what is told of it, and what ends it.
template <class Real>
class Relaxation {
  public:
    Relaxation(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options)
        : m_energy(energy), m_options(options), m_cloth(energy, state) {
        m_relaxing.goal = options.residual;
        m_relaxing.leaves_saddles = options.leaves_saddles;
    }

    RelaxResult run() {
        spread_points(m_energy, m_cloth.state);
        m_relaxing.begin(m_cloth, greatest_strain(m_energy.fabric(), m_cloth.state));
        while (true) {
            m_relaxing.judge(m_cloth);
            const Progress progress{m_relaxing.iterations, m_relaxing.residual, m_relaxing.energy, seconds_since(m_start)};
            m_result.history.push_back(progress);
            if (m_options.watch && !m_options.watch(progress)) return ended(Ending::stopped);
            if (m_relaxing.is_at_goal() && m_relaxing.leave_saddle(m_cloth) != Step::done) return ended(Ending::converged);
            if (m_relaxing.iterations >= m_options.most_iterations) return ended(Ending::iterations);
            if (progress.seconds > m_options.most_seconds) return ended(Ending::time);
            if (m_relaxing.step(m_cloth) != Step::done) return ended(Ending::stuck);
        }
    }

  private:
    RelaxResult ended(Ending ending) {
        m_relaxing.finish(m_cloth);
        m_result.ending = ending;
        m_result.residual = m_relaxing.residual;
        m_result.energy = m_relaxing.energy;
        m_result.reference_N = m_relaxing.reference_N;
        m_result.iterations = m_relaxing.iterations;
        m_result.cg_iterations = m_relaxing.cg_iterations();
        if (m_relaxing.is_looked_at) m_result.curves_down = m_relaxing.curves_down;
        m_result.evaluations = m_energy.evaluations();
        m_result.builds = m_energy.neighbours().builds();
        m_result.seconds = seconds_since(m_start);
        return m_result;
    }

    using Cloth = HostCloth<Real>;
    static_assert(!Cloth::lacks_room(), "so what steps answer is looked at only where nothing may lead on");
    static_assert(std::is_trivially_copyable_v<Relaxing<Cloth>>, "so it travels to a device and back");

    Energy<Real>& m_energy;
    const RelaxOptions& m_options;
    Cloth m_cloth;
    Relaxing<Cloth> m_relaxing;
    RelaxResult m_result;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

}  // namespace

template <class Real>
RelaxResult relax(Energy<Real>& energy, std::vector<Real>& state, const RelaxOptions& options) {
    return Relaxation<Real>(energy, state, options).run();
}

template <class Real>
Bend bend_at(Energy<Real>& energy, const std::vector<Real>& state, double force) {
    std::vector<Real> own = state;
    HostCloth<Real> cloth(energy, own);
    cloth.evaluate();
    return Newton<HostCloth<Real>>().bend(cloth, force);
}

template double greatest_force(const Executor&, const std::vector<float>&);
template double greatest_force(const Executor&, const std::vector<double>&);
template double greatest_strain(const Fabric<float>&, const std::vector<float>&);
template double greatest_strain(const Fabric<double>&, const std::vector<double>&);
template double reference_force(Energy<float>&, const std::vector<float>&);
template double reference_force(Energy<double>&, const std::vector<double>&);
template RelaxResult relax(Energy<float>&, std::vector<float>&, const RelaxOptions&);
template RelaxResult relax(Energy<double>&, std::vector<double>&, const RelaxOptions&);
template Bend bend_at(Energy<float>&, const std::vector<float>&, double);
template Bend bend_at(Energy<double>&, const std::vector<double>&, double);

}  // namespace weave::sim
