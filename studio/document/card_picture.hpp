#pragma once

#include <weave/block/block.hpp>

#include <QImage>

#include <cstddef>
#include <memory>
#include <span>

namespace weave::studio {

/// The card of a block as windows draw it: the card itself, and its darkness in squares of 8 × 8 for when it is seen from afar.
struct CardPicture {
    static constexpr std::size_t square = 8;
    CardImage card;
    /// Grey of each square, 255 where the weft lies over all its crossings; row 0 holds the first picks.
    QImage coarse;
};

std::shared_ptr<const CardPicture> card_picture(const Block& block);
/// The same where only these cells, row by row, differ from the block that `before` is of.
std::shared_ptr<const CardPicture> card_picture(const Block& block, const CardPicture& before, std::span<const std::size_t> changed_cells);

}  // namespace weave::studio
