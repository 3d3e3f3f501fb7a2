#pragma once

#include <weave/block/block.hpp>
#include <weave/picture/page.hpp>

#include <cstddef>
#include <functional>
#include <vector>

namespace weave {

/// Where the squares of a card or a face lie in a picture: row 0 at the bottom, column 0 at the left, or at
/// the right where the cloth is seen from behind.
///
/// A square is `cell` pixels wide. Where even one pixel a square would be too large, `step` × `step` squares
/// share a pixel.
struct Grid {
    std::size_t rows = 0, columns = 0;
    std::size_t cell = 1, step = 1;
    Point corner{};  ///< top left, whole pixels
    bool mirrored = false;

    [[nodiscard]] std::size_t width() const { return (columns + step - 1) / step * cell; }
    [[nodiscard]] std::size_t height() const { return (rows + step - 1) / step * cell; }
    /// Left edge of a column and top edge of a row, in pixels; also for the ones after the last.
    [[nodiscard]] double x_of(double column) const;
    [[nodiscard]] double y_of(double row) const;
    /// The middle of a square.
    [[nodiscard]] Point centre(std::size_t row, std::size_t column) const;
    /// The box of a square; whole pixels when step is 1.
    [[nodiscard]] Rectangle box(std::size_t row, std::size_t column) const;
    /// The first row (or column) that shares line `y` (or column `x`) of pixels, counted from the grid's top
    /// left.
    [[nodiscard]] std::size_t row_at(std::size_t y) const { return (height() / cell - 1 - y / cell) * step; }
    [[nodiscard]] std::size_t column_at(std::size_t x) const {
        return (mirrored ? width() / cell - 1 - x / cell : x / cell) * step;
    }
};

/// A grid is never drawn longer than this many pixels; larger cloths share pixels.
inline constexpr std::size_t longest_grid_side = 8000;

/// Space that rulers, arrows and labels take round a grid.
inline constexpr double grid_left = 96, grid_bottom = 58, grid_top = 6, grid_right = 14;

/// A grid whose cells are as large as looks good: up to `largest_cell` pixels, about `wanted_side` pixels in
/// all.
Grid make_grid(std::size_t rows, std::size_t columns, std::size_t largest_cell, std::size_t wanted_side,
               std::size_t longest_side = longest_grid_side);

/// The grid of the card picture (picks × ends) and of the face and back pictures (rows × columns of stacks),
/// placed on its page.
Grid card_grid(const Block& block);
Grid face_grid(const Block& block, bool back);

/// How rulers number a grid: from 1, the pick (end) that each row (column) begins with; and where stacks
/// begin.
struct GridNumbers {
    std::function<std::size_t(std::size_t)> pick_of_row, end_of_column;  ///< from 0
};
GridNumbers card_numbers(const Block& block);
GridNumbers stack_numbers(const Block& block);

/// Frame, rulers with numbers, pick-1 and end-1 arrows at the origin.
void draw_rulers(Canvas& canvas, const Grid& grid, const GridNumbers& numbers);

/// What must be said where squares share pixels; empty otherwise.
std::vector<std::string> scale_notes(const Grid& grid, const char* how);

}  // namespace weave
