#include <weave/block/stencil_edit.hpp>

#include <weave/block/card_image.hpp>

#include <algorithm>

namespace weave {

namespace {

/// Where the first old line comes to lie in the new ones; below 0 it is cut off.
std::ptrdiff_t shift_of(std::size_t was, std::size_t now, Keep kept) {
    const auto more = static_cast<std::ptrdiff_t>(now) - static_cast<std::ptrdiff_t>(was);
    if (kept == Keep::low) return 0;
    if (kept == Keep::high) return more;
    return more >= 0 ? more / 2 : -(-more / 2);
}

}  // namespace

Result<StencilMap> resized(const StencilMap& map, std::size_t rows, std::size_t columns, Keep rows_kept,
                           Keep columns_kept, std::uint16_t fill) {
    if (rows == 0 || columns == 0) return bad_input("a stencil needs at least one row and one column");
    WEAVE_CHECK_OK(check_card_size(rows, columns));
    StencilMap result{rows, columns, std::vector<std::uint16_t>(rows * columns, fill)};
    const std::ptrdiff_t up = shift_of(map.rows, rows, rows_kept),
                         right = shift_of(map.columns, columns, columns_kept);
    const auto size = [](std::size_t number) { return static_cast<std::ptrdiff_t>(number); };
    const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, right),
                         after = std::min(size(columns), size(map.columns) + right);
    for (std::ptrdiff_t row = std::max<std::ptrdiff_t>(0, up);
         row < std::min(size(rows), size(map.rows) + up); ++row) {
        if (first >= after) break;
        const auto from = map.blocks.begin() + (row - up) * size(map.columns) + first - right;
        std::copy(from, from + (after - first), result.blocks.begin() + row * size(columns) + first);
    }
    return result;
}

StencilMap with_blocks_renumbered(const StencilMap& map, std::span<const std::uint16_t> numbers) {
    StencilMap result = map;
    for (std::uint16_t& block : result.blocks) block = numbers[block];
    return result;
}

std::vector<std::size_t> stacks_of_blocks(const StencilMap& map, std::size_t blocks) {
    std::vector<std::size_t> counts(blocks);
    for (const std::uint16_t block : map.blocks) {
        if (block < blocks) ++counts[block];
    }
    return counts;
}

}  // namespace weave
