#include <simd/daemon/room.hpp>

#include <array>
#include <cstdio>
#include <numeric>

namespace weave::simd {

std::uint64_t expected_bytes(std::size_t points) {
    constexpr std::uint64_t of_a_process = 40U << 20U, of_a_point = 8192;
    return of_a_process + of_a_point * points;
}

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

std::string memory_text(std::uint64_t bytes) {
    std::array<char, 32> text{};
    const double mib = static_cast<double>(bytes) / (1 << 20);
    if (mib < 1024) std::snprintf(text.data(), text.size(), "%.0f MiB", mib);
    else std::snprintf(text.data(), text.size(), "%.1f GiB", mib / 1024);
    return text.data();
}

}  // namespace weave::simd
