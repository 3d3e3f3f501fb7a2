#include <weave/block/block.hpp>

#include <algorithm>
#include <string>

namespace weave {

namespace {

std::string cell_name(std::size_t row, std::size_t column) {
    return "stacks[" + std::to_string(row) + "][" + std::to_string(column) + "]";
}

std::vector<std::size_t> running_sums(const std::vector<std::uint32_t>& counts) {
    std::vector<std::size_t> sums{0};
    sums.reserve(counts.size() + 1);
    for (const std::uint32_t count : counts) sums.push_back(sums.back() + count);
    return sums;
}

std::string count_of(std::size_t number, const char* noun) {
    return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

Status check_cell(const Stack& stack, std::size_t picks, std::size_t ends, std::size_t row,
                  std::size_t column) {
    const std::string where = cell_name(row, column);
    if (stack.wefts() != picks) {
        return bad_input("holds " + count_of(stack.wefts(), "pick") + ", but row " + std::to_string(row) +
                             " has " + std::to_string(picks),
                         where);
    }
    if (stack.warps() != ends) {
        return bad_input("holds " + count_of(stack.warps(), "end") + ", but column " +
                             std::to_string(column) + " has " + std::to_string(ends),
                         where);
    }
    if (Status fine = stack.check(); !fine) return std::move(fine).error().in(where);
    return {};
}

/// The pixels of one stack: per weft a row of bits, most significant first, bit k for warp k.
std::vector<std::vector<std::uint8_t>> pixels_of(const Stack& stack) {
    std::vector<std::uint8_t> warps_below((stack.warps() + 7) / 8);
    std::vector<std::vector<std::uint8_t>> rows(stack.wefts());
    for (const Slot slot : stack.slots()) {
        if (slot.is_warp())
            warps_below[slot.index() / 8] |= static_cast<std::uint8_t>(0x80 >> slot.index() % 8);
        if (slot.is_weft()) rows[slot.index()] = warps_below;
    }
    return rows;
}

/// ORs `bits` (`count` of them, padding 0) into a row of the card at bit `at`.
void put_bits(std::span<std::uint8_t> row, std::size_t at, const std::vector<std::uint8_t>& bits,
              std::size_t count) {
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
    return bad_input(count_of(stacks, "different stack") + " of " + count_of(height, "slot") +
                     " are more than the limit of " + std::to_string(most_slots) + " slots");
}

Result<Block> Block::make(std::vector<std::uint32_t> t, std::vector<std::uint32_t> p,
                          std::vector<Stack> stacks, std::vector<std::uint32_t> cells, std::size_t height) {
    assert(cells.size() == t.size() * p.size());
    Block block;
    block.m_first_pick = running_sums(t);
    block.m_first_end = running_sums(p);
    if (block.picks() == 0 || block.ends() == 0)
        return bad_input("a block needs at least one pick and one end");
    WEAVE_CHECK_OK(check_card_size(block.picks(), block.ends()));
    std::vector<bool> checked(stacks.size());
    for (std::size_t row = 0, cell = 0; row < t.size(); ++row) {
        for (std::size_t column = 0; column < p.size(); ++column, ++cell) {
            const Stack& stack = stacks[cells[cell]];
            if (checked[cells[cell]] && stack.wefts() == t[row] && stack.warps() == p[column]) continue;
            WEAVE_CHECK_OK(check_cell(stack, t[row], p[column], row, column));
            checked[cells[cell]] = true;
            height = std::max(height, stack.height());
        }
    }
    WEAVE_CHECK_OK(check_height(height));
    block.m_t = std::move(t);
    block.m_p = std::move(p);
    block.m_height = height;
    block.m_stacks = std::move(stacks);
    block.m_cells = std::move(cells);
    return block;
}

std::size_t Block::row_of_pick(std::size_t pick) const {
    const auto next = std::upper_bound(m_first_pick.begin(), m_first_pick.end(), pick);
    return static_cast<std::size_t>(next - m_first_pick.begin()) - 1;
}

std::size_t Block::column_of_end(std::size_t end) const {
    const auto next = std::upper_bound(m_first_end.begin(), m_first_end.end(), end);
    return static_cast<std::size_t>(next - m_first_end.begin()) - 1;
}

bool Block::weft_over(std::size_t pick, std::size_t end) const {
    const std::size_t row = row_of_pick(pick), column = column_of_end(end);
    const Slot weft = Slot::weft(pick - m_first_pick[row]), warp = Slot::warp(end - m_first_end[column]);
    for (const Slot slot : stack(row, column).slots()) {
        if (slot.same_system(warp) && slot.index() == warp.index()) return true;
        if (slot.same_system(weft) && slot.index() == weft.index()) return false;
    }
    return false;
}

CardImage Block::card_image() const {
    std::vector<std::vector<std::vector<std::uint8_t>>> pixels;
    pixels.reserve(m_stacks.size());
    for (const Stack& stack : m_stacks) pixels.push_back(pixels_of(stack));
    CardImage card(picks(), ends());
    for (std::size_t row = 0; row < rows(); ++row) {
        for (std::size_t weft = 0; weft < m_t[row]; ++weft) {
            const auto bits = card.row(m_first_pick[row] + weft);
            for (std::size_t column = 0; column < columns(); ++column) {
                const std::uint32_t number = m_cells[row * columns() + column];
                put_bits(bits, m_first_end[column], pixels[number][weft], m_p[column]);
            }
        }
    }
    return card;
}

bool operator==(const Block& a, const Block& b) {
    if (a.m_t != b.m_t || a.m_p != b.m_p || a.m_height != b.m_height) return false;
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
