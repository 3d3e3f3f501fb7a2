#pragma once

#include <weave/sim/energy.hpp>
#include <weave/sim/hessian.hpp>
#include <weave/sim/multigrid.hpp>
#include <weave/sim/safe_step.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// A step found by conjugate gradients within a radius (Steihaug 1983), measured in the preconditioner's
/// norm.
struct RadiusStep {
    std::vector<double> step;
    double fall = 0;  ///< of the quadratic model
    double size = 0;  ///< of the step
    bool at_border = false;
    bool curves_down =
        false;  ///< it met a direction in which the matrix does not curve upwards, and went along it
    std::size_t iterations = 0;
};

/// Least of ½ x·A·x − b·x among the x no farther out than `radius`, until the residual has fallen to
/// `tolerance` in the preconditioner's norm.
RadiusStep step_within(const Executor& executor, const BlockMatrix& matrix, Preconditioner& preconditioner,
                       const std::vector<double>& b, double radius, double tolerance,
                       std::size_t most_iterations);

/// A direction in which the matrix curves downwards by more than `least` of what the preconditioner holds it
/// for; empty if a search of so many iterations from a random start finds none.
std::vector<double> downward_direction(const Executor& executor, const BlockMatrix& matrix,
                                       Preconditioner& preconditioner, double least,
                                       std::size_t most_iterations);

/// What can be said of a rest that is known to a force.
enum class Bend : std::uint8_t {
    up,    ///< no direction was found in which the energy curves downwards
    open,  ///< one was, but so little that the rest itself, a little farther on, may well curve upwards there
    down,  ///< a saddle: the energy falls to both sides
};

/// Whether a state of rest is a saddle, as a search of 80 conjugate gradient steps with the exact second derivatives finds
/// it. The curvature at a state is not that of the rest it is near: a saddle is claimed only where the energy falls to both
/// sides, on the mean (to which the gradient gives nothing) by more than against a hundredth of `force`, N, which is what
/// counts as none.
template <class Real>
Bend bend_at(Energy<Real>& energy, const std::vector<Real>& state, double force);

/// Newton steps by the exact second derivatives, or far from rest their convex part, no farther than these
/// have proved to hold.
template <class Real>
class Newton {
  public:
    Newton(Energy<Real>& energy, Hessian<Real>& hessian, BlockMatrix& matrix, Multigrid& preconditioner)
        : m_energy(energy), m_hessian(hessian), m_matrix(matrix), m_preconditioner(preconditioner) {}

    /// One step from `state`, whose energy and gradient are given and become those of where it leads;
    /// `residual` tells how exact it should be. False if no step leads down.
    bool step(std::vector<Real>& state, double& value, std::vector<Real>& gradient, double residual);

    /// Leaves a state of rest that is none but a saddle, where the energy falls to both sides: moves by a
    /// little to the side that is lower. False if no such direction is found, or none that is worth it: the
    /// energy must fall as it would against a hundredth of `force`, N, which is what counts as none (a saddle
    /// is flat, so its fall begins with little).
    bool leave_saddle(std::vector<Real>& state, double& value, std::vector<Real>& gradient, double force);

    /// Whether a state is a saddle; see bend_at().
    Bend bend(const std::vector<Real>& state, double force);

    /// Whether the latest leave_saddle() found a direction in which the energy curves downwards.
    [[nodiscard]] bool curves_down() const { return m_curves_down; }
    [[nodiscard]] std::size_t cg_iterations() const { return m_cg_iterations; }

  private:
    double look_down(const std::vector<Real>& state);
    void make_matrix(const std::vector<Real>& state, Curvature curvature);
    double fall_of(const SafeStep& safe);
    double go(std::vector<Real>& state, double share);

    Energy<Real>& m_energy;
    Hessian<Real>& m_hessian;
    BlockMatrix& m_matrix;
    Multigrid& m_preconditioner;
    double m_radius = 0;      ///< of steps by the exact matrix; 0: not known yet
    float m_damping = 1e-3F;  ///< of the convex matrix, as a share of each pivot
    bool m_curves_down = false;
    std::size_t m_cg_iterations = 0;
    std::vector<double> m_force, m_work;
    std::vector<Real> m_change, m_before, m_trial;
};

extern template class Newton<float>;
extern template class Newton<double>;

}  // namespace weave::sim
