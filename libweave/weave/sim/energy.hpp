#pragma once

#include <weave/sim/approach.hpp>
#include <weave/sim/execute.hpp>
#include <weave/sim/fabric.hpp>
#include <weave/sim/fields.hpp>
#include <weave/sim/friction.hpp>
#include <weave/sim/neighbours.hpp>
#include <weave/sim/transition.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace weave::sim {

/// Energy of the yarns and its gradient: stretch, bending and contact, and the fields and held friction that the scene has.
template <class Real>
class Energy {
  public:
    Energy(const Fabric<Real>& fabric, const Executor& executor);

    /// Energy in N·mm; `gradient` is resized to the state and holds ∂E/∂q, zero at slots that do not move.
    double evaluate(const std::vector<Real>& state, std::vector<Real>& gradient, Terms terms = {});

    /// ∂E/∂P of the periods in x and y at fixed control points, N: what the piece pulls its rims together
    /// with. At rest it is the derivative of the relaxed energy. 0 where a direction is not periodic.
    std::array<double, 2> period_gradient(const std::vector<Real>& state);

    /// The samples and their neighbours as the latest evaluation left them.
    [[nodiscard]] Neighbours<Real>& neighbours() { return m_neighbours; }
    /// See Neighbours::first_weights(); those of this state where there were none. Who else computes the same energy needs them.
    const std::vector<Real>& first_weights(const std::vector<Real>& state);
    [[nodiscard]] FabricView<Real> view(const std::vector<Real>& state);
    [[nodiscard]] const Transition<Real>& transition() const { return m_transition; }
    [[nodiscard]] const Friction<Real>& friction() const { return m_friction; }
    /// Holds the friction of the pairs that touch in a state (friction.hpp), where the scene has friction; `stick`: the
    /// transition length over the mean radius of two yarns. Until then there is none.
    void renew_friction(const std::vector<Real>& state, double stick);
    /// Yarns of fixed length give way where they are strained beyond `strain` (StretchLaw); infinite at first: nowhere.
    void give_beyond(double strain) { m_give = strain; }
    [[nodiscard]] const Fabric<Real>& fabric() const { return m_fabric; }
    [[nodiscard]] const Executor& executor() const { return m_executor; }
    [[nodiscard]] std::size_t evaluations() const { return m_evaluations; }

    /// How much of a change of state, at most `most`, may be made at once so that no two yarns can pass
    /// through one another: no pair of near samples comes closer by half its distance or more, and no sample
    /// moves by a quarter of the least reach.
    double safe_share(const std::vector<Real>& state, const std::vector<Real>& change, double most);

    /// Shortens a change where it is not safe: each control point goes as far as the samples near it allow,
    /// and not at all where they do not come to agree. At least 0.9 of what is left is safe.
    void shorten(const std::vector<Real>& state, std::vector<Real>& change);
    /// A round of shorten() by its two halves, for a cloth that is relaxed in parts: the share of the change that is safe
    /// by each segment, and whether it is enough everywhere; and the change shortened by these shares.
    bool find_safe_shares(const std::vector<Real>& state, const std::vector<Real>& change, std::vector<double>& share);
    void shorten_by(const std::vector<Real>& state, std::vector<double>& share, int round, std::vector<Real>& change);

  private:
    void lay_samples(const std::vector<Real>& state);
    void move_samples(const std::vector<Real>& state, const std::vector<Real>& change);
    [[nodiscard]] double safe_share_of(const FabricView<Real>& fabric, std::size_t sample, double most) const;
    [[nodiscard]] CrossingLines<Real> lines(std::size_t sample, std::size_t other, const Vec<Real>& apart, Real reach) const;
    void leave_out_closing(const FabricView<Real>& fabric, const std::vector<double>& share, std::vector<Real>& change) const;
    [[nodiscard]] Vec<Real> without_closing(const FabricView<Real>& fabric, const std::vector<double>& share, std::size_t slot, Vec<Real> mine) const;
    void gather(std::vector<Real>& gradient) const;
    [[nodiscard]] double image_pull(const FabricView<Real>& fabric, std::size_t sample,
                                    std::size_t axis) const;
    double add_weight(const std::vector<Real>& state, std::vector<Real>& gradient) const;

    const Fabric<Real>& m_fabric;
    const Executor& m_executor;
    Transition<Real> m_transition;
    Friction<Real> m_friction;
    Neighbours<Real> m_neighbours;
    std::vector<Sphere<Real>> m_spheres;
    std::vector<Real> m_segment_energy, m_segment_gradient;
    std::vector<Real> m_moved, m_tangent;  ///< of each sample, scratch of safe_share
    double m_give = std::numeric_limits<double>::infinity();
    std::size_t m_evaluations = 0;
};

extern template class Energy<float>;
extern template class Energy<double>;

}  // namespace weave::sim
