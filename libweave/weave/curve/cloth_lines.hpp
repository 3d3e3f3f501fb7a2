#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/curve/passing.hpp>
#include <weave/curve/settled_levels.hpp>
#include <weave/curve/weft_parts.hpp>
#include <weave/loom/pick_table.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace weave {

/// Radii of the yarns that lie in a cloth, scaled as the scene asks.
struct ClothRadii {
    double warp_mm = 0, weft_mm = 0;  ///< mean
    double thinnest_mm = 0;
};

/// The rows and columns of a cloth or a region of it, and how the yarns of each get past one another. How a line is led is found
/// once, and kept in a bit for each stack of a yarn; its ways are made from that when they are asked for, and those of some lines kept.
class ClothLines {
  public:
    using Leads = std::shared_ptr<const std::vector<Lead>>;

    ClothLines(const Design& design, const Block& block, const CurveOptions& options);

    /// Spacing, size and region; no yarns.
    [[nodiscard]] const ClothCurves& frame() const { return m_frame; }
    [[nodiscard]] const ClothRadii& radii() const { return m_radii; }
    [[nodiscard]] bool wraps() const { return m_wraps; }
    [[nodiscard]] const WeftParts& wefts() const { return m_wefts; }
    [[nodiscard]] std::size_t rows() const { return m_frame.region.last_row - m_frame.region.first_row + 1; }
    [[nodiscard]] std::size_t columns() const { return m_frame.region.last_column - m_frame.region.first_column + 1; }

    [[nodiscard]] Vec3 place(double row, double column, double level) const {
        return {row * m_frame.dx_mm, column * m_frame.dy_mm, level * m_frame.dz_mm};
    }
    [[nodiscard]] double level_of(const WeftPart& part, std::size_t column) const;
    [[nodiscard]] bool is_loose_pick(std::size_t pick, std::size_t row, std::size_t column) const;
    [[nodiscard]] bool is_loose_end(std::size_t end, std::size_t row, std::size_t column) const;
    /// All along.
    [[nodiscard]] bool is_loose_part(std::size_t part) const;
    /// Whether a pick lies above an end where they cross.
    [[nodiscard]] bool is_over(std::size_t pick, std::size_t end, std::size_t row, std::size_t column) const;

    /// The first of the parts of a row, or behind them: they follow one another.
    [[nodiscard]] std::size_t first_part(std::size_t row) const;
    /// Ways of the parts of a row, and of the ends of a column.
    [[nodiscard]] Leads row(std::size_t row) const;
    [[nodiscard]] Leads column(std::size_t column) const;
    /// Leads the picks of a row further aside; whether that was still possible.
    bool lead_further(std::size_t row);
    [[nodiscard]] const std::vector<std::size_t>& efforts() const { return m_row_effort; }
    void set_efforts(std::vector<std::size_t> efforts);

  private:
    /// Where yarns lie in the stacks of a block, each different stack looked at once.
    class Places {
      public:
        explicit Places(const Block& block);
        [[nodiscard]] std::size_t of_pick(std::size_t pick, std::size_t row, std::size_t column) const;
        [[nodiscard]] std::size_t of_end(std::size_t end, std::size_t row, std::size_t column) const;
        [[nodiscard]] bool is_loose(std::size_t place, std::size_t row, std::size_t column) const;

      private:
        const Block& m_block;
        std::vector<std::vector<std::size_t>> m_wefts, m_warps;  ///< per different stack
    };
    /// Ways of lines, as long as there are few enough.
    class Kept {
      public:
        [[nodiscard]] Leads find(std::size_t line) const;
        Leads keep(std::size_t line, std::vector<Lead> leads);
        void forget(std::size_t line);

      private:
        static std::size_t keys_of(const std::vector<Lead>& leads);
        std::map<std::size_t, Leads> m_lines;
        std::size_t m_keys = 0;
    };

    void measure(const Design& design, const CurveOptions& options);
    [[nodiscard]] double level_of_end(std::size_t end, std::size_t row, std::size_t column) const;
    [[nodiscard]] bool wefts_climb() const;
    void forget(std::size_t row);

    const Block& m_block;
    std::vector<Pick> m_picks;
    Places m_places;
    ClothRadii m_radii;
    bool m_wraps;
    ClothCurves m_frame;
    WeftParts m_wefts;
    std::optional<SettledLevels> m_settled;
    std::vector<std::size_t> m_row_effort;
    mutable Kept m_kept_rows, m_kept_columns;
    mutable std::vector<std::optional<LineWay>> m_row_way, m_column_way;  ///< where they were asked for
};

}  // namespace weave
