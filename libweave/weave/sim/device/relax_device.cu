#include <weave/sim/device/relax_cuda.cuh>
#include <weave/sim/device/relax_device.hpp>
#include <weave/sim/device/relax_stages.hpp>

namespace weave::sim {

template void lead<float, CudaGangMachine>(CudaGangMachine&, RelaxingCloth<float, CudaGang>&);
template void lead<double, CudaGangMachine>(CudaGangMachine&, RelaxingCloth<double, CudaGang>&);
template void lead<float, CudaLaunchesMachine>(CudaLaunchesMachine&, RelaxingCloth<float, Launches>&);
template void lead<double, CudaLaunchesMachine>(CudaLaunchesMachine&, RelaxingCloth<double, Launches>&);

namespace {

/// Cloth of so many points keeps a device busy between two launches; less is relaxed in one kernel.
constexpr std::size_t points_for_launches = 40'000;

class OnCuda : public DeviceRelaxer {
  public:
    explicit OnCuda(int device) : m_queue(device), m_gang(m_queue), m_launches(m_queue) {}

    RelaxResult relax(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) override {
        if (energy.fabric().points() < points_for_launches) return relax_in_stages(m_gang, energy, state, options);
        return relax_in_stages(m_launches, energy, state, options);
    }
    std::vector<RelaxResult> relax_each(std::span<const ClothToRelax> cloths) override { return relax_each_in_stages(m_gang, cloths); }

  private:
    DeviceQueue m_queue;
    CudaGangMachine m_gang;
    CudaLaunchesMachine m_launches;
};

}  // namespace

std::unique_ptr<DeviceRelaxer> DeviceRelaxer::on(const Device& device) {
    return std::make_unique<OnCuda>(device.number);
}

}  // namespace weave::sim
