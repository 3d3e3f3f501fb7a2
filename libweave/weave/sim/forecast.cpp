#include <weave/sim/forecast.hpp>

#include <array>
#include <cstdio>

namespace weave::sim {

namespace {

constexpr std::uint64_t of_a_process = 40U << 20U, of_a_point = 8192;  // bytes

}  // namespace

std::size_t points_of(const Plan& plan) {
    std::size_t points = 0;
    for (const SimYarn& yarn : plan.scene.yarns) points += yarn.control.size();
    return points;
}

std::uint64_t expected_bytes(std::size_t points) {
    return of_a_process + of_a_point * points;
}

std::size_t points_within(std::uint64_t bytes) {
    return bytes <= of_a_process ? 0 : (bytes - of_a_process) / of_a_point;
}

std::string memory_text(std::uint64_t bytes) {
    std::array<char, 32> text{};
    const double mib = static_cast<double>(bytes) / (1 << 20);
    if (mib < 1024)
        std::snprintf(text.data(), text.size(), "%.0f MiB", mib);
    else
        std::snprintf(text.data(), text.size(), "%.1f GiB", mib / 1024);
    return text.data();
}

}  // namespace weave::sim
