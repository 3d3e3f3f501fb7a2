#include <simd/worker/memory.hpp>

#include <weave/core/instrumented.hpp>

#include <cerrno>
#include <cstring>
#include <string>
#include <sys/resource.h>

namespace weave::simd {

Status limit_memory(std::uint64_t bytes) {
    if (is_sanitized) return {};  // whose shadow of the memory would count as ours
    const rlim_t most = bytes == 0 ? RLIM_INFINITY : static_cast<rlim_t>(bytes);
    rlimit limit{};
    if (::getrlimit(RLIMIT_DATA, &limit) != 0) return system_fault(std::string("cannot read the memory limit: ") + std::strerror(errno));
    limit.rlim_cur = most;
    if (limit.rlim_max != RLIM_INFINITY && limit.rlim_cur > limit.rlim_max) limit.rlim_cur = limit.rlim_max;
    if (::setrlimit(RLIMIT_DATA, &limit) != 0) return system_fault(std::string("cannot limit memory: ") + std::strerror(errno));
    return {};
}

}  // namespace weave::simd
