#pragma once

#include <weave/sim/device/curvature.hpp>
#include <weave/sim/device/memory.hpp>

#include <cstddef>

namespace weave::sim {

/// The matrix of second derivatives of a cloth in the memory of some machine, and what its making needs.
template <class Real>
class CurvatureArrays {
  public:
    /// Bytes that slot blocks may take at most: few points have room for all at once, many take turns.
    static constexpr std::size_t usual_bytes = std::size_t{1} << 30;

    CurvatureArrays(Memory& memory, const ClothView<Real>& cloth, std::size_t most_bytes = usual_bytes);

    [[nodiscard]] CurvatureView<Real> view() const { return m_view; }
    /// Makes room for what make_shape() found missing, and some more; what was there is lost. Old views are no longer good.
    void grow();
    /// For so much, at least, without a margin.
    void grow(const CurvatureNeeds& needs);
    [[nodiscard]] std::size_t bytes() const;

  private:
    void lay();

    Array<std::uint32_t> m_first, m_column, m_diagonal, m_first_near, m_near, m_first_pair, m_owner;
    Array<float> m_value, m_slot_blocks;
    Array<SampleSums<Real>> m_sums;
    Array<CurvatureChunk> m_chunk;
    Array<CurvatureNeeds> m_needed;
    CurvatureView<Real> m_view;
};

extern template class CurvatureArrays<float>;
extern template class CurvatureArrays<double>;

}  // namespace weave::sim
