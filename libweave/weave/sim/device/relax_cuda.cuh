#pragma once

// Relaxations on CUDA devices, whose kernels relax_device.cu and relax_each_device.cu compile once for all.

#include <weave/sim/device/cuda_machines.cuh>
#include <weave/sim/device/relax_on.hpp>

namespace weave::sim {

extern template void lead<float, CudaGangMachine>(CudaGangMachine&, RelaxingCloth<float, CudaGang>&);
extern template void lead<double, CudaGangMachine>(CudaGangMachine&, RelaxingCloth<double, CudaGang>&);
extern template void lead<float, CudaLaunchesMachine>(CudaLaunchesMachine&, RelaxingCloth<float, Launches>&);
extern template void lead<double, CudaLaunchesMachine>(CudaLaunchesMachine&, RelaxingCloth<double, Launches>&);
extern template void lead_each<float, CudaGangMachine>(CudaGangMachine&, std::vector<RelaxingCloth<float, CudaBlockGang>*>);
extern template void lead_each<double, CudaGangMachine>(CudaGangMachine&, std::vector<RelaxingCloth<double, CudaBlockGang>*>);

}  // namespace weave::sim
