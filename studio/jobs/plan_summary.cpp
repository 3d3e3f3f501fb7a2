#include <studio/jobs/plan_summary.hpp>

#include <weave/sim/forecast.hpp>

#include <fstream>

namespace weave::studio {

PlanSummary summary_of(const sim::Plan& plan, const std::string& title) {
    PlanSummary summary;
    summary.title = title;
    summary.points = sim::points_of(plan);
    summary.yarns = plan.scene.yarns.size();
    summary.repeats = plan.repeats[0] * plan.repeats[1];
    summary.expected_bytes = sim::expected_bytes(summary.points);
    summary.lines = plan.lines;
    return summary;
}

std::optional<std::uint64_t> free_memory() {
    std::ifstream table("/proc/meminfo");
    std::string name, unit;
    for (std::uint64_t kibibytes = 0; table >> name >> kibibytes && std::getline(table, unit);) {
        if (name == "MemAvailable:") return kibibytes << 10U;
    }
    return {};
}

}  // namespace weave::studio
