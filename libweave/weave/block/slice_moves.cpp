#include <weave/block/slice_moves.hpp>

#include <weave/block/slice_draft.hpp>

#include <algorithm>

namespace weave {

namespace {

Status check_holds(const Slice& slice, const SliceYarnId& yarn) {
    if (holds(slice, yarn)) return {};
    return invalid("the slice has no " + in_words(slice, yarn));
}

Status check_position(const Slice& slice, std::size_t position) {
    if (position < slice.positions.size()) return {};
    return invalid("there is no position " + std::to_string(position + 1) + "; the last one is " +
                   std::to_string(slice.positions.size()));
}

Status check_step(const Slice& slice, const PathStep& step, const std::string& subject) {
    WEAVE_CHECK_OK(check_position(slice, step.position));
    const std::size_t dots = dots_at(slice, step.position);
    if (step.gap <= dots) return {};
    return invalid(subject + " cannot run above " + std::to_string(step.gap) + " dots of position " +
                   std::to_string(step.position + 1) + ", which has " + std::to_string(dots));
}

/// The kind of yarn that runs along the slice, or is seen end-on, under a number.
SliceYarn yarn_of(const Slice& slice, bool path, std::size_t number) {
    const bool weft = (slice.dots == System::weft) != path;
    return {weft ? Slot::weft(number) : Slot::warp(number), false};
}

/// Puts a dot at `level`, or into a level of its own below it.
void put_dot(SliceDraft& draft, std::size_t position, std::size_t level, const SliceYarn& dot) {
    while (draft.levels() <= level) draft.insert_level(draft.levels());
    if (!draft.is_empty(position, level)) draft.insert_level(level);
    draft.at(position)[level] = dot;
}

/// No level is asked for so far up that filling up to it would take memory for nothing.
Status check_level(std::size_t level) {
    if (level < most_height) return {};
    return invalid("level " + std::to_string(level + 1) + " is higher than the " +
                   std::to_string(most_height) + " levels that a block may have");
}

std::string sentence(std::string words) {
    if (!words.empty() && words[0] >= 'a' && words[0] <= 'z')
        words[0] = static_cast<char>(words[0] - 'a' + 'A');
    return words;
}

}  // namespace

Result<Slice> new_slice(System dots, std::size_t positions) {
    Slice slice{dots, {}};
    slice.positions.assign(std::min(positions, std::size_t{most_yarns} + 1), {SliceYarn(), SliceYarn()});
    for (auto& places : slice.positions) {
        places[0] = yarn_of(slice, true, 0);
        places[1] = yarn_of(slice, false, 0);
    }
    WEAVE_CHECK_OK(to_block(slice));
    return slice;
}

Result<Slice> route_path(const Slice& slice, std::size_t path, std::span<const PathStep> steps) {
    const SliceYarnId yarn = SliceYarnId::run(path);
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_holds(slice, yarn));
    const std::string subject = sentence(in_words(slice, yarn));
    for (const PathStep& step : steps) {
        WEAVE_CHECK_OK(check_step(slice, step, subject));
        const std::size_t was = level_of(draft.slice(), yarn, step.position).value();
        if (gap_of(draft.slice(), path, step.position) == step.gap && !step.level) continue;
        const SliceYarn lifted = draft.lift(step.position, was);
        draft.lay(step.position, step.gap, step.level.value_or(was), lifted);
    }
    return std::move(draft).finish(subject);
}

Result<Slice> add_path(const Slice& slice, std::span<const PathStep> steps) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    const std::size_t path = paths_of(slice);
    const std::string subject = "The new " + in_words(slice, SliceYarnId::run(path));
    std::vector<std::optional<PathStep>> at(slice.positions.size());
    for (const PathStep& step : steps) {
        WEAVE_CHECK_OK(check_step(slice, step, subject));
        at[step.position] = step;
    }
    const auto first = std::ranges::find_if(at, [](const auto& step) { return step.has_value(); });
    std::size_t gap = first == at.end() ? 0 : (*first)->gap;
    std::size_t wish = first == at.end() ? 0 : (*first)->level.value_or(0);
    for (std::size_t position = 0; position < at.size(); ++position) {
        if (at[position]) {
            gap = at[position]->gap;
            wish = at[position]->level.value_or(wish);
        }
        draft.lay(position, std::min(gap, dots_at(slice, position)), wish, yarn_of(slice, true, path));
        wish = level_of(draft.slice(), SliceYarnId::run(path), position).value();
    }
    return std::move(draft).finish(subject);
}

Result<Slice> add_dot(const Slice& slice, std::size_t position, std::size_t level) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_position(slice, position));
    WEAVE_CHECK_OK(check_level(level));
    const SliceYarnId dot = SliceYarnId::dot(position, dots_at(slice, position));
    put_dot(draft, position, level, yarn_of(slice, false, dot.number));
    return std::move(draft).finish_levels("The new " + in_words(slice, dot));
}

Result<Slice> duplicate_yarn(const Slice& slice, const SliceYarnId& yarn) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_holds(slice, yarn));
    const auto make_room = [&](std::size_t number) { return number > yarn.number ? number + 1 : number; };
    const auto copy_at = [&](std::size_t position) {
        const std::size_t level = level_of(draft.slice(), yarn, position).value();
        SliceYarn copy = draft.at(position)[level];
        copy.yarn = copy.yarn.renumbered(yarn.number + 1);
        put_dot(draft, position, level + 1, copy);
    };
    if (yarn.path) {
        draft.renumber_paths(make_room);
        for (std::size_t position = 0; position < slice.positions.size(); ++position) copy_at(position);
    } else {
        draft.renumber_dots(yarn.position, make_room);
        copy_at(yarn.position);
    }
    return std::move(draft).finish("The copy of " + in_words(slice, yarn));
}

Result<Slice> remove_yarns(const Slice& slice, std::span<const SliceYarnId> yarns) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    std::vector<SliceYarnId> list(yarns.begin(), yarns.end());
    std::ranges::sort(list, std::greater<>());  // the last first, so that no number changes before its turn
    list.erase(std::unique(list.begin(), list.end()), list.end());
    for (const SliceYarnId& yarn : list) {
        WEAVE_CHECK_OK(check_holds(slice, yarn));
        const auto close_up = [&](std::size_t number) { return number > yarn.number ? number - 1 : number; };
        const std::size_t first = yarn.path ? 0 : yarn.position;
        const std::size_t after = yarn.path ? slice.positions.size() : yarn.position + 1;
        for (std::size_t position = first; position < after; ++position)
            draft.lift(position, level_of(draft.slice(), yarn, position).value());
        yarn.path ? draft.renumber_paths(close_up) : draft.renumber_dots(yarn.position, close_up);
    }
    const std::string subject = list.size() == 1 ? sentence(in_words(slice, list[0])) : "The yarns chosen";
    return std::move(draft).finish(subject + " cannot be removed");
}

Result<Slice> move_dot(const Slice& slice, const SliceYarnId& dot, std::size_t level) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    if (dot.path)
        return invalid(sentence(in_words(slice, dot)) + " runs along the slice; draw its way instead");
    WEAVE_CHECK_OK(check_holds(slice, dot));
    WEAVE_CHECK_OK(check_level(level));
    while (draft.levels() <= level) draft.insert_level(draft.levels());
    auto& places = draft.at(dot.position);
    const std::size_t from = level_of(draft.slice(), dot, 0).value();
    const SliceYarn moved = draft.lift(dot.position, from);
    std::size_t room = level;  // the next empty place on the way back to where it was
    while (!places[room].yarn.is_empty()) from < level ? --room : ++room;
    for (; room != level; from < level ? ++room : --room)
        std::swap(places[room], places[from < level ? room + 1 : room - 1]);
    places[level] = moved;
    return std::move(draft).finish(sentence(in_words(slice, dot)));
}

Result<Slice> move_dot_to_position(const Slice& slice, const SliceYarnId& dot, std::size_t position,
                                   std::size_t level) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    const std::string subject = sentence(in_words(slice, dot));
    if (dot.path) return invalid(subject + " runs through all positions already");
    WEAVE_CHECK_OK(check_holds(slice, dot));
    WEAVE_CHECK_OK(check_position(slice, position));
    WEAVE_CHECK_OK(check_level(level));
    if (position == dot.position) return move_dot(slice, dot, level);
    SliceYarn moved = draft.lift(dot.position, level_of(slice, dot, 0).value());
    draft.renumber_dots(dot.position,
                        [&](std::size_t number) { return number > dot.number ? number - 1 : number; });
    moved.yarn = moved.yarn.renumbered(dots_at(slice, position));
    put_dot(draft, position, level, moved);
    return std::move(draft).finish(subject);
}

Result<Slice> renumber_yarn(const Slice& slice, const SliceYarnId& yarn, std::size_t number) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_holds(slice, yarn));
    const std::size_t yarns = yarn.path ? paths_of(slice) : dots_at(slice, yarn.position);
    if (number >= yarns) {
        return invalid(
            sentence(in_words(slice, yarn)) + " cannot become number " + std::to_string(number + 1) +
            (yarn.path ? ": there are only " : ": its position has only ") + std::to_string(yarns));
    }
    const auto moved = [&](std::size_t other) {
        if (other == yarn.number) return number;
        if (yarn.number < other && other <= number) return other - 1;
        return number <= other && other < yarn.number ? other + 1 : other;
    };
    yarn.path ? draft.renumber_paths(moved) : draft.renumber_dots(yarn.position, moved);
    return std::move(draft).finish_levels(sentence(in_words(slice, yarn)));
}

Result<Slice> set_enabled(const Slice& slice, const SliceYarnId& yarn, bool enabled) {
    WEAVE_TRY(SliceDraft draft, SliceDraft::open(slice));
    WEAVE_CHECK_OK(check_holds(slice, yarn));
    const std::string subject = sentence(in_words(slice, yarn));
    if ((slice.dots == System::weft) == yarn.path)
        return invalid(subject +
                       " is an end, which runs through the whole cloth; only wefts can be disabled");
    const std::size_t first = yarn.path ? 0 : yarn.position;
    const std::size_t after = yarn.path ? slice.positions.size() : yarn.position + 1;
    for (std::size_t position = first; position < after; ++position)
        draft.at(position)[level_of(slice, yarn, position).value()].disabled = !enabled;
    return std::move(draft).finish_levels(subject + " cannot be disabled");
}

}  // namespace weave
