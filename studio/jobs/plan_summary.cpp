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

std::optional<std::size_t> foreseen_points(const Design& design, const Block& block, const sim::SimulationRequest& request) {
    const bool repeats = design.scene.boundary_x == Boundary::periodic && design.scene.boundary_y == Boundary::periodic &&
                         request.weft_mode.value_or(design.scene.weft_mode) == WeftMode::periodic;
    if (request.region || (repeats && request.reduce)) return {};
    const double per_key = request.points_per_key.value_or(request.fidelity == sim::Fidelity::draft      ? 2
                                                           : request.fidelity == sim::Fidelity::standard ? 4
                                                                                                         : 8);
    const auto keys = static_cast<double>(block.picks() * block.columns() + block.ends() * block.rows());
    return static_cast<std::size_t>(per_key * keys);
}

Error lack_of_memory(std::uint64_t needed, std::uint64_t free, sim::Fidelity fidelity) {
    std::string help = "; simulate a part of the cloth";
    if (fidelity != sim::Fidelity::draft) help += ", or as draft";
    return Error{ErrorCode::refused,
                 "this takes about " + sim::memory_text(needed) + " of memory, and " + sim::memory_text(free) + " are free" +
                     help + ", or on a server",
                 {}};
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
