#include <weave/picture/layer_map.hpp>
#include <weave/picture/views.hpp>

#include <algorithm>

namespace weave {

namespace {

constexpr double heading = 24, gutter = 24;
/// No greys: small cards look grey from afar where black and white alternate.
constexpr Colour no_yarns{0xc9, 0xdc, 0xee}, lifted{0, 0, 0}, weft_over{0xff, 0xff, 0xff},
    between{0xe0, 0x9a, 0x4a};

Colour colour_of(LayerPixel pixel) {
    switch (pixel) {
        case LayerPixel::lifted:
            return lifted;
        case LayerPixel::weft_over:
            return weft_over;
        case LayerPixel::between:
            return between;
        case LayerPixel::none:
            break;
    }
    return no_yarns;
}

/// What each stack of the table shows in each of the first `layers` layers.
std::vector<std::vector<LayerPixel>> pixels_of_layers(const Block& block, std::size_t layers) {
    std::vector<std::vector<LayerPixel>> of_layer(layers);
    for (const Stack& stack : block.stacks()) {
        const std::vector<LayerPixel> pixels = layer_pixels(stack);
        for (std::size_t k = 0; k < layers; ++k)
            of_layer[k].push_back(k < pixels.size() ? pixels[k] : LayerPixel::none);
    }
    return of_layer;
}

bool is_shown(const std::vector<std::vector<LayerPixel>>& of_layer, LayerPixel wanted) {
    return std::ranges::any_of(of_layer, [&](const std::vector<LayerPixel>& pixels) {
        return std::ranges::find(pixels, wanted) != pixels.end();
    });
}

PageText layer_words(const Subject& subject, const Grid& grid,
                     const std::vector<std::vector<LayerPixel>>& of_layer) {
    const Block& block = subject.block;
    PageText text = words_of(subject, "layers, top layer first");
    text.legend = {{"", {{lifted, "ends over the weft"}, {weft_over, "weft over the ends"}}}};
    std::vector<Swatch>& swatches = text.legend[0].swatches;
    if (is_shown(of_layer, LayerPixel::between))
        swatches.push_back({between, "ends on both sides of the weft"});
    if (is_shown(of_layer, LayerPixel::none)) swatches.push_back({no_yarns, "no such layer here"});
    text.notes = scale_notes(grid, "of which it shows the first");
    text.notes.emplace_back(
        "Layer k: in each stack the k-th weft from the top and the ends that go with it: those nearest to it "
        "in "
        "height.");
    if (std::ranges::any_of(block.stacks(), has_loose)) {
        text.notes.emplace_back(
            "Yarns that are loose on purpose are left out; the place of a loose weft counts.");
    }
    if (layer_count(block) > of_layer.size()) {
        text.notes.push_back("Shown: the top " + std::to_string(of_layer.size()) + " of " +
                             std::to_string(layer_count(block)) + " layers.");
    }
    return text;
}

Point panel_size(const Grid& grid) {
    return {std::max(grid_left + static_cast<double>(grid.width()) + grid_right, grid_left + 110.0),
            heading + grid_top + static_cast<double>(grid.height()) + grid_bottom};
}

std::size_t panels_across(std::size_t panels, double width) {
    const auto fitting = static_cast<std::size_t>((1500 + gutter) / (width + gutter));
    std::size_t square = 1;  // large panels form a square, or the page would grow too long
    while (square * square < panels) ++square;
    return std::min(std::max(fitting, square), panels);
}

void draw_layer(Canvas& canvas, const Block& block, const Grid& grid,
                const std::vector<LayerPixel>& of_stack) {
    canvas.pixels(static_cast<std::size_t>(grid.corner.x), static_cast<std::size_t>(grid.corner.y),
                  grid.width(), grid.height(), [&](std::size_t y, std::span<std::uint32_t> pixels) {
                      const auto cells = block.cells(grid.row_at(y));
                      for (std::size_t x = 0; x < pixels.size(); ++x) {
                          pixels[x] = pixel_of(colour_of(of_stack[cells[grid.column_at(x)]]));
                      }
                  });
    if (grid.cell >= 8) {
        std::vector<Point> lines;
        for (std::size_t k = 1; k < grid.rows; ++k) {
            const double y = grid.y_of(static_cast<double>(k)) - 0.5;
            lines.insert(lines.end(), {{grid.x_of(0), y}, {grid.x_of(static_cast<double>(grid.columns)), y}});
        }
        for (std::size_t k = 1; k < grid.columns; ++k) {
            const double x = grid.x_of(static_cast<double>(k)) - 0.5;
            lines.insert(lines.end(), {{x, grid.y_of(0)}, {x, grid.y_of(static_cast<double>(grid.rows))}});
        }
        canvas.lines(lines, {.colour = {0xa8, 0xa8, 0xa8}, .width = 1, .round = false});
    }
    draw_rulers(canvas, grid, stack_numbers(block));
}

}  // namespace

std::vector<Grid> layer_grids(const Block& block) {
    const std::size_t panels = std::min(layer_count(block), most_layers);
    // A shared pixel shows the first of its places: a mean of layers that come and go would say nothing.
    const Grid first = make_grid(block.rows(), block.columns(), 22, 300, panels > 4 ? 2000 : 3000);
    const Point size = panel_size(first);
    const std::size_t across = panels_across(panels, size.x);
    std::vector<Grid> grids(panels, first);
    for (std::size_t k = 0; k < panels; ++k) {
        grids[k].corner.x += static_cast<double>(k % across) * (size.x + gutter);
        grids[k].corner.y += heading + static_cast<double>(k / across) * (size.y + gutter / 2);
    }
    return grids;
}

Result<std::string> draw_layers(const Subject& subject) {
    const Block& block = subject.block;
    const std::vector<Grid> grids = layer_grids(block);
    const std::vector<std::vector<LayerPixel>> of_layer = pixels_of_layers(block, grids.size());
    const Point size = panel_size(grids[0]);
    const std::size_t across = panels_across(grids.size(), size.x),
                      down = (grids.size() + across - 1) / across;
    const double width = static_cast<double>(across) * (size.x + gutter) - gutter;
    const double height = static_cast<double>(down) * (size.y + gutter / 2) - gutter / 2;
    WEAVE_TRY(Page page, Page::open(subject, layer_words(subject, grids[0], of_layer), width, height));
    for (std::size_t k = 0; k < grids.size(); ++k) {
        const std::string name = "Layer " + std::to_string(k + 1) +
                                 (grids.size() == 1             ? " (the only one)"
                                  : k == 0                      ? " (top)"
                                  : k + 1 == layer_count(block) ? " (bottom)"
                                                                : "");
        page.canvas.text({grids[k].corner.x, grids[k].corner.y - 9}, name, {.size = 12, .bold = true});
        draw_layer(page.canvas, block, grids[k], of_layer[k]);
    }
    return std::move(page.canvas).finish();
}

}  // namespace weave
