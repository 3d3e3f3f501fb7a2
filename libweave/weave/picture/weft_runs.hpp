#pragma once

#include <weave/loom/weft_way.hpp>
#include <weave/picture/look.hpp>

#include <cstddef>
#include <vector>

namespace weave {

/// Where the picks lie in a drawing: edge to edge in periodic mode, between their turns in wraparound.
class WeftRuns {
  public:
    WeftRuns(const Subject& subject, const YarnColours& colours);

    struct Run {
        bool woven = false;               ///< a pick without feeder brings no weft
        std::size_t first = 0, last = 0;  ///< columns of the block
        bool leftwards = false;
    };
    [[nodiscard]] const Run& of_pick(std::size_t pick) const { return m_runs[pick]; }
    [[nodiscard]] bool wraparound() const { return m_wraparound; }
    [[nodiscard]] const std::vector<Turn>& turns() const { return m_way.turns; }
    /// The column round whose end (or at which) a turn lies; at the edge of the cloth where nothing catches
    /// it.
    [[nodiscard]] std::size_t column_of(const Turn& turn) const;

  private:
    const Block& m_block;
    bool m_wraparound;
    WeftWay m_way;
    std::vector<Run> m_runs;
};

}  // namespace weave
