#include <weave/block/operations.hpp>

#include <weave/block/operation_checks.hpp>
#include <weave/block/stack_moves.hpp>
#include <weave/core/text.hpp>

#include <algorithm>
#include <map>
#include <numeric>

namespace weave {

namespace {

using Counts = std::vector<std::uint32_t>;

/// What errors call two blocks.
struct Pair {
    std::string one, other;
    [[nodiscard]] Pair swapped() const { return {other, one}; }
};

std::string quoted(const std::string& name) {
    return "'" + name + "'";
}

/// How many yarns two blocks have in the first line of stacks in which they differ. `before`: yarns of the lines before it,
/// of which both have as many.
std::string differs(std::size_t before, const char* yarn, const Pair& names, std::uint32_t one, std::uint32_t other) {
    return "at " + std::string(yarn) + " " + std::to_string(before + 1) + " " + names.one + " has " +
           counted(one, yarn) + " in a stack and " + names.other + " " + std::to_string(other);
}

/// The size of one side of a block as a weaver counts it, then in stacks: `6 picks (3 rows)`.
std::string size_of(const Counts& counts, const char* line, const char* yarn) {
    const auto yarns = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    return counted(yarns, yarn) + " (" + counted(counts.size(), line) + ")";
}

Status check_same(const Counts& one, const Counts& other, const char* line, const char* yarn,
                  const Pair& names) {
    if (one.size() != other.size()) {
        return bad_input(names.one + " has " + size_of(one, line, yarn) + " and " + names.other + " " +
                         size_of(other, line, yarn) + ": the " + line + "s must be equal on the faces that meet");
    }
    std::size_t before = 0;
    for (std::size_t i = 0; i < one.size(); before += one[i++]) {
        if (one[i] != other[i]) return bad_input("cannot attach: " + differs(before, yarn, names, one[i], other[i]));
    }
    return {};
}

/// The tables of several blocks as one, and for each block where its stacks went.
struct MergedTables {
    StackTable table;
    std::vector<std::vector<std::uint32_t>> moved;

    void add(const Block& block) {
        std::vector<std::uint32_t>& numbers = moved.emplace_back();
        numbers.reserve(block.stacks().size());
        for (const Stack& stack : block.stacks()) numbers.push_back(table.number_of(stack));
    }
};

/// Both in the order of their yarns.
Status check_ordered(GridAndHeight first, GridAndHeight second, Face face, const Pair& names) {
    const BlockGrid &one = first.grid, &other = second.grid;
    switch (face) {
        case Face::plus_x:
        case Face::minus_x:
            WEAVE_CHECK_OK(check_same(one.p(), other.p(), "column", "end", names));
            return check_card_size(one.picks() + other.picks(), one.ends());
        case Face::plus_y:
        case Face::minus_y:
            WEAVE_CHECK_OK(check_same(one.t(), other.t(), "row", "pick", names));
            return check_card_size(one.picks(), one.ends() + other.ends());
        default:
            break;
    }
    if (one.rows() != other.rows() || one.columns() != other.columns()) {
        const auto size = [](const BlockGrid& grid) {
            return size_of(grid.t(), "row", "pick") + " and " + size_of(grid.p(), "column", "end");
        };
        return bad_input(names.one + " has " + size(one) + ", " + names.other + " " + size(other) +
                         "; on top of each other rows and columns must be equal");
    }
    WEAVE_CHECK_OK(check_height(first.height + second.height));
    return check_card_size(one.picks() + other.picks(), one.ends() + other.ends());
}

Result<Block> attach_x(const Block& first, const Block& second) {
    MergedTables merged;
    std::vector<std::uint32_t> cells;
    cells.reserve(first.cells().size() + second.cells().size());
    for (const Block* block : {&first, &second}) {
        merged.add(*block);
        for (const std::uint32_t cell : block->cells()) cells.push_back(merged.moved.back()[cell]);
    }
    Counts t = first.t();
    t.insert(t.end(), second.t().begin(), second.t().end());
    return Block::make(std::move(t), first.p(), std::move(merged.table).take(), std::move(cells),
                       std::max(first.height(), second.height()));
}

Result<Block> attach_y(const Block& first, const Block& second) {
    MergedTables merged;
    merged.add(first);
    merged.add(second);
    std::vector<std::uint32_t> cells;
    cells.reserve(first.cells().size() + second.cells().size());
    for (std::size_t row = 0; row < first.rows(); ++row) {
        for (const std::uint32_t cell : first.cells(row)) cells.push_back(merged.moved[0][cell]);
        for (const std::uint32_t cell : second.cells(row)) cells.push_back(merged.moved[1][cell]);
    }
    Counts p = first.p();
    p.insert(p.end(), second.p().begin(), second.p().end());
    return Block::make(first.t(), std::move(p), std::move(merged.table).take(), std::move(cells),
                       std::max(first.height(), second.height()));
}

Result<Block> attach_z(const Block& lower, const Block& upper) {
    StackTable table;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    std::vector<std::uint32_t> cells(lower.cells().size());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
        const auto pair = std::pair(lower.cells()[cell], upper.cells()[cell]);
        auto entry = known.find(pair);
        if (entry == known.end()) {
            WEAVE_CHECK_OK(check_slots(known.size() + 1, lower.height() + upper.height()));
            const Stack pile = piled(lower.stacks()[pair.first], lower.height(), upper.stacks()[pair.second]);
            entry = known.emplace(pair, table.number_of(pile)).first;
        }
        cells[cell] = entry->second;
    }
    Counts t = lower.t(), p = lower.p();
    for (std::size_t i = 0; i < t.size(); ++i) t[i] += upper.t()[i];
    for (std::size_t j = 0; j < p.size(); ++j) p[j] += upper.p()[j];
    return Block::make(std::move(t), std::move(p), std::move(table).take(), std::move(cells),
                       lower.height() + upper.height());
}

Status check_stencil_shape(std::size_t rows, std::size_t columns, std::size_t blocks) {
    if (rows == 0 || columns == 0) return bad_input("a stencil needs at least one row and one column");
    if (blocks == 0) return bad_input("a stencil needs at least one block");
    return {};
}

Status check_stencil(std::span<const BlockPtr> blocks, const StencilMap& map) {
    WEAVE_CHECK_OK(check_stencil_shape(map.rows, map.columns, blocks.size()));
    assert(map.blocks.size() == map.rows * map.columns);
    for (std::size_t cell = 0; cell < map.blocks.size(); ++cell) {
        if (map.blocks[cell] >= blocks.size()) {
            return bad_input("names block " + std::to_string(map.blocks[cell]) + ", but there are only " +
                                 std::to_string(blocks.size()) + ", counted from 0",
                             "stencil[" + std::to_string(cell / map.columns) + "][" +
                                 std::to_string(cell % map.columns) + "]");
        }
    }
    return {};
}

/// The picks (or ends) of each line of the stencil, on which all blocks must agree.
Result<Counts> common_counts(std::span<const BlockGrid* const> grids, std::span<const std::string> names,
                             std::size_t lines, const Counts& (BlockGrid::*counts)() const, const char* yarn) {
    const auto count_at = [&](const BlockGrid* grid, std::size_t i) {
        const Counts& own = (grid->*counts)();
        return own[i % own.size()];
    };
    const auto name_of = [&](std::size_t k) {
        return names.empty() ? "block " + std::to_string(k) : quoted(names[k]);
    };
    Counts common(lines);
    std::size_t before = 0;
    for (std::size_t i = 0; i < lines; before += common[i++]) {
        common[i] = count_at(grids[0], i);
        for (std::size_t k = 1; k < grids.size(); ++k) {
            const std::uint32_t other = count_at(grids[k], i);
            if (other == common[i]) continue;
            const Pair pair{name_of(0), name_of(k)};
            return bad_input(pair.one + " and " + pair.other +
                             " do not fit together: " + differs(before, yarn, pair, common[i], other));
        }
    }
    return common;
}

/// The picks of the rows, and the ends of the columns, of a stencil.
Result<std::pair<Counts, Counts>> stencil_counts(std::span<const BlockGrid* const> grids, std::size_t rows,
                                                 std::size_t columns, std::span<const std::string> names) {
    WEAVE_TRY(Counts t, common_counts(grids, names, rows, &BlockGrid::t, "pick"));
    WEAVE_TRY(Counts p, common_counts(grids, names, columns, &BlockGrid::p, "end"));
    WEAVE_CHECK_OK(check_counts(t, p));
    return std::pair(std::move(t), std::move(p));
}

Result<Block> with_line_renumbered(const Block& block, System system, std::size_t line,
                                   std::span<const std::size_t> order) {
    const bool row = system == System::weft;
    WEAVE_CHECK_OK(check_renumber(block.grid(), system, line, order));
    const auto numbers = new_numbers(order, order.size());
    MergedTables merged;
    merged.add(block);
    const std::vector<std::uint32_t>& moved = merged.moved.front();
    std::map<std::uint32_t, std::uint32_t> known;
    std::vector<std::uint32_t> cells;
    cells.reserve(block.cells().size());
    for (const std::uint32_t cell : block.cells()) cells.push_back(moved[cell]);
    const std::size_t first = row ? line * block.columns() : line, step = row ? 1 : block.columns();
    const std::size_t length = row ? block.columns() : block.rows();
    for (std::size_t k = 0; k < length; ++k) {
        std::uint32_t& cell = cells[first + k * step];
        const auto [entry, is_new] = known.try_emplace(cell, 0);
        if (is_new)
            entry->second = merged.table.number_of(renumbered(merged.table.at(cell), system, *numbers));
        cell = entry->second;
    }
    return Block::make(block.t(), block.p(), std::move(merged.table).take(), std::move(cells),
                       block.height());
}

}  // namespace

Status check_tile(const Extent& of, std::size_t x, std::size_t y, std::size_t z) {
    if (x == 0 || y == 0 || z == 0) return bad_input("a block is tiled at least once in each direction");
    if (x > most_yarns || y > most_yarns || z > most_yarns / std::max(x, y))
        return bad_input("a block is tiled at most " + std::to_string(most_yarns) + " times, where each layer counts: x times z, and y times z");
    WEAVE_CHECK_OK(check_card_size(of.picks * x * z, of.ends * y * z));
    return check_slots(of.stacks, of.height * z);
}

Result<Block> tile(const Block& block, std::size_t x, std::size_t y, std::size_t z) {
    WEAVE_CHECK_OK(check_tile(extent_of(block), x, y, z));
    StackTable table;
    std::vector<std::uint32_t> moved;
    for (const Stack& stack : block.stacks())
        moved.push_back(table.number_of(piled_times(stack, block.height(), z)));
    std::vector<std::uint32_t> cells;
    cells.reserve(block.cells().size() * x * y);
    for (std::size_t row = 0; row < block.rows() * x; ++row) {
        for (std::size_t k = 0; k < y; ++k) {
            for (const std::uint32_t cell : block.cells(row % block.rows())) cells.push_back(moved[cell]);
        }
    }
    return Block::make(repeated(block.t(), x, z), repeated(block.p(), y, z), std::move(table).take(),
                       std::move(cells), block.height() * z);
}

const std::vector<std::string>& face_names() {
    static const std::vector<std::string> names{"+x", "-x", "+y", "-y", "+z", "-z"};
    return names;
}

Status check_attach(GridAndHeight block, GridAndHeight other, Face face, std::span<const std::string> names) {
    assert(names.empty() || names.size() == 2);
    const Pair pair =
        names.empty() ? Pair{"the block", "the other"} : Pair{quoted(names[0]), quoted(names[1])};
    const bool minus = face == Face::minus_x || face == Face::minus_y || face == Face::minus_z;
    return minus ? check_ordered(other, block, face, pair.swapped()) : check_ordered(block, other, face, pair);
}

Result<Block> attach(const Block& block, const Block& other, Face face, std::span<const std::string> names) {
    WEAVE_CHECK_OK(check_attach({block.grid(), block.height()}, {other.grid(), other.height()}, face, names));
    switch (face) {
        case Face::plus_x:
            return attach_x(block, other);
        case Face::minus_x:
            return attach_x(other, block);
        case Face::plus_y:
            return attach_y(block, other);
        case Face::minus_y:
            return attach_y(other, block);
        case Face::plus_z:
            return attach_z(block, other);
        case Face::minus_z:
            return attach_z(other, block);
    }
    return bad_input("a block has six faces");
}

Status check_renumber(const BlockGrid& grid, System system, std::size_t line, std::span<const std::size_t> order) {
    const bool row = system == System::weft;
    const std::size_t lines = row ? grid.rows() : grid.columns();
    const std::string name = row ? "row " : "column ";
    if (line >= lines)
        return bad_input("there is no " + name + std::to_string(line) + "; the last one is " +
                         std::to_string(lines - 1));
    const std::size_t count = row ? grid.t()[line] : grid.p()[line];
    if (new_numbers(order, count)) return {};
    return bad_input("the new order of " + name + std::to_string(line) + " must name each of its " +
                     std::to_string(count) + (row ? " picks" : " ends") + " once, from 0 on");
}

Status check_stencil_size(const BlockGrid& block, std::size_t rows, std::size_t columns) {
    const std::size_t picks = rows / block.rows() * block.picks() + block.first_pick(rows % block.rows());
    const std::size_t ends =
        columns / block.columns() * block.ends() + block.first_end(columns % block.columns());
    return check_card_size(picks, ends);
}

Result<Block> stencil(std::span<const BlockPtr> blocks, const StencilMap& map,
                      std::span<const std::string> names) {
    assert(names.empty() || names.size() == blocks.size());
    WEAVE_CHECK_OK(check_stencil(blocks, map));
    std::vector<const BlockGrid*> grids;
    for (const BlockPtr& block : blocks) grids.push_back(&block->grid());
    WEAVE_TRY(auto counts, stencil_counts(grids, map.rows, map.columns, names));
    MergedTables merged;
    std::size_t height = 0;
    for (const BlockPtr& block : blocks) {
        merged.add(*block);
        height = std::max(height, block->height());
    }
    std::vector<std::uint32_t> cells;
    cells.reserve(map.blocks.size());
    for (std::size_t row = 0; row < map.rows; ++row) {
        const auto sources = map.row(row);
        for (std::size_t column = 0; column < map.columns; ++column) {
            const Block& source = *blocks[sources[column]];
            const std::uint32_t cell = source.cells(row % source.rows())[column % source.columns()];
            cells.push_back(merged.moved[sources[column]][cell]);
        }
    }
    return Block::make(std::move(counts.first), std::move(counts.second), std::move(merged.table).take(),
                       std::move(cells), height);
}

Status check_stencil_counts(std::span<const BlockGrid* const> grids, std::size_t rows, std::size_t columns,
                            std::span<const std::string> names) {
    if (Status size = check_stencil_shape(rows, columns, grids.size()); !size) return size;
    WEAVE_CHECK_OK(stencil_counts(grids, rows, columns, names));
    return {};
}

Result<Block> renumber_row(const Block& block, std::size_t row, std::span<const std::size_t> order) {
    return with_line_renumbered(block, System::weft, row, order);
}

Result<Block> renumber_column(const Block& block, std::size_t column, std::span<const std::size_t> order) {
    return with_line_renumbered(block, System::warp, column, order);
}

}  // namespace weave
