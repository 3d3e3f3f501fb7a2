#include <weave/io/raster.hpp>

namespace weave {

namespace {

// Offsets and sizes of the Windows bitmap file (BITMAPFILEHEADER and BITMAPINFOHEADER).
constexpr std::size_t file_header = 14, info_header = 40, old_info_header = 12;

std::uint32_t little(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < count; ++k) {
        value |= std::uint32_t{static_cast<unsigned char>(bytes[at + k])} << 8 * k;
    }
    return value;
}

void put_little(std::string& out, std::uint32_t value, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) out.push_back(static_cast<char>(value >> 8 * k & 0xff));
}

std::size_t padded_row(std::size_t width, std::size_t bits) {
    return (width * bits + 31) / 32 * 4;
}

/// What the headers say.
struct BmpFacts {
    std::size_t width = 0, height = 0, bits = 0, pixels_at = 0;
    bool from_top = false;
    std::vector<Colour> palette;
};

Status read_size(std::string_view bytes, std::size_t header, BmpFacts& facts) {
    const bool old = header == old_info_header;
    const auto width = static_cast<std::int32_t>(old ? little(bytes, 18, 2) : little(bytes, 18, 4));
    const auto height = static_cast<std::int32_t>(old ? little(bytes, 20, 2) : little(bytes, 22, 4));
    if (width <= 0 || height == 0 || height == INT32_MIN)
        return bad_input("has a BMP header with an impossible size");
    facts.width = static_cast<std::size_t>(width);
    facts.from_top = height < 0;
    facts.height = static_cast<std::size_t>(facts.from_top ? -height : height);
    facts.bits = little(bytes, old ? 24 : 28, 2);
    const std::uint32_t compression = old ? 0 : little(bytes, 30, 4);
    if (compression != 0) return bad_input("is a compressed BMP; save it uncompressed");
    for (const std::size_t known : {1, 4, 8, 24, 32}) {
        if (facts.bits == known) return {};
    }
    return bad_input("is a BMP of " + std::to_string(facts.bits) + " bits a pixel, which is not read");
}

Status read_palette(std::string_view bytes, std::size_t header, BmpFacts& facts) {
    if (facts.bits > 8) return {};
    const std::size_t entry = header == old_info_header ? 3 : 4;
    std::size_t colours = std::size_t{1} << facts.bits;
    if (header >= info_header) {
        const std::size_t used = little(bytes, 46, 4);
        if (used > 0 && used < colours) colours = used;
    }
    const std::size_t at = file_header + header;
    if (at + colours * entry > bytes.size()) return bad_input("is a BMP that ends within its palette");
    for (std::size_t k = 0; k < colours; ++k) {
        const auto part = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[at + k * entry + i]); };
        facts.palette.push_back({part(2), part(1), part(0)});
    }
    return {};
}

Result<BmpFacts> read_headers(std::string_view bytes) {
    if (bytes.size() < file_header + old_info_header)
        return bad_input("is a BMP that ends within its header");
    const std::size_t header = little(bytes, 14, 4);
    if ((header != old_info_header && (header < info_header || header > 256)) ||
        file_header + header > bytes.size()) {
        return bad_input("has a BMP header of an unknown kind");
    }
    BmpFacts facts;
    facts.pixels_at = little(bytes, 10, 4);
    WEAVE_CHECK_OK(read_size(bytes, header, facts));
    WEAVE_CHECK_OK(read_palette(bytes, header, facts));
    const std::size_t row = padded_row(facts.width, facts.bits);
    if (facts.pixels_at > bytes.size() || facts.height > (bytes.size() - facts.pixels_at) / row) {
        return bad_input("is a BMP that ends before its last row");
    }
    return facts;
}

/// The colour of pixel x of a row; an index beyond the palette is an error.
Result<Colour> colour_at(const BmpFacts& facts, std::string_view row, std::size_t x) {
    const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(row[at]); };
    if (facts.bits >= 24) {
        const std::size_t at = x * facts.bits / 8;
        return Colour{byte(at + 2), byte(at + 1), byte(at)};
    }
    const std::size_t bit = x * facts.bits;
    const std::size_t index = byte(bit / 8) >> (8 - facts.bits - bit % 8) & ((1U << facts.bits) - 1);
    if (index >= facts.palette.size()) return bad_input("has a pixel whose colour is not in the palette");
    return facts.palette[index];
}

}  // namespace

Status decode_bmp(std::string_view bytes, RasterSink& sink) {
    WEAVE_TRY(const BmpFacts facts, read_headers(bytes));
    WEAVE_CHECK_OK(sink.start(facts.width, facts.height));
    const std::size_t stride = padded_row(facts.width, facts.bits);
    std::vector<Colour> pixels(facts.width);
    for (std::size_t y = 0; y < facts.height; ++y) {
        const std::size_t stored = facts.from_top ? y : facts.height - 1 - y;
        const std::string_view row = bytes.substr(facts.pixels_at + stored * stride, stride);
        for (std::size_t x = 0; x < facts.width; ++x) {
            WEAVE_TRY(pixels[x], colour_at(facts, row, x));
        }
        WEAVE_CHECK_OK(sink.row(y, pixels));
    }
    return {};
}

Result<std::string> encode_bmp(const BilevelRaster& raster) {
    const std::size_t stride = padded_row(raster.width, 1), pixels = stride * raster.height;
    constexpr std::size_t pixels_at = file_header + info_header + 8;
    if (pixels > UINT32_MAX - pixels_at || raster.width > INT32_MAX || raster.height > INT32_MAX)
        return bad_input("is too large for a BMP");
    std::string out = "BM";
    out.reserve(pixels_at + pixels);
    put_little(out, static_cast<std::uint32_t>(pixels_at + pixels), 4);
    put_little(out, 0, 4);
    put_little(out, pixels_at, 4);
    put_little(out, info_header, 4);
    put_little(out, static_cast<std::uint32_t>(raster.width), 4);
    put_little(out, static_cast<std::uint32_t>(raster.height), 4);  // positive: bottom row first
    put_little(out, 1, 2);
    put_little(out, 1, 2);
    put_little(out, 0, 4);
    put_little(out, static_cast<std::uint32_t>(pixels), 4);
    put_little(out, 2835, 4);  // 72 dots an inch
    put_little(out, 2835, 4);
    put_little(out, 2, 4);
    put_little(out, 2, 4);
    put_little(out, 0x00000000, 4);  // black
    put_little(out, 0x00ffffff, 4);  // white
    std::vector<std::uint8_t> row((raster.width + 7) / 8);
    for (std::size_t k = 0; k < raster.height; ++k) {
        raster.row(raster.height - 1 - k, row);
        out.append(reinterpret_cast<const char*>(row.data()), row.size());
        out.append(stride - row.size(), '\0');
    }
    return out;
}

}  // namespace weave
