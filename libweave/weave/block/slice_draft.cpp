#include <weave/block/slice_draft.hpp>

#include <algorithm>

namespace weave {

namespace {

bool has_yarn_at(const Slice& slice, std::size_t level) {
    return std::ranges::any_of(slice.positions,
                               [&](const auto& places) { return !places[level].yarn.is_empty(); });
}

/// Whether some weft (or warp) of the slice is woven.
bool weaves(const Slice& slice, System system) {
    const SliceNumbers numbers = card_numbers(slice);
    const auto any = [](const auto& list) {
        return std::ranges::any_of(list, [](const auto& number) { return number.has_value(); });
    };
    return system == slice.dots ? std::ranges::any_of(numbers.dots, any) : any(numbers.paths);
}

std::ptrdiff_t offset(std::size_t number) {
    return static_cast<std::ptrdiff_t>(number);
}

}  // namespace

SliceDraft::SliceDraft(Slice slice) : m_slice(std::move(slice)) {
    const std::size_t levels = levels_of(m_slice);
    for (auto& places : m_slice.positions) places.resize(levels);
    for (std::size_t level = 0; level < levels; ++level) m_was_empty.push_back(!has_yarn_at(m_slice, level));
}

Result<SliceDraft> SliceDraft::open(const Slice& slice) {
    WEAVE_CHECK_OK(to_block(slice));
    return SliceDraft(slice);
}

void SliceDraft::insert_level(std::size_t level) {
    for (auto& places : m_slice.positions) places.insert(places.begin() + offset(level), SliceYarn());
    m_was_empty.insert(m_was_empty.begin() + offset(level), false);
}

void SliceDraft::erase_level(std::size_t level) {
    for (auto& places : m_slice.positions) places.erase(places.begin() + offset(level));
    m_was_empty.erase(m_was_empty.begin() + offset(level));
}

SliceYarn SliceDraft::lift(std::size_t position, std::size_t level) {
    return std::exchange(m_slice.positions[position][level], SliceYarn());
}

void SliceDraft::lay(std::size_t position, std::size_t gap, std::size_t wish, const SliceYarn& yarn) {
    const auto& places = m_slice.positions[position];
    std::size_t low = 0, dots = 0;  // the gap is the levels from `low` to before `high`
    while (dots < gap && low < levels()) dots += is_dot(m_slice, places[low++]) ? 1U : 0U;
    std::size_t high = low;
    while (high < levels() && !is_dot(m_slice, places[high])) ++high;
    const auto away = [&](std::size_t level) { return level > wish ? level - wish : wish - level; };
    std::optional<std::size_t> best;
    for (std::size_t level = low; level < high; ++level) {
        if (places[level].yarn.is_empty() && (!best || away(level) < away(*best))) best = level;
    }
    if (!best) {
        best = std::clamp(wish, low, high);
        insert_level(*best);
    }
    m_slice.positions[position][*best] = yarn;
}

void SliceDraft::renumber_dots(std::size_t position, const std::function<std::size_t(std::size_t)>& number) {
    for (SliceYarn& place : m_slice.positions[position]) {
        if (is_dot(m_slice, place)) place.yarn = place.yarn.renumbered(number(place.yarn.index()));
    }
}

void SliceDraft::renumber_paths(const std::function<std::size_t(std::size_t)>& number) {
    for (auto& places : m_slice.positions) {
        for (SliceYarn& place : places) {
            if (is_path(m_slice, place)) place.yarn = place.yarn.renumbered(number(place.yarn.index()));
        }
    }
}

Result<Slice> SliceDraft::finish(const std::string& subject) && {
    for (std::size_t level = levels(); level-- > 0;) {
        if (!m_was_empty[level] && !has_yarn_at(m_slice, level)) erase_level(level);
    }
    return std::move(*this).finish_levels(subject);
}

Result<Slice> SliceDraft::finish_levels(const std::string& subject) && {
    if (!weaves(m_slice, System::weft))
        return invalid(subject + ": no weft would be woven any more; a slice needs at least one pick");
    if (!weaves(m_slice, System::warp))
        return invalid(subject + ": no warp would be left; a slice needs at least one end");
    if (Result<Block> made = to_block(m_slice); !made)
        return invalid(subject + ": " + made.error().message, made.error().where);
    return std::move(m_slice);
}

}  // namespace weave
