#include <studio/editors/cell_picture.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace weave::studio {

namespace {

constexpr QRgb white = 0xffffffff, black = 0xff000000;

}  // namespace

std::size_t CellPicture::rows() const {
    return m_card ? m_card->card.picks() : static_cast<std::size_t>(m_image.height());
}

std::size_t CellPicture::columns() const {
    return m_card ? m_card->card.ends() : static_cast<std::size_t>(m_image.width());
}

QRgb CellPicture::at(std::size_t row, std::size_t column) const {
    if (m_card) return m_card->card.weft_over(row, column) ? white : black;
    return reinterpret_cast<const QRgb*>(m_image.constScanLine(static_cast<int>(row)))[column];
}

/// The mean of squares of `step` to each side, from few samples of them.
QRgb CellPicture::from_afar(double row, double column, double step) const {
    const auto in = [](double place, std::size_t count) { return std::min(static_cast<std::size_t>(std::max(place, 0.0)), count - 1); };
    if (m_card && step >= 4) {
        const auto y = static_cast<int>(in(row + step / 2, rows()) / CardPicture::square);
        const std::size_t x = in(column + step / 2, columns()) / CardPicture::square;
        const int grey = m_card->coarse.constScanLine(y)[x];
        return qRgb(grey, grey, grey);
    }
    int red = 0, green = 0, blue = 0;
    for (const double y : {0.25, 0.75}) {
        for (const double x : {0.25, 0.75}) {
            const QRgb colour = at(in(row + y * step, rows()), in(column + x * step, columns()));
            red += qRed(colour), green += qGreen(colour), blue += qBlue(colour);
        }
    }
    return qRgb(red / 4, green / 4, blue / 4);
}

CellPicture::Seen CellPicture::by_squares(const GridMapping& mapping) const {
    const GridSpan span = mapping.seen();
    const std::size_t height = span.last_row - span.first_row, width = span.last_column - span.first_column;
    Seen seen;
    if (height == 0 || width == 0) return seen;
    seen.image = QImage(static_cast<int>(width), static_cast<int>(height), QImage::Format_RGB32);
    for (std::size_t y = 0; y < height; ++y) {
        const std::size_t row = (mapping.rows_go_up() ? span.last_row - 1 - y : span.first_row + y) % rows();
        auto* line = reinterpret_cast<QRgb*>(seen.image.scanLine(static_cast<int>(y)));
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t column = mapping.columns_go_right() ? span.first_column + x : span.last_column - 1 - x;
            line[x] = at(row, column % columns());
        }
    }
    seen.place = mapping.box({span.first_row, span.first_column}).united(mapping.box({span.last_row - 1, span.last_column - 1}));
    return seen;
}

CellPicture::Seen CellPicture::by_pixels(const GridMapping& mapping, double scale) const {
    Seen seen;
    const QRectF place = mapping.frame().intersected(mapping.room());
    seen.place = QRectF(std::floor(place.left() * scale) / scale, std::floor(place.top() * scale) / scale, std::ceil(place.width() * scale) / scale,
                        std::ceil(place.height() * scale) / scale);
    const int width = static_cast<int>(std::lround(seen.place.width() * scale)), height = static_cast<int>(std::lround(seen.place.height() * scale));
    if (width <= 0 || height <= 0) return {};
    seen.image = QImage(width, height, QImage::Format_RGB32);
    const double step = 1 / (mapping.cell() * scale);
    const QRectF grid = mapping.frame();
    const auto row_count = static_cast<double>(rows()), column_count = static_cast<double>(columns());
    std::vector<double> columns_of(static_cast<std::size_t>(width));
    for (int x = 0; x < width; ++x) {
        const double left = (seen.place.left() + x / scale - grid.left()) / mapping.cell();
        const double column = mapping.columns_go_right() ? left : static_cast<double>(mapping.columns()) - left - step;
        columns_of[static_cast<std::size_t>(x)] = std::fmod(std::max(column, 0.0), column_count);
    }
    for (int y = 0; y < height; ++y) {
        const double top = (seen.place.top() + y / scale - grid.top()) / mapping.cell();
        const double row = std::fmod(std::max(mapping.rows_go_up() ? static_cast<double>(mapping.rows()) - top - step : top, 0.0), row_count);
        auto* line = reinterpret_cast<QRgb*>(seen.image.scanLine(y));
        for (int x = 0; x < width; ++x) line[x] = from_afar(row, columns_of[static_cast<std::size_t>(x)], step);
    }
    return seen;
}

CellPicture::Seen CellPicture::seen(const GridMapping& mapping, double scale) const {
    if (is_empty()) return {};
    return mapping.cell() * scale >= 1 ? by_squares(mapping) : by_pixels(mapping, scale);
}

}  // namespace weave::studio
