#pragma once

#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

enum class View : std::uint8_t { card, face, back, floats, layers, weft_slice, warp_slice, block };

/// What to show: a view, and for slices the row or column (from 0).
struct PictureRequest {
    View view = View::card;
    std::size_t line = 0;
    bool trim = false;  ///< leave out yarns that are loose on purpose
    /// Where views that show a part begin, from 0: the column for weft slices, the row for warp slices, both
    /// for the block. Other views show the whole cloth.
    std::size_t first_row = 0, first_column = 0;
};

/// `card`, `face`, `back`, `floats`, `layers`, `weft:N`, `warp:N` (N from 1, a pick or an end: the slice of
/// its row or column), `block`.
Result<PictureRequest> parse_view(std::string_view text, const Block& block);

/// Lets a slice or the block begin at the row of a pick or the column of an end (from 1) instead of the
/// first. Errors (usage): no such number, or a view that does not begin anywhere along that direction.
Status begin_at(PictureRequest& request, const Block& block, std::optional<std::size_t> pick,
                std::optional<std::size_t> end);

enum class PictureFormat : std::uint8_t { png, svg };

/// A finished picture file. Large cloths are drawn at a smaller scale; past a stated limit the card and face
/// views fall to one pixel a crossing and views that number yarns show the first part and say so in the
/// picture.
Result<std::string> draw(const Design& design, const Evaluation& cloth, const PictureRequest& request,
                         PictureFormat format);

}  // namespace weave
