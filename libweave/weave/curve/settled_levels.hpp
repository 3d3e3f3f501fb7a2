#pragma once

#include <weave/block/block.hpp>
#include <weave/curve/cloth_curves.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace weave {

/// What the levels of a cloth settle between.
struct LevelSpacing {
    double dx_mm = 1, dy_mm = 1;        ///< spacing of rows and of columns
    std::array<bool, 2> is_periodic{};  ///< along x (rows) and y (columns)
};

/// Levels at which yarns run more straight than in the slots of their stacks. In a stack neighbours that lie on
/// different slots stay in order, `settled_gap` of a level or more apart; else every yarn runs as straight as the others
/// let it: least is Σ (Δlevel)²/spacing along all yarns, with a weak pull to the planned slots. Picks, whose crossings
/// are mostly closer than those of ends, end up the straighter ones.
class SettledLevels {
  public:
    SettledLevels(const Block& block, const Region& region, const LevelSpacing& spacing);

    [[nodiscard]] double of_pick(std::size_t pick, std::size_t column) const;
    [[nodiscard]] double of_end(std::size_t end, std::size_t row) const;

  private:
    void settle(std::size_t row, std::size_t column);
    [[nodiscard]] std::size_t at_pick(std::size_t pick, std::size_t column) const;
    [[nodiscard]] std::size_t at_end(std::size_t end, std::size_t row) const;

    const Block& m_block;
    Region m_region;
    LevelSpacing m_spacing;
    std::size_t m_rows, m_columns, m_first_pick, m_first_end;
    std::vector<float> m_picks, m_ends;  ///< pick by pick and end by end
};

inline constexpr double settled_gap = 0.6;

}  // namespace weave
