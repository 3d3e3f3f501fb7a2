#pragma once

#include <weave/sim/energy.hpp>
#include <weave/sim/hessian.hpp>
#include <weave/sim/multigrid.hpp>

#include <cstddef>
#include <deque>
#include <vector>

namespace weave::sim {

/// Steps by what the last ones told of the energy (limited-memory BFGS; Nocedal 1980), seen through the
/// preconditioner of a convex matrix that is made anew only now and then. A step costs one evaluation or two
/// instead of a matrix and its solution, and soon knows how softly cloth gives way where the convex matrix is
/// too stiff.
template <class Real>
class Descent {
  public:
    Descent(Energy<Real>& energy, Hessian<Real>& hessian, BlockMatrix& matrix, Multigrid& preconditioner)
        : m_energy(energy), m_hessian(hessian), m_matrix(matrix), m_preconditioner(preconditioner) {}

    /// One step from `state`, whose energy and gradient are given and become those of where it leads. False
    /// if no step leads down.
    bool step(std::vector<Real>& state, double& value, std::vector<Real>& gradient);

    /// What was learnt no longer holds: another step came between.
    void forget();

  private:
    struct Pair {
        std::vector<double> change, bend;  ///< of places and of the gradient, rows
        double product = 0;
    };

    void renew(const std::vector<Real>& state);
    void find_direction();
    double go(std::vector<Real>& state, double share);
    void remember(double share, const std::vector<Real>& gradient);

    Energy<Real>& m_energy;
    Hessian<Real>& m_hessian;
    BlockMatrix& m_matrix;
    Multigrid& m_preconditioner;
    std::deque<Pair> m_pairs;
    std::vector<double> m_slope, m_direction, m_work;
    std::vector<Real> m_change, m_before, m_trial;
    std::size_t m_steps = 0, m_steps_of_matrix = 0;
};

extern template class Descent<float>;
extern template class Descent<double>;

}  // namespace weave::sim
