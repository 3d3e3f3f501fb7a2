#include <weave/io/raster.hpp>

#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

namespace weave {

namespace {

/// A file in memory, as libtiff sees it, and its last complaint.
struct TiffTalk {
    std::string_view in;
    std::string out;
    bool writing = false;
    std::size_t at = 0;
    std::string error = "the file is damaged";
    bool decoding = false;  ///< pixels are being read
    bool guessed = false;   ///< libtiff went on after what it could not decode: the pixels are its invention

    [[nodiscard]] std::size_t size() const { return writing ? out.size() : in.size(); }
};

TiffTalk& talk_of(thandle_t handle) {
    return *static_cast<TiffTalk*>(handle);
}

tmsize_t on_read(thandle_t handle, void* to, tmsize_t count) {
    TiffTalk& talk = talk_of(handle);
    if (talk.at >= talk.size() || count <= 0) return 0;
    const std::size_t take = std::min(static_cast<std::size_t>(count), talk.size() - talk.at);
    std::memcpy(to, (talk.writing ? talk.out.data() : talk.in.data()) + talk.at, take);
    talk.at += take;
    return static_cast<tmsize_t>(take);
}

tmsize_t on_write(thandle_t handle, void* from, tmsize_t count) {
    TiffTalk& talk = talk_of(handle);
    if (!talk.writing || count <= 0) return 0;
    const auto bytes = static_cast<std::size_t>(count);
    if (talk.at + bytes > talk.out.size()) talk.out.resize(talk.at + bytes);
    std::memcpy(talk.out.data() + talk.at, from, bytes);
    talk.at += bytes;
    return count;
}

toff_t on_seek(thandle_t handle, toff_t offset, int whence) {
    TiffTalk& talk = talk_of(handle);
    const toff_t base = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? talk.at : talk.size();
    talk.at = base + offset;
    return talk.at;
}

int on_close(thandle_t) {
    return 0;
}
toff_t on_size(thandle_t handle) {
    return talk_of(handle).size();
}
/// The bytes are in memory, so libtiff reads them there. Without this, 4.5.0 refuses sound files with tiles
/// of one bit that are not compressed. It asks for memory to write to, but never writes to what it reads.
int on_map(thandle_t handle, void** memory, toff_t* size) {
    const TiffTalk& talk = talk_of(handle);
    if (talk.writing) return 0;
    *memory = const_cast<char*>(talk.in.data());
    *size = talk.in.size();
    return 1;
}
void on_unmap(thandle_t, void*, toff_t) {}

int on_error(TIFF*, void* user, const char*, const char* format, va_list words) {
    TiffTalk& talk = *static_cast<TiffTalk*>(user);
    char line[200];
    std::vsnprintf(line, sizeof line, format, words);
    talk.error = line;
    talk.guessed = talk.guessed || talk.decoding;
    return 1;  // handled: libtiff prints nothing
}

/// Of fax pictures libtiff only warns where a row does not come out, makes one up, and reports success.
int on_warning(TIFF* tiff, void* user, const char* module, const char* format, va_list words) {
    if (static_cast<TiffTalk*>(user)->decoding) on_error(tiff, user, module, format, words);
    return 1;
}

struct CloseTiff {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffPtr = std::unique_ptr<TIFF, CloseTiff>;

TiffPtr open(TiffTalk& talk, const char* mode) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, &talk);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, &talk);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, tmsize_t{1} << 28);
    TIFF* tiff = TIFFClientOpenExt("picture", mode, &talk, on_read, on_write, on_seek, on_close, on_size,
                                   on_map, on_unmap, options);
    TIFFOpenOptionsFree(options);
    return TiffPtr(tiff);
}

Error damaged(const TiffTalk& talk) {
    return bad_input("is not a readable TIFF: " + talk.error);
}

/// One bit a pixel in plain strips: row by row, however large. The mills' looms write this kind.
Status read_bilevel(TIFF* tiff, TiffTalk& talk, std::size_t width, std::size_t height, bool one_is_black,
                    bool from_bottom, RasterSink& sink) {
    const tmsize_t line = TIFFScanlineSize(tiff);
    if (line < static_cast<tmsize_t>((width + 7) / 8) || line > tmsize_t{1} << 28)
        return bad_input("has rows of an impossible length");
    std::vector<std::uint8_t> packed(static_cast<std::size_t>(line));
    std::vector<Colour> pixels(width);
    for (std::size_t y = 0; y < height; ++y) {
        if (TIFFReadScanline(tiff, packed.data(), static_cast<std::uint32_t>(y), 0) != 1 || talk.guessed)
            return damaged(talk);
        for (std::size_t x = 0; x < width; ++x) {
            const bool one = (packed[x / 8] >> (7 - x % 8) & 1) != 0;
            pixels[x] = one == one_is_black ? Colour{0, 0, 0} : Colour{255, 255, 255};
        }
        WEAVE_CHECK_OK(sink.row(from_bottom ? height - 1 - y : y, pixels));
    }
    return {};
}

/// Any other kind, by libtiff's own conversion to colours.
Status read_any(TIFF* tiff, TiffTalk& talk, std::size_t width, std::size_t height, RasterSink& sink) {
    if (width * height > most_pixels_at_once)
        return bad_input(
            "is a TIFF of a kind that is too large to hold; save it with one bit a pixel, in strips");
    std::vector<std::uint32_t> raster(width * height);
    if (TIFFReadRGBAImageOriented(tiff, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                                  raster.data(), ORIENTATION_TOPLEFT, 1) != 1 ||
        talk.guessed) {
        return damaged(talk);
    }
    std::vector<Colour> pixels(width);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) {
            const std::uint32_t pixel = raster[y * width + x];
            if (TIFFGetA(pixel) != 0xff) {
                return bad_input("the pixel in column " + std::to_string(x + 1) + " from the left and row " +
                                 std::to_string(y + 1) + " from the top is transparent");
            }
            pixels[x] = {static_cast<std::uint8_t>(TIFFGetR(pixel)),
                         static_cast<std::uint8_t>(TIFFGetG(pixel)),
                         static_cast<std::uint8_t>(TIFFGetB(pixel))};
        }
        WEAVE_CHECK_OK(sink.row(y, pixels));
    }
    return {};
}

template <class Value>
Value field(TIFF* tiff, std::uint32_t tag) {
    Value value{};
    TIFFGetFieldDefaulted(tiff, tag, &value);
    return value;
}

}  // namespace

Status decode_tiff(std::string_view bytes, RasterSink& sink) {
    TiffTalk talk;
    talk.in = bytes;
    const TiffPtr tiff = open(talk, "r");
    if (!tiff) return damaged(talk);
    const std::size_t width = field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGEWIDTH);
    const std::size_t height = field<std::uint32_t>(tiff.get(), TIFFTAG_IMAGELENGTH);
    const auto orientation = field<std::uint16_t>(tiff.get(), TIFFTAG_ORIENTATION);
    if (orientation > ORIENTATION_LEFTBOT || orientation >= ORIENTATION_LEFTTOP)
        return bad_input("is a TIFF that is stored on its side; turn it first");
    const char* description = field<const char*>(tiff.get(), TIFFTAG_IMAGEDESCRIPTION);
    if (description != nullptr && std::strncmp(description, "weave ", 6) == 0)
        sink.reading = std::string(description).substr(0, 200);
    if (TIFFLastDirectory(tiff.get()) == 0)
        sink.warnings.push_back("the file holds several pictures; the first one is read");
    WEAVE_CHECK_OK(sink.start(width, height));
    std::uint16_t photometric = PHOTOMETRIC_MINISWHITE;
    const bool says = TIFFGetField(tiff.get(), TIFFTAG_PHOTOMETRIC, &photometric) == 1;
    const bool plain = field<std::uint16_t>(tiff.get(), TIFFTAG_BITSPERSAMPLE) == 1 &&
                       field<std::uint16_t>(tiff.get(), TIFFTAG_SAMPLESPERPIXEL) == 1 &&
                       TIFFIsTiled(tiff.get()) == 0 &&
                       (photometric == PHOTOMETRIC_MINISWHITE || photometric == PHOTOMETRIC_MINISBLACK) &&
                       (orientation == ORIENTATION_TOPLEFT || orientation == ORIENTATION_BOTLEFT);
    if (!says) sink.warnings.push_back("the file does not say whether 0 is white; taken so");
    talk.decoding = true;
    if (!plain) return read_any(tiff.get(), talk, width, height, sink);
    return read_bilevel(tiff.get(), talk, width, height, photometric == PHOTOMETRIC_MINISWHITE,
                        orientation == ORIENTATION_BOTLEFT, sink);
}

Result<std::string> encode_tiff(const BilevelRaster& raster) {
    if ((raster.width + 7) / 8 * raster.height > (std::size_t{1} << 31))
        return bad_input("is too large for a TIFF");
    TiffTalk talk;
    talk.writing = true;
    TiffPtr tiff = open(talk, "wl");
    if (!tiff) return system_fault("libtiff: " + talk.error);
    TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(raster.width));
    TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(raster.height));
    TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 1);
    TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISWHITE);
    TIFFSetField(tiff.get(), TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, static_cast<std::uint32_t>(raster.height));
    TIFFSetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, raster.reading.c_str());
    std::vector<std::uint8_t> row((raster.width + 7) / 8);
    const std::size_t padding = row.size() * 8 - raster.width;
    for (std::size_t y = 0; y < raster.height; ++y) {
        raster.row(y, row);
        for (std::uint8_t& byte : row) byte = static_cast<std::uint8_t>(~byte);  // here 1 is black
        row.back() &= static_cast<std::uint8_t>(0xff << padding);
        if (TIFFWriteScanline(tiff.get(), row.data(), static_cast<std::uint32_t>(y), 0) != 1)
            return system_fault("libtiff: " + talk.error);
    }
    if (TIFFFlush(tiff.get()) != 1) return system_fault("libtiff: " + talk.error);
    tiff.reset();
    return std::move(talk.out);
}

}  // namespace weave
