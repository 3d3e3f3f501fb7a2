#pragma once

#include <weave/block/card_image.hpp>
#include <weave/diff/line_alignment.hpp>

#include <cstdint>

namespace weave {

/// Which pick and end of one card is which of another.
struct CardAlignment {
    LineAlignment picks, ends;
    friend bool operator==(const CardAlignment&, const CardAlignment&) = default;
};

/// Lays one card on another so that as little as possible differs: crossings that changed, and all crossings
/// of picks and ends that were removed or inserted. Found are removed and inserted lines at the edges and
/// inside, also where crossings changed beside them and where both picks and ends were; what is best in
/// general cannot be known in bounded time. Aligning the other way round gives the mirror image of the
/// result.
///
/// Takes memory of some four cards and 16 bytes a pick and end, and a time that grows as the crossings do.
CardAlignment align_cards(const CardImage& before, const CardImage& after);

/// Crossings that differ between a pick of one card and one of another, in the ends that are matched.
std::uint64_t changed_in_line(const CardImage& before, const CardImage& after, std::size_t pick_before,
                              std::size_t pick_after, const LineAlignment& ends);

/// A hash of each pick over the ends that are matched, on one side of the alignment.
std::vector<std::uint64_t> line_hashes(const CardImage& card, const LineAlignment& ends, bool is_before);

}  // namespace weave
