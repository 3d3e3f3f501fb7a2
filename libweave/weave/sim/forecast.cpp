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

std::uint64_t copied_bytes(const Plan& plan) {
    const std::uint64_t repeats = std::uint64_t{plan.repeats[0]} * plan.repeats[1];
    if (repeats == 1) return 0;
    // Places, planned places, strain and contact force of a point, and the same in the file; a crossing's words in both.
    constexpr std::uint64_t of_copied_point = 2 * (2 * 3 + 2) * sizeof(double), of_copied_crossing = sizeof(Crossing) + 7 * sizeof(std::uint32_t);
    return repeats * (of_copied_point * points_of(plan) + of_copied_crossing * plan.curves.crossings.size());
}

std::uint64_t expected_bytes(const Plan& plan) {
    return expected_bytes(points_of(plan)) + copied_bytes(plan);
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
