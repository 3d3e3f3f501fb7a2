#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace weave {

/// Up to 64 pixels of a packed row of the card from `at` on, the first in the most significant bit, 0 after
/// the last.
inline std::uint64_t bits_at(std::span<const std::uint8_t> row, std::size_t at, std::size_t count) {
    const std::size_t first = at / 8, shift = at % 8;
    std::uint64_t word = 0;
    for (std::size_t k = 0; k < 8; ++k) word = word << 8 | (first + k < row.size() ? row[first + k] : 0U);
    word <<= shift;
    if (shift != 0 && first + 8 < row.size()) word |= std::uint64_t{row[first + 8]} >> (8 - shift);
    return count == 0 ? 0 : word >> (64 - count) << (64 - count);
}

/// Whether every row has one pick (or every column one end).
inline bool all_single(std::span<const std::uint32_t> counts) {
    return std::all_of(counts.begin(), counts.end(), [](std::uint32_t count) { return count == 1; });
}

/// How two sets of yarns lie to each other.
enum class Nesting : std::uint8_t { equal, inside, around, apart };

/// Follows two sets word by word; once they are apart they stay so.
class NestingTest {
  public:
    void add(std::uint64_t one, std::uint64_t other) {
        m_only_one |= one & ~other;
        m_only_other |= other & ~one;
    }
    [[nodiscard]] bool apart() const { return m_only_one != 0 && m_only_other != 0; }
    [[nodiscard]] Nesting result() const {
        if (apart()) return Nesting::apart;
        if (m_only_one != 0) return Nesting::around;
        return m_only_other != 0 ? Nesting::inside : Nesting::equal;
    }

  private:
    std::uint64_t m_only_one = 0, m_only_other = 0;
};

}  // namespace weave
