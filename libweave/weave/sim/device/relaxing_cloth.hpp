#pragma once

#include <weave/sim/device/crew_arrays.hpp>
#include <weave/sim/device/leg.hpp>
#include <weave/sim/relax.hpp>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// A relaxation by a crew, seen from the processor: legs of some steps each, between which room is made, whoever watches is told, and time
/// is looked at. Nothing of the cloth is copied but its state: at the end, and for whoever watches after each leg, which is then as long as a
/// picture lasts.
template <class Real, class Crew>
class RelaxingCloth {
  public:
    using OwnLeg = Leg<CrewCloth<Real, Crew>>;

    /// `energy`, `state` and `options` must stay. Throws std::bad_alloc where the memory does not suffice.
    RelaxingCloth(Memory& memory, Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options)
        : m_state(state), m_options(options), m_arrays(memory, energy, state), m_history(memory, most_steps_of_leg + 2),
          m_items(energy.fabric().samples()) {
        m_leg.relaxing.goal = options.residual;
        m_leg.relaxing.leaves_saddles = options.leaves_saddles;
        m_leg.most_iterations = options.most_iterations;
        m_leg.strain = greatest_strain(energy.fabric(), state);
    }

    [[nodiscard]] bool is_over() const { return m_leg.phase == Phase::over; }
    /// What its crew mostly works on: contact samples.
    [[nodiscard]] std::size_t items() const { return m_items; }
    [[nodiscard]] std::size_t bytes() const { return m_arrays.bytes() + m_history.bytes(); }

    /// The next leg is kernel() with leg().
    void begin_leg() { m_began = seconds(); }
    [[nodiscard]] RunLeg<Real> kernel() const { return {m_arrays.room(), m_history.view(), m_steps}; }
    OwnLeg& leg() { return m_leg; }
    /// Throws std::bad_alloc where there is no room for what the leg lacked.
    void end_leg() {
        if (m_leg.lacks_room) m_arrays.grow(m_leg.cloth);
        if (m_leg.records > 0) look();
        if (!is_over()) return;
        m_state = m_arrays.state();
        m_result.seconds = seconds();
    }

    /// Once it is over.
    [[nodiscard]] RelaxResult result() {
        const Relaxing<CrewCloth<Real, Crew>>& relaxing = m_leg.relaxing;
        m_result.ending = m_leg.ending;
        m_result.residual = relaxing.residual;
        m_result.energy = relaxing.energy;
        m_result.reference_N = relaxing.reference_N;
        m_result.iterations = relaxing.iterations;
        m_result.cg_iterations = relaxing.cg_iterations();
        if (relaxing.is_looked_at) m_result.curves_down = relaxing.curves_down;
        m_result.evaluations = m_leg.cloth.evaluations;
        m_result.builds = m_leg.cloth.lists.builds;
        return m_result;
    }

  private:
    using Phase = typename OwnLeg::Phase;
    static constexpr std::uint32_t most_steps_of_leg = 256;
    /// A leg that someone watches: short enough for 60 pictures a second.
    static constexpr double watched_leg_s = 0.012, unwatched_leg_s = 0.2;

    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - m_start).count();
    }

    /// Writes down what the leg told, and ends the relaxation where time is up or whoever watches says so.
    void look() {
        const double now = seconds();
        const std::vector<StepRecord> records = m_history.get(m_leg.records);
        for (std::size_t r = 0; r < records.size(); ++r) {
            const double share = static_cast<double>(r + 1) / static_cast<double>(records.size());
            m_result.history.push_back({records[r].iteration, records[r].residual, records[r].energy, m_began + share * (now - m_began), {}});
        }
        const bool goes_on = m_leg.phase != Phase::over && m_leg.phase != Phase::finish;
        if (goes_on && now > m_options.most_seconds) m_leg.end(Ending::time);
        if (m_options.watch) {
            m_state = m_arrays.state();
            if (!m_options.watch(m_result.history.back()) && goes_on) m_leg.end(Ending::stopped);
        }
        choose_steps(now - m_began);
    }

    void choose_steps(double took) {
        const double wanted = m_options.watch ? watched_leg_s : unwatched_leg_s;
        const double steps = m_steps * std::clamp(wanted / std::max(1e-6, took), 0.25, 4.0);
        m_steps = static_cast<std::uint32_t>(std::clamp(steps, 1.0, double(most_steps_of_leg)));
    }

    std::vector<double>& m_state;
    const RelaxOptions& m_options;
    CrewArrays<Real> m_arrays;
    Array<StepRecord> m_history;
    std::size_t m_items;
    OwnLeg m_leg;
    std::uint32_t m_steps = 4;
    RelaxResult m_result;
    std::chrono::steady_clock::time_point m_start = std::chrono::steady_clock::now();
    double m_began = 0;
};

}  // namespace weave::sim
