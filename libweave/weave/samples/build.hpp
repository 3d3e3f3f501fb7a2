#pragma once

#include <weave/design/design.hpp>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// What the shipped designs are built with. Only the samples include this.
namespace weave::sample {

/// Which wefts of a cell lie below an end: bit w for weft w of the row.
using Below = std::uint32_t;

/// The lowest `count` wefts.
constexpr Below lowest(std::size_t count) {
    return (Below{1} << count) - 1;
}

/// One end of a cell: the wefts that lie below it, and whether it is loose on purpose.
struct End {
    Below below = 0;
    bool loose = false;
};

/// The end at a height among wefts that are numbered from the bottom up: it lies over the lowest `height` of
/// them.
constexpr End at(std::size_t height) {
    return {lowest(height), false};
}
constexpr End loose_at(std::size_t height) {
    return {lowest(height), true};
}

/// The stack of `wefts` wefts (at most 31) in which every end lies as asked; of yarns that could change
/// places the lower number lies lower. The ends below one weft must include those below every weft that is
/// lower, or there is no such stack: an assertion.
Stack cell(std::size_t wefts, std::span<const End> ends, Below loose_wefts = 0);
inline Stack cell(std::size_t wefts, std::initializer_list<End> ends, Below loose_wefts = 0) {
    return cell(wefts, std::span(ends.begin(), ends.size()), loose_wefts);
}

/// A leaf of `rows` x `columns` cells, `wefts` picks a row and `warps` ends a column; `stack_of_cell(i, j)`
/// must be good.
template <class StackOfCell>
NodePtr stacks(std::size_t rows, std::size_t columns, std::uint32_t wefts, std::uint32_t warps,
               StackOfCell stack_of_cell) {
    auto block = make_block(std::vector<std::uint32_t>(rows, wefts),
                            std::vector<std::uint32_t>(columns, warps), stack_of_cell);
    return std::make_shared<const Node>(
        Node{StacksLeaf{std::make_shared<const Block>(std::move(block).value())}, {}});
}

/// A leaf that is one warp slice, from the stacks of its rows.
NodePtr warp_slice_of(const std::vector<Stack>& rows);

NodePtr preset(std::string family, std::map<std::string, std::int64_t> options);
NodePtr tiled(std::string of, std::size_t x, std::size_t y);
NodePtr attached(std::string of, std::string other, Face face);
NodePtr stencilled(std::vector<std::string> of, StencilMap map);
NodePtr renumbered(std::string of, std::size_t row, std::vector<std::size_t> order);

/// A kind of yarn whose stiffness follows from what it is made of.
YarnType yarn(std::string name, std::string_view colour, double radius_mm, double tex, double stretch_N,
              double bend_N_mm2);
YarnType roving(std::string name, std::string_view shade, double radius_mm, double tex);
YarnType cotton(std::string name, std::string_view colour, double radius_mm = 0.12, double tex = 30);
Colour colour(std::string_view text);

/// A design with these yarns, each system of one kind, one beam and one feeder, woven in a periodic repeat.
Design cloth(std::string title, std::string notes, YarnType warp, YarnType weft);
/// Adds a block, and makes it the root.
void add(Design& design, const std::string& name, NodePtr node);

}  // namespace weave::sample
