#include <studio/editors/slice_edits.hpp>

#include <QCoreApplication>

#include <algorithm>

namespace weave::studio {

namespace {

struct Words {
    Q_DECLARE_TR_FUNCTIONS(SliceEdits)
};

int counted(const ChosenYarns& chosen) {
    return static_cast<int>(chosen.size());
}

bool is_weft(const Slice& slice, const SliceYarnId& yarn) {
    return (slice.dots == System::weft) != yarn.path;
}

Result<SliceEdit> edited(Result<Slice> slice, const QString& what, ChosenYarns chosen) {
    if (!slice) return std::move(slice).error();
    return SliceEdit{std::move(slice).value(), what, std::move(chosen)};
}

/// `Remove weft 3 of position 2`, `Remove 4 yarns`; `many` has their number.
QString named(const QString& one, const QString& many, const Slice& slice, const ChosenYarns& chosen) {
    return chosen.size() == 1 ? one.arg(words_of(slice, *chosen.begin())) : many;
}

Status check_chosen(const ChosenYarns& chosen) {
    if (!chosen.empty()) return {};
    return invalid(Words::tr("no yarn is chosen; click on one first").toStdString());
}

Result<std::size_t> stepped(std::size_t number, int step, const QString& beyond) {
    if (step < 0 && number < static_cast<std::size_t>(-step)) return invalid(beyond.toStdString());
    return number + static_cast<std::size_t>(step);  // wraps round and back for steps down
}

}  // namespace

QString kind_of_dots(const Slice& slice) {
    return slice.dots == System::weft ? Words::tr("weft") : Words::tr("warp");
}
QString kind_of_paths(const Slice& slice) {
    return slice.dots == System::weft ? Words::tr("warp") : Words::tr("weft");
}

QString words_of(const Slice& slice, const SliceYarnId& yarn) {
    const QString kind = yarn.path ? kind_of_paths(slice) : kind_of_dots(slice);
    if (yarn.path) return Words::tr("%1 %2").arg(kind).arg(yarn.number + 1);
    return Words::tr("%1 %2 of position %3").arg(kind).arg(yarn.number + 1).arg(yarn.position + 1);
}

QString told(const Slice& slice, const SliceYarnId& yarn) {
    const auto number = card_numbers(slice).of(yarn);
    QString what = Words::tr("disabled, not woven");
    if (number)
        what = (is_weft(slice, yarn) ? Words::tr("pick %1 on the loom") : Words::tr("end %1 on the card")).arg(*number + 1);
    return Words::tr("%1: %2").arg(words_of(slice, yarn), what);
}

Result<SliceEdit> remove_chosen(const Slice& slice, const ChosenYarns& chosen) {
    WEAVE_CHECK_OK(check_chosen(chosen));
    const std::vector<SliceYarnId> list(chosen.begin(), chosen.end());
    return edited(remove_yarns(slice, list), named(Words::tr("Remove %1"), Words::tr("Remove %n yarn(s)", nullptr, counted(chosen)), slice, chosen),
                  {});
}

Result<SliceEdit> duplicate_chosen(const Slice& slice, const ChosenYarns& chosen) {
    WEAVE_CHECK_OK(check_chosen(chosen));
    Slice result = slice;
    ChosenYarns copies;
    // The last first, so that the numbers of those before stay; each copy moves on by the copies made before
    // it.
    for (auto yarn = chosen.rbegin(); yarn != chosen.rend(); ++yarn) {
        WEAVE_TRY(result, duplicate_yarn(result, *yarn));
        const auto before = std::ranges::count_if(chosen, [&](const SliceYarnId& other) {
            return other.path == yarn->path && other.position == yarn->position &&
                   other.number < yarn->number;
        });
        SliceYarnId copy = *yarn;
        copy.number += 1 + static_cast<std::size_t>(before);
        copies.insert(copy);
    }
    return edited(std::move(result), named(Words::tr("Duplicate %1"), Words::tr("Duplicate %n yarn(s)", nullptr, counted(chosen)), slice, chosen),
                  copies);
}

Result<SliceEdit> move_chosen(const Slice& slice, const ChosenYarns& chosen, int up, int right) {
    WEAVE_CHECK_OK(check_chosen(chosen));
    if (right != 0 && chosen.size() > 1)
        return invalid(Words::tr("only one yarn at a time can go to another position").toStdString());
    std::vector<SliceYarnId> list(chosen.begin(), chosen.end());
    std::ranges::sort(list, [&](const SliceYarnId& a, const SliceYarnId& b) {  // who goes ahead makes room
        return up > 0 ? level_of(slice, a, 0) > level_of(slice, b, 0)
                      : level_of(slice, a, 0) < level_of(slice, b, 0);
    });
    Slice result = slice;
    ChosenYarns moved;
    for (const SliceYarnId& yarn : list) {
        const std::size_t here = level_of(result, yarn, 0).value_or(0);
        WEAVE_TRY(const std::size_t level,
                  stepped(here, up, Words::tr("%1 lies at the bottom already").arg(words_of(slice, yarn))));
        if (right == 0) {
            WEAVE_TRY(result, move_dot(result, yarn, level));
            moved.insert(yarn);
            continue;
        }
        WEAVE_TRY(const std::size_t position,
                  stepped(yarn.position, right,
                          Words::tr("%1 is at the first position already").arg(words_of(slice, yarn))));
        WEAVE_TRY(result, move_dot_to_position(result, yarn, position, level));
        moved.insert(SliceYarnId::dot(position, dots_at(result, position) - 1));
    }
    return edited(std::move(result), named(Words::tr("Move %1"), Words::tr("Move %n yarn(s)", nullptr, counted(chosen)), slice, chosen), moved);
}

Result<SliceEdit> move_path(const Slice& slice, std::size_t path, std::size_t position, int up) {
    const SliceYarnId yarn = SliceYarnId::run(path);
    const QString dots = kind_of_dots(slice);
    const std::size_t gap = gap_of(slice, path, position);
    if (up > 0 && gap == dots_at(slice, position))
        return invalid(Words::tr("%1 runs above every %2 of position %3 already")
                           .arg(words_of(slice, yarn), dots)
                           .arg(position + 1)
                           .toStdString());
    WEAVE_TRY(const std::size_t to, stepped(gap, up,
                                            Words::tr("%1 runs below every %2 of position %3 already")
                                                .arg(words_of(slice, yarn), dots)
                                                .arg(position + 1)));
    return draw_path(slice, path, {{position, to, {}}});
}

Result<SliceEdit> renumber_chosen(const Slice& slice, const ChosenYarns& chosen, int later) {
    WEAVE_CHECK_OK(check_chosen(chosen));
    if (chosen.size() > 1)
        return invalid(Words::tr("choose one yarn alone to change its place in the order").toStdString());
    SliceYarnId yarn = *chosen.begin();
    const std::size_t yarns = yarn.path ? paths_of(slice) : dots_at(slice, yarn.position);
    const QString first = yarn.path ? Words::tr("%1 is the first on the loom already")
                                    : Words::tr("%1 is the first of its position on the loom already");
    const QString last = yarn.path ? Words::tr("%1 is the last on the loom already")
                                   : Words::tr("%1 is the last of its position on the loom already");
    if (later > 0 && yarn.number + 1 >= yarns) return invalid(last.arg(words_of(slice, yarn)).toStdString());
    WEAVE_TRY(const std::size_t number, stepped(yarn.number, later, first.arg(words_of(slice, yarn))));
    const QString what = Words::tr("Renumber %1").arg(words_of(slice, yarn));
    Result<Slice> result = renumber_yarn(slice, yarn, number);
    yarn.number = number;
    return edited(std::move(result), what, {yarn});
}

Result<SliceEdit> enable_chosen(const Slice& slice, const ChosenYarns& chosen) {
    WEAVE_CHECK_OK(check_chosen(chosen));
    const bool enable =
        std::ranges::all_of(chosen, [&](const SliceYarnId& yarn) { return is_disabled(slice, yarn); });
    Slice result = slice;
    for (const SliceYarnId& yarn : chosen) {
        WEAVE_TRY(result, set_enabled(result, yarn, enable));
    }
    const QString one = enable ? Words::tr("Enable %1") : Words::tr("Disable %1");
    const QString many = enable ? Words::tr("Enable %n weft(s)", nullptr, counted(chosen)) : Words::tr("Disable %n weft(s)", nullptr, counted(chosen));
    return edited(std::move(result),
                  named(one, many, slice, chosen), chosen);
}

Result<SliceEdit> add_like(const Slice& slice, const ChosenYarns& chosen) {
    if (chosen.empty()) return draw_new_path(slice, {});
    const SliceYarnId yarn = *chosen.rbegin();
    if (!yarn.path) return add_dot_at(slice, yarn.position, level_of(slice, yarn, 0).value_or(0) + 1);
    std::vector<PathStep> steps;
    for (std::size_t position = 0; position < slice.positions.size(); ++position)
        steps.push_back({position, gap_of(slice, yarn.number, position), level_of(slice, yarn, position)});
    return draw_new_path(slice, steps);
}

Result<SliceEdit> add_dot_at(const Slice& slice, std::size_t position, std::size_t level) {
    const std::size_t number = position < slice.positions.size() ? dots_at(slice, position) : 0;
    const QString what = Words::tr("Add %1 to position %2").arg(kind_of_dots(slice)).arg(position + 1);
    return edited(add_dot(slice, position, level), what, {SliceYarnId::dot(position, number)});
}

Result<SliceEdit> draw_path(const Slice& slice, std::size_t path, const std::vector<PathStep>& steps) {
    const SliceYarnId yarn = SliceYarnId::run(path);
    return edited(route_path(slice, path, steps), Words::tr("Draw %1").arg(words_of(slice, yarn)), {yarn});
}

Result<SliceEdit> draw_new_path(const Slice& slice, const std::vector<PathStep>& steps) {
    return edited(add_path(slice, steps), Words::tr("Add a %1").arg(kind_of_paths(slice)),
                  {SliceYarnId::run(paths_of(slice))});
}

Result<SliceEdit> edit_position(const Slice& slice, PositionEdit edit, std::size_t position,
                                std::size_t level) {
    const auto name = [&](const QString& words) { return words.arg(position + 1); };
    switch (edit) {
        case PositionEdit::insert:
            return edited(insert_position(slice, position + 1), Words::tr("Insert position %1").arg(position + 2),
                          {});
        case PositionEdit::duplicate:
            return edited(duplicate_position(slice, position), name(Words::tr("Duplicate position %1")), {});
        case PositionEdit::remove:
            return edited(remove_position(slice, position), name(Words::tr("Remove position %1")), {});
        case PositionEdit::earlier: {
            WEAVE_TRY(const std::size_t to, stepped(position, -1, Words::tr("it is the first position already")));
            return edited(move_position(slice, position, to), name(Words::tr("Move position %1")), {});
        }
        case PositionEdit::later:
            if (position + 1 >= slice.positions.size())
                return invalid(Words::tr("it is the last position already").toStdString());
            return edited(move_position(slice, position, position + 1), name(Words::tr("Move position %1")), {});
        case PositionEdit::raise:
            return edited(raise(slice, position, level), name(Words::tr("Raise yarns of position %1")), {});
        case PositionEdit::lower:
            break;
    }
    return edited(lower(slice, position, level), name(Words::tr("Lower yarns of position %1")), {});
}

Result<SliceEdit> close_up_levels(const Slice& slice) {
    Slice closed = without_empty_levels(slice);
    if (levels_of(closed) == levels_of(slice))
        return invalid(Words::tr("no level is empty all along").toStdString());
    return edited(std::move(closed), Words::tr("Close up empty levels"), {});
}

Result<SliceEdit> turn(const Slice& slice) {
    Slice turned = slice;
    turned.dots = slice.dots == System::weft ? System::warp : System::weft;
    for (std::vector<SliceYarn>& position : turned.positions) {
        for (SliceYarn& place : position) {
            const Slot yarn = place.yarn;
            if (yarn.is_empty()) continue;
            place.yarn = yarn.is_weft() ? Slot::warp(yarn.index(), yarn.is_loose()) : Slot::weft(yarn.index(), yarn.is_loose());
        }
    }
    if (const Result<Block> block = to_block(turned); !block) return block.error();
    const QString what = turned.dots == System::weft ? Words::tr("Draw along the warp") : Words::tr("Draw along the weft");
    return SliceEdit{std::move(turned), what, {}};
}

}  // namespace weave::studio
