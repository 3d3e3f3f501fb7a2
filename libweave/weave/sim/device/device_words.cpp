#include <weave/sim/device/devices.hpp>

namespace weave::sim {

std::string cuda_version_words(int version) {
    return std::to_string(version / 1000) + '.' + std::to_string(version % 1000 / 10);
}

}  // namespace weave::sim
