#include <weave/sim/memory_room.hpp>

#include <weave/core/text.hpp>
#include <weave/curve/cloth_layout.hpp>
#include <weave/sim/forecast.hpp>
#include <weave/sim/resolution.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>
#include <sys/resource.h>
#include <unistd.h>

namespace weave::sim {

namespace {

/// A part with fewer rows or columns of stacks has nothing that can move.
constexpr std::size_t fewest_lines = 3;
/// How much denser than on average the points of a plan may lie somewhere, and how many more key points a stack may have than yarns.
constexpr double densest = 1.5, keys_of_a_yarn = 2;

/// Rows, and as many columns, of stacks that the room does for wherever they are taken; 0 where a part of so few is none.
std::size_t lines_within(const MemoryNeed& need, const MemoryRoom& room) {
    const auto lines = static_cast<std::size_t>(std::sqrt(static_cast<double>(points_within(room.bytes)) / need.points_in_a_stack));
    return lines < fewest_lines ? 0 : lines;
}

bool does_as_draft(const MemoryNeed& need, const MemoryRoom& room) {
    const double share = resolution_of(Fidelity::draft).points_per_key / need.points_per_key;
    const auto of_draft = [&](std::uint64_t amount) { return static_cast<std::uint64_t>(share * static_cast<double>(amount)); };
    return share < 1 && expected_bytes(of_draft(need.points)) + of_draft(need.copied_bytes) <= room.bytes;
}

/// What a cloth of many repeats may be simulated as instead: the repeat as it was before it was tiled.
std::string repeat_within(const MemoryNeed& need, const MemoryRoom& room) {
    if (need.copied_bytes == 0 || expected_bytes(need.points) > room.bytes) return {};
    return "a design of one of its repeats, " + counted(need.picks_and_ends[0], "pick") + " and " + counted(need.picks_and_ends[1], "end") + ", or ";
}

std::string part_within(const MemoryNeed& need, const MemoryRoom& room) {
    const std::size_t lines = lines_within(need, room);
    if (lines == 0) return "a part of the cloth";
    const auto yarns = [&](double in_a_line) { return std::to_string(static_cast<std::size_t>(static_cast<double>(lines) * in_a_line)); };
    return "a part of the cloth, up to " + yarns(need.picks_in_a_row) + " picks and " + yarns(need.ends_in_a_column) + " ends";
}

std::string help_for(const MemoryNeed& need, const MemoryRoom& room) {
    std::string help = "simulate " + repeat_within(need, room) + part_within(need, room);
    if (does_as_draft(need, room)) help += ", or all of it as draft";
    if (room.server.empty()) help += ", or have a server do it that has so much";
    return help;
}

/// What the limit on the address space of this process, if there is one, leaves.
std::uint64_t left_of_address_space() {
    constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
    rlimit limit{};
    std::uint64_t pages = 0;
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return no_limit;
    if (!(std::ifstream("/proc/self/statm") >> pages)) return no_limit;
    const std::uint64_t taken = pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return limit.rlim_cur - std::min<std::uint64_t>(taken, limit.rlim_cur);
}

}  // namespace

MemoryNeed need_of(const Plan& plan) {
    const auto lines = [](std::size_t first, std::size_t last) { return static_cast<double>(last - first + 1); };
    const Region& region = plan.curves.region;
    const auto in_each = [](std::size_t yarns, std::size_t of) { return static_cast<double>(yarns) / static_cast<double>(of); };
    MemoryNeed need{points_of(plan), plan.fidelity, plan.points_per_key};
    need.points_in_a_stack = densest * static_cast<double>(need.points) /
                             (lines(region.first_row, region.last_row) * lines(region.first_column, region.last_column));
    need.picks_in_a_row = in_each(plan.cloth_picks, plan.cloth_rows);
    need.ends_in_a_column = in_each(plan.cloth_ends, plan.cloth_columns);
    need.copied_bytes = copied_bytes(plan);
    need.picks_and_ends = {plan.cloth_picks / plan.repeats[0], plan.cloth_ends / plan.repeats[1]};
    return need;
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
    const std::span<const std::uint32_t> t(block.t()), p(block.p());
    const Result<ClothLayout::Extent> extent = ClothLayout::foreseen(design, block, {request.region, request.weft_mode});
    if (!extent) return {};  // the plan says why
    const std::uint32_t yarns_in_a_stack = std::ranges::max(t.subspan(part.first_row, rows)) + std::ranges::max(p.subspan(part.first_column, columns));
    MemoryNeed need{0, request.fidelity, request.points_per_key.value_or(resolution_of(request.fidelity).points_per_key)};
    need.points = static_cast<std::size_t>(need.points_per_key * static_cast<double>(extent->segments)) + extent->open_yarns;
    need.points_in_a_stack = keys_of_a_yarn * need.points_per_key * yarns_in_a_stack;
    need.picks_in_a_row = static_cast<double>(picks) / static_cast<double>(rows);
    need.ends_in_a_column = static_cast<double>(ends) / static_cast<double>(columns);
    return need;
}

std::optional<MemoryRoom> room_here() {
    std::ifstream table("/proc/meminfo");
    std::string name, unit;
    for (std::uint64_t kibibytes = 0; table >> name >> kibibytes && std::getline(table, unit);) {
        if (name == "MemAvailable:") return MemoryRoom{std::min(kibibytes << 10U, left_of_address_space()), {}};
    }
    return {};
}

Status check_room(const MemoryNeed& need, const MemoryRoom& room) {
    const std::uint64_t needed = expected_bytes(need.points) + need.copied_bytes;
    if (needed <= room.bytes) return {};
    const std::string there = room.server.empty() ? " are free" : " is all that there is on " + room.server;
    return Error{ErrorCode::refused,
                 "this takes about " + memory_text(needed) + " of memory, and " + memory_text(room.bytes) +
                     there + "; " + help_for(need, room),
                 {}};
}

}  // namespace weave::sim
