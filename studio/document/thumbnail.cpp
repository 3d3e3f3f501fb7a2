#include <studio/document/thumbnail.hpp>

#include <weave/picture/look.hpp>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

/// A small weave is shown several times side by side, so that it looks like cloth.
constexpr std::size_t least_stacks = 16;

std::size_t times(std::size_t stacks, const Block& block) {
    return std::max(block.rows(), block.columns()) >= least_stacks ? 1 : std::max<std::size_t>(1, least_stacks / stacks);
}

}  // namespace

QImage thumbnail(const Design& design, const Block& block, int side) {
    const std::size_t rows = block.rows() * times(block.rows(), block), columns = block.columns() * times(block.columns(), block);
    const double scale = static_cast<double>(side) / static_cast<double>(std::max(rows, columns));
    const auto pixels = [&](std::size_t stacks) { return std::max(1, static_cast<int>(std::lround(static_cast<double>(stacks) * scale))); };
    const int width = pixels(columns), height = pixels(rows);
    const Subject subject{design, block, {}};
    const YarnColours colours(subject);
    const Surface face(block, colours, false, false);
    QImage image(width, height, QImage::Format_RGB32);
    for (int y = 0; y < height; ++y) {
        const std::size_t row = static_cast<std::size_t>(height - 1 - y) * rows / static_cast<std::size_t>(height) % block.rows();
        auto* line = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < width; ++x) {
            const std::size_t column = static_cast<std::size_t>(x) * columns / static_cast<std::size_t>(width) % block.columns();
            const Colour colour = face.colour(row, column).value_or(Colour{255, 255, 255});
            line[x] = qRgb(colour.red, colour.green, colour.blue);
        }
    }
    return image;
}

}  // namespace weave::studio
