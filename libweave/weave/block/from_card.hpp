#pragma once

#include <weave/block/block.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace weave {

/// The block with this card image and these t and p, in each cell the canonical one of the orders that fit:
/// lower number lower. `t` and `p` are repeated until they cover the card; an error if they do not come out
/// even. An error where a cell admits no order names the cell, two picks and two ends that contradict each
/// other: each lies over one of the ends and under the other, crosswise.
Result<Block> block_from_card(const CardImage& card, std::vector<std::uint32_t> t,
                              std::vector<std::uint32_t> p);

/// One way to read a bare card as stacks.
struct Grouping {
    std::vector<std::uint32_t> t, p;
    std::string reason;  ///< why it stands where it does in the ranking, one line for a weaver
};

/// Groupings that every cell of the card admits, best first, at most `most`. There is no single truth (any
/// one-pick row admits all ends as one cell), so the ranking prefers, in this order, picks that keep one
/// order over the whole width, stacks of equal counts, and counts that repeat. Never empty: t = p = 1 fits
/// every card. Stacks of equal counts that fit come before counts without a rule.
std::vector<Grouping> possible_groupings(const CardImage& card, std::size_t most = 8);

}  // namespace weave
