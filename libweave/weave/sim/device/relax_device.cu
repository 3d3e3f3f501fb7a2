#include <weave/sim/device/relax_cuda.cuh>
#include <weave/sim/device/relax_device.hpp>
#include <weave/sim/device/relax_stages.hpp>

#include <algorithm>

namespace weave::sim {

template void lead<float, CudaGangMachine>(CudaGangMachine&, RelaxingCloth<float, CudaGang>&);
template void lead<double, CudaGangMachine>(CudaGangMachine&, RelaxingCloth<double, CudaGang>&);
template void lead<float, CudaLaunchesMachine>(CudaLaunchesMachine&, RelaxingCloth<float, Launches>&);
template void lead<double, CudaLaunchesMachine>(CudaLaunchesMachine&, RelaxingCloth<double, Launches>&);

namespace {

// Not measured on a device yet.
/// Cloth of so many points keeps a device busy between two launches; less is relaxed in one kernel.
constexpr std::size_t points_for_launches = 40'000;
/// Cloth of fewer points is content with one block, where there are so many cloths that they fill a device.
constexpr std::size_t points_for_a_block = 6'000, cloths_for_blocks = 8;

class OnCuda : public DeviceRelaxer {
  public:
    explicit OnCuda(int device) : m_queue(device), m_gang(m_queue), m_launches(m_queue) {}

    RelaxResult relax(Energy<double>& energy, std::vector<double>& state, const RelaxOptions& options) override {
        if (energy.fabric().points() < points_for_launches) return relax_in_stages(m_gang, energy, state, options);
        return relax_in_stages(m_launches, energy, state, options);
    }
    std::vector<RelaxResult> relax_each(std::span<const ClothToRelax> cloths) override {
        const bool are_small = std::ranges::all_of(cloths, [](const ClothToRelax& cloth) { return cloth.energy->fabric().points() < points_for_a_block; });
        if (are_small && cloths.size() >= cloths_for_blocks) return relax_each_in_stages(m_gang, cloths);
        std::vector<RelaxResult> results;
        for (const ClothToRelax& cloth : cloths) results.push_back(relax(*cloth.energy, *cloth.state, cloth.options));
        return results;
    }

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
