#pragma once

#include <weave/sim/device/cloth_view.hpp>
#include <weave/sim/device/memory.hpp>
#include <weave/sim/fabric.hpp>

#include <cstddef>
#include <vector>

namespace weave::sim {

/// The yarns of a fabric in the memory of some machine.
template <class Real>
class ClothArrays {
  public:
    /// `state` tells where the cloth lies, so that its samples can be counted in steps (SampleScale).
    ClothArrays(Memory& memory, const Fabric<double>& fabric, const std::vector<double>& state);

    [[nodiscard]] ClothView<Real> view() const { return m_view; }
    [[nodiscard]] std::size_t bytes() const;

  private:
    void lay_rows(Memory& memory, const Fabric<double>& fabric);
    void lay_yarns(Memory& memory, const Fabric<double>& fabric);
    void set_scale(const Fabric<double>& fabric, const std::vector<double>& state);

    Array<SegmentPlace> m_segment;
    Array<YarnConstants<Real>> m_yarn;
    Array<YarnSpan> m_span;
    Array<Basis<Real>> m_basis;
    Array<Gauss<Real>> m_gauss;
    Array<std::uint32_t> m_segment_of_sample, m_yarn_of_slot, m_yarn_of_row, m_slot_of_row, m_first_slot_of_row;
    Array<SlotShares> m_shares;
    Array<RowSlot> m_slots_of_row;
    Array<Sphere<Real>> m_spheres;
    Array<double> m_weight_N, m_class_radius;
    ClothView<Real> m_view;
};

extern template class ClothArrays<float>;
extern template class ClothArrays<double>;

}  // namespace weave::sim
