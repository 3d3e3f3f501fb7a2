#pragma once

#include <weave/sim/fabric.hpp>
#include <weave/sim/hessian_terms.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace weave::sim {

/// The forces of a crossing on its way to the other side (SimScene::transition): a spring between the heights of its two
/// yarns, and the share of their contact that has come back. Few samples take part, so all runs on one core.
template <class Real>
class Transition {
  public:
    explicit Transition(const Fabric<Real>& fabric);

    [[nodiscard]] bool is_on() const { return m_on; }
    /// Whether two own samples lie on the two stretches, which the list of neighbours leaves out.
    [[nodiscard]] bool parts(std::uint32_t a, std::uint32_t b) const {
        return m_on && m_side[a] != 0 && m_side[b] != 0 && m_side[a] != m_side[b];
    }
    /// Adds the gradient by slots, which is not folded yet; the energy in N·mm.
    double add(const FabricView<Real>& fabric, std::vector<Real>& gradient) const;

    /// Second derivatives by each segment's own slots that bound the true ones from above (twice the convex diagonal:
    /// the blocks between the two yarns, which the matrix has no place for, are left out).
    [[nodiscard]] std::vector<std::pair<std::uint32_t, SlotBlocks>> curvature(const FabricView<Real>& fabric) const;

  private:
    /// A contact sample of a stretch; `offset` moves it to where the stretch goes through it.
    struct Sample {
        std::uint32_t segment = 0, within = 0;
        Vec<double> offset{0, 0, 0};
    };
    struct Laid;
    [[nodiscard]] std::vector<Laid> lay(const FabricView<Real>& fabric, std::size_t side) const;
    [[nodiscard]] double lift(const FabricView<Real>& fabric) const;
    void list_stretch(const Fabric<Real>& fabric, std::size_t side);

    bool m_on = false;
    TransitionPair m_pair;
    std::array<std::vector<Sample>, 2> m_stretch;
    std::array<Sample, 2> m_crossing;          ///< segment and offset of the point that the spring holds
    std::array<Basis<double>, 2> m_basis{};    ///< at that point
    std::vector<std::uint8_t> m_side;          ///< per own sample: 0, or which of the two stretches
};

extern template class Transition<float>;
extern template class Transition<double>;

}  // namespace weave::sim
