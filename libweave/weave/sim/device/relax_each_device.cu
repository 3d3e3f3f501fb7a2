// A file of its own: the kernels take nvcc long, and two files are compiled at once.

#include <weave/sim/device/relax_cuda.cuh>

namespace weave::sim {

template void lead_each<float, CudaGangMachine>(CudaGangMachine&, std::vector<RelaxingCloth<float, CudaBlockGang>*>);
template void lead_each<double, CudaGangMachine>(CudaGangMachine&, std::vector<RelaxingCloth<double, CudaBlockGang>*>);

}  // namespace weave::sim
