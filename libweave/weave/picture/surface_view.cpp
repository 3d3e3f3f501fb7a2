#include <weave/picture/grid.hpp>
#include <weave/picture/look.hpp>
#include <weave/picture/views.hpp>

#include <algorithm>
#include <array>

namespace weave {

namespace {

constexpr Colour gap{0x2b, 0x2b, 0x2f};  ///< what one sees between the yarns
constexpr std::size_t yarn_look = 8;     ///< from this many pixels a place on, yarns are drawn as yarns

std::uint32_t pixel_at(const Surface& surface, std::size_t row, std::size_t column) {
    return pixel_of(surface.colour(row, column).value_or(gap));
}

/// The mean colour of the places that share a pixel.
std::uint32_t mean_pixel(const Surface& surface, const Grid& grid, std::size_t row, std::size_t column) {
    std::array<std::size_t, 3> sum{};
    std::size_t count = 0;
    for (std::size_t i = row; i < std::min(row + grid.step, grid.rows); ++i) {
        for (std::size_t j = column; j < std::min(column + grid.step, grid.columns); ++j, ++count) {
            const std::uint32_t pixel = pixel_at(surface, i, j);
            for (std::size_t k = 0; k < 3; ++k) sum[k] += pixel >> (16 - 8 * k) & 0xff;
        }
    }
    std::uint32_t mean = 0;
    for (const std::size_t channel : sum) mean = mean << 8 | static_cast<std::uint32_t>(channel / count);
    return mean;
}

void draw_flat(Canvas& canvas, const Surface& surface, const Grid& grid) {
    const auto fill = [&](std::size_t y, std::span<std::uint32_t> pixels) {
        const std::size_t row = grid.row_at(y);
        for (std::size_t x = 0; x < pixels.size(); x += grid.cell) {
            const std::size_t column = grid.column_at(x);
            const std::uint32_t pixel =
                grid.step == 1 ? pixel_at(surface, row, column) : mean_pixel(surface, grid, row, column);
            std::fill_n(pixels.begin() + static_cast<std::ptrdiff_t>(x), grid.cell, pixel);
        }
    };
    canvas.pixels(static_cast<std::size_t>(grid.corner.x), static_cast<std::size_t>(grid.corner.y),
                  grid.width(), grid.height(), fill);
}

/// One float: the places along its yarn where it lies on top, drawn as one rounded piece that dips under at
/// both ends.
void draw_float(Canvas& canvas, const Grid& grid, const Rectangle& first, const Rectangle& last, bool along_x,
                Colour colour) {
    const auto side = static_cast<double>(grid.cell);
    const double rim = std::max(0.5, side * 0.07), dip = rim * 1.6;
    Rectangle place{std::min(first.x, last.x), std::min(first.y, last.y), std::abs(first.x - last.x) + side,
                    std::abs(first.y - last.y) + side};
    if (along_x) {
        place = {place.x - dip / 2, place.y + rim, place.width + dip, place.height - 2 * rim};
    } else {
        place = {place.x + rim, place.y - dip / 2, place.width - 2 * rim, place.height + dip};
    }
    canvas.yarn(place, along_x, colour);
}

void draw_yarns(Canvas& canvas, const Surface& surface, const Grid& grid) {
    const Rectangle all{grid.corner.x, grid.corner.y, static_cast<double>(grid.width()),
                        static_cast<double>(grid.height())};
    canvas.clip(all);
    canvas.rectangle(all, gap);
    for (std::size_t row = 0; row < grid.rows; ++row) {
        for (std::size_t column = 0; column < grid.columns;) {
            const Slot yarn = surface.at(row, column);
            std::size_t after = column + 1;
            if (yarn.is_weft()) {
                while (after < grid.columns && surface.at(row, after).is_weft() &&
                       surface.at(row, after).index() == yarn.index())
                    ++after;
                draw_float(canvas, grid, grid.box(row, column), grid.box(row, after - 1), true,
                           *surface.colour(row, column));
            }
            column = after;
        }
    }
    for (std::size_t column = 0; column < grid.columns; ++column) {
        for (std::size_t row = 0; row < grid.rows;) {
            const Slot yarn = surface.at(row, column);
            std::size_t after = row + 1;
            if (yarn.is_warp()) {
                while (after < grid.rows && surface.at(after, column).is_warp() &&
                       surface.at(after, column).index() == yarn.index())
                    ++after;
                draw_float(canvas, grid, grid.box(row, column), grid.box(after - 1, column), false,
                           *surface.colour(row, column));
            }
            row = after;
        }
    }
    canvas.unclip();
}

/// The yarns on top and their colours, as far as a legend can hold them.
std::vector<LegendRow> colours_of(const Surface& surface, const Grid& grid) {
    std::vector<Colour> warps, wefts;
    const auto note = [](std::vector<Colour>& list, Colour colour) {
        if (list.size() <= 8 && std::ranges::find(list, colour) == list.end()) list.push_back(colour);
    };
    for (std::size_t row = 0; row < grid.rows; ++row) {
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const Slot slot = surface.at(row, column);
            if (!slot.is_empty()) note(slot.is_weft() ? wefts : warps, *surface.colour(row, column));
        }
    }
    std::vector<LegendRow> legend;
    const auto add = [&](const char* name, const std::vector<Colour>& list) {
        if (list.empty()) return;
        legend.push_back({name, {}});
        for (std::size_t k = 0; k < std::min<std::size_t>(list.size(), 8); ++k) {
            legend.back().swatches.push_back({list[k], to_text(list[k])});
        }
        if (list.size() > 8) legend.back().swatches.back().text += "  and more";
    };
    add("weft", wefts);
    add("warp", warps);
    return legend;
}

}  // namespace

Result<std::string> draw_surface(const Subject& subject) {
    const bool back = subject.request.view == View::back;
    const YarnColours colours(subject);
    const Surface surface(subject.block, colours, back, subject.request.trim);
    const Grid grid = face_grid(subject.block, back);
    PageText text =
        words_of(subject, back ? "back, colour and weave, seen from behind (left and right change places)"
                               : "face, colour and weave");
    text.legend = colours_of(surface, grid);
    text.notes = scale_notes(grid, "in their mean colour");
    if (subject.block.height() > 2) {
        text.notes.push_back(std::string("Each place shows the ") + (back ? "lowest" : "topmost") +
                             " yarn of its stack.");
    }
    if (subject.request.trim) text.notes.push_back("Trimmed: yarns that are loose on purpose are left out.");
    WEAVE_TRY(Page page, Page::open(subject, text, grid_left + static_cast<double>(grid.width()) + grid_right,
                                    grid_top + static_cast<double>(grid.height()) + grid_bottom));
    if (grid.cell >= yarn_look) {
        draw_yarns(page.canvas, surface, grid);
    } else {
        draw_flat(page.canvas, surface, grid);
    }
    draw_rulers(page.canvas, grid, stack_numbers(subject.block));
    return std::move(page.canvas).finish();
}

}  // namespace weave
