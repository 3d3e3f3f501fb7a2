#include <weave/picture/grid.hpp>

#include <algorithm>

namespace weave {

namespace {

/// The smallest of 1, 5, 10, 50, 100 … whose marks are at least `least` pixels apart.
std::size_t ruler_step(double pixels_each, double least) {
    std::size_t step = 1;
    for (bool five = true; static_cast<double>(step) * pixels_each < least; five = !five)
        step *= five ? 5 : 2;
    return step;
}

double pixels_each(const Grid& grid) {
    return static_cast<double>(grid.cell) / static_cast<double>(grid.step);
}

/// Calls mark(line, number) for the lines of a ruler: 1, 5, 10 and so on where every line is one yarn, else
/// the first yarn of every line, or every few lines, that has room for its number. A line without yarns has
/// none.
template <class Mark>
void rule(std::size_t lines, double pixels, double least,
          const std::function<std::size_t(std::size_t)>& number_of, Mark mark) {
    const std::size_t step = ruler_step(pixels / static_cast<double>(std::max<std::size_t>(lines, 1)), least);
    bool one_each = true;
    for (std::size_t line = 0; line < lines && one_each; ++line) one_each = number_of(line + 1) == line + 1;
    for (std::size_t line = 0; line < lines; ++line) {
        if (number_of(line + 1) == number_of(line)) continue;
        const std::size_t place = one_each ? line + 1 : line;
        if (line == 0 || place % step == 0) mark(line, number_of(line) + 1);
    }
}

void draw_pick_arrow(Canvas& canvas, const Grid& grid) {
    const double x = grid.mirrored ? grid.corner.x + static_cast<double>(grid.width()) : grid.corner.x;
    const double first = std::max(pixels_each(grid), 1.0) / 2;
    const double bottom = grid.corner.y + static_cast<double>(grid.height());
    const double y = bottom - first;
    const double tip = grid.corner.x - 34, tail = grid.corner.x - 46;
    const Point shaft[]{{tail, y}, {tip - 4, y}};
    canvas.polyline(shaft, {.colour = accent, .width = 2});
    canvas.arrow_head({tip, y}, {1, 0}, 8, accent);
    canvas.text({tail - 4, y}, "pick 1",
                {.size = 11, .colour = accent, .anchor = Anchor::end, .bold = true, .centred = true});
    const double end_x = grid.mirrored ? x - first : x + first;
    const Point stem[]{{end_x, bottom + 40}, {end_x, bottom + 30}};
    canvas.polyline(stem, {.colour = accent, .width = 2});
    canvas.arrow_head({end_x, bottom + 24}, {0, -1}, 8, accent);
    canvas.text(
        {grid.mirrored ? end_x + 8 : end_x - 8, bottom + 53}, "end 1",
        {.size = 11, .colour = accent, .anchor = grid.mirrored ? Anchor::end : Anchor::start, .bold = true});
}

}  // namespace

double Grid::x_of(double column) const {
    const double from_side = column * static_cast<double>(cell) / static_cast<double>(step);
    return mirrored ? corner.x + static_cast<double>(width()) - from_side : corner.x + from_side;
}

double Grid::y_of(double row) const {
    return corner.y + static_cast<double>(height()) -
           row * static_cast<double>(cell) / static_cast<double>(step);
}

Point Grid::centre(std::size_t row, std::size_t column) const {
    return {x_of(static_cast<double>(column) + 0.5), y_of(static_cast<double>(row) + 0.5)};
}

Rectangle Grid::box(std::size_t row, std::size_t column) const {
    const double side = pixels_each(*this);
    const Point middle = centre(row, column);
    return {middle.x - side / 2, middle.y - side / 2, side, side};
}

Grid make_grid(std::size_t rows, std::size_t columns, std::size_t largest_cell, std::size_t wanted_side,
               std::size_t longest_side) {
    Grid grid{.rows = rows, .columns = columns};
    const std::size_t most = std::max({rows, columns, std::size_t{1}});
    grid.cell = std::clamp<std::size_t>(wanted_side / most, 1, largest_cell);
    if (most > longest_side) grid.step = (most + longest_side - 1) / longest_side;
    grid.corner = {Page::margin + grid_left, Page::body_top + grid_top};
    return grid;
}

Grid card_grid(const Block& block) {
    return make_grid(block.picks(), block.ends(), 28, 900);
}

Grid face_grid(const Block& block, bool back) {
    Grid grid = make_grid(block.rows(), block.columns(), 40, 960);
    grid.mirrored = back;
    return grid;
}

GridNumbers card_numbers(const Block&) {
    const auto same = [](std::size_t line) { return line; };
    return {same, same};
}

GridNumbers stack_numbers(const Block& block) {
    return {[&block](std::size_t row) { return block.first_pick(row); },
            [&block](std::size_t column) { return block.first_end(column); }};
}

void draw_rulers(Canvas& canvas, const Grid& grid, const GridNumbers& numbers) {
    const double bottom = grid.corner.y + static_cast<double>(grid.height()), left = grid.corner.x;
    const double width = static_cast<double>(grid.width()), height = static_cast<double>(grid.height());
    canvas.outline({left - 0.5, grid.corner.y - 0.5, width + 1, height + 1},
                   {.colour = ink, .width = 1, .round = false});
    const Stroke tick{.colour = faint_ink, .width = 1, .round = false};
    rule(grid.rows, height, 15, numbers.pick_of_row, [&](std::size_t row, std::size_t number) {
        const double y = grid.centre(row, 0).y;
        const Point mark[]{{left - 5, y}, {left - 1, y}};
        canvas.polyline(mark, tick);
        canvas.text({left - 7, y}, std::to_string(number),
                    {.size = 10, .anchor = Anchor::end, .centred = true});
    });
    const auto digits = static_cast<double>(std::to_string(numbers.end_of_column(grid.columns)).size());
    rule(grid.columns, width, 8 + 7 * digits, numbers.end_of_column,
         [&](std::size_t column, std::size_t number) {
             const double x = grid.centre(0, column).x;
             const Point mark[]{{x, bottom + 1}, {x, bottom + 5}};
             canvas.polyline(mark, tick);
             canvas.text({x, bottom + 16}, std::to_string(number), {.size = 10, .anchor = Anchor::middle});
         });
    draw_pick_arrow(canvas, grid);
}

std::vector<std::string> scale_notes(const Grid& grid, const char* how) {
    if (grid.step == 1) return {};
    const std::string side = std::to_string(grid.step);
    return {"Too large for one pixel each: every pixel stands for " + side + " × " + side + " places, " +
            how + "."};
}

}  // namespace weave
