#pragma once

#include <weave/loom/pick_table.hpp>
#include <weave/picture/page.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace weave {

/// The paper's colours: grey wefts, orange warps.
inline constexpr Colour paper_weft{0x8a, 0x8f, 0x96}, paper_warp{0xe6, 0x8a, 0x1e};

/// Colours of the yarns of a cloth, every end and pick looked up once.
class YarnColours {
  public:
    explicit YarnColours(const Subject& subject);
    /// As the design says. A pick without feeder brings no weft.
    [[nodiscard]] Colour of_end(std::size_t end) const { return m_ends[end]; }
    [[nodiscard]] Colour of_pick(std::size_t pick) const { return m_picks[pick]; }
    [[nodiscard]] bool has_weft(std::size_t pick) const { return m_woven[pick]; }
    /// For drawings that explain: the paper's colours, unless the design has colours of its own for this
    /// system.
    [[nodiscard]] Colour drawn_end(std::size_t end) const { return m_own_warp ? m_ends[end] : paper_warp; }
    [[nodiscard]] Colour drawn_pick(std::size_t pick) const {
        return m_own_weft ? m_picks[pick] : paper_weft;
    }
    /// The same in a shade that tells the yarn from those of its colour in the same column or row.
    [[nodiscard]] Colour shaded_end(std::size_t end) const;
    [[nodiscard]] Colour shaded_pick(std::size_t pick) const;
    [[nodiscard]] const std::vector<Pick>& picks() const { return m_table; }

  private:
    std::vector<Pick> m_table;
    std::vector<Colour> m_ends, m_picks;
    std::vector<std::uint8_t> m_end_shades, m_pick_shades;
    std::vector<bool> m_woven;
    bool m_own_warp = false, m_own_weft = false;
};

/// The yarn that is seen at every stack of a cloth, from above or below.
class Surface {
  public:
    /// With `trim`, yarns that are loose on purpose are looked through; picks without weft always are.
    Surface(const Block& block, const YarnColours& colours, bool back, bool trim);
    /// Empty where nothing lies there. Numbers count within the stack.
    [[nodiscard]] Slot at(std::size_t row, std::size_t column) const;
    [[nodiscard]] const Block& block() const { return m_block; }
    [[nodiscard]] std::optional<Colour> colour(std::size_t row, std::size_t column) const;

  private:
    [[nodiscard]] Slot seen(const Stack& stack, std::size_t row, bool all_woven) const;
    const Block& m_block;
    const YarnColours& m_colours;
    bool m_back, m_trim;
    std::vector<Slot> m_of_stack;      ///< for each stack of the block's table, where all wefts are woven
    std::vector<bool> m_row_is_woven;  ///< rows all of whose picks bring weft
};

}  // namespace weave
