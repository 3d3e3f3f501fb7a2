#pragma once

// The devices besides the processor on which the simulator can run. This header needs no CUDA, and what it declares is there in
// every build: where nvcc was missing, device_none.cpp answers for devices.cu.

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace weave::sim {

/// A device, as its driver describes it.
struct Device {
    int number = 0;  ///< by which its driver counts it
    std::string name;
    std::size_t bytes = 0, free_bytes = 0;  ///< of its memory
    int capability[2]{0, 0};                ///< compute capability: 9, 0 for an H100
    int multiprocessors = 0;
    std::string trouble;  ///< why the simulator cannot use it, in words; empty where it can
};

/// What there is.
struct Devices {
    std::vector<Device> all;
    std::string why_none;  ///< why none can be used, in words; empty where one can
    bool is_built_in = false;  ///< whether this program has code for devices at all
    int driver = 0, runtime = 0;  ///< CUDA versions, 13000 for 13.0; 0 where there is none
};

/// Looks the devices up. Where none can be used that is an answer, never an error.
Devices devices();

/// A CUDA version as people write it: 13.0.
std::string cuda_version_words(int version);

/// Something that a device or its driver could not do. Exceptional: it is caught at the rim, where a run goes on on the processor
/// or ends with a report.
class DeviceError : public std::runtime_error {
  public:
    /// `code` is CUDA's number for it, `words` what CUDA says of that.
    DeviceError(const std::string& call, int code, const std::string& words)
        : std::runtime_error(call + ": " + words + " (CUDA error " + std::to_string(code) + ")"), m_call(call), m_code(code) {}

    [[nodiscard]] const std::string& call() const { return m_call; }
    [[nodiscard]] int code() const { return m_code; }

  private:
    std::string m_call;
    int m_code;
};

}  // namespace weave::sim
