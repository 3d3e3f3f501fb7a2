#pragma once

#include <weave/block/flip.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace weave {

/// What a part of a card is to look like: these pixels, the first of them at this pick and end, both from 0.
/// Past the card's last pick or end it goes on at the first; it is no larger than the card.
struct CardWish {
    std::size_t pick = 0, end = 0;
    CardImage pixels;
};

/// What of a wish can be. All that it does not speak of stays as it is.
struct GrantedWish {
    std::vector<Flip> flips;    ///< that make it so, in an order in which each is valid
    std::vector<Flip> refused;  ///< crossings that stay as they are, by pick and end
    std::string reason;         ///< of the first of those
};

/// Makes as much of a wish come true as flips can. Of a stack of several yarns a flip may make room for
/// another, so the order matters; what comes out does not depend on one that the caller chooses. No refused
/// crossing could be flipped in the end, and no several of them together: any way from one stack to another
/// leads over single flips that each bring it nearer.
GrantedWish grant(const Block& block, const CardWish& wish);

}  // namespace weave
