// The edits of a drawn slice that change whole positions, or the empty places in one.

#include <weave/block/slice_draft.hpp>
#include <weave/block/slice_moves.hpp>

#include <algorithm>

namespace weave {

namespace {

std::string name_of(std::size_t position) {
    return "position " + std::to_string(position + 1);
}

Status check_position(const Slice& slice, std::size_t position) {
    if (position < slice.positions.size()) return {};
    return invalid("there is no " + name_of(position) + "; the last one is " +
                   std::to_string(slice.positions.size()));
}

std::ptrdiff_t offset(std::size_t number) {
    return static_cast<std::ptrdiff_t>(number);
}

}  // namespace

Result<Slice> insert_position(const Slice& slice, std::size_t position) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    if (position != slice.positions.size()) WEAVE_CHECK_OK(check_position(slice, position));
    std::vector<SliceYarn> places = draft.at(position > 0 ? position - 1 : 0);
    for (SliceYarn& place : places) {
        if (is_dot(slice, place)) place = {};
    }
    draft.positions().insert(draft.positions().begin() + offset(position), std::move(places));
    return std::move(draft).finish_levels("A new " + name_of(position));
}

Result<Slice> duplicate_position(const Slice& slice, std::size_t position) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_position(slice, position));
    std::vector<SliceYarn> copy = draft.at(position);
    draft.positions().insert(draft.positions().begin() + offset(position + 1), std::move(copy));
    return std::move(draft).finish_levels("The copy of " + name_of(position));
}

Result<Slice> remove_position(const Slice& slice, std::size_t position) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_position(slice, position));
    if (slice.positions.size() == 1)
        return invalid("the only position cannot be removed; a slice needs at least one");
    draft.positions().erase(draft.positions().begin() + offset(position));
    return std::move(draft).finish("Position " + std::to_string(position + 1) + " cannot be removed");
}

Result<Slice> move_position(const Slice& slice, std::size_t position, std::size_t to) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_position(slice, position));
    WEAVE_CHECK_OK(check_position(slice, to));
    auto& list = draft.positions();
    std::vector<SliceYarn> places = std::move(list[position]);
    list.erase(list.begin() + offset(position));
    list.insert(list.begin() + offset(to), std::move(places));
    return std::move(draft).finish_levels("Position " + std::to_string(position + 1));
}

Result<Slice> raise(const Slice& slice, std::size_t position, std::size_t level) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_position(slice, position));
    const std::vector<SliceYarn>& places = draft.at(position);
    const auto above = std::find_if(places.rbegin(), places.rend(),
                                    [](const SliceYarn& place) { return !place.yarn.is_empty(); });
    if (level >= static_cast<std::size_t>(places.rend() - above))
        return invalid("nothing lies at or above level " + std::to_string(level + 1) + " of " +
                       name_of(position));
    if (!places.back().yarn.is_empty()) draft.insert_level(draft.levels());
    auto& raised = draft.at(position);
    raised.insert(raised.begin() + offset(level), SliceYarn());
    raised.pop_back();  // empty, by what was done above
    return std::move(draft).finish_levels("Position " + std::to_string(position + 1));
}

Result<Slice> lower(const Slice& slice, std::size_t position, std::size_t level) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_position(slice, position));
    auto& places = draft.at(position);
    for (std::size_t below = std::min(level, places.size()); below-- > 0;) {
        if (!places[below].yarn.is_empty()) continue;
        places.erase(places.begin() + offset(below));
        places.emplace_back();
        return std::move(draft).finish("Position " + std::to_string(position + 1));
    }
    return invalid("there is no empty place below level " + std::to_string(level + 1) + " of " +
                   name_of(position));
}

Slice without_empty_levels(const Slice& slice) {
    Slice result{slice.dots, std::vector<std::vector<SliceYarn>>(slice.positions.size())};
    for (std::size_t level = 0; level < levels_of(slice); ++level) {
        const bool used = std::ranges::any_of(slice.positions, [&](const auto& places) {
            return level < places.size() && !places[level].yarn.is_empty();
        });
        if (!used) continue;
        for (std::size_t position = 0; position < slice.positions.size(); ++position) {
            const auto& places = slice.positions[position];
            result.positions[position].push_back(level < places.size() ? places[level] : SliceYarn());
        }
    }
    return result;
}

}  // namespace weave
