#pragma once

#include <studio/editors/slice_view.hpp>

#include <QPainter>
#include <QPalette>

#include <optional>
#include <set>
#include <vector>

namespace weave::studio {

/// A path that is being drawn: its levels, which may lie between those of the slice.
struct PathPreview {
    std::size_t first = 0;
    std::vector<double> levels;
};

/// What is picked out in a drawing of a slice.
struct SliceMarks {
    std::optional<SliceYarnId> hovered;
    std::set<SliceYarnId> selected;
    std::optional<std::size_t> path_place;  ///< position at which keys move the selected path
    std::optional<PathPreview> preview;     ///< of a path
    std::optional<QPointF> dot_preview;     ///< a dot that would come here, as position and level
    std::optional<std::pair<SliceYarnId, SliceYarnId>> crossing;  ///< dot and path that would be exchanged
};

/// Draws a slice as the pictures of the product do: dots with their numbers, paths as round lines with a dark
/// rim, levels as faint rows, the weft's way as arrows. `space` is the part of the widget for it; the ruler
/// stands below. The palette's base is the paper, its text the ink.
void paint_slice(QPainter& painter, const SliceView& view, const SliceScene& scene, const SliceMarks& marks,
                 const QRectF& space, const QPalette& palette);
/// The numbers of the positions below `space`, in weavers' words.
void paint_ruler(QPainter& painter, const SliceView& view, const SliceScene& scene, const SliceMarks& marks,
                 const QRectF& ruler, const QPalette& palette);

/// The blue that marks what is chosen, the vermilion that marks what is to be (Okabe-Ito).
inline constexpr QRgb chosen_ink = 0xff0072b2, wished_ink = 0xffd55e00;

}  // namespace weave::studio
