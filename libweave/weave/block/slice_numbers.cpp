#include <weave/block/slice_numbers.hpp>

#include <algorithm>

namespace weave {

namespace {

std::size_t count_of(const Slice& slice, std::size_t position, bool paths) {
    return static_cast<std::size_t>(std::ranges::count_if(
        slice.positions[position],
        [&](const SliceYarn& place) { return paths ? is_path(slice, place) : is_dot(slice, place); }));
}

}  // namespace

std::size_t dots_at(const Slice& slice, std::size_t position) {
    return count_of(slice, position, false);
}

std::size_t paths_of(const Slice& slice) {
    return slice.positions.empty() ? 0 : count_of(slice, 0, true);
}

std::size_t levels_of(const Slice& slice) {
    std::size_t levels = 0;
    for (const auto& position : slice.positions) levels = std::max(levels, position.size());
    return levels;
}

std::optional<std::size_t> level_of(const Slice& slice, const SliceYarnId& yarn, std::size_t position) {
    if (!yarn.path) position = yarn.position;
    if (position >= slice.positions.size()) return {};
    const auto& places = slice.positions[position];
    for (std::size_t level = 0; level < places.size(); ++level) {
        const bool kind = yarn.path ? is_path(slice, places[level]) : is_dot(slice, places[level]);
        if (kind && places[level].yarn.index() == yarn.number) return level;
    }
    return {};
}

bool holds(const Slice& slice, const SliceYarnId& yarn) {
    return level_of(slice, yarn, 0).has_value();
}

std::size_t gap_of(const Slice& slice, std::size_t path, std::size_t position) {
    const auto& places = slice.positions[position];
    const auto top = static_cast<std::ptrdiff_t>(level_of(slice, SliceYarnId::run(path), position).value());
    return static_cast<std::size_t>(std::count_if(
        places.begin(), places.begin() + top, [&](const SliceYarn& place) { return is_dot(slice, place); }));
}

bool is_disabled(const Slice& slice, const SliceYarnId& yarn) {
    const auto disabled_at = [&](std::size_t position) {
        const auto level = level_of(slice, yarn, position);
        return level && slice.positions[position][*level].disabled;
    };
    if (!yarn.path) return disabled_at(yarn.position);
    for (std::size_t position = 0; position < slice.positions.size(); ++position)
        if (disabled_at(position)) return true;
    return false;
}

SliceNumbers card_numbers(const Slice& slice) {
    SliceNumbers numbers;
    std::vector<bool> off(paths_of(slice));
    std::size_t next = 0;
    for (std::size_t position = 0; position < slice.positions.size(); ++position) {
        std::vector<bool> dot_off(dots_at(slice, position));
        for (const SliceYarn& place : slice.positions[position]) {
            if (!place.disabled || place.yarn.is_empty()) continue;
            std::vector<bool>& marks = is_dot(slice, place) ? dot_off : off;
            if (place.yarn.index() < marks.size()) marks[place.yarn.index()] = true;
        }
        auto& here = numbers.dots.emplace_back();
        for (const bool is_off : dot_off)
            here.push_back(is_off ? std::nullopt : std::optional<std::size_t>(next++));
    }
    next = 0;
    for (const bool is_off : off)
        numbers.paths.push_back(is_off ? std::nullopt : std::optional<std::size_t>(next++));
    return numbers;
}

std::string in_words(const Slice& slice, const SliceYarnId& yarn) {
    const bool weft = (slice.dots == System::weft) != yarn.path;
    std::string words = (weft ? "weft " : "warp ") + std::to_string(yarn.number + 1);
    if (!yarn.path) words += " of position " + std::to_string(yarn.position + 1);
    return words;
}

}  // namespace weave
