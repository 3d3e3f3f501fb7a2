#pragma once

#include <weave/core/result.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// The two yarn systems of a cloth.
enum class System : std::uint8_t { warp, weft };

/// One place in a stack: empty (paper's E), a weft or a warp.
///
/// A yarn is counted from 0 within its own row (wefts) or column (warps) of the block, so a stack means the
/// same wherever it stands and operations need not renumber it. The number on the loom is
/// Block::first_pick(row) + index or Block::first_end(column) + index.
///
/// A yarn may be loose on purpose: a placeholder, or a part that is trimmed after weaving. It weaves as it
/// lies, but checks do not ask that it binds, and trimmed pictures leave it out.
class Slot {
  public:
    static constexpr std::uint32_t most_yarns = std::uint32_t{1} << 28;

    constexpr Slot() = default;  ///< empty
    static constexpr Slot weft(std::size_t index, bool loose = false) { return {weft_kind, index, loose}; }
    static constexpr Slot warp(std::size_t index, bool loose = false) { return {warp_kind, index, loose}; }

    [[nodiscard]] constexpr bool is_empty() const { return m_bits == 0; }
    [[nodiscard]] constexpr bool is_weft() const { return (m_bits & 3) == weft_kind; }
    [[nodiscard]] constexpr bool is_warp() const { return (m_bits & 3) == warp_kind; }
    [[nodiscard]] constexpr bool is_loose() const { return (m_bits & 4) != 0; }
    [[nodiscard]] constexpr std::size_t index() const { return m_bits >> 3; }
    [[nodiscard]] constexpr bool same_system(Slot other) const { return (m_bits & 3) == (other.m_bits & 3); }
    [[nodiscard]] constexpr std::uint32_t bits() const { return m_bits; }

    /// The same kind of yarn with another number.
    [[nodiscard]] constexpr Slot renumbered(std::size_t index) const {
        return {m_bits & 3, index, is_loose()};
    }

    friend constexpr bool operator==(Slot, Slot) = default;

  private:
    static constexpr std::uint32_t weft_kind = 1, warp_kind = 2;
    constexpr Slot(std::uint32_t kind, std::size_t index, bool loose)
        : m_bits(static_cast<std::uint32_t>(index) << 3 | (loose ? 4U : 0U) | kind) {}
    std::uint32_t m_bits = 0;
};

/// The yarns of one cell of a block from the bottom up. Empty slots above the topmost yarn are not kept.
class Stack {
  public:
    Stack() = default;
    explicit Stack(std::vector<Slot> slots);

    [[nodiscard]] std::span<const Slot> slots() const { return m_slots; }
    [[nodiscard]] std::size_t height() const { return m_slots.size(); }
    [[nodiscard]] std::size_t wefts() const { return m_wefts; }
    [[nodiscard]] std::size_t warps() const { return m_warps; }

    /// Whether that weft stands above that warp; the stack must hold both.
    [[nodiscard]] bool weft_over(std::size_t weft, std::size_t warp) const;

    /// Whether the stack holds wefts 0 … wefts()-1 and warps 0 … warps()-1 exactly once each.
    /// Otherwise a sentence that names the yarn which is foreign or repeated as documents write it: counted
    /// through the whole block, so from the first pick and end of the cell.
    [[nodiscard]] Status check(std::size_t first_pick = 0, std::size_t first_end = 0) const;

    /// Position of each weft (or warp) from the bottom, by its number in the cell. The stack must pass
    /// check().
    [[nodiscard]] std::vector<std::size_t> positions(System system) const;

    friend bool operator==(const Stack& a, const Stack& b) { return a.m_slots == b.m_slots; }

  private:
    std::vector<Slot> m_slots;
    std::size_t m_wefts = 0, m_warps = 0;
};

struct StackHash {
    std::size_t operator()(const Stack& stack) const;
};

/// Reads a stack as people write it, bottom first: `T0 P1 P0 -` is weft 0, warp 1, warp 0 and an empty slot;
/// a yarn that is loose on purpose has a tilde: `P2~`. Numbers count through the whole block, so the first
/// pick and end of the cell are taken off. Errors: an unknown word, or a yarn that comes before the cell.
Result<Stack> parse_stack(std::string_view text, std::size_t first_pick = 0, std::size_t first_end = 0);

/// The stack in the form that parse_stack reads.
std::string to_text(const Stack& stack, std::size_t first_pick = 0, std::size_t first_end = 0);

}  // namespace weave
