#include <weave/block/block.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace weave {

namespace {

std::string cell_name(std::size_t row, std::size_t column) {
    return "stacks[" + std::to_string(row) + "][" + std::to_string(column) + "]";
}

/// One stack against the counts of its row and column; `first` is the cell's first pick and end.
Status check_cell(const Stack& stack, std::size_t picks, std::size_t ends, std::size_t row,
                  std::size_t column, std::pair<std::size_t, std::size_t> first) {
    const std::string where = cell_name(row, column);
    if (stack.wefts() != picks) {
        return bad_input("holds " + counted(stack.wefts(), "pick") + ", but row " + std::to_string(row) +
                             " has " + std::to_string(picks),
                         where);
    }
    if (stack.warps() != ends) {
        return bad_input("holds " + counted(stack.warps(), "end") + ", but column " + std::to_string(column) +
                             " has " + std::to_string(ends),
                         where);
    }
    if (Status fine = stack.check(first.first, first.second); !fine) return std::move(fine).error().in(where);
    return {};
}

/// The pixels of all stacks of a table in one run of bytes: per stack and weft a row of bits, most
/// significant first, bit k for warp k.
class StackPixels {
  public:
    explicit StackPixels(const std::vector<Stack>& stacks);
    /// The row of one weft.
    [[nodiscard]] const std::uint8_t* row(std::uint32_t stack, std::size_t weft) const {
        return &m_bytes[m_stacks[stack].first_byte + weft * m_stacks[stack].row_bytes];
    }

  private:
    struct Place {
        std::size_t first_byte = 0, row_bytes = 0;
    };
    std::vector<Place> m_stacks;
    std::vector<std::uint8_t> m_bytes;
};

StackPixels::StackPixels(const std::vector<Stack>& stacks) {
    std::size_t bytes = 0;
    for (const Stack& stack : stacks) {
        m_stacks.push_back({bytes, (stack.warps() + 7) / 8});
        bytes += stack.wefts() * m_stacks.back().row_bytes;
    }
    m_bytes.resize(bytes);
    std::vector<std::uint8_t> warps_below;
    for (std::size_t k = 0; k < stacks.size(); ++k) {
        const Place place = m_stacks[k];
        warps_below.assign(place.row_bytes, 0);
        for (const Slot slot : stacks[k].slots()) {
            if (slot.is_warp())
                warps_below[slot.index() / 8] |= static_cast<std::uint8_t>(0x80 >> slot.index() % 8);
            if (slot.is_weft())
                std::copy(warps_below.begin(), warps_below.end(),
                          m_bytes.begin() +
                              static_cast<std::ptrdiff_t>(place.first_byte + slot.index() * place.row_bytes));
        }
    }
}

/// ORs `bits` (`count` of them, padding 0) into a row of the card at bit `at`.
void put_bits(std::span<std::uint8_t> row, std::size_t at, const std::uint8_t* bits, std::size_t count) {
    const std::size_t shift = at % 8;
    std::size_t byte = at / 8;
    for (std::size_t done = 0; done < count; done += 8, ++byte) {
        const std::uint32_t moved = std::uint32_t{bits[done / 8]} << 8 >> shift;
        row[byte] |= static_cast<std::uint8_t>(moved >> 8);
        if ((moved & 0xff) != 0) row[byte + 1] |= static_cast<std::uint8_t>(moved & 0xff);
    }
}

}  // namespace

Status check_height(std::size_t height) {
    if (height <= most_height) return {};
    return bad_input("a block of " + std::to_string(height) + " slots is higher than the limit of " +
                     std::to_string(most_height));
}

Status check_slots(std::size_t stacks, std::size_t height) {
    WEAVE_CHECK_OK(check_height(height));
    if (height == 0 || stacks <= most_slots / height) return {};
    return bad_input(counted(stacks, "different stack") + " of " + counted(height, "slot") +
                     " are more than the limit of " + std::to_string(most_slots) + " slots");
}

Status check_counts(const std::vector<std::uint32_t>& t, const std::vector<std::uint32_t>& p) {
    const auto picks = std::accumulate(t.begin(), t.end(), std::uint64_t{0});
    const auto ends = std::accumulate(p.begin(), p.end(), std::uint64_t{0});
    if (picks == 0 || ends == 0) return bad_input("a block needs at least one pick and one end");
    return check_card_size(picks, ends);
}

Result<Block> Block::make(std::vector<std::uint32_t> t, std::vector<std::uint32_t> p,
                          std::vector<Stack> stacks, std::vector<std::uint32_t> cells, std::size_t height) {
    assert(cells.size() == t.size() * p.size());
    WEAVE_CHECK_OK(check_counts(t, p));
    Block block;
    block.m_grid = BlockGrid(std::move(t), std::move(p));
    std::vector<bool> used(stacks.size());
    for (std::size_t row = 0, cell = 0; row < block.rows(); ++row) {
        const std::uint32_t picks = block.t()[row];
        for (std::size_t column = 0; column < block.columns(); ++column, ++cell) {
            const std::uint32_t number = cells[cell];
            if (number >= stacks.size()) {
                return bad_input("is stack " + std::to_string(number) + " of a table of " +
                                     std::to_string(stacks.size()) + ", counted from 0",
                                 cell_name(row, column));
            }
            const Stack& stack = stacks[number];
            const std::uint32_t ends = block.p()[column];
            if (used[number] && stack.wefts() == picks && stack.warps() == ends) continue;
            WEAVE_CHECK_OK(check_cell(stack, picks, ends, row, column,
                                      {block.first_pick(row), block.first_end(column)}));
            used[number] = true;
            height = std::max(height, stack.height());
        }
    }
    WEAVE_CHECK_OK(check_height(height));
    block.m_height = height;
    block.m_stacks = std::move(stacks);
    block.m_cells = std::move(cells);
    block.leave_out_unused(used);
    return block;
}

void Block::leave_out_unused(const std::vector<bool>& used) {
    if (std::find(used.begin(), used.end(), false) == used.end()) return;
    std::vector<std::uint32_t> moved(used.size());
    std::vector<Stack> kept;
    for (std::size_t k = 0; k < used.size(); ++k) {
        moved[k] = static_cast<std::uint32_t>(kept.size());
        if (used[k]) kept.push_back(std::move(m_stacks[k]));
    }
    kept.shrink_to_fit();
    m_stacks = std::move(kept);
    for (std::uint32_t& cell : m_cells) cell = moved[cell];
}

Block Block::with_stacks(const std::map<std::size_t, Stack>& stacks) && {
    StackTable table;
    std::vector<std::uint32_t> moved;
    moved.reserve(m_stacks.size());
    for (Stack& stack : m_stacks) moved.push_back(table.number_of(std::move(stack)));
    for (std::uint32_t& cell : m_cells) cell = moved[cell];
    for (const auto& [cell, stack] : stacks) {
        assert(stack.wefts() == t()[cell / columns()] && stack.warps() == p()[cell % columns()] &&
               stack.check() && stack.height() <= m_height);
        m_cells[cell] = table.number_of(stack);
    }
    m_stacks = std::move(table).take();
    std::vector<bool> used(m_stacks.size());
    for (const std::uint32_t cell : m_cells) used[cell] = true;
    leave_out_unused(used);
    return std::move(*this);
}

bool Block::weft_over(std::size_t pick, std::size_t end) const {
    const std::size_t row = row_of_pick(pick), column = column_of_end(end);
    return stack(row, column).weft_over(pick - first_pick(row), end - first_end(column));
}

CardImage Block::card_image() const {
    const StackPixels pixels(m_stacks);
    CardImage card(picks(), ends());
    for (std::size_t row = 0; row < rows(); ++row) {
        for (std::size_t weft = 0; weft < t()[row]; ++weft) {
            const auto bits = card.row(first_pick(row) + weft);
            for (std::size_t column = 0; column < columns(); ++column) {
                const std::uint8_t* const drawn = pixels.row(m_cells[row * columns() + column], weft);
                put_bits(bits, first_end(column), drawn, p()[column]);
            }
        }
    }
    return card;
}

bool operator==(const Block& a, const Block& b) {
    if (!(a.m_grid == b.m_grid) || a.m_height != b.m_height) return false;
    for (std::size_t cell = 0; cell < a.m_cells.size(); ++cell) {
        if (!(a.m_stacks[a.m_cells[cell]] == b.m_stacks[b.m_cells[cell]])) return false;
    }
    return true;
}

std::uint32_t StackTable::number_of(Stack stack) {
    const auto [entry, is_new] = m_numbers.try_emplace(stack, static_cast<std::uint32_t>(m_stacks.size()));
    if (is_new) m_stacks.push_back(std::move(stack));
    return entry->second;
}

}  // namespace weave
