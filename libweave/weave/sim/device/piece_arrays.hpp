#pragma once

#include <weave/sim/device/memory.hpp>
#include <weave/sim/device/pieces.hpp>
#include <weave/sim/hierarchy.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// The multigrid of a cloth in the memory of some machine.
template <class Real>
class PieceArrays {
  public:
    PieceArrays(Memory& memory, const Hierarchy& hierarchy);

    [[nodiscard]] PiecesView<Real> view() const { return m_view; }
    /// Makes room for what shape_pieces() found missing, and some more; what was there is lost. Old views are no longer good.
    void grow();
    [[nodiscard]] std::size_t bytes() const;

  private:
    void number_levels(const std::vector<PieceLevel>& levels);
    void lay_shares(Memory& memory, const std::vector<PieceLevel>& levels);
    void lay();

    std::vector<std::size_t> m_order;          ///< levels by depth, the rows first
    std::vector<std::uint32_t> m_first_piece;  ///< per level of the hierarchy
    Array<PieceRange> m_level;
    Array<std::uint32_t> m_level_of, m_first_member, m_first_target;
    Array<PieceShare<Real>> m_member, m_target;
    Array<std::uint32_t> m_first, m_column, m_diagonal, m_start, m_count, m_found;
    Array<float> m_value;
    Array<Real> m_inverse, m_residual, m_step;
    Array<double> m_whole, m_spare_whole;
    Array<PiecesNeeds> m_needed;
    PiecesView<Real> m_view;
};

extern template class PieceArrays<float>;
extern template class PieceArrays<double>;

}  // namespace weave::sim
