#include <weave/picture/slice_map.hpp>

#include <algorithm>

namespace weave {

namespace {

constexpr double across = 46, up = 27;  ///< pixels between positions and between levels
constexpr double left = 104, top = 30;

const Stack& stack_at(const Subject& subject, const SliceMap& map, std::size_t position) {
    const std::size_t place = map.begin + position;
    return map.dots == System::weft ? subject.block.stack(place, subject.request.line)
                                    : subject.block.stack(subject.request.line, place);
}

void list_dots(const Subject& subject, const YarnColours& colours, SliceMap& map) {
    const Block& block = subject.block;
    for (std::size_t position = 0; position < map.positions; ++position) {
        const auto slots = stack_at(subject, map, position).slots();
        for (std::size_t level = 0; level < std::min(slots.size(), map.levels); ++level) {
            const Slot slot = slots[level];
            if (map.dots == System::weft ? !slot.is_weft() : !slot.is_warp()) continue;
            if (subject.request.trim && slot.is_loose()) continue;
            SliceDot dot{position, level, slot.index(), {}, slot.is_loose()};
            if (map.dots == System::weft) {
                dot.number += block.first_pick(map.begin + position);
                if (!colours.has_weft(dot.number)) continue;
                dot.colour = colours.drawn_pick(dot.number);
            } else {
                dot.number += block.first_end(map.begin + position);
                dot.colour = colours.drawn_end(dot.number);
            }
            map.dot_list.push_back(dot);
        }
    }
}

/// Levels and looseness of every path yarn at every shown position: two tables, yarn by yarn.
void list_paths(const Subject& subject, SliceMap& map, std::size_t yarns) {
    map.paths.resize(yarns);
    for (std::size_t position = 0; position < map.positions; ++position) {
        const auto slots = stack_at(subject, map, position).slots();
        for (std::size_t level = 0; level < slots.size(); ++level) {
            const Slot slot = slots[level];
            if (slot.is_empty() || (map.dots == System::weft ? !slot.is_warp() : !slot.is_weft())) continue;
            map.paths[slot.index()].levels.push_back(level);
            map.paths[slot.index()].loose.push_back(slot.is_loose());
        }
    }
    for (std::size_t k = 0; k < yarns; ++k) {
        map.paths[k].shift = (static_cast<double>(k) + 0.5) / static_cast<double>(yarns) - 0.5;
    }
}

/// Leaves the part of a path that its yarn runs through.
void cut(SlicePath& path, const WeftRuns::Run& run, std::size_t begin) {
    const std::size_t after = begin + path.levels.size();
    if (run.first >= after || run.last < begin) return path.levels.clear();
    path.first = std::max(run.first, begin) - begin;
    const auto from = static_cast<std::ptrdiff_t>(path.first),
               to = static_cast<std::ptrdiff_t>(std::min(run.last + 1, after) - begin);
    path.levels = {path.levels.begin() + from, path.levels.begin() + to};
    path.loose = {path.loose.begin() + from, path.loose.begin() + to};
}

/// The turns of which a pick is shown and whose side lies within the shown part.
std::vector<SliceTurn> turns_of(const SliceMap& map, const WeftRuns& runs) {
    const auto path_of = [&](std::size_t pick) -> std::optional<std::size_t> {
        const auto found = std::ranges::find(map.paths, pick, &SlicePath::number);
        if (found == map.paths.end()) return {};
        return static_cast<std::size_t>(found - map.paths.begin());
    };
    std::vector<SliceTurn> turns;
    for (const Turn& turn : runs.turns()) {
        const std::size_t column = runs.column_of(turn);
        if (column < map.begin || column >= map.begin + map.positions) continue;
        const SliceTurn shown{turn, path_of(turn.from_pick), path_of(turn.to_pick)};
        if (shown.from || shown.to) turns.push_back(shown);
    }
    return turns;
}

/// Positions that the line through level k of a path spans in one piece.
double drawn_length(const SliceMap& map, const SlicePath& path, std::size_t k, bool trim) {
    const auto is_drawn = [&](std::size_t level) { return !trim || !path.loose[level]; };
    std::size_t first = k, last = k;
    while (first > 0 && is_drawn(first - 1)) --first;
    while (last + 1 < path.levels.size() && is_drawn(last + 1)) ++last;
    const auto beyond = [&](bool cut, Side side) {  // a trimmed yarn is cut midway between two levels
        return cut ? 0.5 : reaches(map, path, side) ? overhang : 0;
    };
    return static_cast<double>(last - first) + beyond(first > 0, Side::left) +
           beyond(last + 1 < path.levels.size(), Side::right);
}

}  // namespace

SliceMap slice_map(const Subject& subject, const YarnColours& colours, const WeftRuns& runs,
                   SliceLimits limits) {
    const Block& block = subject.block;
    const std::size_t line = subject.request.line;
    SliceMap map;
    map.dots = subject.request.view == View::warp_slice ? System::weft : System::warp;
    const bool warps_run = map.dots == System::weft;
    map.all_positions = warps_run ? block.rows() : block.columns();
    map.all_levels = block.height();
    map.begin = warps_run ? subject.request.first_row : subject.request.first_column;
    map.positions = std::min(limits.positions, warps_run ? subject.request.rows_of(block.rows()) : subject.request.columns_of(block.columns()));
    map.levels = std::min(map.all_levels, limits.levels);
    list_dots(subject, colours, map);
    list_paths(subject, map, warps_run ? block.p()[line] : block.t()[line]);
    for (std::size_t k = 0; k < map.paths.size(); ++k) {
        SlicePath& path = map.paths[k];
        path.number = (warps_run ? block.first_end(line) : block.first_pick(line)) + k;
        path.colour = warps_run ? colours.shaded_end(path.number) : colours.shaded_pick(path.number);
        if (warps_run) continue;
        const WeftRuns::Run& run = runs.of_pick(path.number);
        path.leftwards = run.leftwards;
        if (run.woven) {
            cut(path, run, map.begin);
        } else {
            path.levels.clear();
        }
    }
    std::erase_if(map.paths, [&](const SlicePath& path) {
        return path.levels.empty() ||
               std::ranges::all_of(path.levels, [&](std::size_t level) { return level >= map.levels; });
    });
    if (!warps_run) map.turns = turns_of(map, runs);
    return map;
}

bool reaches(const SliceMap& map, const SlicePath& path, Side side) {
    return std::ranges::none_of(map.turns, [&](const SliceTurn& shown) {
        return shown.turn.side == side &&
               (shown.turn.from_pick == path.number || shown.turn.to_pick == path.number);
    });
}

std::vector<std::size_t> arrow_places(const SliceMap& map, const SlicePath& path, bool trim) {
    constexpr double shortest = 63 / across;  // three heads with their rims
    const std::size_t steps = path.levels.size() - 1;
    std::vector<std::size_t> places;
    if (steps == 0) return places;
    // Neighbours carry their arrows at different places, so that none hides another.
    for (std::size_t k = (steps / 2 + 2 * path.number) % std::min<std::size_t>(steps, 6); k < steps; k += 6) {
        if (trim && (path.loose[k] || path.loose[k + 1])) continue;
        if (drawn_length(map, path, k, trim) >= shortest) places.push_back(k);
    }
    return places;
}

bool swaps(const SliceMap& map, const SlicePath& path, std::size_t k) {
    return std::ranges::any_of(map.paths, [&](const SlicePath& other) {
        const std::size_t here = path.first + k;
        if (&other == &path || here < other.first || here + 1 > other.last()) return false;
        const std::size_t j = here - other.first;
        return (path.levels[k] < other.levels[j]) != (path.levels[k + 1] < other.levels[j + 1]);
    });
}

Point slice_point(const SliceMap& map, double position, double level) {
    return {Page::margin + left + across * position,
            Page::body_top + top + up * (static_cast<double>(map.levels) - 1 - level)};
}

}  // namespace weave
