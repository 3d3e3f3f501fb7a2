#pragma once

#include <cstdint>

namespace weave {

/// Which one of `count` that repeat for ever an index means, and in which round; round 0 is theirs.
struct Wrapped {
    std::int64_t index = 0, round = 0;
};
constexpr Wrapped wrapped(std::int64_t at, std::int64_t count) {
    const std::int64_t round = at >= 0 ? at / count : -((count - 1 - at) / count);
    return {at - round * count, round};
}

}  // namespace weave
