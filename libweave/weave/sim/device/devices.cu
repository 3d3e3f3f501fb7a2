#include <weave/sim/device/cuda_check.cuh>
#include <weave/sim/device/devices.hpp>

namespace weave::sim {

namespace {

/// Code is compiled for this compute capability and later ones.
constexpr int least_capability = 8;

/// Why there are no devices, where CUDA answered `error` when asked for their number.
std::string words_for(cudaError_t error, int driver) {
    switch (error) {
        case cudaErrorInsufficientDriver:
            return driver == 0 ? "there is no driver for NVIDIA devices here"
                               : "the driver knows CUDA " + cuda_version_words(driver) + " at most, which is too old";
        case cudaErrorNoDevice: return "there is no NVIDIA device here";
        default: return std::string("CUDA cannot be used here: ") + cudaGetErrorString(error);
    }
}

/// What keeps the simulator from using the device that the thread speaks to; looks up its free memory too.
std::string trouble_with(Device& device, const cudaDeviceProp& facts) {
    if (facts.major < least_capability)
        return "its compute capability is below " + std::to_string(least_capability) + ".0";
    int cooperates = 0;
    cudaError_t error = cudaDeviceGetAttribute(&cooperates, cudaDevAttrCooperativeLaunch, device.number);
    if (error == cudaSuccess && cooperates == 0) return "its blocks cannot wait for one another";
    std::size_t all = 0;
    if (error == cudaSuccess) error = cudaMemGetInfo(&device.free_bytes, &all);
    if (error == cudaSuccess) return {};
    static_cast<void>(cudaGetLastError());
    return cudaGetErrorString(error);
}

Device describe(int number) {
    Device device;
    device.number = number;
    cudaDeviceProp facts{};
    cudaError_t error = cudaGetDeviceProperties(&facts, number);
    if (error == cudaSuccess) error = cudaSetDevice(number);
    if (error != cudaSuccess) {
        static_cast<void>(cudaGetLastError());
        device.trouble = cudaGetErrorString(error);
        return device;
    }
    device.name = facts.name;
    device.bytes = facts.totalGlobalMem;
    device.capability[0] = facts.major;
    device.capability[1] = facts.minor;
    device.multiprocessors = facts.multiProcessorCount;
    device.trouble = trouble_with(device, facts);
    return device;
}

}  // namespace

Devices devices() {
    Devices found;
    found.is_built_in = true;
    static_cast<void>(cudaRuntimeGetVersion(&found.runtime));
    if (cudaDriverGetVersion(&found.driver) != cudaSuccess) found.driver = 0;
    int count = 0, before = 0;
    const cudaError_t error = cudaGetDeviceCount(&count);
    if (error != cudaSuccess || count == 0) { // the count of a call that failed must not be read
        static_cast<void>(cudaGetLastError());
        found.why_none = words_for(error == cudaSuccess ? cudaErrorNoDevice : error, found.driver);
        return found;
    }
    const bool has_before = cudaGetDevice(&before) == cudaSuccess;
    bool is_any_usable = false;
    for (int number = 0; number < count; ++number) {
        found.all.push_back(describe(number));
        is_any_usable = is_any_usable || found.all.back().trouble.empty();
    }
    if (has_before) static_cast<void>(cudaSetDevice(before));
    if (!is_any_usable) found.why_none = found.all.front().name + " cannot be used: " + found.all.front().trouble;
    return found;
}

void check_cuda(cudaError_t result, const char* call) {
    if (result == cudaSuccess) return;
    static_cast<void>(cudaGetLastError());
    throw DeviceError(call, static_cast<int>(result), cudaGetErrorString(result));
}

}  // namespace weave::sim
