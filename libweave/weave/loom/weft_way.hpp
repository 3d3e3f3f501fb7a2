#pragma once

#include <weave/block/card_image.hpp>
#include <weave/loom/pick_table.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace weave {

enum class Side : std::uint8_t { left, right };
enum class CaughtBy : std::uint8_t { end, pick, none };

/// Where the yarn of one feeder turns between two consecutive picks of that feeder (paper, section 4.2).
struct Turn {
    std::uint32_t feeder = 0;
    std::size_t from_pick = 0, to_pick = 0;  ///< from 0
    Side side = Side::left;
    CaughtBy caught_by = CaughtBy::none;
    std::size_t end = 0;   ///< the end that catches the loop, or at which `pick` does; unless none
    std::size_t pick = 0;  ///< the pick that catches it, where caught_by is pick
};

/// The part of the ends that one feeder's yarn spans in one pick: from `first` to `last` inclusive. A pick
/// whose two turns cross, or that has no end at all, is `crossed` and runs from edge to edge in pictures.
struct PickSpan {
    std::uint32_t feeder = 0;
    std::size_t pick = 0, first = 0, last = 0;
    bool crossed = false;
};

/// The shuttle stands on the other side than where its next pick starts.
struct MissedBox {
    std::uint32_t feeder = 0;
    std::size_t from_pick = 0, to_pick = 0;
};

/// The way of every feeder's yarn through the cloth in wraparound.
struct WeftWay {
    std::vector<Turn> turns;      ///< ordered by the pick they come from, then feeder
    std::vector<PickSpan> spans;  ///< ordered by pick, then feeder
};

/// Where the loops are caught on a shuttle loom. Loops are pulled inwards until an end between their two
/// picks holds them, or another feeder's yarn. Where the cloth alone does not settle it, by convention
///  - of two turns of different feeders that cross outside the cloth the later one lies above, and above
///  tails;
///  - a loop laid round another turn passes it on the side on which it lies itself at the end that catches
///    that turn: above where both its picks lie over this end, below where both lie under, else above;
///  - a bight crosses the picks between its own straight: no loop climbs round another's turn, and picks stay
///  beside each other in the order in which they were beaten up;
///  - of the loops that can still move the one laid first is pulled next, as far as it comes. The order tells
///    only where loops from both sides hook each other.
/// A loop hooked by another is caught by a pick of that other; `end` is the next end that it cannot pass.
/// Beyond its turns no pick stays in the fabric. Where a pick is crossed, turns of the feeders around it are
/// what its yarn would do if the crossed pick stayed: a defect to mend, no prediction.
///
/// More picks than the card has are further repeats of it. `loose`, of the size of the card, is true at the
/// crossings whose end is not to hold any loop: with loose_ends() the way is that after trimming, but
/// where loops of two feeders hook each other between firm ends they may come to rest at a loose one.
WeftWay weft_way(const CardImage& card, const std::vector<Pick>& picks, const CardImage* loose = nullptr);

/// The crossings at which the end is loose on purpose.
CardImage loose_ends(const Block& block);

/// Where a shuttle would have to start from the side on which it does not stand. It does not turn there.
std::vector<MissedBox> missed_boxes(const std::vector<Pick>& picks);

}  // namespace weave
