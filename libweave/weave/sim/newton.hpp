#pragma once

#include <weave/sim/cloth.hpp>
#include <weave/sim/safe_step.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// A step found by conjugate gradients within a radius (Steihaug 1983), measured in the preconditioner's
/// norm: the cloth's `step`.
struct RadiusStep {
    double fall = 0;  ///< of the quadratic model, N·mm
    double size = 0;  ///< of the step
    bool at_border = false;
    bool curves_down = false;  ///< it met a direction in which the matrix does not curve upwards, and went along it
    std::size_t iterations = 0;
};

/// Where a step of conjugate gradients lies in the preconditioner's norm: its size², step·M·direction and direction².
struct RadiusPlace {
    double size2 = 0, along = 0, direction2 = 0;

    WEAVE_HD void move(double share) { size2 = size2_at(share); }
    /// Size² when the step has gone on by a share of the direction.
    [[nodiscard]] WEAVE_HD double size2_at(double share) const { return size2 + share * (2 * along + share * direction2); }
    /// The next direction: what is left, of `next` in size², and `turn` of the last, along which the step went by `share`.
    WEAVE_HD void turn_to(double next, double turn, double share) {
        along = turn * (along + share * direction2);
        direction2 = next + turn * turn * direction2;
    }
    /// How far along the direction the radius is reached.
    [[nodiscard]] WEAVE_HD double to_border(double radius) const {
        const double root = std::sqrt(greater(0.0, along * along + direction2 * (radius * radius - size2)));
        return (radius * radius - size2) / (along + root);
    }
};

/// Least of ½ x·A·x + gradient·x among the x no farther out than `radius`, until the residual has fallen to
/// `tolerance` in the preconditioner's norm.
WEAVE_ANYWHERE template <class Cloth>
WEAVE_HD RadiusStep step_within(Cloth& cloth, double radius, double tolerance, std::size_t most_iterations) {
    RadiusStep result;
    cloth.start_from_gradient();
    double work = cloth.precondition();
    cloth.turn(0);
    RadiusPlace place{0, 0, work};
    const double goal = tolerance * tolerance * work;
    while (result.iterations < most_iterations && work > goal) {
        const double curvature = cloth.curvature(), share = work / curvature;
        ++result.iterations;
        result.curves_down = !(curvature > 0);
        if (result.curves_down || place.size2_at(share) >= radius * radius) {
            const double last = place.to_border(radius);
            result.fall += last * work - last * last * curvature / 2;
            cloth.move(last);
            place.move(last);
            result.at_border = true;
            break;
        }
        result.fall += share * work / 2;
        cloth.move(share);
        place.move(share);
        const double next = cloth.precondition(), turn = next / work;
        place.turn_to(next, turn, share);
        cloth.turn(turn);
        work = next;
    }
    result.size = std::sqrt(place.size2);
    return result;
}

/// Looks for a direction in which the matrix curves downwards by more than `least` of what the preconditioner holds it
/// for: the cloth's `direction`. False if a search of so many iterations from a random start finds none.
WEAVE_ANYWHERE template <class Cloth>
WEAVE_HD bool downward_direction(Cloth& cloth, double least, std::size_t most_iterations) {
    cloth.start_at_random();
    double work = cloth.precondition(), size2 = work;
    cloth.turn(0);
    for (std::size_t i = 0; i < most_iterations && work > 0; ++i) {
        const double curvature = cloth.curvature();
        if (curvature < -least * size2) return true;
        if (!(curvature > 0)) break;
        cloth.move(work / curvature);
        const double next = cloth.precondition(), turn = next / work;
        cloth.turn(turn);
        size2 = next + turn * turn * size2;
        work = next;
    }
    return false;
}

/// What can be said of a rest that is known to a force.
enum class Bend : std::uint8_t {
    up,    ///< no direction was found in which the energy curves downwards
    open,  ///< one was, but so little that the rest itself, a little farther on, may well curve upwards there
    down,  ///< a saddle: the energy falls to both sides
};

/// Newton steps by the exact second derivatives, or far from rest their convex part, no farther than these
/// have proved to hold.
template <class Cloth>
class Newton {
  public:
    /// One step from the cloth's state, whose energy `value`, N·mm, and gradient are given and become those of where it leads;
    /// `residual` tells how exact it should be.
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD Step step(Cloth& cloth, double& value, double residual) {
        cloth.keep_state();
        const Step how = try_step(cloth, value, residual);
        if (how == Step::lacks_room) cloth.back();
        return how;
    }

    /// Leaves a state of rest that is none but a saddle, where the energy falls to both sides: moves by a
    /// little to the side that is lower. None if no such direction is found, or none that is worth it: the
    /// energy must fall as it would against a hundredth of `force`, N, which is what counts as none (a saddle
    /// is flat, so its fall begins with little).
    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD Step leave_saddle(Cloth& cloth, double& value, double force) {
        cloth.keep_state();
        const Step how = try_to_leave(cloth, value, force);
        if (how == Step::lacks_room) cloth.back();
        return how;
    }

    /// Whether the cloth's state, evaluated, is a saddle; see bend_at(). The state stays what it is; where the cloth then lacks
    /// room the answer is void.
    WEAVE_ANYWHERE WEAVE_HD Bend bend(Cloth& cloth, double force) {
        cloth.keep_state();
        const Bend found = bend_along(cloth, look_down(cloth), force);
        cloth.back();
        return found;
    }

    /// Whether the latest leave_saddle() found a direction in which the energy curves downwards.
    [[nodiscard]] WEAVE_HD bool curves_down() const { return m_curves_down; }
    [[nodiscard]] WEAVE_HD std::size_t cg_iterations() const { return m_cg_iterations; }

  private:
    WEAVE_ANYWHERE WEAVE_HD Step try_to_leave(Cloth& cloth, double& value, double force) {
        const double share = look_down(cloth);
        if (cloth.lacks_room()) return Step::lacks_room;
        if (!m_curves_down) return Step::none;
        double there = 0, back = 0, best = 0;
        double lowest = value - worth * force * share * cloth.greatest_force(cloth.change);
        if (!look_to_both_sides(cloth, share, there, back)) return Step::lacks_room;
        if (there < lowest) best = share;
        lowest = lesser(lowest, there);
        if (back < lowest) best = -share;
        value = cloth.go(best);
        if (cloth.lacks_room()) return Step::lacks_room;
        cloth.accept_trial();
        return best != 0 ? Step::done : Step::none;
    }

    WEAVE_ANYWHERE WEAVE_HD Bend bend_along(Cloth& cloth, double share, double force) const {
        double there = 0, back = 0;
        if (cloth.lacks_room() || !m_curves_down || !look_to_both_sides(cloth, share, there, back)) return Bend::up;
        const double here = cloth.go(0), against = worth * force * share * cloth.greatest_force(cloth.change);
        return (there + back) / 2 < here - against && greater(there, back) < here ? Bend::down : Bend::open;
    }

    /// Energies at a share of the change to either side, N·mm. False if the cloth lacks room.
    WEAVE_ANYWHERE WEAVE_HD static bool look_to_both_sides(Cloth& cloth, double share, double& there, double& back) {
        there = cloth.go(share);
        if (cloth.lacks_room()) return false;
        back = cloth.go(-share);
        return !cloth.lacks_room();
    }

    WEAVE_ANYWHERE WEAVE_CALLED WEAVE_HD Step try_step(Cloth& cloth, double& value, double residual) {
        const bool exact = residual < exact_below;
        make_matrix(cloth, exact ? Curvature::exact : Curvature::convex);
        if (cloth.lacks_room()) return Step::lacks_room;
        if (!exact) cloth.add_to_pivots(m_damping);
        if (m_radius == 0) {
            cloth.start_from_gradient();
            m_radius = std::sqrt(cloth.precondition());
        }
        const double tolerance = clamped(std::sqrt(residual), 1e-3, 0.1);
        for (int attempt = 0; attempt < most_attempts; ++attempt) {
            const RadiusStep found = step_within(cloth, exact ? m_radius : no_radius, tolerance, most_cg);
            m_cg_iterations += found.iterations;
            cloth.change_from(cloth.step);
            const SafeStep safe = make_safe(cloth, 1);
            const double fall = safe.kept < 1 ? fall_of(cloth, safe) : found.fall, there = cloth.go(1);
            if (cloth.lacks_room()) return Step::lacks_room;
            const double gain = value - there, held = fall > 0 ? gain / fall : -1;
            const bool settled = settles(cloth, gain, value);
            learn(cloth, exact, held, settled, found, safe);
            if (held > 1e-4 || settled) {
                value = there;
                cloth.accept_trial();
                return Step::done;
            }
            cloth.back();
            cloth.evaluate_trial();
            if (cloth.lacks_room()) return Step::lacks_room;
        }
        return Step::none;
    }

    /// What the energy did, as a share `held` of what it should, tells how far the next step may go: by the exact matrix
    /// within a radius, by the convex one damped.
    WEAVE_ANYWHERE WEAVE_HD void learn(Cloth& cloth, bool exact, double held, bool settled, const RadiusStep& found,
                                    const SafeStep& safe) {
        if (exact) {
            if (held > 0.75 && found.at_border)
                m_radius *= 3;
            else if (held < 0.25 && !settled)
                m_radius = greater(0.25 * held, 0.1) * lesser(1.0, safe.kept) * found.size;
        } else if (held < 0.25) {
            cloth.add_to_pivots(7 * m_damping);
            m_damping = lesser(8 * m_damping, 1e3F);
        } else if (held > 0.75 && safe.kept > 0.5) {
            m_damping = greater(m_damping / 4, 1e-7F);
        }
    }

    /// The energy changes by no more than its rounding, and the forces say that the step leads towards rest.
    WEAVE_ANYWHERE WEAVE_HD static bool settles(Cloth& cloth, double gain, double value) {
        return std::abs(gain) <= Cloth::noise * std::abs(value) &&
               cloth.greatest_force(cloth.trial) < cloth.greatest_force(cloth.gradient);
    }

    WEAVE_ANYWHERE WEAVE_HD static void make_matrix(Cloth& cloth, Curvature curvature) {
        constexpr float damping = 1e-7F;
        cloth.assemble(curvature);
        if (cloth.lacks_room()) return;
        cloth.add_to_pivots(damping);
        cloth.factor();
    }

    /// How much the energy should fall by a step that was cut, N·mm.
    WEAVE_ANYWHERE WEAVE_HD static double fall_of(Cloth& cloth, const SafeStep& safe) {
        cloth.aim_along_change();
        return -safe.slope - cloth.curvature() / 2;
    }

    /// Looks for a direction in which the energy curves downwards: the cloth's change, and how much of it is a little way;
    /// 0 if there is none.
    WEAVE_ANYWHERE WEAVE_HD double look_down(Cloth& cloth) {
        constexpr double far = 0.05;  // of the least reach
        m_curves_down = false;
        if (cloth.is_empty()) return 0;
        make_matrix(cloth, Curvature::exact);
        if (cloth.lacks_room()) return 0;
        m_curves_down = downward_direction(cloth, least_curvature, most_search);
        if (!m_curves_down) return 0;
        cloth.change_from(cloth.direction);
        const double share = far * cloth.least_reach() / cloth.greatest_force(cloth.change);
        const double safe = cloth.safe_share(cloth.change, 2 * share);
        return lesser(share, safe / 2);
    }

    /// Above this residual the energy is far from what exact second derivatives tell; their convex part leads on
    /// better, however far.
    static constexpr double exact_below = 1, no_radius = 1e150;
    /// A direction curves down that does so by this share of what the preconditioner holds it for; one is looked for by so
    /// many steps.
    static constexpr double least_curvature = 1e-3;
    static constexpr std::size_t most_search = 80;
    /// What a fall must be worth, as a share of that against the force that counts as none.
    static constexpr double worth = 0.01;
    static constexpr std::size_t most_cg = 500;
    static constexpr int most_attempts = 10;

    double m_radius = 0;      ///< of steps by the exact matrix; 0: not known yet
    float m_damping = 1e-3F;  ///< of the convex matrix, as a share of each pivot
    bool m_curves_down = false;
    std::size_t m_cg_iterations = 0;
};

}  // namespace weave::sim
