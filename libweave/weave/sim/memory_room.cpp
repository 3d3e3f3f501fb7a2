#include <weave/sim/memory_room.hpp>

#include <weave/sim/forecast.hpp>
#include <weave/sim/resolution.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace weave::sim {

namespace {

/// A part with fewer rows or columns of stacks has nothing that can move.
constexpr std::size_t fewest_lines = 3;

std::size_t stacks_of(const Region& region) {
    return (region.last_row - region.first_row + 1) * (region.last_column - region.first_column + 1);
}

/// Rows, and as many columns, of stacks that the room does for; 0 where a part of so few is none.
std::size_t lines_within(const MemoryNeed& need, const MemoryRoom& room) {
    const double share = static_cast<double>(points_within(room.bytes)) / static_cast<double>(need.points);
    const auto lines = static_cast<std::size_t>(std::sqrt(share * static_cast<double>(need.stacks)));
    return lines < fewest_lines ? 0 : lines;
}

std::string help_for(const MemoryNeed& need, const MemoryRoom& room) {
    std::string help = "simulate a part of the cloth";
    if (const std::size_t lines = lines_within(need, room); lines > 0)
        help += ", of about " + std::to_string(lines) + " rows and " + std::to_string(lines) + " columns of stacks at most";
    if (need.fidelity != Fidelity::draft) help += ", or as draft";
    if (room.server.empty()) help += ", or on a server";
    return help;
}

}  // namespace

MemoryNeed need_of(const Plan& plan) {
    return {points_of(plan), stacks_of(plan.curves.region), plan.fidelity};
}

std::optional<MemoryNeed> foreseen_need(const Design& design, const Block& block,
                                        const SimulationRequest& request) {
    const bool repeats = design.scene.boundary_x == Boundary::periodic && design.scene.boundary_y == Boundary::periodic &&
                         request.weft_mode.value_or(design.scene.weft_mode) == WeftMode::periodic;
    if (repeats && request.reduce && !request.region) return {};
    const Region part = request.region.value_or(Region{0, block.rows() - 1, 0, block.columns() - 1});
    if (part.last_row >= block.rows() || part.last_column >= block.columns()) return {};  // the plan says so
    const std::size_t rows = part.last_row - part.first_row + 1, columns = part.last_column - part.first_column + 1;
    const std::size_t picks = block.first_pick(part.last_row + 1) - block.first_pick(part.first_row),
                      ends = block.first_end(part.last_column + 1) - block.first_end(part.first_column);
    const double points = request.points_per_key.value_or(resolution_of(request.fidelity).points_per_key) * static_cast<double>(picks * columns + ends * rows);
    return MemoryNeed{static_cast<std::size_t>(points), stacks_of(part), request.fidelity};
}

std::optional<MemoryRoom> room_here() {
    std::ifstream table("/proc/meminfo");
    std::string name, unit;
    for (std::uint64_t kibibytes = 0; table >> name >> kibibytes && std::getline(table, unit);) {
        if (name == "MemAvailable:") return MemoryRoom{kibibytes << 10U, {}};
    }
    return {};
}

Status check_room(const MemoryNeed& need, const MemoryRoom& room) {
    const std::uint64_t needed = expected_bytes(need.points);
    if (needed <= room.bytes) return {};
    const std::string there = room.server.empty() ? " are free" : " is all that there is on " + room.server;
    return Error{ErrorCode::refused,
                 "this takes about " + memory_text(needed) + " of memory, and " + memory_text(room.bytes) +
                     there + "; " + help_for(need, room),
                 {}};
}

bool is_hopeless(const MemoryNeed& need, const MemoryRoom& room) {
    return least_bytes(need.points) > room.bytes;
}

}  // namespace weave::sim
