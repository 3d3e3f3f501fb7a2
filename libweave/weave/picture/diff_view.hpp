#pragma once

#include <weave/diff/design_diff.hpp>
#include <weave/picture/canvas.hpp>
#include <weave/picture/grid.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace weave {

/// How a comparison is drawn.
struct DiffLook {
    /// Of the cards laid on each other, in pixels; a large card is drawn up to the longest before crossings share pixels.
    std::size_t wanted_side = 900, longest_side = longest_grid_side;
    int scale = 1;                  ///< a PNG has scale × scale pixels to each of these
    bool has_words = true;          ///< title and notes; a picture beside words of its own needs its legend alone
    std::vector<Mark>* marks = nullptr;  ///< where to list what is drawn, or nowhere
};

/// The cards of two designs laid on each other as a picture file: what stays light, ends that are lifted now
/// and ends that no longer are in two colours (and, where there is room, with a standing or a lying bar),
/// inserted and removed picks and ends as bands. Beside the card a bar stands wherever something changed, and
/// round changes that are too small for the picture's size a ring (change_rings.hpp), so that single
/// crossings of a large card are found. Picks and ends are numbered as in the design after. Large cards share
/// pixels; one with a change shows the change. Errors: a design has no cloth (invalid); memory.
Result<std::string> draw_diff(const WovenDesign& before, const WovenDesign& after, const DesignDiff& diff,
                              PictureFormat format, const DiffLook& look = {});

}  // namespace weave
