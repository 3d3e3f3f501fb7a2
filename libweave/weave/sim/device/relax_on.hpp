#pragma once

#include <weave/sim/device/crew_arrays.hpp>
#include <weave/sim/device/leg.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/spread.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace weave::sim {

/// A relaxation by the crew of a machine, led from the processor: legs of some steps each, between which room is made, whoever
/// watches is told, and time is looked at. Nothing of the cloth is copied but the state, where someone watches.
///
/// A `Machine` has a `Crew`, a `memory()`, and `run(kernel, numbers)`: kernel(crew, numbers) by its crew, each thread with numbers of
/// its own that begin alike; those of one of them come back.
template <class Real, class Machine>
class RelaxingOn {
  public:
    RelaxingOn(Machine& machine, Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options)
        : m_machine(machine), m_state(state), m_options(options), m_arrays(machine.memory(), energy.fabric(), state),
          m_history(machine.memory(), most_steps_of_leg + 2) {
        m_leg.relaxing.goal = options.residual;
        m_leg.relaxing.leaves_saddles = options.leaves_saddles;
        m_leg.most_iterations = options.most_iterations;
        m_leg.strain = greatest_strain(energy.fabric(), state);
    }

    RelaxResult run();

    [[nodiscard]] std::size_t bytes() const { return m_arrays.bytes(); }

  private:
    using Cloth = CrewCloth<Real, typename Machine::Crew>;
    using Phase = typename Leg<Cloth>::Phase;
    static constexpr std::uint32_t most_steps_of_leg = 256;
    /// A leg that someone watches: short enough for 60 pictures a second.
    static constexpr double watched_leg_s = 0.012, unwatched_leg_s = 0.2;

    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    }

    /// Writes down what the leg told, and ends the relaxation where time is up or whoever watches says so.
    void look(double began) {
        const double now = seconds();
        const std::vector<StepRecord> records = m_history.get(m_leg.records);
        for (std::size_t r = 0; r < records.size(); ++r) {
            const double share = static_cast<double>(r + 1) / static_cast<double>(records.size());
            m_result.history.push_back({records[r].iteration, records[r].residual, records[r].energy, began + share * (now - began), {}});
        }
        const bool goes_on = m_leg.phase != Phase::over && m_leg.phase != Phase::finish;
        if (goes_on && now > m_options.most_seconds) m_leg.end(Ending::time);
        if (m_options.watch) {
            m_state = m_arrays.state();
            if (!m_options.watch(m_result.history.back()) && goes_on) m_leg.end(Ending::stopped);
        }
        choose_steps(now - began);
    }

    void choose_steps(double took) {
        const double wanted = m_options.watch ? watched_leg_s : unwatched_leg_s;
        const double steps = m_steps * std::clamp(wanted / std::max(1e-6, took), 0.25, 4.0);
        m_steps = static_cast<std::uint32_t>(std::clamp(steps, 1.0, double(most_steps_of_leg)));
    }

    RelaxResult result() {
        const Relaxing<Cloth>& relaxing = m_leg.relaxing;
        m_result.ending = m_leg.ending;
        m_result.residual = relaxing.residual;
        m_result.energy = relaxing.energy;
        m_result.reference_N = relaxing.reference_N;
        m_result.iterations = relaxing.iterations;
        m_result.cg_iterations = relaxing.cg_iterations();
        if (relaxing.is_looked_at) m_result.curves_down = relaxing.curves_down;
        m_result.evaluations = m_leg.cloth.evaluations;
        m_result.builds = m_leg.cloth.lists.builds;
        m_result.seconds = seconds();
        return m_result;
    }

    Machine& m_machine;
    std::vector<double>& m_state;
    const RelaxOptions& m_options;
    CrewArrays<Real> m_arrays;
    Array<StepRecord> m_history;
    Leg<Cloth> m_leg;
    std::uint32_t m_steps = 4;
    RelaxResult m_result;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
};

// Apart from its class, so that whoever knows it to be compiled elsewhere (relax_cuda.cuh) does not compile its kernels again.
template <class Real, class Machine>
RelaxResult RelaxingOn<Real, Machine>::run() {
    while (m_leg.phase != Phase::over) {
        const double began = seconds();
        m_machine.run(RunLeg<Real>{m_arrays.room(), m_history.view(), m_steps}, m_leg);
        if (m_leg.lacks_room) m_arrays.grow(m_leg.cloth);
        if (m_leg.records > 0) look(began);
    }
    m_state = m_arrays.state();
    return result();
}

/// relax() (relax.hpp) by the crew of a machine, with forces in `Real`. Of the scene device_can_relax() (relax_device.hpp) must hold. Throws std::bad_alloc where the
/// machine's memory does not suffice; the state is then what it was, or one on the way.
template <class Real, class Machine>
RelaxResult relax_on(Machine& machine, Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) {
    spread_points(energy, state);
    return RelaxingOn<Real, Machine>(machine, energy, state, options).run();
}

}  // namespace weave::sim
