#pragma once

#include <weave/block/block_grid.hpp>
#include <weave/block/card_image.hpp>
#include <weave/block/stack.hpp>
#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <unordered_map>
#include <vector>

namespace weave {

/// No block may be higher, in slots: real cloth has dozens of layers, and a hostile file could ask for
/// billions.
inline constexpr std::size_t most_height = std::size_t{1} << 20;
/// No operation in height fills more slots in the different stacks of its result.
inline constexpr std::size_t most_slots = std::size_t{1} << 28;

/// An error where a block of this height is higher than most_height.
Status check_height(std::size_t height);
/// The same, or where so many different stacks of this height have more than most_slots.
Status check_slots(std::size_t stacks, std::size_t height);

/// A weave block {r, c, h, t, p, A} (paper, section 4.1): a tilable piece of 3D weave as an array of stacks.
///
/// Row i holds t[i] picks and column j holds p[j] ends. Equal stacks are kept once: a cell is the number of
/// its stack in a table. A full-size shoe has 400,000 cells but some hundred different stacks, so a block
/// costs four bytes a cell and operations work on the table. A Block always obeys the yarn index constraints:
/// make() is the only way in.
class Block {
  public:
    /// Checks every constraint of the paper's section 4.1. `cells` has t.size() * p.size() entries, row by
    /// row, each an index into `stacks`. Stacks that no cell names are left out of the block; equal ones may
    /// stand in the table more than once, which only costs room. `height` is raised to the tallest stack that
    /// is used where it is smaller and is at most most_height. Errors name the first bad cell as
    /// `stacks[row][column]`.
    static Result<Block> make(std::vector<std::uint32_t> t, std::vector<std::uint32_t> p,
                              std::vector<Stack> stacks, std::vector<std::uint32_t> cells,
                              std::size_t height = 0);

    [[nodiscard]] const BlockGrid& grid() const { return m_grid; }
    [[nodiscard]] std::size_t rows() const { return m_grid.rows(); }
    [[nodiscard]] std::size_t columns() const { return m_grid.columns(); }
    [[nodiscard]] std::size_t height() const { return m_height; }
    [[nodiscard]] std::size_t picks() const { return m_grid.picks(); }
    [[nodiscard]] std::size_t ends() const { return m_grid.ends(); }
    /// Picks of each row.
    [[nodiscard]] const std::vector<std::uint32_t>& t() const { return m_grid.t(); }
    /// Ends of each column.
    [[nodiscard]] const std::vector<std::uint32_t>& p() const { return m_grid.p(); }

    /// Number of the first pick of a row, from 0; also defined for rows() as the total.
    [[nodiscard]] std::size_t first_pick(std::size_t row) const { return m_grid.first_pick(row); }
    [[nodiscard]] std::size_t first_end(std::size_t column) const { return m_grid.first_end(column); }
    [[nodiscard]] std::size_t row_of_pick(std::size_t pick) const { return m_grid.row_of_pick(pick); }
    [[nodiscard]] std::size_t column_of_end(std::size_t end) const { return m_grid.column_of_end(end); }

    [[nodiscard]] const Stack& stack(std::size_t row, std::size_t column) const {
        return m_stacks[m_cells[row * columns() + column]];
    }
    /// The table of stacks, each used by some cell, and for each cell, row by row, its entry.
    [[nodiscard]] const std::vector<Stack>& stacks() const { return m_stacks; }
    [[nodiscard]] std::span<const std::uint32_t> cells() const { return m_cells; }
    [[nodiscard]] std::span<const std::uint32_t> cells(std::size_t row) const {
        return std::span(m_cells).subspan(row * columns(), columns());
    }

    /// The block with other stacks in some cells, by the number of the cell, row by row. Each must hold the
    /// yarns of its cell and be no higher than the block. The cells stay where they are in memory.
    [[nodiscard]] Block with_stacks(const std::map<std::size_t, Stack>& stacks) &&;

    /// One pixel of the card image, without making all of it.
    [[nodiscard]] bool weft_over(std::size_t pick, std::size_t end) const;
    /// Pixel I[x][y] is true exactly where pick x stands above end y in the stack that holds both.
    [[nodiscard]] CardImage card_image() const;

    /// Same t, p, height and, cell by cell, same stacks.
    friend bool operator==(const Block& a, const Block& b);

  private:
    Block() = default;
    void leave_out_unused(const std::vector<bool>& used);

    BlockGrid m_grid;
    std::size_t m_height = 0;
    std::vector<Stack> m_stacks;
    std::vector<std::uint32_t> m_cells;
};

using BlockPtr = std::shared_ptr<const Block>;

/// Gives equal stacks the same number, in the order in which they first come.
class StackTable {
  public:
    std::uint32_t number_of(Stack stack);
    [[nodiscard]] const Stack& at(std::uint32_t number) const { return m_stacks[number]; }
    /// The table so far; the object must not be used afterwards.
    [[nodiscard]] std::vector<Stack> take() && { return std::move(m_stacks); }

  private:
    std::vector<Stack> m_stacks;
    std::unordered_map<Stack, std::uint32_t, StackHash> m_numbers;
};

/// An error where a block with these counts would have no pick or no end, or a card larger than the limits.
Status check_counts(const std::vector<std::uint32_t>& t, const std::vector<std::uint32_t>& p);

/// A block from a function that gives the stack of each cell. One that is too large is refused before any is
/// made.
template <class StackOfCell>
Result<Block> make_block(std::vector<std::uint32_t> t, std::vector<std::uint32_t> p,
                         StackOfCell stack_of_cell, std::size_t height = 0) {
    WEAVE_CHECK_OK(check_counts(t, p));
    StackTable table;
    std::vector<std::uint32_t> cells;
    cells.reserve(t.size() * p.size());
    for (std::size_t row = 0; row < t.size(); ++row) {
        for (std::size_t column = 0; column < p.size(); ++column) {
            cells.push_back(table.number_of(stack_of_cell(row, column)));
        }
    }
    return Block::make(std::move(t), std::move(p), std::move(table).take(), std::move(cells), height);
}

}  // namespace weave
