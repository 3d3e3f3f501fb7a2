#pragma once

// Calls of CUDA that must not fail unseen: each wrapped in WEAVE_CUDA_CHECK, which throws DeviceError.

#include <cuda_runtime.h>

namespace weave::sim {

/// Throws where `result`, what `call` returned, is an error, and forgets the error: the next call answers for itself, unless the
/// device is beyond use.
void check_cuda(cudaError_t result, const char* call);

}  // namespace weave::sim

#define WEAVE_CUDA_CHECK(call) ::weave::sim::check_cuda((call), #call)
