#pragma once

#include <weave/diff/design_diff.hpp>
#include <weave/picture/canvas.hpp>

#include <string>
#include <vector>

namespace weave {

/// The cards of two designs laid on each other as a picture file: what stays light, ends that are lifted now
/// and ends that no longer are in two colours (and, where there is room, with a standing or a lying bar),
/// inserted and removed picks and ends as bands. Beside the card a bar stands wherever something changed, and
/// round changes that are too small for the picture's size a ring (change_rings.hpp), so that single
/// crossings of a large card are found. Picks and ends are numbered as in the design after. Large cards share
/// pixels; one with a change shows the change. `marks` lists what is drawn. Errors: a design has no cloth
/// (invalid); memory.
Result<std::string> draw_diff(const WovenDesign& before, const WovenDesign& after, const DesignDiff& diff,
                              PictureFormat format, std::vector<Mark>* marks = nullptr);

}  // namespace weave
