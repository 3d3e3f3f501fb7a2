#include <studio/document/card_picture.hpp>

#include <algorithm>
#include <bit>

namespace weave::studio {

namespace {

/// The grey of one square, squares at the rim being smaller.
std::uint8_t grey_of(const CardImage& card, std::size_t row, std::size_t column) {
    const std::size_t first = row * CardPicture::square, last = std::min(first + CardPicture::square, card.picks());
    const std::size_t width = std::min(CardPicture::square, card.ends() - column * CardPicture::square);
    int over = 0;
    for (std::size_t pick = first; pick < last; ++pick) over += std::popcount(card.row(pick)[column]);
    return static_cast<std::uint8_t>(static_cast<std::size_t>(over) * 255 / ((last - first) * width));
}

std::size_t squares(std::size_t length) {
    return (length + CardPicture::square - 1) / CardPicture::square;
}

}  // namespace

std::shared_ptr<const CardPicture> card_picture(const Block& block) {
    auto picture = std::make_shared<CardPicture>();
    picture->card = block.card_image();
    const std::size_t rows = squares(picture->card.picks()), columns = squares(picture->card.ends());
    picture->coarse = QImage(static_cast<int>(columns), static_cast<int>(rows), QImage::Format_Grayscale8);
    for (std::size_t row = 0; row < rows; ++row) {
        std::uint8_t* line = picture->coarse.scanLine(static_cast<int>(row));
        for (std::size_t column = 0; column < columns; ++column) line[column] = grey_of(picture->card, row, column);
    }
    return picture;
}

std::shared_ptr<const CardPicture> card_picture(const Block& block, const CardPicture& before, std::span<const std::size_t> changed_cells) {
    if (changed_cells.size() > block.rows() * block.columns() / 8) return card_picture(block);
    auto picture = std::make_shared<CardPicture>(before);
    for (const std::size_t cell : changed_cells) {
        const std::size_t row = cell / block.columns(), column = cell % block.columns();
        for (std::size_t pick = block.first_pick(row); pick < block.first_pick(row + 1); ++pick) {
            for (std::size_t end = block.first_end(column); end < block.first_end(column + 1); ++end) {
                picture->card.set(pick, end, block.weft_over(pick, end));
                const std::size_t square_row = pick / CardPicture::square, square_column = end / CardPicture::square;
                picture->coarse.scanLine(static_cast<int>(square_row))[square_column] = grey_of(picture->card, square_row, square_column);
            }
        }
    }
    return picture;
}

}  // namespace weave::studio
