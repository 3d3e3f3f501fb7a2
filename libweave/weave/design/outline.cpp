#include <weave/design/outline.hpp>

#include <weave/block/card_bits.hpp>
#include <weave/block/from_card.hpp>
#include <weave/block/stack_moves.hpp>
#include <weave/design/extent_to_be.hpp>
#include <weave/design/tree.hpp>

#include <algorithm>
#include <map>

namespace weave {

namespace {

using Counts = std::vector<std::uint32_t>;

/// What is held and copied meanwhile may come to so much, in units of 4 bytes (256 MB); else the cloth is
/// evaluated.
constexpr std::size_t most_units = std::size_t{1} << 26;
/// The deepest tree: each level takes room on the program's stack.
constexpr std::size_t most_levels = 256;
constexpr std::size_t units_of_a_stack = 16;  ///< beside its slots

/// One block of the design, as far as it is known.
struct Part {
    const Node* node = nullptr;
    std::vector<const Part*> children;
    std::size_t levels = 1;  ///< of the tree below it, itself included
    BlockPtr block;          ///< a leaf that is laid out; else null
    BlockGrid grid;
    Extent extent;                         ///< at most, as to stacks and slots
    std::map<std::size_t, Stack> flipped;  ///< by cell
};

/// Walks the tree from the bottom up. Every function that can fail says so where the way of few stacks ends,
/// be it because something is wrong or because it would cost too much.
class Draughtsman {
  public:
    std::optional<Outline> draw(const Design& design, std::optional<CardPlace> place);
    /// Why the cloth cannot be woven, where its counts tell so.
    [[nodiscard]] const std::optional<Error>& error() const { return m_error; }

  private:
    bool put_together(Part& part);
    bool lay_out(Part& part);
    static Extent extent_of_part(const Part& part);
    bool flip(Part& part, const std::string& name);
    std::optional<Stack> stack(const Part& part, std::size_t row, std::size_t column);
    std::optional<Stack> unflipped(const Part& part, std::size_t row, std::size_t column);
    bool spend(std::size_t units) {
        if (units > m_units) return false;
        m_units -= units;
        return true;
    }

    // The grid of a block that is made from others, whose counts fit; nothing where more than those must be looked at.
    static std::optional<BlockGrid> grid_of(const TileOperation& operation, const Part& part);
    static std::optional<BlockGrid> grid_of(const AttachOperation& operation, const Part& part);
    static std::optional<BlockGrid> grid_of(const StencilOperation& operation, const Part& part);
    static std::optional<BlockGrid> grid_of(const RenumberOperation&, const Part& part);
    static std::optional<BlockGrid> grid_of(const CardLeaf& leaf, const Part& part);
    template <class Leaf>
    static std::optional<BlockGrid> grid_of(const Leaf&, const Part& part) {
        return part.block->grid();
    }

    // One stack of a block, made from those of its children.
    std::optional<Stack> at(const TileOperation& operation, const Part& part, std::size_t row,
                            std::size_t column);
    std::optional<Stack> at(const AttachOperation& operation, const Part& part, std::size_t row,
                            std::size_t column);
    std::optional<Stack> at(const StencilOperation& operation, const Part& part, std::size_t row,
                            std::size_t column);
    std::optional<Stack> at(const RenumberOperation& operation, const Part& part, std::size_t row,
                            std::size_t column);
    std::optional<Stack> at(const CardLeaf& leaf, const Part& part, std::size_t row, std::size_t column);
    template <class Leaf>
    std::optional<Stack> at(const Leaf&, const Part& part, std::size_t row, std::size_t column) {
        return part.block->stack(row, column);
    }

    std::map<std::string, Part> m_parts;
    std::vector<LostFlip> m_lost;
    std::optional<Error> m_error;
    std::size_t m_units = most_units;
};

/// Whether the card is read with one pick and one end a cell, so that its pixels are its stacks and fit in
/// any case.
bool is_single(const CardLeaf& leaf) {
    return all_single(leaf.t) && all_single(leaf.p) && leaf.card->picks() % leaf.t.size() == 0 &&
           leaf.card->ends() % leaf.p.size() == 0;
}

Counts joined(const Counts& one, const Counts& other) {
    Counts both = one;
    both.insert(both.end(), other.begin(), other.end());
    return both;
}

Counts summed(const Counts& one, const Counts& other) {
    Counts both = one;
    for (std::size_t k = 0; k < both.size(); ++k) both[k] += other[k];
    return both;
}

bool is_minus(Face face) {
    return face == Face::minus_x || face == Face::minus_y || face == Face::minus_z;
}

/// The two blocks of an attachment: the one with the lower numbers first.
std::pair<const Part*, const Part*> in_order(const AttachOperation& operation, const Part& part) {
    if (is_minus(operation.face)) return {part.children[1], part.children[0]};
    return {part.children[0], part.children[1]};
}

std::optional<BlockGrid> Draughtsman::grid_of(const TileOperation& operation, const Part& part) {
    const Part& child = *part.children[0];
    const auto& [of, x, y, z] = operation;
    if (!check_tile(child.extent, x, y, z)) return {};
    return BlockGrid(repeated(child.grid.t(), x, z), repeated(child.grid.p(), y, z));
}

std::optional<BlockGrid> Draughtsman::grid_of(const AttachOperation& operation, const Part& part) {
    const auto [first, second] = in_order(operation, part);
    const BlockGrid &one = first->grid, &other = second->grid;
    switch (operation.face) {
        case Face::plus_x:
        case Face::minus_x:
            return BlockGrid(joined(one.t(), other.t()), one.p());
        case Face::plus_y:
        case Face::minus_y:
            return BlockGrid(one.t(), joined(one.p(), other.p()));
        default:
            const Extent extent = extent_to_be(operation, {first->extent, second->extent});
            if (!check_slots(extent.stacks, extent.height)) return {};
            return BlockGrid(summed(one.t(), other.t()), summed(one.p(), other.p()));
    }
}

/// The counts of each line of a stencil, if all blocks agree on them.
std::optional<Counts> common_counts(const std::vector<const Part*>& blocks, std::size_t lines,
                                    const Counts& (BlockGrid::*counts)() const) {
    const auto over_the_lines = [&](const Part* block) {
        const Counts& own = (block->grid.*counts)();
        Counts all(lines);
        for (std::size_t i = 0; i < lines; ++i) all[i] = own[i % own.size()];
        return all;
    };
    Counts common = over_the_lines(blocks[0]);
    for (std::size_t k = 1; k < blocks.size(); ++k) {
        if (over_the_lines(blocks[k]) != common) return {};
    }
    return common;
}

std::optional<BlockGrid> Draughtsman::grid_of(const StencilOperation& operation, const Part& part) {
    auto t = common_counts(part.children, operation.map->rows, &BlockGrid::t);
    auto p = common_counts(part.children, operation.map->columns, &BlockGrid::p);
    if (!t || !p) return {};
    return BlockGrid(std::move(*t), std::move(*p));
}

std::optional<BlockGrid> Draughtsman::grid_of(const RenumberOperation&, const Part& part) {
    return part.children[0]->grid;
}

std::optional<BlockGrid> Draughtsman::grid_of(const CardLeaf& leaf, const Part& part) {
    if (part.block) return part.block->grid();
    return BlockGrid(Counts(leaf.card->picks(), 1), Counts(leaf.card->ends(), 1));
}

std::optional<Stack> Draughtsman::at(const TileOperation& operation, const Part& part, std::size_t row,
                                     std::size_t column) {
    const Part& child = *part.children[0];
    const auto one = stack(child, row % child.grid.rows(), column % child.grid.columns());
    if (!one) return {};
    return piled_times(*one, child.extent.height, operation.z);
}

std::optional<Stack> Draughtsman::at(const AttachOperation& operation, const Part& part, std::size_t row,
                                     std::size_t column) {
    const auto [first, second] = in_order(operation, part);
    const std::size_t rows = first->grid.rows(), columns = first->grid.columns();
    switch (operation.face) {
        case Face::plus_x:
        case Face::minus_x:
            return row < rows ? stack(*first, row, column) : stack(*second, row - rows, column);
        case Face::plus_y:
        case Face::minus_y:
            return column < columns ? stack(*first, row, column) : stack(*second, row, column - columns);
        default:
            const auto lower = stack(*first, row, column), upper = stack(*second, row, column);
            if (!lower || !upper) return {};
            return piled(*lower, first->extent.height, *upper);
    }
}

std::optional<Stack> Draughtsman::at(const StencilOperation& operation, const Part& part, std::size_t row,
                                     std::size_t column) {
    const Part& source = *part.children[operation.map->row(row)[column]];
    return stack(source, row % source.grid.rows(), column % source.grid.columns());
}

std::optional<Stack> Draughtsman::at(const RenumberOperation& operation, const Part& part, std::size_t row,
                                     std::size_t column) {
    auto old = stack(*part.children[0], row, column);
    if (!old || (operation.system == System::weft ? row : column) != operation.line) return old;
    return renumbered(*old, operation.system, *new_numbers(operation.order, operation.order.size()));
}

std::optional<Stack> Draughtsman::at(const CardLeaf& leaf, const Part& part, std::size_t row,
                                     std::size_t column) {
    if (part.block) return part.block->stack(row, column);
    const bool over = leaf.card->weft_over(row, column);
    return over ? Stack({Slot::warp(0), Slot::weft(0)}) : Stack({Slot::weft(0), Slot::warp(0)});
}

/// The stack of a cell before the flips of its own block.
std::optional<Stack> Draughtsman::unflipped(const Part& part, std::size_t row, std::size_t column) {
    auto made =
        std::visit([&](const auto& source) { return at(source, part, row, column); }, part.node->source);
    if (!made || !spend(units_of_a_stack + made->height())) return {};
    return made;
}

std::optional<Stack> Draughtsman::stack(const Part& part, std::size_t row, std::size_t column) {
    const auto found = part.flipped.find(row * part.grid.columns() + column);
    return found != part.flipped.end() ? found->second : unflipped(part, row, column);
}

/// Lays out the block of a leaf that is small or holds its stacks anyway; or that has to be tried whole.
bool Draughtsman::lay_out(Part& part) {
    const auto made = [&](Result<Block> block) {
        if (!block || !spend(extent_of(*block).units())) return false;
        part.block = std::make_shared<const Block>(std::move(block).value());
        return true;
    };
    if (const auto* leaf = std::get_if<StacksLeaf>(&part.node->source)) part.block = leaf->block;
    if (const auto* leaf = std::get_if<PresetLeaf>(&part.node->source))
        return made(make_preset(leaf->preset));
    if (const auto* leaf = std::get_if<SliceLeaf>(&part.node->source)) return made(to_block(leaf->slice));
    const auto* leaf = std::get_if<CardLeaf>(&part.node->source);
    if (leaf == nullptr || is_single(*leaf)) return true;
    if (extent_to_be(*leaf, {}).units() > m_units) return false;
    return made(block_from_card(*leaf->card, leaf->t, leaf->p));
}

/// No table holds more stacks than there are cells, nor a card of single picks and ends more than two.
Extent Draughtsman::extent_of_part(const Part& part) {
    if (part.block) return extent_of(*part.block);
    std::vector<Extent> extents;
    for (const Part* child : part.children) extents.push_back(child->extent);
    Extent extent = extent_to_be(part.node->source, extents);
    if (std::holds_alternative<CardLeaf>(part.node->source))
        extent.height = extent.stacks = 2, extent.slots = 4;
    extent.stacks = std::min(extent.stacks, extent.cells());
    extent.slots = std::min(extent.slots, extent.stacks * extent.height);
    return extent;
}

/// Counts and extent of a block whose children are known.
bool Draughtsman::put_together(Part& part) {
    for (const Part* child : part.children) part.levels = std::max(part.levels, child->levels + 1);
    if (part.levels > most_levels || !lay_out(part)) return false;
    part.extent = extent_of_part(part);
    if (!check_height(part.extent.height) || !spend(3 * (part.extent.rows + part.extent.columns)))
        return false;
    auto grid = std::visit([&](const auto& source) { return grid_of(source, part); }, part.node->source);
    if (!grid || !check_counts(grid->t(), grid->p())) return false;
    part.grid = std::move(*grid);
    return true;
}

bool Draughtsman::flip(Part& part, const std::string& name) {
    std::map<std::size_t, Stack> stacks;
    for (const Flip& flip : part.node->flips) {
        if (!part.grid.holds(flip.pick, flip.end)) continue;
        const std::size_t cell = part.grid.cell_of(flip.pick, flip.end), columns = part.grid.columns();
        if (stacks.contains(cell)) continue;
        auto old = unflipped(part, cell / columns, cell % columns);
        if (!old) return false;
        part.extent.stacks += 1, part.extent.slots += old->height();
        stacks.emplace(cell, std::move(*old));
    }
    for (RefusedFlip& lost : flip_stacks(part.grid, part.node->flips, stacks))
        m_lost.push_back({name, lost.flip, std::move(lost.reason)});
    part.flipped = std::move(stacks);
    return true;
}

std::optional<Outline> Draughtsman::draw(const Design& design, std::optional<CardPlace> place) {
    const std::vector<std::string> order = bottom_up(design, design.root);
    std::map<std::string, std::size_t> uses{{design.root, 1}};
    for (const std::string& name : order) {
        for (const std::string& child : children_of(*design.blocks.at(name))) ++uses[child];
    }
    std::size_t held = 0;  // as the evaluator would hold it, whose limit this is
    for (const std::string& name : order) {
        Part& part = m_parts[name];
        part.node = design.blocks.at(name).get();
        const std::vector<std::string> children = children_of(*part.node);
        std::vector<Extent> extents;
        std::vector<SizedPart> sizes;
        for (const std::string& child : children) {
            part.children.push_back(&m_parts.at(child));
            extents.push_back(part.children.back()->extent);
            sizes.push_back({&part.children.back()->grid, extents.back().height});
        }
        if (Status fits = check_counts_fit(part.node->source, sizes); !fits) {
            m_error = std::move(fits).error().under("blocks." + name);
            return {};
        }
        if (held + needed_for(*part.node, extents) > Evaluator::standard_limit) return {};
        if (!put_together(part) || !flip(part, name)) return {};
        held += part.extent.units();
        for (const std::string& child : children) {
            if (--uses[child] == 0) held -= m_parts.at(child).extent.units();
        }
    }
    const Part& cloth = m_parts.at(design.root);
    Outline outline{cloth.grid, cloth.extent.height, std::move(m_lost), {}};
    if (!place || !cloth.grid.holds(place->pick, place->end)) return outline;
    const std::size_t row = cloth.grid.row_of_pick(place->pick),
                      column = cloth.grid.column_of_end(place->end);
    auto at = stack(cloth, row, column);
    if (!at) return {};
    outline.at = {std::move(*at), cloth.grid.first_pick(row), cloth.grid.first_end(column)};
    return outline;
}

}  // namespace

Result<Outline> outline(const Design& design, std::optional<CardPlace> place) {
    WEAVE_CHECK_OK(check(design));
    Draughtsman draughtsman;
    if (auto drawn = draughtsman.draw(design, place)) return std::move(*drawn);
    if (draughtsman.error()) return *draughtsman.error();
    WEAVE_TRY(Evaluation evaluation, evaluate(design));
    const Block& block = *evaluation.block;
    Outline outline{block.grid(), block.height(), std::move(evaluation.lost_flips), {}};
    if (place && block.grid().holds(place->pick, place->end))
        outline.at = stack_at(block, place->pick, place->end);
    return outline;
}

}  // namespace weave
