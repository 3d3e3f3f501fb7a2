#pragma once

#include <QImage>

#include <functional>
#include <memory>
#include <studio/document/card_picture.hpp>
#include <studio/editors/grid_mapping.hpp>

namespace weave::studio {

/// What fills the squares of a grid: a card in black and white, or a picture with a pixel a square (row 0 its first line).
class CellPicture {
  public:
    CellPicture() = default;
    explicit CellPicture(std::shared_ptr<const CardPicture> card) : m_card(std::move(card)) {}
    explicit CellPicture(QImage image) : m_image(std::move(image)) {}

    [[nodiscard]] bool is_empty() const { return !m_card && m_image.isNull(); }
    [[nodiscard]] std::size_t rows() const;
    [[nodiscard]] std::size_t columns() const;

    /// What is seen of the grid, which may hold this picture several times side by side, and where in the window it goes. The scale is
    /// device pixels to one of the window's. Large squares have a pixel each, to be drawn larger; small ones share pixels.
    struct Seen {
        QImage image;
        QRectF place;
    };
    [[nodiscard]] Seen seen(const GridMapping& mapping, double scale) const;

  private:
    [[nodiscard]] QRgb at(std::size_t row, std::size_t column) const;
    [[nodiscard]] QRgb from_afar(double row, double column, double step) const;
    [[nodiscard]] Seen by_squares(const GridMapping& mapping) const;
    [[nodiscard]] Seen by_pixels(const GridMapping& mapping, double scale) const;

    std::shared_ptr<const CardPicture> m_card;
    QImage m_image;
};

}  // namespace weave::studio
