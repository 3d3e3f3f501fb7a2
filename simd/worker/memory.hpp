#pragma once

#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::simd {

/// From now on this process cannot have more memory of its own than so many bytes; 0: no bound but the system's. Asking for more
/// throws std::bad_alloc, which ends the work with a report.
Status limit_memory(std::uint64_t bytes);

}  // namespace weave::simd
