#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::loomlink {

/// One bit a hook and pick: whether the hook is lifted. Hooks count from 0 in the controller's order, picks
/// from 0 as they are woven.
class LiftTable {
  public:
    LiftTable() = default;
    /// Nothing lifted.
    LiftTable(std::size_t picks, std::size_t hooks)
        : m_picks(picks), m_hooks(hooks), m_row_bytes((hooks + 7) / 8), m_bits(picks * m_row_bytes) {}

    [[nodiscard]] std::size_t picks() const { return m_picks; }
    [[nodiscard]] std::size_t hooks() const { return m_hooks; }

    [[nodiscard]] bool lifted(std::size_t pick, std::size_t hook) const {
        return (m_bits[pick * m_row_bytes + hook / 8] >> hook % 8 & 1) != 0;
    }
    void lift(std::size_t pick, std::size_t hook) {
        m_bits[pick * m_row_bytes + hook / 8] |= static_cast<std::uint8_t>(1 << hook % 8);
    }

    friend bool operator==(const LiftTable&, const LiftTable&) = default;

  private:
    std::size_t m_picks = 0, m_hooks = 0, m_row_bytes = 0;
    std::vector<std::uint8_t> m_bits;
};

}  // namespace weave::loomlink
