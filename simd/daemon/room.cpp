#include <simd/daemon/room.hpp>

#include <numeric>

namespace weave::simd {

std::uint64_t Room::taken() const {
    return std::accumulate(m_promised.begin(), m_promised.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const auto& entry) { return sum + entry.second; });
}

std::uint64_t Room::promised(std::uint64_t worker) const {
    const auto found = m_promised.find(worker);
    return found == m_promised.end() ? 0 : found->second;
}

bool Room::take(std::uint64_t worker, std::uint64_t bytes) {
    const std::uint64_t others = taken() - promised(worker);
    if (others + bytes > m_bytes) return false;
    m_promised[worker] = bytes;
    return true;
}

}  // namespace weave::simd
