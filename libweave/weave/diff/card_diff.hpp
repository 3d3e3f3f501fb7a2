#pragma once

#include <weave/diff/card_alignment.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace weave {

/// Crossings side by side in one pick that changed alike; all numbers from 0.
struct ChangedRun {
    std::size_t pick_before = 0, pick_after = 0;
    std::size_t end_before = 0, end_after = 0;  ///< the first
    std::size_t count = 0;
    bool lifted = false;  ///< the ends are lifted now and were not; otherwise the other way round
    friend bool operator==(const ChangedRun&, const ChangedRun&) = default;
};

/// The picks and ends within which all changes lie, the last ones included; from 0.
struct ChangedBox {
    std::size_t first_pick = 0, last_pick = 0, first_end = 0, last_end = 0;
    friend bool operator==(const ChangedBox&, const ChangedBox&) = default;
};

/// A pick (or end) that weaves elsewhere what it wove before.
struct MovedLine {
    std::size_t before = 0, after = 0;
    friend bool operator==(const MovedLine&, const MovedLine&) = default;
};

/// Two card images compared, laid on each other so that as little as possible differs.
struct CardDiff {
    /// No more runs are listed; all are counted.
    static constexpr std::size_t most_runs = 4096;

    CardAlignment alignment;
    std::uint64_t compared = 0;               ///< crossings of matched picks and ends
    std::uint64_t lifted = 0;                 ///< of these, ends that are lifted now and were not
    std::uint64_t lowered = 0;                ///< ends that were lifted and are not now
    std::size_t picks = 0, ends = 0;          ///< how many matched picks and ends have changed crossings
    std::optional<ChangedBox> before, after;  ///< where they are, in the numbers of each card
    std::vector<ChangedRun> runs;             ///< the first ones, by pick and end
    std::uint64_t runs_in_all = 0;
    /// Picks (or ends) that differ where they lie, and equal one that differs elsewhere, and only that one.
    std::vector<MovedLine> moved_picks, moved_ends;

    [[nodiscard]] std::uint64_t changed() const { return lifted + lowered; }
    /// The same size, and no crossing that differs.
    [[nodiscard]] bool is_same() const {
        return changed() == 0 && alignment.picks.is_straight() && alignment.ends.is_straight();
    }
};

/// Compares two cards. Counts are the same whichever card is called the first, but that lifted and lowered,
/// inserted and removed change their parts.
CardDiff diff_cards(const CardImage& before, const CardImage& after);

}  // namespace weave
