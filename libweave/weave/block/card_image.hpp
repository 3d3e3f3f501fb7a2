#pragma once

#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace weave {

/// No card image, from a file or from an operation, may have more crossings, or more picks or ends, than this: a few
/// bytes of a design can ask for any size, and what is allowed has to fit into a desk's memory (20,000 × 20,000 do).
inline constexpr std::uint64_t most_crossings = std::uint64_t{1} << 29, most_yarns = std::uint64_t{1} << 24;

/// The card image I of a weave (paper, section 4.1): one row per pick, one column per end.
/// A pixel is true (1, white) where the weft lies over the warp, false (0, black) where the end is lifted
/// over the weft. Bits are packed as they are hashed: rows from the first pick on, most significant bit
/// first, each row padded to whole bytes with 0.
class CardImage {
  public:
    CardImage() = default;
    /// All pixels false. The size must pass check_card_size.
    CardImage(std::size_t picks, std::size_t ends);

    [[nodiscard]] std::size_t picks() const { return m_picks; }
    [[nodiscard]] std::size_t ends() const { return m_ends; }
    [[nodiscard]] std::size_t row_bytes() const { return m_row_bytes; }

    /// Whether pick lies over end; both count from 0.
    [[nodiscard]] bool weft_over(std::size_t pick, std::size_t end) const {
        return (m_bytes[pick * m_row_bytes + end / 8] >> (7 - end % 8) & 1) != 0;
    }
    void set(std::size_t pick, std::size_t end, bool weft_over) {
        const auto bit = static_cast<std::uint8_t>(0x80 >> end % 8);
        std::uint8_t& byte = m_bytes[pick * m_row_bytes + end / 8];
        byte = static_cast<std::uint8_t>(weft_over ? byte | bit : byte & ~bit);
    }

    [[nodiscard]] std::span<const std::uint8_t> row(std::size_t pick) const {
        return {m_bytes.data() + pick * m_row_bytes, m_row_bytes};
    }
    /// Packed bits of one row to write to; padding bits must stay 0.
    [[nodiscard]] std::span<std::uint8_t> row(std::size_t pick) {
        return {m_bytes.data() + pick * m_row_bytes, m_row_bytes};
    }
    [[nodiscard]] std::span<const std::uint8_t> bytes() const { return m_bytes; }

    /// SHA-256 of the packed bits, lower-case hexadecimal.
    [[nodiscard]] std::string sha256() const;

    /// The picks as columns and the ends as rows, each pixel as it was.
    [[nodiscard]] CardImage transposed() const;

    friend bool operator==(const CardImage&, const CardImage&) = default;

  private:
    std::size_t m_picks = 0, m_ends = 0, m_row_bytes = 0;
    std::vector<std::uint8_t> m_bytes;
};

/// An error where a card of this size is empty or larger than the limits.
Status check_card_size(std::uint64_t picks, std::uint64_t ends);

}  // namespace weave
