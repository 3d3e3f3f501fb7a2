#pragma once

#include <weave/sim/device/lists.hpp>
#include <weave/sim/device/memory.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// The arrays of the lists in the memory of some machine.
template <class Real>
class ListsArrays {
  public:
    /// `first_weights`: see Energy::first_weights().
    ListsArrays(Memory& memory, const ClothView<Real>& cloth, const std::vector<double>& first_weights);

    [[nodiscard]] const ListsRoom<Real>& room() const { return m_room; }
    /// Makes room for what did not fit, and somewhat more; the lists are then to be made anew.
    void grow(ListsState& state);
    [[nodiscard]] std::size_t bytes() const;

  private:
    void hold_images(std::size_t images);
    void hold_neighbours(std::size_t neighbours);
    void hold_candidates(std::size_t candidates);

    std::size_t m_own;
    Array<Sample<Real>> m_sample, m_built, m_wide_built;
    Array<Real> m_radius, m_first_weight;
    Array<HaloSample> m_halo;
    Array<std::uint32_t> m_first_image, m_first, m_neighbour, m_first_candidate, m_candidate, m_first_of_bucket, m_cell_sample;
    Array<std::uint64_t> m_cell_key;
    ListsRoom<Real> m_room;
};

extern template class ListsArrays<float>;
extern template class ListsArrays<double>;

}  // namespace weave::sim
