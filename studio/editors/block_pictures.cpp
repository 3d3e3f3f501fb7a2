#include <studio/editors/block_pictures.hpp>

#include <weave/picture/canvas.hpp>
#include <weave/picture/float_map.hpp>
#include <weave/picture/layer_map.hpp>
#include <weave/picture/look.hpp>

#include <vector>

namespace weave::studio {

namespace {

constexpr Colour nothing{0xee, 0xee, 0xee};

QRgb pixel(Colour colour) {
    return qRgb(colour.red, colour.green, colour.blue);
}

template <class ColourOf>
QImage picture_of(const Block& block, ColourOf colour_of) {
    QImage image(static_cast<int>(block.columns()), static_cast<int>(block.rows()), QImage::Format_RGB32);
    for (std::size_t row = 0; row < block.rows(); ++row) {
        auto* line = reinterpret_cast<QRgb*>(image.scanLine(static_cast<int>(row)));
        for (std::size_t column = 0; column < block.columns(); ++column) line[column] = colour_of(row, column);
    }
    return image;
}

QRgb layer_colour(LayerPixel pixel) {
    switch (pixel) {
        case LayerPixel::lifted:
            return qRgb(0, 0, 0);
        case LayerPixel::weft_over:
            return qRgb(255, 255, 255);
        case LayerPixel::between:
            return qRgb(0x99, 0x99, 0x99);
        case LayerPixel::none:
            break;
    }
    return qRgb(nothing.red, nothing.green, nothing.blue);
}

QImage layer_picture(const Block& block, std::size_t layer) {
    std::vector<QRgb> of_stack;
    for (const Stack& stack : block.stacks()) {
        const std::vector<LayerPixel> pixels = layer_pixels(stack);
        of_stack.push_back(layer_colour(layer < pixels.size() ? pixels[layer] : LayerPixel::none));
    }
    return picture_of(block, [&](std::size_t row, std::size_t column) { return of_stack[block.cells(row)[column]]; });
}

}  // namespace

QImage block_picture(const Design& design, const Block& block, CardMode mode, std::size_t layer) {
    if (mode == CardMode::layer) return layer_picture(block, layer);
    const Subject subject{design, block, {}};
    const YarnColours colours(subject);
    const Surface surface(block, colours, mode == CardMode::back || mode == CardMode::back_floats, false);
    if (mode == CardMode::face || mode == CardMode::back)
        return picture_of(block, [&](std::size_t row, std::size_t column) { return pixel(surface.colour(row, column).value_or(nothing)); });
    const std::vector<std::int32_t> lengths = float_lengths(surface);
    return picture_of(block, [&](std::size_t row, std::size_t column) {
        const std::int32_t length = lengths[row * block.columns() + column];
        return pixel(length == 0 ? nothing : float_colour(length));
    });
}

}  // namespace weave::studio
