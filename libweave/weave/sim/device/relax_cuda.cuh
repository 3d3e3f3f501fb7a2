#pragma once

// Relaxations on CUDA devices, whose kernels relax_device.cu compiles once for all.

#include <weave/sim/device/cuda_machines.cuh>
#include <weave/sim/device/relax_on.hpp>

namespace weave::sim {

extern template class RelaxingOn<float, CudaGangMachine>;
extern template class RelaxingOn<double, CudaGangMachine>;
extern template class RelaxingOn<float, CudaLaunchesMachine>;
extern template class RelaxingOn<double, CudaLaunchesMachine>;

}  // namespace weave::sim
