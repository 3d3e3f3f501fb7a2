#include <weave/picture/float_map.hpp>
#include <weave/picture/views.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace weave {

namespace {

/// Lengths up to each of these share a colour.
constexpr std::array<std::int32_t, 8> bins{1, 2, 3, 4, 6, 9, 15, INT32_MAX};
constexpr std::array<const char*, 8> bin_names{"1", "2", "3", "4", "5–6", "7–9", "10–15", "over 15"};
/// Lightness falls evenly from step to step in both; blue and orange stay apart for colour-blind eyes.
constexpr std::array<Colour, 8> weft_scale{{{0xe3, 0xee, 0xf9},
                                            {0xc2, 0xd9, 0xee},
                                            {0x99, 0xc2, 0xe2},
                                            {0x68, 0xa8, 0xd3},
                                            {0x3f, 0x89, 0xc0},
                                            {0x22, 0x69, 0xa4},
                                            {0x0f, 0x49, 0x80},
                                            {0x06, 0x2a, 0x54}}};
constexpr std::array<Colour, 8> warp_scale{{{0xfe, 0xed, 0xd6},
                                            {0xfd, 0xd6, 0xa6},
                                            {0xfb, 0xb8, 0x6b},
                                            {0xf3, 0x95, 0x37},
                                            {0xdd, 0x73, 0x12},
                                            {0xb5, 0x55, 0x08},
                                            {0x85, 0x3a, 0x05},
                                            {0x52, 0x22, 0x03}}};
constexpr Colour nothing{0xff, 0xff, 0xff};
constexpr double panel_gap = 36, panel_title = 22, heading_size = 12;

std::size_t bin_of(std::int32_t length) {
    std::size_t bin = 0;
    while (bins[bin] < length) ++bin;
    return bin;
}

/// A line through every float along its yarn says in which direction it runs.
void draw_directions(Canvas& canvas, const Grid& grid, const std::vector<std::int32_t>& lengths) {
    if (grid.cell < 8) return;
    std::vector<Point> on_dark, on_light;
    const double reach = static_cast<double>(grid.cell) * 0.5;
    for (std::size_t row = 0; row < grid.rows; ++row) {
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const std::int32_t length = lengths[row * grid.columns + column];
            if (length == 0) continue;
            const Point middle = grid.centre(row, column);
            const Point along = length > 0 ? Point{reach, 0} : Point{0, reach};
            const double share = std::abs(length) == 1 ? 0.5 : 1.0;
            auto& lines = bin_of(std::abs(length)) >= 4 ? on_dark : on_light;
            lines.insert(lines.end(), {{middle.x - along.x * share, middle.y - along.y * share},
                                       {middle.x + along.x * share, middle.y + along.y * share}});
        }
    }
    canvas.lines(on_light, {.colour = {0x40, 0x40, 0x40}, .width = 1, .alpha = 0.55, .round = false});
    canvas.lines(on_dark, {.colour = {0xff, 0xff, 0xff}, .width = 1, .alpha = 0.7, .round = false});
}

/// The longest float of the places that share a pixel.
std::int32_t longest(const std::vector<std::int32_t>& lengths, const Grid& grid, std::size_t row,
                     std::size_t column) {
    std::int32_t most = 0;
    for (std::size_t i = row; i < std::min(row + grid.step, grid.rows); ++i) {
        for (std::size_t j = column; j < std::min(column + grid.step, grid.columns); ++j) {
            const std::int32_t length = lengths[i * grid.columns + j];
            if (std::abs(length) > std::abs(most)) most = length;
        }
    }
    return most;
}

/// Cells of one colour as one shape, runs joined, so that SVG stays small and sharp.
void draw_shapes(Canvas& canvas, const Grid& grid, const std::vector<std::int32_t>& lengths) {
    std::array<std::vector<Rectangle>, 17> shapes;  // wefts, warps, nothing
    const auto shape_of = [](std::int32_t length) {
        return length == 0 ? std::size_t{16} : bin_of(std::abs(length)) + (length > 0 ? 0 : 8);
    };
    const auto side = static_cast<double>(grid.cell);
    for (std::size_t row = 0; row < grid.rows; ++row) {
        for (std::size_t column = 0, after = 0; column < grid.columns; column = after) {
            const std::size_t shape = shape_of(lengths[row * grid.columns + column]);
            while (after < grid.columns && shape_of(lengths[row * grid.columns + after]) == shape) ++after;
            const Rectangle first = grid.box(row, column), last = grid.box(row, after - 1);
            shapes[shape].push_back(
                {std::min(first.x, last.x), first.y, std::abs(first.x - last.x) + side, side});
        }
    }
    for (std::size_t k = 0; k < 16; ++k)
        canvas.rectangles(shapes[k], k < 8 ? weft_scale[k] : warp_scale[k - 8]);
}

struct Longest {
    std::int32_t weft = 0, warp = 0;
};

/// Over the cloth as it will be: loose yarns are looked through, as the rules for floats do.
Longest longest_of(const Subject& subject, const YarnColours& colours, bool back) {
    Longest longest;
    for (const std::int32_t length : float_lengths(Surface(subject.block, colours, back, true))) {
        longest.weft = std::max(longest.weft, length);
        longest.warp = std::max(longest.warp, -length);
    }
    return longest;
}

std::string heading_of(bool back, Longest longest) {
    return std::string(back ? "Back, seen from behind" : "Face") + ": longest weft float " +
           std::to_string(longest.weft) + ", warp float " + std::to_string(longest.warp);
}

void draw_panel(Canvas& canvas, const Subject& subject, const YarnColours& colours, const Grid& grid) {
    const Surface surface(subject.block, colours, grid.mirrored, subject.request.trim);
    const std::vector<std::int32_t> lengths = float_lengths(surface);
    const std::string words = heading_of(grid.mirrored, longest_of(subject, colours, grid.mirrored));
    canvas.text({grid.corner.x, grid.corner.y - 9}, words, {.size = heading_size, .bold = true});
    if (grid.cell >= 4) {
        draw_shapes(canvas, grid, lengths);
        draw_directions(canvas, grid, lengths);
    } else {
        canvas.pixels(static_cast<std::size_t>(grid.corner.x), static_cast<std::size_t>(grid.corner.y),
                      grid.width(), grid.height(), [&](std::size_t y, std::span<std::uint32_t> pixels) {
                          for (std::size_t x = 0; x < pixels.size(); ++x) {
                              pixels[x] = pixel_of(
                                  float_colour(longest(lengths, grid, grid.row_at(y), grid.column_at(x))));
                          }
                      });
    }
    draw_rulers(canvas, grid, stack_numbers(subject.block));
}

/// Width of one panel with its rulers; its heading, with the longest floats there could be, may be wider than
/// a small grid.
double panel_width(const Grid& grid) {
    const Longest most{static_cast<std::int32_t>(grid.columns), static_cast<std::int32_t>(grid.rows)};
    return grid_left + std::max(static_cast<double>(grid.width()) + grid_right,
                                Canvas::text_width(heading_of(true, most), heading_size, true));
}

}  // namespace

std::vector<std::int32_t> float_lengths(const Surface& surface) {
    const std::size_t rows = surface.block().rows(), columns = surface.block().columns();
    std::vector<std::int32_t> lengths(rows * columns);
    const auto same = [](Slot a, Slot b) { return a.same_system(b) && a.index() == b.index(); };
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0, after = 0; column < columns; column = after) {
            const Slot yarn = surface.at(row, column);
            while (after < columns && same(surface.at(row, after), yarn)) ++after;
            if (!yarn.is_weft()) continue;
            std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(row * columns + column), after - column,
                        static_cast<std::int32_t>(after - column));
        }
    }
    std::vector<std::size_t> begun(columns, 0);  // row in which the warp float of each column begins
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns; ++column) {
            const Slot yarn = surface.at(row, column);
            if (!yarn.is_warp()) {
                begun[column] = row + 1;
                continue;
            }
            const bool ends = row + 1 == rows || !same(surface.at(row + 1, column), yarn);
            if (!ends) continue;
            const auto length = static_cast<std::int32_t>(row + 1 - begun[column]);
            for (std::size_t k = begun[column]; k <= row; ++k) lengths[k * columns + column] = -length;
            begun[column] = row + 1;
        }
    }
    return lengths;
}

Colour float_colour(std::int32_t length) {
    if (length == 0) return nothing;
    return (length > 0 ? weft_scale : warp_scale)[bin_of(std::abs(length))];
}

FloatGrids float_grids(const Block& block) {
    FloatGrids grids;
    grids.face = make_grid(block.rows(), block.columns(), 24, 560, 5000);
    grids.face.corner.y += panel_title;
    grids.back = grids.face;
    grids.back.mirrored = true;
    grids.back.corner.x += panel_width(grids.face) + panel_gap;
    return grids;
}

Result<std::string> draw_floats(const Subject& subject) {
    const FloatGrids grids = float_grids(subject.block);
    PageText text = words_of(subject, "float map, face and back");
    text.legend = {{"weft float over", {}}, {"warp float over", {}}};
    for (std::size_t k = 0; k < bins.size(); ++k) {
        text.legend[0].swatches.push_back({weft_scale[k], bin_names[k]});
        text.legend[1].swatches.push_back({warp_scale[k], bin_names[k]});
    }
    text.notes = scale_notes(grids.face, "in the colour of the longest float");
    text.notes.push_back(
        "Lengths count stacks over which one yarn stays on the surface; floats end at the edges of the "
        "picture.");
    if (subject.request.trim) {
        text.notes.emplace_back("Trimmed: yarns that are loose on purpose are left out.");
    } else if (std::ranges::any_of(subject.block.stacks(), has_loose)) {
        text.notes.emplace_back("The headings count the cloth without the yarns that are loose on purpose.");
    }
    const YarnColours colours(subject);
    WEAVE_TRY(Page page,
              Page::open(subject, text, 2 * panel_width(grids.face) + panel_gap,
                         panel_title + grid_top + static_cast<double>(grids.face.height()) + grid_bottom));
    draw_panel(page.canvas, subject, colours, grids.face);
    draw_panel(page.canvas, subject, colours, grids.back);
    return std::move(page.canvas).finish();
}

}  // namespace weave
