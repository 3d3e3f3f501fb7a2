#pragma once

#include <weave/sim/block_matrix.hpp>
#include <weave/sim/cloth.hpp>
#include <weave/sim/energy.hpp>
#include <weave/sim/hessian.hpp>
#include <weave/sim/learned_pairs.hpp>
#include <weave/sim/multigrid.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// The cloth that the steps of a relaxation lead, on the processor's cores. What each operation means: cloth.hpp.
template <class Real>
class HostCloth {
  public:
    using Slots = std::vector<Real>;
    using Rows = std::vector<double>;

    /// `start` becomes the state, where it lies.
    HostCloth(Energy<Real>& energy, Slots& start);

    static constexpr double noise = 1e-12;
    static constexpr bool lacks_room() { return false; }
    [[nodiscard]] bool is_empty() const { return m_hessian.rows() == 0; }
    [[nodiscard]] double least_reach() const { return m_energy.fabric().least_reach(); }

    double reference_force();
    void give_beyond(double strain) { m_energy.give_beyond(strain); }
    double evaluate() { return m_energy.evaluate(state, gradient); }
    double evaluate_trial() { return m_energy.evaluate(state, trial); }
    double go(double share);
    void keep_state() { before = state; }
    void back() { state = before; }
    void accept_trial() { gradient.swap(trial); }

    template <class Number>
    [[nodiscard]] double dot(const std::vector<Number>& a, const std::vector<Number>& b) const {
        return m_energy.executor().sum(
            a.size(), [&](std::size_t i) { return static_cast<double>(a[i]) * static_cast<double>(b[i]); });
    }
    [[nodiscard]] double greatest_force(const Slots& slots) const;
    double safe_share(const Slots& slots, double most) { return m_energy.safe_share(state, slots, most); }
    void shorten(Slots& slots) { m_energy.shorten(state, slots); }
    void stop_uphill(Slots& slots) const;
    void scale(Slots& slots, double share) const;
    void cut_from_change() { cut = change; }
    void accept_cut() { change.swap(cut); }

    void assemble(Curvature curvature) { m_hessian.assemble(m_energy, state, curvature, m_matrix); }
    void add_to_pivots(float share) { m_matrix.add_to_pivots(share); }
    void factor() { m_preconditioner.factor(m_matrix); }

    void find_direction();
    void remember(double share);
    void forget_pairs() { m_pairs.forget(); }

    void start_from_gradient();
    void start_at_random();
    double precondition();
    void turn(double share);
    double curvature();
    void move(double share);
    void change_from(const Rows& rows) { m_hessian.to_slots(rows, change); }
    void aim_along_change() { m_hessian.to_rows(change, direction); }

    Slots& state;
    Slots gradient, trial, before, change, cut;
    Rows residual, solved, direction, step, product;

  private:
    Energy<Real>& m_energy;
    Hessian<Real> m_hessian;
    BlockMatrix m_matrix;
    Multigrid m_preconditioner;
    LearnedPairs m_pairs;
    Rows m_work;
};

extern template class HostCloth<float>;
extern template class HostCloth<double>;

}  // namespace weave::sim
