#pragma once

#include <weave/block/slice_moves.hpp>

#include <QString>

#include <set>

namespace weave::studio {

using ChosenYarns = std::set<SliceYarnId>;

/// A slice after an edit, what the edit is called in the list of undo, and what is chosen afterwards.
struct SliceEdit {
    Slice slice;
    QString what;
    ChosenYarns chosen;
};

/// `weft 3 of position 2`, `warp 1`; and the same with what it is on the loom.
QString words_of(const Slice& slice, const SliceYarnId& yarn);
QString told(const Slice& slice, const SliceYarnId& yarn);
/// `weft` or `warp`, as the slice's dots (or paths) are.
QString kind_of_dots(const Slice& slice);
QString kind_of_paths(const Slice& slice);

// What a person asks of the chosen yarns; each is one edit. Errors as the moves of the library tell them.
Result<SliceEdit> remove_chosen(const Slice& slice, const ChosenYarns& chosen);
Result<SliceEdit> duplicate_chosen(const Slice& slice, const ChosenYarns& chosen);
/// Dots by so many levels and positions.
Result<SliceEdit> move_chosen(const Slice& slice, const ChosenYarns& chosen, int up, int right);
/// A path over, or under, the next dot at one position.
Result<SliceEdit> move_path(const Slice& slice, std::size_t path, std::size_t position, int up);
/// One yarn earlier (-1) or later (1) on loom and card.
Result<SliceEdit> renumber_chosen(const Slice& slice, const ChosenYarns& chosen, int later);
/// Disables the chosen wefts, or enables them if none of them is woven.
Result<SliceEdit> enable_chosen(const Slice& slice, const ChosenYarns& chosen);
/// A new yarn of the kind of the chosen one: a dot above it, or a path in the same gaps.
Result<SliceEdit> add_like(const Slice& slice, const ChosenYarns& chosen);
Result<SliceEdit> add_dot_at(const Slice& slice, std::size_t position, std::size_t level);
Result<SliceEdit> draw_path(const Slice& slice, std::size_t path, const std::vector<PathStep>& steps);
Result<SliceEdit> draw_new_path(const Slice& slice, const std::vector<PathStep>& steps);

enum class PositionEdit { insert, duplicate, remove, earlier, later, raise, lower };
/// What becomes of a whole position; raise and lower begin at `level`.
Result<SliceEdit> edit_position(const Slice& slice, PositionEdit edit, std::size_t position,
                                std::size_t level);
Result<SliceEdit> close_up_levels(const Slice& slice);
/// The same drawing along the other system: what were wefts are warps. A disabled weft stands in the way, as warps cannot be disabled.
Result<SliceEdit> turn(const Slice& slice);

}  // namespace weave::studio
