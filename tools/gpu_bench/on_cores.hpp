#pragma once

#include <weave/sim/device/relax_device.hpp>

#include <memory>

namespace weave::gpu_bench {

/// The device's solver by the cores of the processor: shows, where there is no device, that what is measured runs, and what the solver
/// costs there.
std::unique_ptr<sim::DeviceRelaxer> relaxer_on_cores();

}  // namespace weave::gpu_bench
