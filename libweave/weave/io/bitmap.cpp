#include <weave/io/bitmap.hpp>

#include <weave/core/file.hpp>
#include <weave/io/raster.hpp>

#include <algorithm>

namespace weave {

namespace {

constexpr Colour black{0, 0, 0}, white{255, 255, 255};

std::string reading_text(const BitmapReading& reading) {
    return std::string("weave card image; pick 1 = ") + (reading.pick_1_at_bottom ? "bottom" : "top") +
           " row; end 1 = " + (reading.end_1_at_left ? "left" : "right") +
           " column; lifted end = " + (reading.black_is_lifted ? "black" : "white") + "; seen from the face";
}

/// Fills one packed row of the picture, 1 = white, from the pick that it shows.
void fill_row(const CardImage& card, const BitmapReading& reading, std::size_t row_from_top,
              std::span<std::uint8_t> packed) {
    const std::size_t pick = reading.pick_1_at_bottom ? card.picks() - 1 - row_from_top : row_from_top;
    const auto bits = card.row(pick);
    if (reading.end_1_at_left) {
        std::copy(bits.begin(), bits.end(), packed.begin());
    } else {
        std::fill(packed.begin(), packed.end(), std::uint8_t{0});
        for (std::size_t end = 0; end < card.ends(); ++end) {
            const std::size_t x = card.ends() - 1 - end;
            if (card.weft_over(pick, end)) packed[x / 8] |= static_cast<std::uint8_t>(0x80 >> x % 8);
        }
    }
    if (reading.black_is_lifted) return;
    for (std::uint8_t& byte : packed) byte = static_cast<std::uint8_t>(~byte);
    const std::size_t padding = packed.size() * 8 - card.ends();
    packed.back() &= static_cast<std::uint8_t>(0xff << padding);
}

/// Puts one row of a picture into the card; an error at the first pixel that is neither black nor white.
Status take_row(CardImage& card, const BitmapReading& reading, std::size_t row_from_top,
                std::span<const Colour> pixels) {
    const std::size_t pick = reading.pick_1_at_bottom ? card.picks() - 1 - row_from_top : row_from_top;
    const auto row = card.row(pick);
    for (std::size_t x = 0; x < pixels.size(); ++x) {
        const bool is_white = pixels[x] == white;
        if (!is_white && pixels[x] != black) {
            return bad_input("a card image is black and white only, but the pixel in column " +
                             std::to_string(x + 1) + " from the left and row " +
                             std::to_string(row_from_top + 1) + " from the top is " + to_text(pixels[x]));
        }
        if (is_white != reading.black_is_lifted) continue;
        const std::size_t end = reading.end_1_at_left ? x : card.ends() - 1 - x;
        row[end / 8] |= static_cast<std::uint8_t>(0x80 >> end % 8);
    }
    return {};
}

Status check_picture_size(std::size_t width, std::size_t height) {
    if (width <= longest_side && height <= longest_side) return check_card_size(height, width);
    return bad_input("a picture of " + std::to_string(width) + " by " + std::to_string(height) +
                     " pixels is longer on a side than the limit of " + std::to_string(longest_side));
}

bool starts_with(std::string_view bytes, std::string_view magic) {
    return bytes.substr(0, magic.size()) == magic;
}

using Decoder = Status (*)(std::string_view, RasterSink&);

/// By the first bytes; nothing where they are no picture's.
Decoder decoder_for(std::string_view bytes) {
    if (starts_with(bytes, "\x89PNG\r\n\x1a\n")) return decode_png;
    if (starts_with(bytes, std::string_view("II*\0", 4)) || starts_with(bytes, std::string_view("MM\0*", 4)))
        return decode_tiff;
    return starts_with(bytes, "BM") ? decode_bmp : nullptr;
}

Status decode(std::string_view bytes, RasterSink& sink) {
    const Decoder decoder = decoder_for(bytes);
    return decoder != nullptr ? decoder(bytes, sink) : bad_input("is neither a PNG, a TIFF nor a BMP picture");
}

}  // namespace

bool is_bitmap(std::string_view bytes) {
    return decoder_for(bytes) != nullptr;
}

Result<BitmapFormat> bitmap_format_of(const std::filesystem::path& path) {
    const std::string extension = lower_extension(path);
    if (extension == ".png") return BitmapFormat::png;
    if (extension == ".tif" || extension == ".tiff") return BitmapFormat::tiff;
    if (extension == ".bmp") return BitmapFormat::bmp;
    return Error{ErrorCode::usage, "a card image's name ends in .png, .tif, .tiff or .bmp", path.string()};
}

Result<std::string> write_bitmap(const CardImage& card, BitmapFormat format, const BitmapReading& reading) {
    WEAVE_CHECK_OK(check_picture_size(card.ends(), card.picks()));
    const BilevelRaster raster{
        card.ends(), card.picks(),
        [&](std::size_t row, std::span<std::uint8_t> packed) { fill_row(card, reading, row, packed); },
        reading_text(reading)};
    switch (format) {
        case BitmapFormat::png:
            return encode_png(raster);
        case BitmapFormat::tiff:
            return encode_tiff(raster);
        case BitmapFormat::bmp:
            return encode_bmp(raster);
    }
    return bad_input("is not a bitmap format");
}

Result<CardFromBitmap> read_bitmap(std::string_view bytes, const BitmapReading& reading) {
    CardFromBitmap read;
    RasterSink sink;
    sink.start = [&](std::size_t width, std::size_t height) -> Status {
        WEAVE_CHECK_OK(check_picture_size(width, height));
        read.card = CardImage(height, width);
        return {};
    };
    sink.row = [&](std::size_t row, std::span<const Colour> pixels) {
        return take_row(read.card, reading, row, pixels);
    };
    WEAVE_CHECK_OK(decode(bytes, sink));
    read.warnings = std::move(sink.warnings);
    if (!sink.reading.empty() && sink.reading != reading_text(reading)) {
        read.warnings.push_back("the file says '" + sink.reading + "', but is read as '" +
                                reading_text(reading) + "'");
    }
    return read;
}

Status check_reads_back(std::string_view bytes, const CardImage& card, const BitmapReading& reading) {
    const Result<CardFromBitmap> back = read_bitmap(bytes, reading);
    if (back && back->card == card) return {};
    return system_fault("the card image does not read back as it was; nothing is written");
}

Result<std::string> write_proven_bitmap(const CardImage& card, BitmapFormat format,
                                        const BitmapReading& reading) {
    WEAVE_TRY(std::string bytes, write_bitmap(card, format, reading));
    WEAVE_CHECK_OK(check_reads_back(bytes, card, reading));
    return bytes;
}

Result<ColourImage> read_colour_image(std::string_view bytes, const PictureSizeCheck& fits) {
    ColourImage image;
    RasterSink sink;
    sink.start = [&](std::size_t width, std::size_t height) -> Status {
        WEAVE_CHECK_OK(check_picture_size(width, height));
        if (fits) WEAVE_CHECK_OK(fits(height, width));
        image.rows = height, image.columns = width;
        return {};
    };
    // Memory grows with the rows that really come: a few bytes may claim a huge picture.
    sink.row = [&](std::size_t, std::span<const Colour> pixels) -> Status {
        image.pixels.insert(image.pixels.end(), pixels.begin(), pixels.end());
        return {};
    };
    WEAVE_CHECK_OK(decode(bytes, sink));
    for (std::size_t low = 0, high = image.rows - 1; low < high; ++low, --high) {
        const auto row = [&](std::size_t i) {
            return image.pixels.begin() + static_cast<std::ptrdiff_t>(i * image.columns);
        };
        std::swap_ranges(row(low), row(low + 1), row(high));
    }
    return image;
}

}  // namespace weave
