#include <weave/block/from_card.hpp>

#include <weave/block/card_bits.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

namespace weave {

namespace {

using Counts = std::vector<std::uint32_t>;

/// The pixels of one cell: per weft `words` words, in which the leading bits are the warps below it.
struct Cell {
    std::size_t wefts = 0, warps = 0, words = 0;
    std::vector<std::uint64_t> bits;

    [[nodiscard]] std::span<const std::uint64_t> weft(std::size_t k) const {
        return std::span(bits).subspan(k * words, words);
    }
    [[nodiscard]] std::size_t warps_below(std::size_t k) const {
        std::size_t count = 0;
        for (const std::uint64_t word : weft(k)) count += static_cast<std::size_t>(std::popcount(word));
        return count;
    }
    void read(const CardImage& card, std::size_t first_pick, std::size_t first_end) {
        bits.clear();
        for (std::size_t k = 0; k < wefts; ++k) {
            const auto row = card.row(first_pick + k);
            for (std::size_t done = 0; done < warps; done += 64) {
                bits.push_back(bits_at(row, first_end + done, std::min<std::size_t>(64, warps - done)));
            }
        }
    }
};

/// Two picks and two ends of a cell that lie crosswise.
struct Contradiction {
    std::size_t weft = 0, other_weft = 0, warp = 0, other_warp = 0;
};

std::size_t first_only_in(std::span<const std::uint64_t> one, std::span<const std::uint64_t> other) {
    for (std::size_t word = 0;; ++word) {
        const std::uint64_t only = one[word] & ~other[word];
        if (only != 0) return word * 64 + static_cast<std::size_t>(std::countl_zero(only));
    }
}

/// The wefts of a cell from the bottom up: the fewer warps below, the lower; then by number.
std::vector<std::size_t> wefts_upwards(const Cell& cell) {
    std::vector<std::size_t> order(cell.wefts), below(cell.wefts);
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t k = 0; k < cell.wefts; ++k) below[k] = cell.warps_below(k);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return below[a] < below[b]; });
    return order;
}

/// The canonical stack of a cell. It has one exactly when the sets of warps below its wefts are nested (a
/// staircase); otherwise two of them that follow each other in size give the contradiction.
std::variant<Stack, Contradiction> order_of(const Cell& cell) {
    std::vector<Slot> slots;
    slots.reserve(cell.wefts + cell.warps);
    const std::vector<std::uint64_t> nothing(cell.words);
    std::span<const std::uint64_t> reached(nothing);
    std::size_t lower = 0;
    for (const std::size_t weft : wefts_upwards(cell)) {
        const auto below = cell.weft(weft);
        for (std::size_t word = 0; word < cell.words; ++word) {
            if ((reached[word] & ~below[word]) != 0) {
                return Contradiction{lower, weft, first_only_in(reached, below),
                                     first_only_in(below, reached)};
            }
        }
        for (std::size_t word = 0; word < cell.words; ++word) {
            for (std::uint64_t added = below[word] & ~reached[word]; added != 0;) {
                const int bit = std::countl_zero(added);
                slots.push_back(Slot::warp(word * 64 + static_cast<std::size_t>(bit)));
                added &= ~(std::uint64_t{1} << (63 - bit));
            }
        }
        slots.push_back(Slot::weft(weft));
        reached = below;
        lower = weft;
    }
    for (std::size_t warp = 0; warp < cell.warps; ++warp) {
        if ((reached[warp / 64] >> (63 - warp % 64) & 1) == 0) slots.push_back(Slot::warp(warp));
    }
    return Stack(std::move(slots));
}

/// The stacks met so far, by the pixels of their cell: a design has few different ones among its many cells.
class KnownCells {
  public:
    static constexpr std::uint32_t unknown = ~std::uint32_t{0};

    /// The number kept for cells of this shape and these pixels; `unknown` where there is none yet.
    std::uint32_t& number_of(const Cell& cell) {
        Shape& shape = shape_of(cell.wefts, cell.warps);
        const std::size_t crossings = cell.wefts * cell.warps;
        if (crossings > 64) return shape.large.try_emplace(bytes_of(cell), unknown).first->second;
        std::uint64_t key = 0;
        for (const std::uint64_t word : cell.bits)
            key = cell.warps == 64 ? word : key << cell.warps | word >> (64 - cell.warps);
        if (crossings > most_in_table) return shape.small.try_emplace(key, unknown).first->second;
        if (shape.table.empty()) shape.table.assign(std::size_t{1} << crossings, unknown);
        return shape.table[key];
    }

  private:
    static constexpr std::size_t most_in_table = 12;
    struct Shape {
        std::vector<std::uint32_t> table;
        std::unordered_map<std::uint64_t, std::uint32_t> small;
        std::unordered_map<std::string, std::uint32_t> large;
    };

    static std::string bytes_of(const Cell& cell) {
        return {reinterpret_cast<const char*>(cell.bits.data()), cell.bits.size() * sizeof(std::uint64_t)};
    }
    Shape& shape_of(std::size_t wefts, std::size_t warps) {
        if (m_last == nullptr || m_last_shape != std::pair(wefts, warps)) {
            m_last_shape = {wefts, warps};
            m_last = &m_shapes[m_last_shape];
        }
        return *m_last;
    }

    std::map<std::pair<std::size_t, std::size_t>, Shape> m_shapes;
    std::pair<std::size_t, std::size_t> m_last_shape;
    Shape* m_last = nullptr;
};

/// `counts` as often as they fit into `yarns`, which must come out even.
Result<Counts> repeated_over(const Counts& counts, std::size_t yarns, const char* name, const char* kind) {
    std::uint64_t sum = 0;
    for (const std::uint32_t count : counts) {
        if (count == 0) return bad_input(std::string(name) + " holds a 0; each count must be at least 1");
        sum += count;
    }
    if (counts.empty()) return bad_input(std::string(name) + " holds no counts");
    if (sum > yarns || yarns % sum != 0) {
        return bad_input("the counts of " + std::string(name) + " add up to " + std::to_string(sum) + " " +
                         kind + ", which does not divide the card's " + std::to_string(yarns));
    }
    Counts all;
    all.reserve(yarns / sum * counts.size());
    for (std::size_t k = 0; k < yarns / sum; ++k) all.insert(all.end(), counts.begin(), counts.end());
    return all;
}

Error contradicts(const Contradiction& found, std::size_t row, std::size_t column, std::size_t first_pick,
                  std::size_t first_end) {
    const auto pick = [&](std::size_t k) { return "pick " + std::to_string(first_pick + k + 1); };
    const auto end = [&](std::size_t k) { return "end " + std::to_string(first_end + k + 1); };
    return invalid("no order fits: " + pick(found.weft) + " lies over " + end(found.warp) + " and under " +
                       end(found.other_warp) + ", but " + pick(found.other_weft) + " under " +
                       end(found.warp) + " and over " + end(found.other_warp),
                   "stacks[" + std::to_string(row) + "][" + std::to_string(column) + "]");
}

/// One pick and one end a cell: the pixel itself numbers the stack. Four hundred million crossings pass here.
Result<Block> single_block(const CardImage& card, Counts t, Counts p) {
    std::vector<std::uint32_t> cells(card.picks() * card.ends());
    std::size_t cell = 0;
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        const auto row = card.row(pick);
        for (std::size_t end = 0; end < card.ends(); ++end) cells[cell++] = row[end / 8] >> (7 - end % 8) & 1;
    }
    std::vector<Stack> stacks{Stack({Slot::weft(0), Slot::warp(0)}), Stack({Slot::warp(0), Slot::weft(0)})};
    return Block::make(std::move(t), std::move(p), std::move(stacks), std::move(cells));
}

}  // namespace

Result<Block> block_from_card(const CardImage& card, std::vector<std::uint32_t> t,
                              std::vector<std::uint32_t> p) {
    WEAVE_CHECK_OK(check_card_size(card.picks(), card.ends()));
    WEAVE_TRY(t, repeated_over(t, card.picks(), "t", "picks"));
    WEAVE_TRY(p, repeated_over(p, card.ends(), "p", "ends"));
    if (all_single(t) && all_single(p)) return single_block(card, std::move(t), std::move(p));
    KnownCells known;
    Cell cell;
    std::vector<Stack> stacks;
    std::vector<std::uint32_t> cells;
    cells.reserve(t.size() * p.size());
    for (std::size_t row = 0, first_pick = 0; row < t.size(); first_pick += t[row++]) {
        for (std::size_t column = 0, first_end = 0; column < p.size(); first_end += p[column++]) {
            cell.wefts = t[row], cell.warps = p[column], cell.words = (cell.warps + 63) / 64;
            cell.read(card, first_pick, first_end);
            std::uint32_t& number = known.number_of(cell);
            if (number == KnownCells::unknown) {
                auto order = order_of(cell);
                if (const auto* found = std::get_if<Contradiction>(&order)) {
                    return contradicts(*found, row, column, first_pick, first_end);
                }
                number = static_cast<std::uint32_t>(stacks.size());
                stacks.push_back(std::move(std::get<Stack>(order)));
            }
            cells.push_back(number);
        }
    }
    return Block::make(std::move(t), std::move(p), std::move(stacks), std::move(cells));
}

}  // namespace weave
