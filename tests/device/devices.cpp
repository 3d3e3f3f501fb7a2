#include <weave/sim/device/devices.hpp>

#include <catch2/catch.hpp>

using namespace weave::sim;

TEST_CASE("devices: there is one that can be used, or it is said why not", "[device]") {
    const Devices found = devices();
    bool is_any_usable = false;
    for (const Device& device : found.all) is_any_usable = is_any_usable || device.trouble.empty();
    CHECK(found.why_none.empty() == is_any_usable);
    if (!found.is_built_in) CHECK(found.all.empty());
    CHECK(devices().all.size() == found.all.size());  // and again: nothing is left behind
}

TEST_CASE("devices: a fault of a device tells the call and what CUDA says", "[device]") {
    const DeviceError fault("cudaMalloc(&at, bytes)", 2, "out of memory");
    CHECK(fault.call() == "cudaMalloc(&at, bytes)");
    CHECK(fault.code() == 2);
    CHECK(std::string(fault.what()) == "cudaMalloc(&at, bytes): out of memory (CUDA error 2)");
    CHECK(cuda_version_words(13'000) == "13.0");
    CHECK(cuda_version_words(12'040) == "12.4");
}
