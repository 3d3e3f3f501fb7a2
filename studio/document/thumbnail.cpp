#include <studio/document/thumbnail.hpp>

#include <weave/picture/look.hpp>

#include <algorithm>

namespace weave::studio {

QImage thumbnail(const Design& design, const Block& block, int side) {
    const auto rows = static_cast<int>(std::min<std::size_t>(block.rows(), 1U << 24)), columns = static_cast<int>(std::min<std::size_t>(block.columns(), 1U << 24));
    const double scale = static_cast<double>(side) / std::max(rows, columns);
    const int width = std::max(1, static_cast<int>(columns * scale)), height = std::max(1, static_cast<int>(rows * scale));
    const Subject subject{design, block, {}};
    const YarnColours colours(subject);
    const Surface face(block, colours, false, false);
    QImage image(width, height, QImage::Format_RGB32);
    for (int y = 0; y < height; ++y) {
        const auto row = static_cast<std::size_t>(std::int64_t{height - 1 - y} * rows / height);
        auto* line = reinterpret_cast<QRgb*>(image.scanLine(y));
        for (int x = 0; x < width; ++x) {
            const auto column = static_cast<std::size_t>(std::int64_t{x} * columns / width);
            const Colour colour = face.colour(row, column).value_or(Colour{255, 255, 255});
            line[x] = qRgb(colour.red, colour.green, colour.blue);
        }
    }
    return image;
}

}  // namespace weave::studio
