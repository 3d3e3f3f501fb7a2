#pragma once

#include <weave/block/card_image.hpp>

#include <cstddef>

namespace weave {

// Parts of cards, as they are copied and put down elsewhere. Each has its first pick and its first end first,
// as a card.

/// `picks` × `ends` crossings of a card, from this one on. Past the last pick or end the card begins anew, as
/// the cloth does: a part may be larger than its card.
CardImage part_of(const CardImage& card, std::size_t pick, std::size_t end, std::size_t picks,
                  std::size_t ends);

/// A part with one side for all of it.
CardImage one_sided(std::size_t picks, std::size_t ends, bool weft_over);

/// Each pixel the other way: the lifted ends down, all others up.
CardImage inverted(const CardImage& part);

/// The last end first.
CardImage mirrored_across(const CardImage& part);

/// The last pick first.
CardImage mirrored_along(const CardImage& part);

}  // namespace weave
