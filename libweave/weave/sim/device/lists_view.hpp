#pragma once

#include <weave/sim/device/cloth_view.hpp>
#include <weave/sim/fabric.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// Contact samples, own ones first, then their images some periods away, and for each own sample those that may touch it, in the
/// order of (own sample, image).
template <class Real>
struct ListsView {
    View<Sample<Real>> sample;
    View<Real> radius;              ///< mm, of each sample
    View<HaloSample> halo;          ///< of sample `own + i`
    std::uint32_t own = 0;          ///< how many own samples
    View<std::uint32_t> first;      ///< per own sample, and one more
    View<std::uint32_t> neighbour;  ///< indices of samples

    /// The own sample that a sample is, or is an image of.
    [[nodiscard]] WEAVE_HD std::uint32_t own_of(std::uint32_t of) const { return of < own ? of : halo[of - own].of; }
};

}  // namespace weave::sim
