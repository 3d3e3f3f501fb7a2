#pragma once

#include <sim/scenes.hpp>

#include <weave/sim/device/cloth_arrays.hpp>
#include <weave/sim/device/lists_view.hpp>
#include <weave/sim/device/memory.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim::testing {

/// The lists of a cloth as the processor's Neighbours have made them, for bodies that only read lists.
template <class Real>
class HostLists {
  public:
    HostLists(Memory& memory, Neighbours<double>& from, const ClothView<Real>& cloth)
        : m_sample(memory), m_radius(memory), m_halo(memory), m_first(memory), m_neighbour(memory) {
        const std::size_t own = cloth.samples, all = own + from.halo();
        const SamplesView<double> at = from.samples();
        std::vector<Sample<Real>> samples(all);
        std::vector<Real> radii(all);
        const SampleScale& scale = cloth.scale;
        for (std::size_t i = 0; i < all; ++i) {
            const double places[3]{at.x[i], at.y[i], at.z[i]};
            for (std::size_t k = 0; k < 3; ++k) samples[i].at[k] = counted<Real>(places[k], scale.origin[k], scale.step_mm);
            samples[i].weight = static_cast<Real>(at.weight[i]);
            radii[i] = static_cast<Real>(at.radius[i]);
        }
        m_sample = Array<Sample<Real>>(memory, samples);
        m_radius = Array<Real>(memory, radii);
        m_halo = Array<HaloSample>(memory, {from.halo_samples(), from.halo_samples() + from.halo()});
        m_first = own == 0 ? Array<std::uint32_t>(memory, 1) : Array<std::uint32_t>(memory, {from.first(), from.first() + own + 1});
        m_neighbour = Array<std::uint32_t>(memory, {from.others(), from.others() + from.entries()});
        m_own = static_cast<std::uint32_t>(own);
    }

    [[nodiscard]] ListsView<Real> view() const {
        return {m_sample.view(), m_radius.view(), m_halo.view(), m_own, m_first.view(), m_neighbour.view()};
    }

  private:
    Array<Sample<Real>> m_sample;
    Array<Real> m_radius;
    Array<HaloSample> m_halo;
    Array<std::uint32_t> m_first, m_neighbour;
    std::uint32_t m_own = 0;
};

}  // namespace weave::sim::testing
