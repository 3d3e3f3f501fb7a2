// A configuration of the simulation daemon from anywhere: refused with a reason, or one that can be served with.
#include "support/must.hpp"

#include <simd/commands/config.hpp>

using namespace weave;
using fuzz::must;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto config = simd::parse_config(fuzz::text_of(data, size));
    if (!config) {
        must(!config.error().message.empty(), "a refusal says why");
        return 0;
    }
    must(static_cast<bool>(simd::check_config(*config)), "what was read can be served with");
    must(config->workers >= 1 && config->workers <= 64, "the number of workers has its bounds");
    must(config->sessions >= 1 && config->jobs_at_once >= 1 && config->stall_seconds >= 1, "nothing is served with none of it");
    must(simd::threads_of(*config) >= 1 && simd::memory_of(*config) > 0, "something can compute");
    must(!config->plain || config->certificate.empty(), "plain goes with no certificate");
    return 0;
}
