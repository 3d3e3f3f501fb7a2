#include <weave/sim/device/curvature_arrays.hpp>

#include <algorithm>

namespace weave::sim {

namespace {

constexpr std::size_t slot_block_numbers = 144;

/// Lists grow and shrink from one to the next by little.
std::uint64_t with_margin(std::uint64_t needed) {
    return needed + needed / 8;
}

}  // namespace

template <class Real>
CurvatureArrays<Real>::CurvatureArrays(Memory& memory, const ClothView<Real>& cloth, std::size_t most_bytes)
    : m_first(memory, std::size_t{cloth.rows} + 1), m_column(memory), m_diagonal(memory, cloth.rows),
      m_first_near(memory, std::size_t{cloth.segments} + 1), m_near(memory), m_first_pair(memory, std::size_t{cloth.segments} + 1),
      m_owner(memory), m_value(memory), m_slot_blocks(memory), m_sums(memory, cloth.samples), m_chunk(memory, 1), m_needed(memory, 1) {
    m_view.matrix.rows = cloth.rows;
    m_view.most_slot_blocks = most_bytes / (slot_block_numbers * sizeof(float));
    lay();
}

template <class Real>
void CurvatureArrays<Real>::grow() {
    const CurvatureNeeds needs = m_needed.get().front();
    const std::uint64_t slot_blocks = std::max(needs.slot_blocks, std::min(m_view.most_slot_blocks, with_margin(needs.slot_blocks)));
    grow({with_margin(needs.near), with_margin(needs.pairs), with_margin(needs.blocks), slot_blocks});
}

template <class Real>
void CurvatureArrays<Real>::grow(const CurvatureNeeds& needs) {
    if (needs.near > m_near.size()) m_near.resize(needs.near);
    if (needs.pairs > m_owner.size()) m_owner.resize(needs.pairs);
    if (needs.blocks > m_column.size()) {
        m_column.resize(needs.blocks);
        m_value.resize(9 * needs.blocks);
    }
    if (slot_block_numbers * needs.slot_blocks > m_slot_blocks.size()) m_slot_blocks.resize(slot_block_numbers * needs.slot_blocks);
    lay();
}

template <class Real>
void CurvatureArrays<Real>::lay() {
    m_view.matrix.first = m_first.view();
    m_view.matrix.column = m_column.view();
    m_view.matrix.diagonal = m_diagonal.view();
    m_view.matrix.value = m_value.view();
    m_view.near = {m_first_near.view(), m_near.view(), m_first_pair.view(), m_owner.view()};
    m_view.sums = m_sums.view();
    m_view.slot_blocks = m_slot_blocks.view();
    m_view.chunk = m_chunk.view();
    m_view.needed = m_needed.view();
    m_view.room = {m_near.size(), m_owner.size(), m_column.size(), m_slot_blocks.size() / slot_block_numbers};
}

template <class Real>
std::size_t CurvatureArrays<Real>::bytes() const {
    return m_first.bytes() + m_column.bytes() + m_diagonal.bytes() + m_first_near.bytes() + m_near.bytes() + m_first_pair.bytes() +
           m_owner.bytes() + m_value.bytes() + m_slot_blocks.bytes() + m_sums.bytes() + m_chunk.bytes() + m_needed.bytes();
}

template class CurvatureArrays<float>;
template class CurvatureArrays<double>;

}  // namespace weave::sim
