// Answers where this program was built without CUDA; else devices.cu does.

#include <weave/sim/device/devices.hpp>

namespace weave::sim {

Devices devices() {
    Devices none;
    none.why_none = "this program was built without CUDA";
    return none;
}

}  // namespace weave::sim
