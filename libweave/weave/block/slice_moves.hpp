#pragma once

#include <weave/block/slice_numbers.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace weave {

// Every edit of a drawn slice, as a function from slice to slice. A result always passes to_block(); an error
// says which yarn it is about and why (positions, yarns and levels counted from 1). Yarns that are not named
// keep their order in every position. A level that the edit leaves without any yarn goes; all others stay,
// empty ones too.

/// A slice to begin with: in each position one dot above the only path.
Result<Slice> new_slice(System dots, std::size_t positions);

/// Where a path runs at one position: above exactly `gap` of the dots that the position draws. It takes the
/// empty place in that gap that is nearest to `level`, or a level of its own.
struct PathStep {
    std::size_t position = 0, gap = 0;
    std::optional<std::size_t> level;  ///< absent: nearest to where the path was, or came from
    friend bool operator==(const PathStep&, const PathStep&) = default;
};
/// Runs a path through other gaps; at positions that no step names it stays where it is.
Result<Slice> route_path(const Slice& slice, std::size_t path, std::span<const PathStep> steps);
/// A new path, the last one on the card; at positions that no step names it runs in the gap of the nearest
/// one to the left that has a step, else of the first.
Result<Slice> add_path(const Slice& slice, std::span<const PathStep> steps);

/// A new dot, the last of its position on the loom (or card): in the place at `level` if that is empty, else
/// in a level of its own below what lies there. Levels above the slice are filled up.
Result<Slice> add_dot(const Slice& slice, std::size_t position, std::size_t level);

/// The same yarn once more: it lies right above, in the same gaps, and comes next after it on loom and card.
Result<Slice> duplicate_yarn(const Slice& slice, const SliceYarnId& yarn);
/// Takes yarns out; the numbers of the others close up.
Result<Slice> remove_yarns(const Slice& slice, std::span<const SliceYarnId> yarns);

/// Moves a dot to another level of its position; where it meets others they take one step towards
/// where it was.
Result<Slice> move_dot(const Slice& slice, const SliceYarnId& dot, std::size_t level);
/// Moves a dot to another position, where it becomes the last on the loom (or card); see add_dot().
Result<Slice> move_dot_to_position(const Slice& slice, const SliceYarnId& dot, std::size_t position,
                                   std::size_t level);

/// Gives a yarn another place in the order on loom and card: of a dot among those of its position, of a path
/// among all paths. `number` counts what is drawn, from 0.
Result<Slice> renumber_yarn(const Slice& slice, const SliceYarnId& yarn, std::size_t number);

/// Lets a weft be woven, or only drawn. Ends cannot be disabled.
Result<Slice> set_enabled(const Slice& slice, const SliceYarnId& yarn, bool enabled);

/// A position without dots before `position` (or after the last), where each path runs as it does beside it.
Result<Slice> insert_position(const Slice& slice, std::size_t position);
/// The position once more, after it.
Result<Slice> duplicate_position(const Slice& slice, std::size_t position);
Result<Slice> remove_position(const Slice& slice, std::size_t position);
/// The position comes to stand where that of number `to` stands now.
Result<Slice> move_position(const Slice& slice, std::size_t position, std::size_t to);

/// An empty place below `level` at one position: what lies from there on up is raised by one.
Result<Slice> raise(const Slice& slice, std::size_t position, std::size_t level);
/// Takes out the next empty place below `level`: what lies above it is lowered by one. An error where there
/// is none.
Result<Slice> lower(const Slice& slice, std::size_t position, std::size_t level);
/// The slice without the levels that no yarn lies in.
Slice without_empty_levels(const Slice& slice);

}  // namespace weave
