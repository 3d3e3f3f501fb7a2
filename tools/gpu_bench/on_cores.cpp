#include "on_cores.hpp"

#include <weave/sim/device/host_machines.hpp>
#include <weave/sim/device/relax_stages.hpp>

namespace weave::gpu_bench {

namespace {

class OnCores : public sim::DeviceRelaxer {
  public:
    sim::RelaxResult relax(sim::Energy<double>& energy, std::vector<double>& state, const sim::RelaxOptions& options) override {
        return sim::relax_in_stages(m_cores, energy, state, options);
    }
    std::vector<sim::RelaxResult> relax_each(std::span<const sim::ClothToRelax> cloths) override {
        return sim::relax_each_in_stages(m_thread, cloths);
    }

  private:
    sim::Executor m_executor{0};
    sim::CoresMachine m_cores{m_executor};
    sim::OneThreadMachine m_thread;
};

}  // namespace

std::unique_ptr<sim::DeviceRelaxer> relaxer_on_cores() {
    return std::make_unique<OnCores>();
}

}  // namespace weave::gpu_bench
