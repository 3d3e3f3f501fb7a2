// Answers where this program was built without CUDA; else devices.cu does.

#include <weave/sim/device/devices.hpp>
#include <weave/sim/device/relax_device.hpp>

namespace weave::sim {

Devices devices() {
    Devices none;
    none.why_none = "this program was built without CUDA";
    return none;
}

std::unique_ptr<DeviceRelaxer> DeviceRelaxer::on(const Device&) {
    throw DeviceError("relaxing on a device", 0, "this program was built without CUDA");
}

}  // namespace weave::sim
