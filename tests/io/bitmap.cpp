#include <weave/io/bitmap.hpp>

#include <catch2/catch.hpp>
#include <png.h>

#include <support/random.hpp>

using namespace weave;
using weave::testing::for_all;
using weave::testing::Random;

namespace {

CardImage random_card(Random& random, std::size_t most = 40) {
    CardImage card(random.between(1, most), random.between(1, most));
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        for (std::size_t end = 0; end < card.ends(); ++end) card.set(pick, end, random.coin());
    }
    return card;
}

constexpr BitmapFormat formats[] = {BitmapFormat::png, BitmapFormat::tiff, BitmapFormat::bmp};

unsigned byte_at(const std::string& bytes, std::size_t at) {
    return static_cast<unsigned char>(bytes[at]);
}

std::size_t little(const std::string& bytes, std::size_t at, std::size_t count) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < count; ++k) value |= std::size_t{byte_at(bytes, at + k)} << 8 * k;
    return value;
}

/// Value of a tag in the first directory of a little-endian TIFF with short or long values.
std::size_t tiff_tag(const std::string& bytes, std::size_t tag) {
    const std::size_t directory = little(bytes, 4, 4);
    for (std::size_t k = 0; k < little(bytes, directory, 2); ++k) {
        const std::size_t entry = directory + 2 + 12 * k;
        if (little(bytes, entry, 2) == tag)
            return little(bytes, entry + 8, little(bytes, entry + 2, 2) == 3 ? 2 : 4);
    }
    return 0xdead;
}

/// An L: end 1 lifted on all three picks, end 2 lifted on pick 1 only. Asymmetric in both directions.
CardImage letter_l() {
    CardImage card(3, 2);
    for (std::size_t pick = 0; pick < 3; ++pick) card.set(pick, 1, true);
    card.set(0, 1, false);
    return card;
}

/// A BMP by hand, rows as they are stored.
std::string bmp(int width, int height, int bits, const std::vector<Colour>& palette,
                const std::string& rows) {
    std::string out = "BM";
    const auto put = [&](long value, int count) {
        for (int k = 0; k < count; ++k) out.push_back(static_cast<char>(value >> 8 * k & 0xff));
    };
    put(0, 8);
    put(54 + 4 * static_cast<long>(palette.size()), 4);
    put(40, 4), put(width, 4), put(height, 4), put(1, 2), put(bits, 2), put(0, 4), put(0, 4), put(0, 8);
    put(static_cast<long>(palette.size()), 4), put(0, 4);
    for (const Colour c : palette) put(c.blue | c.green << 8 | c.red << 16, 4);
    return out + rows;
}

struct TiffTag {
    unsigned tag, value, count = 1;
};

/// A bilevel little-endian TIFF by hand, 1 = black; `offsets` is the tag that says where its strip or tiles
/// lie.
std::string tiff(unsigned width, unsigned height, std::vector<TiffTag> tags, unsigned offsets,
                 const std::string& data) {
    for (const TiffTag& tag :
         std::vector<TiffTag>{{256, width}, {257, height}, {258, 1}, {262, 0}, {277, 1}, {offsets, 8}})
        tags.push_back(tag);
    std::sort(tags.begin(), tags.end(), [](const TiffTag& a, const TiffTag& b) { return a.tag < b.tag; });
    std::string out = "II*";
    const auto put = [&](std::size_t value, int bytes) {
        for (int k = 0; k < bytes; ++k) out.push_back(static_cast<char>(value >> 8 * k & 0xff));
    };
    const unsigned pieces = static_cast<unsigned>(data.size() / 256), many = pieces > 1 ? pieces : 1;
    const std::size_t lists = 8 + data.size(), directory = lists + (many > 1 ? 8 * many : 0);
    put(0, 1), put(directory, 4);
    out += data;
    for (unsigned k = 0; many > 1 && k < many; ++k) put(8 + 256 * k, 4);
    for (unsigned k = 0; many > 1 && k < many; ++k) put(256, 4);
    put(tags.size(), 2);
    for (const TiffTag& tag : tags) {
        const bool list = many > 1 && (tag.tag == offsets || tag.count > 1);
        put(tag.tag, 2), put(4, 2), put(list ? many : 1, 4);
        put(!list ? tag.value : tag.tag == offsets ? lists : lists + 4 * many, 4);
    }
    put(0, 4);
    return out;
}

}  // namespace

TEST_CASE("a card survives every format in every reading, bit for bit") {
    for_all([](Random& random) {
        const CardImage card = random_card(random);
        const BitmapReading reading{random.coin(), random.coin(), random.coin()};
        const BitmapFormat format = formats[random.between(0, 2)];
        const Result<std::string> bytes = write_bitmap(card, format, reading);
        REQUIRE(bytes);
        const Result<CardFromBitmap> back = read_bitmap(*bytes, reading);
        REQUIRE(back);
        REQUIRE(back->card == card);
        REQUIRE(back->warnings.empty());
    });
}

TEST_CASE("the default reading: bottom row is pick 1, left column end 1, black a lifted end") {
    for (const BitmapFormat format : formats) {
        const Result<ColourImage> image = read_colour_image(*write_bitmap(letter_l(), format));
        REQUIRE(image);
        REQUIRE(image->rows == 3);
        REQUIRE(image->columns == 2);
        const Colour black{0, 0, 0}, white{255, 255, 255};
        const std::vector<Colour> expected{black, black, black,
                                           white, black, white};  // from the bottom row up
        CHECK(image->pixels == expected);
    }
}

TEST_CASE("a TIFF is of the kind that a TC2 takes") {
    CardImage card(2394, 1320);
    card.set(0, 0, true);
    const std::string bytes = *write_bitmap(card, BitmapFormat::tiff);
    CHECK(bytes.substr(0, 4) == std::string("II*\0", 4));
    CHECK(tiff_tag(bytes, 256) == 1320);
    CHECK(tiff_tag(bytes, 257) == 2394);
    CHECK(tiff_tag(bytes, 258) == 1);     // BitsPerSample
    CHECK(tiff_tag(bytes, 259) == 1);     // no compression
    CHECK(tiff_tag(bytes, 262) == 0);     // WhiteIsZero
    CHECK(tiff_tag(bytes, 274) == 1);     // Orientation
    CHECK(tiff_tag(bytes, 277) == 1);     // SamplesPerPixel
    CHECK(tiff_tag(bytes, 278) == 2394);  // one strip
    CHECK(tiff_tag(bytes, 279) == 165 * 2394);
    const std::size_t strip = tiff_tag(bytes, 273);
    CHECK(byte_at(bytes, strip) == 0xff);               // top row: last pick, all lifted, 1 = black
    CHECK(byte_at(bytes, strip + 165 * 2393) == 0x7f);  // bottom row: pick 1, end 1 down
}

TEST_CASE(
    "a BMP is one bit, uncompressed, its pixels at byte 62, palette black then white, bottom row first") {
    const std::string bytes = *write_bitmap(letter_l(), BitmapFormat::bmp);
    CHECK(bytes.substr(0, 2) == "BM");
    CHECK(little(bytes, 2, 4) == bytes.size());
    CHECK(little(bytes, 10, 4) == 62);
    CHECK(little(bytes, 18, 4) == 2);
    CHECK(little(bytes, 22, 4) == 3);
    CHECK(little(bytes, 28, 2) == 1);
    CHECK(little(bytes, 30, 4) == 0);
    CHECK(little(bytes, 54, 4) == 0);
    CHECK(little(bytes, 58, 4) == 0x00ffffff);
    REQUIRE(bytes.size() == 62 + 3 * 4);
    CHECK(byte_at(bytes, 62) == 0x00);  // pick 1: both ends lifted
    CHECK(byte_at(bytes, 66) == 0x40);  // pick 2: end 2 down
}

TEST_CASE("a file that says how it is to be read warns when it is read otherwise") {
    for (const BitmapFormat format : {BitmapFormat::png, BitmapFormat::tiff}) {
        const std::string bytes = *write_bitmap(letter_l(), format, {true, true, false});
        const Result<CardFromBitmap> back = read_bitmap(bytes);
        REQUIRE(back);
        REQUIRE(back->warnings.size() == 1);
        CHECK(back->warnings[0].find("lifted end = white") != std::string::npos);
    }
}

TEST_CASE("other programs' bilevel pictures are read: inverted palette, top-down, 24 bits, 4 bits") {
    const Colour black{0, 0, 0}, white{255, 255, 255};
    const std::string four(4, '\0');
    CardImage expected(2, 2);  // pick 1 under both ends; pick 2 over end 1
    expected.set(1, 0, true);
    const auto card = [](const std::string& bytes) { return read_bitmap(bytes)->card; };
    CHECK(card(bmp(2, 2, 1, {white, black}, std::string("\xc0\0\0\0\x40\0\0\0", 8))) == expected);
    CHECK(card(bmp(2, -2, 1, {black, white}, std::string("\x80\0\0\0\0\0\0\0", 8))) == expected);
    CHECK(card(bmp(2, 2, 4, {black, white}, std::string("\0\0\0\0\x10\0\0\0", 8))) == expected);
    CHECK(card(bmp(2, 2, 24, {}, std::string(8, '\0') + std::string("\xff\xff\xff\0\0\0\0\0", 8))) ==
          expected);
}

TEST_CASE("a picture that is not black and white is refused at its first other pixel") {
    ColourImage image{2, 3, std::vector<Colour>(6, Colour{255, 255, 255})};
    image.pixels[1] = {200, 10, 10};  // bottom row, second column
    const Result<CardFromBitmap> read = read_bitmap(*write_png(image));
    REQUIRE(!read);
    CHECK(read.error().code == ErrorCode::bad_input);
    CHECK(read.error().message.find("column 2 from the left and row 2 from the top is #c80a0a") !=
          std::string::npos);
}

TEST_CASE("colour pictures come back as they were, row 0 at the bottom") {
    for_all(
        [](Random& random) {
            ColourImage image{random.between(1, 9), random.between(1, 9), {}};
            for (std::size_t k = 0; k < image.rows * image.columns; ++k) {
                const auto part = [&] { return static_cast<std::uint8_t>(random.between(0, 255)); };
                image.pixels.push_back({part(), part(), part()});
            }
            const Result<ColourImage> back = read_colour_image(*write_png(image));
            REQUIRE(back);
            REQUIRE(back->rows == image.rows);
            REQUIRE(back->columns == image.columns);
            REQUIRE(back->pixels == image.pixels);
        },
        weave::testing::property_cases());
}

TEST_CASE("a card that does not read back as it was is found, bit by bit") {
    for (const BitmapFormat format : formats) {
        const BitmapReading reading{false, true, true};
        const std::string bytes = *write_proven_bitmap(letter_l(), format, reading);
        CHECK(bytes == *write_bitmap(letter_l(), format, reading));
        CHECK(check_reads_back(bytes, letter_l(), reading));
        for (std::size_t pick = 0; pick < 3; ++pick) {
            for (std::size_t end = 0; end < 2; ++end) {
                CardImage other = letter_l();
                other.set(pick, end, !other.weft_over(pick, end));
                const Status differs = check_reads_back(bytes, other, reading);
                REQUIRE_FALSE(differs);
                CHECK(differs.error().code == ErrorCode::system);
                CHECK_THAT(differs.error().text(), Catch::Contains("does not read back"));
            }
        }
        CHECK_FALSE(check_reads_back(bytes, letter_l(), {true, true, true}));
        CHECK_FALSE(check_reads_back(bytes.substr(0, bytes.size() / 2), letter_l(), reading));
    }
}

TEST_CASE("a TIFF that starts at another corner is turned the right way up") {
    // As stored, from its first byte: the L's foot, then its stem; 1 = black.
    const std::string stored("\xc0\x80\x80", 3);
    const auto card = [](const std::string& text) {  // rows from the top, X = lifted
        CardImage image(3, 2);
        for (std::size_t row = 0; row < 3; ++row)
            for (std::size_t end = 0; end < 2; ++end) image.set(2 - row, end, text[row * 3 + end] != 'X');
        return image;
    };
    const auto read = [&](unsigned orientation) {
        return read_bitmap(tiff(2, 3, {{259, 1}, {274, orientation}, {278, 3}, {279, 3}}, 273, stored));
    };
    CHECK(read(1).value().card == card("XX X- X-"));
    CHECK(read(2).value().card == card("XX -X -X"));  // the first column is the right one
    CHECK(read(3).value().card == card("-X -X XX"));  // and the first row the bottom one
    CHECK(read(4).value().card == card("X- X- XX"));
    for (const unsigned orientation : {5U, 6U, 7U, 8U})
        CHECK_THAT(read(orientation).error().text(), Catch::Contains("on its side"));
}

TEST_CASE("a TIFF in tiles of one bit that are not compressed is read") {
    // 70 by 40 pixels in tiles of 64 by 32: two across, two down, 256 bytes each. Black are the pixels (0,
    // 0), (65, 0), (63, 33) and (69, 39), counted from the top left corner.
    std::string tiles(1024, '\0');
    const auto blacken = [&](std::size_t x, std::size_t y) {
        const std::size_t tile = y / 32 * 2 + x / 64, byte = tile * 256 + y % 32 * 8 + x % 64 / 8;
        tiles[byte] = static_cast<char>(tiles[byte] | 0x80 >> x % 8);
    };
    CardImage expected(40, 70);
    for (std::size_t pick = 0; pick < 40; ++pick)
        for (std::size_t end = 0; end < 70; ++end) expected.set(pick, end, true);
    for (const auto& [x, y] :
         std::vector<std::pair<std::size_t, std::size_t>>{{0, 0}, {65, 0}, {63, 33}, {69, 39}}) {
        blacken(x, y);
        expected.set(39 - y, x, false);
    }
    const Result<CardFromBitmap> read =
        read_bitmap(tiff(70, 40, {{259, 1}, {322, 64}, {323, 32}, {325, 256, 4}}, 324, tiles));
    if (!read) FAIL(read.error().text());
    CHECK(read->card == expected);
}

TEST_CASE("a PNG that is transparent anywhere is refused, as no one can say what colour it has") {
    for (const int clear : {-1, 0, 4}) {
        std::vector<std::uint8_t> rgba;
        for (int k = 0; k < 6; ++k)
            for (const int part : {0, 0, 0, k == clear ? 254 : 255})
                rgba.push_back(static_cast<std::uint8_t>(part));
        png_image image{};
        image.version = PNG_IMAGE_VERSION;
        image.width = 3, image.height = 2, image.format = PNG_FORMAT_RGBA;
        std::string bytes(4096, '\0');
        png_alloc_size_t size = bytes.size();
        REQUIRE(png_image_write_to_memory(&image, bytes.data(), &size, 0, rgba.data(), 0, nullptr) != 0);
        bytes.resize(size);
        const Result<CardFromBitmap> read = read_bitmap(bytes);
        const Result<ColourImage> colours = read_colour_image(bytes);
        CHECK(bool(read) == (clear < 0));
        CHECK(bool(colours) == (clear < 0));
        if (clear < 0) continue;
        const std::string where = clear == 0 ? "column 1 from the left and row 1 from the top is transparent"
                                             : "column 2 from the left and row 2 from the top is transparent";
        CHECK_THAT(read.error().text(), Catch::Contains(where));
        CHECK_THAT(colours.error().text(), Catch::Contains(where));
    }
}

TEST_CASE("damaged, foreign and oversized pictures are refused, whatever is in them") {
    CHECK(!read_bitmap(""));
    CHECK(!read_bitmap("GIF89a"));
    CHECK(!read_bitmap(bmp(100000, 100000, 1, {{0, 0, 0}}, "")));  // more crossings than a card may have
    CHECK(!read_bitmap(
        bmp(2, 2, 1, {{0, 0, 0}}, std::string("\x40\0\0\0\0\0\0\0", 8))));  // index beyond the palette
    CHECK(!read_bitmap(bmp(0, 2, 1, {{0, 0, 0}}, std::string(8, '\0'))));
    CHECK(!read_bitmap(bmp(2, 2, 16, {}, std::string(16, '\0'))));
    for_all([](Random& random) {
        std::string bytes = *write_bitmap(random_card(random, 12), formats[random.between(0, 2)]);
        for (std::size_t k = random.between(1, 4); k > 0; --k) {
            bytes[random.between(0, bytes.size() - 1)] = static_cast<char>(random.between(0, 255));
        }
        if (random.coin()) bytes.resize(random.between(0, bytes.size()));
        const Result<CardFromBitmap> read = read_bitmap(bytes);  // anything but a crash
        if (read) CHECK(read->card.picks() * read->card.ends() <= most_crossings);
        if (!read) CHECK(!read.error().message.empty());
    });
}

/// A fax picture (CCITT group 4) of 8 by 8 pixels, a twill 2/2, of which libtiff gets these bytes to decode.
std::string fax(const std::string& pixels) {
    const auto number = [](std::size_t value, int bytes) {
        std::string text;
        for (int k = 0; k < bytes; ++k) text.push_back(static_cast<char>(value >> 8 * k & 0xff));
        return text;
    };
    const std::vector<std::pair<std::size_t, std::size_t>> fields{{256, 8}, {257, 8}, {258, 1}, {259, 4},
                                                                  {262, 0}, {273, 8}, {277, 1}, {278, 8},
                                                                  {279, pixels.size()}};
    std::string file = "II" + number(42, 2) + number(8 + pixels.size(), 4) + pixels + number(fields.size(), 2);
    for (const auto& [tag, value] : fields) file += number(tag, 2) + number(4, 2) + number(1, 4) + number(value, 4);
    return file + number(0, 4);
}

TEST_CASE("a damaged fax picture is refused, where libtiff makes up rows and reports success") {
    const std::string pixels(
        "\x26\xb9\x7c\xb8\x6e\x47\xcb\xe4\x70\xdc\xbe\x5f\x26\xa8\xbe\x5d\x13\x5c\xbe\x5c\x37\x23"
        "\xe5\xf2\x38\x6e\x5f\x2f\x93\x54\x5f\x2e\x80\x04\x00\x40",
        36);
    const auto card = read_bitmap(fax(pixels));
    REQUIRE(card);
    for (std::size_t pick = 0; pick < 8; ++pick) {
        for (std::size_t end = 0; end < 8; ++end) CHECK(card->card.weft_over(pick, end) == ((pick + end + 3) % 4 < 2));
    }
    CHECK_THAT(read_bitmap(fax(pixels.substr(0, 18))).error().message, Catch::Contains("is not a readable TIFF"));
    std::size_t refused = 0;
    for (std::size_t at = 0; at < 30; ++at) {
        std::string damaged = pixels;
        damaged[at] = static_cast<char>(damaged[at] ^ 0xff);
        refused += read_bitmap(fax(damaged)) ? 0 : 1;
    }
    CHECK(refused > 20);
}

TEST_CASE("a picture whose size is of no use is refused before its pixels are read") {
    const CardImage card(30, 20);
    for (const BitmapFormat format : formats) {
        const std::string whole = *write_bitmap(card, format);
        std::size_t asked = 0;
        const auto fits = [&](std::size_t rows, std::size_t columns) -> Status {
            ++asked;
            CHECK((rows == 30 && columns == 20));
            return bad_input("of no use");
        };
        CHECK(read_colour_image(whole, fits).error().message == "of no use");
        CHECK(asked == 1);
        CHECK(read_colour_image(whole, [](std::size_t, std::size_t) { return Status(); })->pixels.size() == 600);
    }
}

TEST_CASE("a few bytes that claim a picture of endless rows cost no memory") {
    // A PNG of two rows of 2^25 pixels in colours, as far as the start of its pixels.
    const std::string claim(
        "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\x02\0\0\0\0\0\0\x02\x08\x02\0\0\0\x99\x7d\xff\x05"
        "\0\0\0\x07IDAT\x78\x9c\x63\x60\x60\x60\xf8",
        48);
    CHECK_THAT(read_bitmap(claim).error().message, Catch::Contains("longer on a side than the limit"));
    CHECK_THAT(read_colour_image(claim).error().message, Catch::Contains("longer on a side than the limit"));
    // The same with a text that claims 1.3 GB, of which ten bytes are there.
    const std::string text =
        claim.substr(0, 33) + std::string("\x4f\x4f\x4f\x4fiTXt\x74\0NDAEB\x82\xff\xff\xff\0", 19);
    CHECK_FALSE(read_bitmap(text));
    for (const BitmapFormat format : formats) {
        const CardImage wide(1, (std::size_t{1} << 22) + 1), widest(1, std::size_t{1} << 22);
        CHECK_FALSE(write_bitmap(wide, format));
        const Result<std::string> written = write_bitmap(widest, format);
        REQUIRE(written);
        CHECK(read_bitmap(*written).value().card == widest);  // what is written can be read
    }
}

TEST_CASE("the format is chosen by the name's ending") {
    CHECK(*bitmap_format_of("a.PNG") == BitmapFormat::png);
    CHECK(*bitmap_format_of("a.tif") == BitmapFormat::tiff);
    CHECK(*bitmap_format_of("a.tiff") == BitmapFormat::tiff);
    CHECK(*bitmap_format_of("b.c.bmp") == BitmapFormat::bmp);
    CHECK(bitmap_format_of("a.jpg").error().code == ErrorCode::usage);
}
