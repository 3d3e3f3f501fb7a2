#pragma once

#include <weave/sim/device/cloth_arrays.hpp>
#include <weave/sim/device/crew_cloth.hpp>
#include <weave/sim/device/curvature_arrays.hpp>
#include <weave/sim/device/lists_arrays.hpp>
#include <weave/sim/device/piece_arrays.hpp>
#include <weave/sim/energy.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// All that a crew relaxes a cloth in, in the memory of its machine. Of the scene device_can_relax() (relax_device.hpp) must hold.
template <class Real>
class CrewArrays {
  public:
    /// Throws std::bad_alloc where the memory does not suffice.
    CrewArrays(Memory& memory, Energy<double>& energy, const std::vector<double>& state);

    [[nodiscard]] CrewRoom<Real> room() const;
    /// Makes room for what did not fit, as the state tells. Throws like the constructor.
    void grow(CrewState& state);
    [[nodiscard]] std::vector<double> state() const { return m_state.get(); }
    [[nodiscard]] std::size_t bytes() const;

  private:
    ClothArrays<Real> m_cloth;
    ListsArrays<Real> m_lists;
    CurvatureArrays<Real> m_curvature;
    PieceArrays<Real> m_pieces;
    std::size_t m_numbers;  ///< of a vector of rows
    Array<ContactSum<Real>> m_contact;
    Array<double> m_energy, m_share, m_state, m_before, m_products, m_sums, m_pair_share;
    Array<Real> m_by_segment, m_vectors, m_pair_change, m_pair_bend;
    Array<Moved<Real>> m_moved;
    Array<std::uint32_t> m_key;
    double m_reference_floor_N = 0;
};

extern template class CrewArrays<float>;
extern template class CrewArrays<double>;

}  // namespace weave::sim
