#include "picture.hpp"

#include "must.hpp"

namespace weave::fuzz {

namespace {

/// Larger ones, which a few bytes can hold where a format packs well, are read but not written again: runs
/// stay quick.
constexpr std::size_t most_pixels = std::size_t{1} << 18;

BitmapReading reading_of(unsigned number) {
    return {(number & 1) != 0, (number & 2) != 0, (number & 4) != 0};
}

void try_card(std::string_view bytes, BitmapFormat format, const BitmapReading& reading) {
    const auto read = read_bitmap(bytes, reading);
    if (!read) {
        must(!read.error().message.empty(), "a refusal says why");
        return;
    }
    const CardImage& card = read->card;
    must(card.picks() > 0 && card.ends() > 0 && card.picks() <= most_crossings / card.ends(),
         "a card keeps its bounds");
    if (card.picks() * card.ends() > most_pixels) return;
    const auto written = write_bitmap(card, format, reading);
    must(static_cast<bool>(written), "what was read can be written");
    const auto again = read_bitmap(*written, reading);
    must(again && again->card == card, "a card reads as it was written");
}

void try_colours(std::string_view bytes) {
    const auto image = read_colour_image(bytes);
    if (!image) {
        must(!image.error().message.empty(), "a refusal says why");
        return;
    }
    must(image->rows > 0 && image->columns > 0, "a picture is not empty");
    must(image->pixels.size() == image->rows * image->columns, "a picture has all its pixels");
    if (image->pixels.size() > most_pixels) return;
    const auto written = write_png(*image);
    must(static_cast<bool>(written), "what was read can be written");
    const auto again = read_colour_image(*written);
    must(again && again->rows == image->rows && again->columns == image->columns &&
             again->pixels == image->pixels,
         "a picture reads as it was written");
}

}  // namespace

void try_picture(std::string_view bytes, BitmapFormat format, std::uint64_t claimed_pixels) {
    if (claimed_pixels > most_pixels) {
        try_card(bytes, format, {});
        return;
    }
    for (unsigned number = 0; number < 8; ++number) try_card(bytes, format, reading_of(number));
    try_colours(bytes);
}

}  // namespace weave::fuzz
