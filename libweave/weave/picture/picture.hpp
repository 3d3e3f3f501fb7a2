#pragma once

#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
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
    /// Where views that show a part begin and end, from 0: columns for weft slices, rows for warp slices, both for the block.
    /// They show no more than they have room for, and never what lies beyond the cloth. Other views show the whole cloth.
    std::size_t first_row = 0, first_column = 0;
    std::size_t last_row = no_limit, last_column = no_limit;
    static constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
    /// How many rows, or columns, of so many are asked for.
    [[nodiscard]] std::size_t rows_of(std::size_t all) const { return std::min(last_row, all - 1) - first_row + 1; }
    [[nodiscard]] std::size_t columns_of(std::size_t all) const { return std::min(last_column, all - 1) - first_column + 1; }
};

/// A part of a cloth by its picks and ends, from 1: from the first one to the last for which there is room, where nothing is said.
struct PictureSpan {
    std::optional<std::size_t> from_pick{}, to_pick{}, from_end{}, to_end{};
};

/// `card`, `face`, `back`, `floats`, `layers`, `weft:N`, `warp:N` (N from 1, a pick or an end: the slice of
/// its row or column), `block`.
Result<PictureRequest> parse_view(std::string_view text, const Block& block);

/// Lets a slice or the block show the rows and columns in which a span lies, whole. Errors (usage): no such number, a span that
/// ends before it begins, or a view that does not show a part along that direction.
Status show_span(PictureRequest& request, const Block& block, const PictureSpan& span);

enum class PictureFormat : std::uint8_t { png, svg };

/// A finished picture file. Large cloths are drawn at a smaller scale; past a stated limit the card and face
/// views fall to one pixel a crossing and views that number yarns show the first part and say so in the
/// picture.
Result<std::string> draw(const Design& design, const Evaluation& cloth, const PictureRequest& request,
                         PictureFormat format);

}  // namespace weave
