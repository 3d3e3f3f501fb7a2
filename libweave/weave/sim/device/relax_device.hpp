#pragma once

// Relaxing on a device, for the rest of the tree: needs no CUDA, and is there in every build (device_none.cpp).

#include <weave/sim/device/devices.hpp>
#include <weave/sim/relax.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace weave::sim {

/// Relaxes cloths on one device, in memory that it asks for with each.
class DeviceRelaxer {
  public:
    /// Throws DeviceError where the device cannot be had.
    static std::unique_ptr<DeviceRelaxer> on(const Device& device);
    virtual ~DeviceRelaxer() = default;

    /// relax() (relax.hpp) there, of a scene that device_can_relax(). Forces are float while that leads on, and double beyond: the
    /// goal is the same. Whoever watches is told a few times within each sixtieth of a second, not after each step. Throws DeviceError or
    /// std::bad_alloc; the state is then one on the way.
    virtual RelaxResult relax(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) = 0;

    /// The same for many cloths: small ones next to one another, each by a share of the device, else one after the other. One that
    /// somebody stops stops alone. Whoever watches is told of all of them by turns.
    virtual std::vector<RelaxResult> relax_each(std::span<const ClothToRelax> cloths) = 0;
};

/// Whether a device models all that a scene holds: not friction, nor a crossing on its way to the other side.
bool device_can_relax(const SimScene& scene);

/// Bytes of its memory that a device is expected to take for a cloth, with double forces. Lists of what touches grow with what they
/// meet: this is what relaxations of the samples took, and some more (tests/device/foreseen.cpp).
std::size_t device_bytes(const Fabric<double>& fabric);

}  // namespace weave::sim
