#include <weave/curve/settled_levels.hpp>

#include <algorithm>
#include <cmath>

namespace weave {

namespace {

constexpr int rounds = 60;
constexpr double pull_to_plan = 0.02;  ///< against that of the neighbours in a line of spacing 1 mm

/// A yarn in a stack: where its neighbours would have it, and how much they care.
struct Wish {
    double level = 0, weight = 0;
    float* settled = nullptr;
};

/// The levels nearest to the wishes, in order and settled_gap apart: neighbours that would come too near share their
/// mean wish (pool adjacent violators; Barlow et al. 1972).
void meet_wishes(std::vector<Wish>& wishes) {
    struct Pool {
        double sum, weight;
        std::size_t first;
        [[nodiscard]] double mean() const { return sum / weight; }
    };
    std::vector<Pool> pools;
    for (std::size_t k = 0; k < wishes.size(); ++k) {
        const double level = wishes[k].level - static_cast<double>(k) * settled_gap;
        pools.push_back({level * wishes[k].weight, wishes[k].weight, k});
        while (pools.size() > 1 && pools[pools.size() - 2].mean() > pools.back().mean()) {
            Pool& below = pools[pools.size() - 2];
            below.sum += pools.back().sum;
            below.weight += pools.back().weight;
            pools.pop_back();
        }
    }
    for (std::size_t p = 0; p < pools.size(); ++p) {
        const std::size_t last = p + 1 < pools.size() ? pools[p + 1].first : wishes.size();
        for (std::size_t k = pools[p].first; k < last; ++k)
            *wishes[k].settled = static_cast<float>(pools[p].mean() + static_cast<double>(k) * settled_gap);
    }
}

}  // namespace

SettledLevels::SettledLevels(const Block& block, const Region& region, const LevelSpacing& spacing)
    : m_block(block),
      m_region(region),
      m_spacing(spacing),
      m_rows(region.last_row - region.first_row + 1),
      m_columns(region.last_column - region.first_column + 1),
      m_first_pick(block.first_pick(region.first_row)),
      m_first_end(block.first_end(region.first_column)),
      m_picks((block.first_pick(region.last_row + 1) - m_first_pick) * m_columns),
      m_ends((block.first_end(region.last_column + 1) - m_first_end) * m_rows) {
    const auto each_stack = [&](auto visit) {
        for (std::size_t row = region.first_row; row <= region.last_row; ++row) {
            for (std::size_t column = region.first_column; column <= region.last_column; ++column) visit(row, column);
        }
    };
    each_stack([&](std::size_t row, std::size_t column) {
        const std::span<const Slot> slots = block.stack(row, column).slots();
        for (std::size_t level = 0; level < slots.size(); ++level) {
            if (slots[level].is_empty()) continue;
            const bool weft = slots[level].is_weft();
            float& at = weft ? m_picks[at_pick(block.first_pick(row) + slots[level].index(), column)]
                             : m_ends[at_end(block.first_end(column) + slots[level].index(), row)];
            at = static_cast<float>(level);
        }
    });
    for (int round = 0; round < rounds; ++round) each_stack([&](std::size_t row, std::size_t column) { settle(row, column); });
}

/// Brings the yarns of one stack where their neighbours in their lines would have them.
void SettledLevels::settle(std::size_t row, std::size_t column) {
    const std::span<const Slot> slots = m_block.stack(row, column).slots();
    std::vector<Wish> wishes;
    for (std::size_t level = 0; level < slots.size(); ++level) {
        if (slots[level].is_empty()) continue;
        const bool weft = slots[level].is_weft();
        const std::size_t count = weft ? m_columns : m_rows,
                          k = weft ? column - m_region.first_column : row - m_region.first_row,
                          first = weft ? at_pick(m_block.first_pick(row) + slots[level].index(), m_region.first_column)
                                       : at_end(m_block.first_end(column) + slots[level].index(), m_region.first_row);
        float* line = (weft ? m_picks : m_ends).data() + first;
        const double stiffness = 1 / (weft ? m_spacing.dy_mm : m_spacing.dx_mm);
        const bool goes_round = m_spacing.is_periodic[weft ? 1 : 0];
        Wish wish{pull_to_plan * static_cast<double>(level), pull_to_plan, &line[k]};
        const auto add = [&](std::size_t neighbour) {
            wish.level += stiffness * static_cast<double>(line[neighbour]);
            wish.weight += stiffness;
        };
        if (k > 0 || goes_round) add(k > 0 ? k - 1 : count - 1);
        if (k + 1 < count || goes_round) add(k + 1 < count ? k + 1 : 0);
        wish.level /= wish.weight;
        wishes.push_back(wish);
    }
    meet_wishes(wishes);
}

std::size_t SettledLevels::at_pick(std::size_t pick, std::size_t column) const {
    return (pick - m_first_pick) * m_columns + (column - m_region.first_column);
}

std::size_t SettledLevels::at_end(std::size_t end, std::size_t row) const {
    return (end - m_first_end) * m_rows + (row - m_region.first_row);
}

double SettledLevels::of_pick(std::size_t pick, std::size_t column) const {
    return static_cast<double>(m_picks[at_pick(pick, column)]);
}

double SettledLevels::of_end(std::size_t end, std::size_t row) const {
    return static_cast<double>(m_ends[at_end(end, row)]);
}

}  // namespace weave
