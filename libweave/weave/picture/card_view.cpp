#include <weave/picture/grid.hpp>
#include <weave/picture/views.hpp>

#include <bit>
#include <vector>

namespace weave {

namespace {

constexpr Colour lifted{0x00, 0x00, 0x00}, weft_over{0xff, 0xff, 0xff};

/// How many of `count` bits from `first` on are 1 in a packed row.
std::size_t ones(std::span<const std::uint8_t> row, std::size_t first, std::size_t count) {
    std::size_t sum = 0;
    for (std::size_t k = first; k < first + count; ++k) sum += row[k / 8] >> (7 - k % 8) & 1U;
    return sum;
}

/// One row of pixels where step × step crossings share each.
void fill_shared(const CardImage& card, const Grid& grid, std::size_t y, std::span<std::uint32_t> pixels) {
    const std::size_t first_pick = grid.row_at(y), last_pick = std::min(first_pick + grid.step, card.picks());
    for (std::size_t x = 0; x < pixels.size(); ++x) {
        const std::size_t end = grid.column_at(x), ends = std::min(grid.step, card.ends() - end);
        std::size_t sum = 0;
        for (std::size_t pick = first_pick; pick < last_pick; ++pick) sum += ones(card.row(pick), end, ends);
        const std::size_t all = (last_pick - first_pick) * ends;
        pixels[x] = static_cast<std::uint32_t>((sum * 255 + all / 2) / all) * 0x010101U;
    }
}

void fill_row(const CardImage& card, const Grid& grid, std::size_t y, std::span<std::uint32_t> pixels) {
    if (grid.step > 1) return fill_shared(card, grid, y, pixels);
    const std::size_t pick = grid.row_at(y);
    for (std::size_t end = 0, x = 0; end < card.ends(); ++end) {
        const std::uint32_t colour = card.weft_over(pick, end) ? pixel_of(weft_over) : pixel_of(lifted);
        for (std::size_t k = 0; k < grid.cell; ++k) pixels[x++] = colour;
    }
}

/// Lines between picks and ends, stronger ones where the stacks meet.
void draw_stack_grid(Canvas& canvas, const Block& block, const Grid& grid) {
    if (grid.cell < 4) return;
    const double right = grid.x_of(static_cast<double>(grid.columns)),
                 top = grid.y_of(static_cast<double>(grid.rows));
    const double left = grid.x_of(0), bottom = grid.y_of(0);
    std::vector<Point> thin, strong;
    const bool stacked = block.picks() > block.rows() || block.ends() > block.columns();
    const auto across = [&](std::vector<Point>& lines, double pick) {
        const double y = grid.y_of(pick) - 0.5;
        lines.insert(lines.end(), {{left, y}, {right, y}});
    };
    const auto along = [&](std::vector<Point>& lines, double end) {
        const double x = grid.x_of(end) - 0.5;
        lines.insert(lines.end(), {{x, top}, {x, bottom}});
    };
    if (grid.cell >= 8) {
        for (std::size_t pick = 1; pick < grid.rows; ++pick) across(thin, static_cast<double>(pick));
        for (std::size_t end = 1; end < grid.columns; ++end) along(thin, static_cast<double>(end));
    }
    for (std::size_t row = 1; stacked && row < block.rows(); ++row)
        across(strong, static_cast<double>(block.first_pick(row)));
    for (std::size_t column = 1; stacked && column < block.columns(); ++column) {
        along(strong, static_cast<double>(block.first_end(column)));
    }
    canvas.lines(thin, {.colour = {0xa8, 0xa8, 0xa8}, .width = 1, .round = false});
    canvas.lines(strong,
                 {.colour = {0x4a, 0xa3, 0xdf}, .width = grid.cell >= 10 ? 2.0 : 1.0, .round = false});
}

/// Runs of lifted ends as rectangles: a small card stays a drawing in SVG.
void draw_runs(Canvas& canvas, const CardImage& card, const Grid& grid) {
    std::vector<Rectangle> runs;
    const auto side = static_cast<double>(grid.cell);
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        for (std::size_t end = 0; end < card.ends();) {
            std::size_t after = end;
            while (after < card.ends() && !card.weft_over(pick, after)) ++after;
            if (after > end) {
                const Rectangle first = grid.box(pick, end);
                runs.push_back({first.x, first.y, static_cast<double>(after - end) * side, side});
            }
            end = std::max(after, end + 1);
        }
    }
    canvas.rectangles(runs, lifted);
}

}  // namespace

Result<std::string> draw_card(const Subject& subject) {
    const Block& block = subject.block;
    const Grid grid = card_grid(block);
    PageText text = words_of(subject, "card image, face up");
    text.legend = {{"", {{lifted, "end lifted (warp over weft)"}, {weft_over, "weft over warp"}}}};
    text.notes = scale_notes(grid, "grey is the share of wefts that lie over");
    text.notes.push_back(
        "Origin bottom left: picks are woven upwards, ends count from the left." +
        std::string(grid.cell >= 4 && (block.picks() > block.rows() || block.ends() > block.columns())
                        ? " Blue lines part the stacks."
                        : ""));
    WEAVE_TRY(Page page, Page::open(subject, text, grid_left + static_cast<double>(grid.width()) + grid_right,
                                    grid_top + static_cast<double>(grid.height()) + grid_bottom));
    const CardImage card = block.card_image();
    if (grid.cell >= 4) {
        draw_runs(page.canvas, card, grid);
    } else {
        page.canvas.pixels(static_cast<std::size_t>(grid.corner.x), static_cast<std::size_t>(grid.corner.y),
                           grid.width(), grid.height(), [&](std::size_t y, std::span<std::uint32_t> row) {
                               fill_row(card, grid, y, row);
                           });
    }
    draw_stack_grid(page.canvas, block, grid);
    draw_rulers(page.canvas, grid, card_numbers(block));
    return std::move(page.canvas).finish();
}

}  // namespace weave
