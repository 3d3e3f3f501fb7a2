#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace weave {

/// Lines that follow one another.
struct LineSpan {
    std::size_t first = 0, count = 0;  ///< first from 0
    friend bool operator==(const LineSpan&, const LineSpan&) = default;
};

/// Lines before that are these lines after.
struct LineMatch {
    std::size_t before = 0, after = 0, count = 0;  ///< the first of each, from 0
    friend bool operator==(const LineMatch&, const LineMatch&) = default;
};

/// Which line of one list is which of another. Both lists keep their order: matches rise on both sides. A
/// line before without a partner was removed, one after without a partner inserted.
struct LineAlignment {
    std::size_t before = 0, after = 0;  ///< lengths of the lists
    std::vector<LineMatch> matches;

    [[nodiscard]] std::vector<LineSpan> removed() const;
    [[nodiscard]] std::vector<LineSpan> inserted() const;
    [[nodiscard]] std::size_t matched() const;
    /// Whether line k is line k throughout.
    [[nodiscard]] bool is_straight() const;
    friend bool operator==(const LineAlignment&, const LineAlignment&) = default;
};

/// The alignment of the lists the other way round.
LineAlignment turned_round(LineAlignment alignment);

/// Lines of both lists as they are told together: matched ones once, between them what was removed, then what
/// was inserted there.
struct MergedSpan {
    enum class Kind : std::uint8_t { matched, removed, inserted };
    Kind kind = Kind::matched;
    std::size_t before = 0, after = 0;  ///< first line on each side; where there is none, the next one
    std::size_t count = 0;
};
std::vector<MergedSpan> merged(const LineAlignment& alignment);

/// The first `min(before, after)` lines matched from the front, or from the back.
LineAlignment matched_from_front(std::size_t before, std::size_t after);
LineAlignment matched_from_back(std::size_t before, std::size_t after);

/// Equal lines matched: a longest common subsequence after Myers, "An O(ND) difference algorithm and its
/// variations" (1986), in linear space. Takes at most some `most_steps` steps; what is still open then stays
/// unmatched, which is no wrong answer but a longer one. Lines are given by hashes.
LineAlignment match_equal(std::span<const std::uint64_t> before, std::span<const std::uint64_t> after,
                          std::uint64_t most_steps = std::uint64_t{1} << 26);

/// In how many places line `before` differs from line `after`.
using LineDistance = std::function<std::uint64_t(std::size_t before, std::size_t after)>;

/// Matches what lies open between matches as well, so that of each gap only the lines remain by which one
/// side is longer, taken out where the rest then differs least. In time of the lines in the gaps.
void match_gaps(LineAlignment& alignment, const LineDistance& distance);

/// Takes back detours: where matched lines leave a diagonal and come back to it, they are matched straight if
/// that differs in less than the lines which the detour removes and inserts, `line_length` each.
void straighten(LineAlignment& alignment, const LineDistance& distance, std::uint64_t line_length);

}  // namespace weave
