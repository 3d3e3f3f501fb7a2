#include <weave/picture/layer_map.hpp>
#include <weave/picture/views.hpp>

#include <algorithm>

namespace weave {

namespace {

constexpr double heading = 24, gutter = 24;
constexpr Colour no_yarns{0xc9, 0xd3, 0xdc}, lifted{0, 0, 0}, weft_over{0xff, 0xff, 0xff};

Colour colour_of(LayerPixel pixel) {
    return pixel == LayerPixel::none ? no_yarns : pixel == LayerPixel::lifted ? lifted : weft_over;
}

/// Height in the stack of the yarn that stands for `layer`, or none.
std::optional<std::size_t> height_of(const Stack& stack, System system, std::size_t layer,
                                     std::size_t layers) {
    const std::size_t yarns = system == System::weft ? stack.wefts() : stack.warps();
    if (yarns == 0) return std::nullopt;
    std::size_t above = layer * yarns / layers;  // yarns of the system that lie higher
    for (std::size_t k = stack.height(); k-- > 0;) {
        const Slot slot = stack.slots()[k];
        if (system == System::weft ? !slot.is_weft() : !slot.is_warp()) continue;
        if (above-- == 0) return k;
    }
    return std::nullopt;
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

std::size_t layer_count(const Block& block) {
    std::size_t layers = 1;
    for (const Stack& stack : block.stacks()) layers = std::max({layers, stack.wefts(), stack.warps()});
    return layers;
}

LayerPixel layer_pixel(const Stack& stack, std::size_t layer) {
    const std::size_t layers = std::max(stack.wefts(), stack.warps());
    if (layer >= layers) return LayerPixel::none;
    const auto weft = height_of(stack, System::weft, layer, layers),
               warp = height_of(stack, System::warp, layer, layers);
    if (!weft || !warp) return LayerPixel::none;
    return *weft > *warp ? LayerPixel::weft_over : LayerPixel::lifted;
}

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
    PageText text = words_of(subject, "layers, top layer first");
    text.legend = {{"", {{lifted, "end lifted over its weft"}, {weft_over, "weft over its end"}}}};
    const bool uneven = std::ranges::any_of(block.stacks(), [&](const Stack& stack) {
        return layer_pixel(stack, layer_count(block) - 1) == LayerPixel::none;
    });
    if (uneven) text.legend[0].swatches.push_back({no_yarns, "no such layer here"});
    text.notes = scale_notes(grids[0], "of which it shows the first");
    text.notes.push_back("Layer k: the k-th weft and the k-th warp of each stack, counted from the top.");
    if (layer_count(block) > grids.size()) {
        text.notes.push_back("Shown: the top " + std::to_string(grids.size()) + " of " +
                             std::to_string(layer_count(block)) + " layers.");
    }
    const Point size = panel_size(grids[0]);
    const std::size_t across = panels_across(grids.size(), size.x),
                      down = (grids.size() + across - 1) / across;
    const double width = static_cast<double>(across) * (size.x + gutter) - gutter;
    const double height = static_cast<double>(down) * (size.y + gutter / 2) - gutter / 2;
    WEAVE_TRY(Page page, Page::open(subject.format, text, width, height));
    for (std::size_t k = 0; k < grids.size(); ++k) {
        std::vector<LayerPixel> of_stack;
        for (const Stack& stack : block.stacks()) of_stack.push_back(layer_pixel(stack, k));
        const std::string name = "Layer " + std::to_string(k + 1) +
                                 (grids.size() == 1             ? " (the only one)"
                                  : k == 0                      ? " (top)"
                                  : k + 1 == layer_count(block) ? " (bottom)"
                                                                : "");
        page.canvas.text({grids[k].corner.x, grids[k].corner.y - 9}, name, {.size = 12, .bold = true});
        draw_layer(page.canvas, block, grids[k], of_stack);
    }
    return std::move(page.canvas).finish();
}

}  // namespace weave
