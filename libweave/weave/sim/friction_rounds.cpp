#include <weave/sim/friction_rounds.hpp>

#include <algorithm>

namespace weave::sim {

namespace {

constexpr std::size_t most_rounds = 40;
/// A round goes this far below the residual that it began with: to go further would be lost when friction is
/// renewed.
constexpr double round_share = 0.1;
/// Where yarns still lie in one another, what they press with says little: so early rounds are short.
constexpr double first_residual = 0.1;

/// Rounds under way.
class Rounds {
  public:
    Rounds(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options,
           const RelaxOnce& once)
        : m_energy(energy), m_state(state), m_options(options), m_once(once) {}

    FrictionResult run() {
        double goal = std::max(m_options.residual, first_residual);
        while (true) {
            renew();
            const double residual = residual_now();
            m_result.agreed = m_result.rounds > 0 && residual <= m_options.residual;
            m_result.last.residual = residual;
            if (m_result.agreed || !may_go_on()) return ended();
            if (m_result.rounds > 0) goal = std::max(m_options.residual / 2, round_share * residual);
            relax_round(goal);
        }
    }

  private:
    void renew() { m_energy.renew_friction(m_state, stick_share); }

    double residual_now() {
        const double reference = reference_force(m_energy, m_state);
        std::vector<double> gradient;
        m_value = m_energy.evaluate(m_state, gradient);
        m_result.last.reference_N = reference;
        return reference > 0 ? greatest_force(m_energy.executor(), gradient) / reference : 0;
    }

    [[nodiscard]] bool may_go_on() {
        RelaxResult& last = m_result.last;
        if (m_result.rounds == 0) return true;
        if (last.ending == Ending::stopped || last.ending == Ending::time) return false;
        if (last.iterations < m_options.most_iterations && m_result.rounds < most_rounds) return true;
        last.ending = Ending::iterations;
        return false;
    }

    void relax_round(double goal) {
        const RelaxResult before = m_result.last;
        RelaxOptions options = m_options;
        options.residual = goal;
        options.most_iterations = m_options.most_iterations - before.iterations;
        options.most_seconds = m_options.most_seconds - before.seconds;
        if (m_options.watch) {
            options.watch = [&](Progress progress) {
                progress.iteration += before.iterations;
                progress.seconds += before.seconds;
                return m_options.watch(progress);
            };
        }
        m_result.last = joined(before, m_once(m_energy, m_state, options));
        ++m_result.rounds;
    }

    static RelaxResult joined(const RelaxResult& before, RelaxResult after) {
        std::vector<Progress> history = before.history;
        for (Progress progress : after.history) {
            progress.iteration += before.iterations;
            progress.seconds += before.seconds;
            history.push_back(progress);
        }
        after.history = std::move(history);
        after.iterations += before.iterations;
        after.cg_iterations += before.cg_iterations;
        after.seconds += before.seconds;
        return after;
    }

    FrictionResult ended() {
        RelaxResult& last = m_result.last;
        if (m_result.agreed) last.ending = Ending::converged;
        last.energy = m_value;
        last.evaluations = m_energy.evaluations();
        m_result.slip = m_energy.friction().summary(m_energy.view(m_state));
        return std::move(m_result);
    }

    Energy<double>& m_energy;
    std::vector<double>& m_state;
    const RelaxOptions& m_options;
    const RelaxOnce& m_once;
    double m_value = 0;
    FrictionResult m_result;
};

}  // namespace

FrictionResult relax_with_friction(Energy<double>& energy, std::vector<double>& state,
                                   const RelaxOptions& options, const RelaxOnce& once) {
    if (energy.fabric().scene().friction > 0) return Rounds(energy, state, options, once).run();
    FrictionResult result;
    result.last = once(energy, state, options);
    return result;
}

}  // namespace weave::sim
