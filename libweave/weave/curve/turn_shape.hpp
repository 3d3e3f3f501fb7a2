#pragma once

#include <weave/curve/weft_parts.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace weave {

/// Lays out the turns of a wraparound cloth: where each runs in the gap between two columns, and over or
/// under what it passes there. Lengths in rows, columns and levels.
class TurnShapes {
  public:
    /// The level of a part in a column between its first and last.
    using LevelOf = std::function<double(const WeftPart&, std::size_t column)>;

    /// `reach` is how far outside its column a turn lies by itself, in columns. All arguments must outlive
    /// this.
    TurnShapes(const Block& block, const WeftParts& wefts, LevelOf level_of, double reach);

    /// The key points of a turn between those in the stacks that it joins, in columns, rows and levels, from
    /// its earlier pick to its later: half an ellipse outside the column. A turn over several rows runs on
    /// along the gap with one point a row that it passes, and there above or below the picks as
    /// loom/weft_way.hpp has it, where their order allows. `variant` counts other, less regular ways that end
    /// at the same stacks.
    [[nodiscard]] std::vector<Vec3> keys(std::size_t bend, std::size_t variant) const;

  private:
    struct Lane {
        std::size_t gap = 0;         ///< left of column `gap`
        double outside = 0.5;        ///< columns from the column that it turns round
        double first = 0, last = 0;  ///< rows
    };
    [[nodiscard]] Vec3 end_of(const WeftBend& bend, bool later) const;
    void assign_lanes(const std::vector<std::size_t>& bends, double reach);
    [[nodiscard]] double level_at_row(std::size_t bend, std::size_t row, double straight) const;
    [[nodiscard]] bool lies_above(const WeftBend& loop, const WeftPart& part) const;
    [[nodiscard]] bool passes_above(const WeftBend& outer, const WeftBend& inner) const;
    [[nodiscard]] double bulge_of(std::size_t bend, std::size_t variant) const;
    template <class Visit>
    void each_passing(std::size_t bend, std::size_t row, Visit visit) const;

    const Block& m_block;
    const WeftParts& m_wefts;
    LevelOf m_level_of;
    std::vector<Lane> m_lanes;                       ///< of each bend
    std::vector<std::vector<std::size_t>> m_of_row;  ///< parts
};

}  // namespace weave
