#include <weave/sim/friction_rounds.hpp>

#include <Eigen/Dense>

#include <algorithm>

namespace weave::sim {

namespace {

constexpr std::size_t most_rounds = 40;
/// A round goes this far below the residual that it began with: to go further would be lost when friction is
/// renewed.
constexpr double round_share = 0.1;
/// Where yarns still lie in one another, what they press with says little: so early rounds are short.
constexpr double first_residual = 0.1;
/// Answers of earlier rounds that are used: with 4 of them `orthogonal` did not come to agree from some starts.
constexpr Eigen::Index most_remembered = 2;
constexpr double longest_step = 1;  ///< times the way of the last round

/// Rounds under way.
class Rounds {
  public:
    Rounds(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options,
           const RelaxOnce& once)
        : m_energy(energy), m_state(state), m_options(options), m_once(once) {}

    FrictionResult run() {
        double goal = std::max(m_options.residual, first_residual);
        while (true) {
            m_energy.renew_friction(m_state, stick_share);
            const double residual = residual_now();
            m_result.agreed = m_result.rounds > 0 && residual <= m_options.residual;
            m_result.last.residual = residual;
            if (m_result.agreed || !may_go_on()) return ended();
            if (m_result.rounds > 0) goal = std::max(m_options.residual / 2, round_share * residual);
            hold_next();
            relax_round(goal);
        }
    }

  private:
    /// Holds the friction of the state for the next round; once rounds have shown how they answer to what is
    /// held, that of a state which by all they have shown comes to rest where it is held (Anderson's method):
    /// rounds may swing to and fro for ever else.
    void hold_next() {
        if (m_result.rounds == 0) {
            m_held = to_vector(m_state);
            return;
        }
        Eigen::VectorXd way = to_vector(m_state) - m_held, step = way;
        if (m_way.size() > 0) remember(way - m_way);
        if (m_answers.cols() > 0) {
            Eigen::ColPivHouseholderQR<Eigen::MatrixXd> known(m_answers);
            known.setThreshold(1e-3);
            const Eigen::VectorXd shares = known.solve(way);
            step -= (m_moves + m_answers) * shares;
            step *= std::min(1.0, longest_step * way.norm() / std::max(1e-300, step.norm()));
        }
        m_way = std::move(way);
        m_move = step;
        m_held += step;
        const std::vector<double> held(m_held.begin(), m_held.end());
        if (m_answers.cols() > 0) m_energy.renew_friction(held, stick_share);
    }

    /// What is held has moved by `m_move`, and where the round comes to rest from there has changed by
    /// `answer`.
    void remember(const Eigen::VectorXd& answer) {
        const Eigen::Index kept = std::min<Eigen::Index>(m_answers.cols(), most_remembered - 1);
        const auto shift = [&](Eigen::MatrixXd& matrix, const Eigen::VectorXd& latest) {
            Eigen::MatrixXd next(latest.size(), kept + 1);
            next << latest, matrix.leftCols(kept);
            matrix = std::move(next);
        };
        if (kept == 0) m_moves.resize(answer.size(), 0), m_answers.resize(answer.size(), 0);
        shift(m_moves, m_move);
        shift(m_answers, answer);
    }

    static Eigen::VectorXd to_vector(const std::vector<double>& state) {
        return Eigen::Map<const Eigen::VectorXd>(state.data(), static_cast<Eigen::Index>(state.size()));
    }

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
    /// State whose friction a round holds, how far from it the last one came to rest, and by how much it
    /// moved since.
    Eigen::VectorXd m_held, m_way, m_move;
    Eigen::MatrixXd m_moves, m_answers;  ///< of earlier rounds, the latest first
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
