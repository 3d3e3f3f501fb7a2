#pragma once

#include <weave/sim/cloth.hpp>
#include <weave/sim/safe_step.hpp>

#include <cmath>
#include <cstddef>

namespace weave::sim {

/// Steps by what the last ones told of the energy (limited-memory BFGS; Nocedal 1980), seen through the
/// preconditioner of a convex matrix that is made anew only now and then. A step costs one evaluation or two
/// instead of a matrix and its solution, and soon knows how softly cloth gives way where the convex matrix is
/// too stiff.
template <class Cloth>
class Descent {
  public:
    /// One step from the cloth's state, whose energy `value`, N·mm, and gradient are given and become those of where it leads.
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD Step step(Cloth& cloth, double& value) {
        cloth.keep_state();
        const Step how = try_step(cloth, value);
        if (how != Step::done) forget(cloth);
        if (how == Step::lacks_room) cloth.back();
        return how;
    }

    /// What was learnt no longer holds: another step came between.
    WEAVE_ANYWHERE WEAVE_HD void forget(Cloth& cloth) {
        cloth.forget_pairs();
        m_steps_of_matrix = steps_later;
    }

  private:
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD Step try_step(Cloth& cloth, double& value) {
        if (m_steps == 0 || m_steps_of_matrix >= (m_steps < first_steps ? steps_at_first : steps_later)) {
            renew(cloth);
            if (cloth.lacks_room()) return Step::lacks_room;
        }
        ++m_steps;
        ++m_steps_of_matrix;
        cloth.find_direction();
        const SafeStep safe = make_safe(cloth, longest);
        if (!(safe.slope < 0)) return Step::none;
        double share = 1;
        for (int cut = 0; cut < most_cuts; ++cut) {
            double there = cloth.go(share);
            if (cloth.lacks_room()) return Step::lacks_room;
            const double slope_there = cloth.dot(cloth.trial, cloth.change), gain = value - there;
            if (!falls(gain, share, safe) && !settles(gain, value, slope_there, safe)) {
                const double lowest = -safe.slope * share * share / (2 * (-gain - safe.slope * share));
                share = clamped(lowest, 0.1 * share, 0.5 * share);
                continue;
            }
            // It still falls there nearly as steeply as here: twice as far, if that is lower.
            if (slope_there < 0.7 * safe.slope && cut == 0 && safe.farthest > 1) {
                go_farther(cloth, lesser(safe.farthest, 2 * share), share, there);
                if (cloth.lacks_room()) return Step::lacks_room;
            }
            cloth.remember(share);
            cloth.accept_trial();
            value = there;
            return Step::done;
        }
        cloth.back();
        value = cloth.evaluate();
        return cloth.lacks_room() ? Step::lacks_room : Step::none;
    }

    WEAVE_ANYWHERE WEAVE_HD void renew(Cloth& cloth) {
        cloth.assemble(Curvature::convex);
        if (cloth.lacks_room()) return;
        cloth.add_to_pivots(damping);
        cloth.factor();
        m_steps_of_matrix = 0;
    }

    WEAVE_HD static bool falls(double gain, double share, const SafeStep& safe) { return gain >= -1e-4 * share * safe.slope; }

    /// The energy changes by no more than its rounding, and the slope says that the step leads towards rest.
    WEAVE_HD static bool settles(double gain, double value, double slope_there, const SafeStep& safe) {
        return std::abs(gain) < Cloth::noise * std::abs(value) && std::abs(slope_there) < std::abs(safe.slope);
    }

    /// Goes to `farther` if that is lower than `there` at `share`, and comes back from it otherwise.
    WEAVE_ANYWHERE WEAVE_HD static void go_farther(Cloth& cloth, double farther, double& share, double& there) {
        const double value_there = cloth.go(farther);
        if (cloth.lacks_room()) return;
        if (value_there < there) {
            there = value_there;
            share = farther;
        } else {
            cloth.go(share);
        }
    }

    /// Steps that a matrix serves: few at the start, where contacts come and go.
    static constexpr std::size_t first_steps = 12, steps_at_first = 3, steps_later = 40;
    /// Share of each pivot that keeps the matrix from being singular: a cloth that floats moves as a whole.
    static constexpr float damping = 1e-5F;
    /// Farther than this many times the step that was asked for none goes.
    static constexpr double longest = 8;
    static constexpr int most_cuts = 10;

    std::size_t m_steps = 0, m_steps_of_matrix = 0;
};

}  // namespace weave::sim
