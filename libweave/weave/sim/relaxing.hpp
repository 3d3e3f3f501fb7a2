#pragma once

#include <weave/sim/cloth.hpp>
#include <weave/sim/descent.hpp>
#include <weave/sim/newton.hpp>

#include <cstddef>
#include <limits>

namespace weave::sim {

/// One relaxation under way, as numbers alone: steps that learn while yarns have far to go, Newton's where the exact matrix
/// leads home. Whoever leads it calls begin(), then judge(), leave_saddle() where it is at its goal, and step() by turns,
/// and finish() at the end. Whatever answers that the cloth lacks room is called again, once there is room and evaluate()
/// was called.
template <class Cloth>
struct Relaxing {
    double goal = 1e-3;  ///< residual
    bool leaves_saddles = true;
    /// Of the cloth's state: greatest force over the reference force, N, and energy, N·mm.
    double residual = 0, reference_N = 0, energy = 0;
    std::size_t iterations = 0;
    /// Whether the rest was looked at by second derivatives, and whether the energy curves downwards in some direction there.
    bool is_looked_at = false, curves_down = false;

    /// Energy and gradient of the cloth's state.
    WEAVE_ANYWHERE WEAVE_HD Step evaluate(Cloth& cloth) {
        energy = cloth.evaluate();
        return cloth.lacks_room() ? Step::lacks_room : Step::done;
    }

    /// The start; `strain`: the greatest of yarns of fixed length, each taken as a whole.
    WEAVE_ANYWHERE WEAVE_HD Step begin(Cloth& cloth, double strain) {
        reference_N = cloth.reference_force();
        if (cloth.lacks_room()) return Step::lacks_room;
        m_gives = strain > strain_of_a_long_start;
        if (m_gives) cloth.give_beyond(give);
        return evaluate(cloth);
    }

    /// How far from rest the state is.
    WEAVE_ANYWHERE WEAVE_HD Step judge(Cloth& cloth) {
        if (renews_reference() && !renew_reference(cloth)) return Step::lacks_room;
        residual = residual_of(cloth);
        if (m_gives && residual <= greater(residual_that_tightens, goal) && !tighten(cloth)) return Step::lacks_room;
        // Rest is judged by the forces of this state: those of a crushed start would hide what is left.
        return !is_at_goal() || measure_anew(cloth) ? Step::done : Step::lacks_room;
    }

    [[nodiscard]] WEAVE_HD bool is_at_goal() const { return residual <= goal; }

    /// Leaves a state at its goal that is none but a saddle; none if it is no saddle, or enough were left.
    WEAVE_ANYWHERE WEAVE_HD Step leave_saddle(Cloth& cloth) {
        if (!leaves_saddles || m_saddles == most_saddles) return Step::none;
        const Step how = m_newton.leave_saddle(cloth, energy, goal * reference_N);
        if (how == Step::none) {
            is_looked_at = true;
            curves_down = m_newton.curves_down();
        } else {
            m_descent.forget(cloth);
        }
        if (how == Step::done) ++m_saddles;
        return how;
    }

    /// One step; none if nothing leads on.
    WEAVE_ANYWHERE WEAVE_HD Step step(Cloth& cloth) {
        const Choice before = m_choice;
        const Step how = step_by_choice(cloth);
        if (how == Step::done) ++iterations;
        if (how == Step::lacks_room) m_choice = before;
        return how;
    }

    /// The last state's residual and energy, whatever ended the relaxation.
    WEAVE_ANYWHERE WEAVE_HD Step finish(Cloth& cloth) {
        if (m_gives && !tighten(cloth)) return Step::lacks_room;
        return measure_anew(cloth) ? Step::done : Step::lacks_room;
    }

    [[nodiscard]] WEAVE_HD std::size_t cg_iterations() const { return m_newton.cg_iterations(); }

  private:
    /// Which steps are made, and what those of either kind were worth.
    struct Choice {
        bool is_by_matrix = false;
        int left = patience;  ///< steps until the next choice
        int runs = 0;         ///< of matrix steps that follow one another
        /// Least residual, energy at the last choice, and how far it fell by the latest steps of either kind.
        double best = 1e300, best_before = 1e300, energy_before = 1e300, gain = 0, matrix_gain = 1e300;
    };

    WEAVE_ANYWHERE WEAVE_HD double residual_of(Cloth& cloth) const {
        const double force = cloth.greatest_force(cloth.gradient);
        return reference_N > 0 ? force / reference_N : 0;
    }

    /// The residual with the reference of this very state. Like those that follow false where the cloth lacks room.
    WEAVE_ANYWHERE WEAVE_HD bool measure_anew(Cloth& cloth) {
        if (m_referred != iterations && !renew_reference(cloth)) return false;
        residual = residual_of(cloth);
        return true;
    }

    /// After 1, 2, 4, 8, 16 steps, and after every 32nd.
    [[nodiscard]] WEAVE_HD bool renews_reference() const {
        return m_referred != iterations && (iterations % 32 == 0 || (iterations & (iterations - 1)) == 0);
    }

    WEAVE_ANYWHERE WEAVE_HD bool renew_reference(Cloth& cloth) {
        const double reference = cloth.reference_force();
        if (cloth.lacks_room()) return false;
        cloth.evaluate_trial();
        if (cloth.lacks_room()) return false;
        reference_N = reference;
        m_referred = iterations;
        return true;
    }

    /// Yarns give way no longer.
    WEAVE_ANYWHERE WEAVE_HD bool tighten(Cloth& cloth) {
        cloth.give_beyond(std::numeric_limits<double>::infinity());
        if (evaluate(cloth) == Step::lacks_room) return false;
        m_descent.forget(cloth);
        m_gives = false;
        return measure_anew(cloth);
    }

    /// Near rest the exact matrix leads home. Farther off it is little worth, cloth being far from a
    /// quadratic form, unless steps that learn make no way: then something is so stiff against the rest that
    /// only the matrix knows it.
    WEAVE_ANYWHERE WEAVE_HD Step step_by_choice(Cloth& cloth) {
        m_choice.best = lesser(m_choice.best, residual);
        if (--m_choice.left <= 0) choose();
        if (m_choice.is_by_matrix || residual < newton_below) {
            m_descent.forget(cloth);
            const Step how = m_newton.step(cloth, energy, residual);
            if (how != Step::none) return how;
            m_choice.left = 0;
        }
        // The second has forgotten what misled the first.
        for (int attempt = 0; attempt < 2; ++attempt) {
            const Step how = m_descent.step(cloth, energy);
            if (how != Step::none) return how;
        }
        return m_newton.step(cloth, energy, residual);
    }

    /// Which steps come next. Where those that learn have not halved the residual some of the matrix are tried, if the last of
    /// them paid as well; as time goes by they are trusted again. They go on for a while where they pay far more.
    WEAVE_HD void choose() {
        Choice& now = m_choice;
        const double gain = now.energy_before - energy;
        if (now.is_by_matrix) {
            now.matrix_gain = gain;
            now.is_by_matrix = gain > 2 * now.gain && ++now.runs < most_runs;
        } else {
            now.gain = gain;
            now.runs = 0;
            now.is_by_matrix = now.best >= 0.5 * now.best_before && now.matrix_gain >= gain;
            now.matrix_gain *= 2;
        }
        now.left = now.is_by_matrix ? newtons_at_once : patience;
        now.energy_before = energy;
        now.best_before = now.best;
    }

    /// A start that lays yarns of fixed length this much too long would be crushed by what draws them in: at first
    /// they draw no harder than a little strain does, until the cloth has given way to that.
    static constexpr double strain_of_a_long_start = 0.25, give = 0.05, residual_that_tightens = 0.1;
    static constexpr double newton_below = 1e-4;
    static constexpr int patience = 50, newtons_at_once = 6, most_runs = 8, most_saddles = 5;

    Choice m_choice;
    bool m_gives = false;
    int m_saddles = 0;
    std::size_t m_referred = 0;  ///< iteration whose state the reference force is of
    Descent<Cloth> m_descent;
    Newton<Cloth> m_newton;
};

}  // namespace weave::sim
