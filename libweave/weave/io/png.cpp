#include <weave/io/bitmap.hpp>
#include <weave/io/raster.hpp>

#include <png.h>

#include <csetjmp>
#include <cstdlib>
#include <cstring>

namespace weave {

namespace {

constexpr const char* reading_key = "Description";

/// What libpng's callbacks share. libpng reports an error by jumping out of the call; `guarded` catches the
/// jump around calls in whose frames nothing needs destroying.
struct PngTalk {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string_view in;
    std::string out;
    char error[200] = "is a damaged PNG";
};

void on_error(png_structp png, png_const_charp message) {
    auto* talk = static_cast<PngTalk*>(png_get_error_ptr(png));
    std::strncpy(talk->error, message, sizeof talk->error - 1);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, png_size_t count) {
    auto* talk = static_cast<PngTalk*>(png_get_io_ptr(png));
    if (count > talk->in.size()) png_error(png, "the file ends too early");
    std::memcpy(to, talk->in.data(), count);
    talk->in.remove_prefix(count);
}

void on_write(png_structp png, png_bytep from, png_size_t count) {
    static_cast<PngTalk*>(png_get_io_ptr(png))->out.append(reinterpret_cast<const char*>(from), count);
}

template <class Call>
bool guarded(PngTalk& talk, Call call) {
    if (setjmp(png_jmpbuf(talk.png)) != 0) return false;
    call();
    return true;
}

Error damaged(const PngTalk& talk) {
    return bad_input("is not a readable PNG: " + std::string(talk.error));
}

/// libpng allocates what a text or profile claims to be, up to 2 GiB, before it looks for the bytes; no row
/// needs this much.
png_voidp bounded_malloc(png_structp, png_alloc_size_t bytes) {
    constexpr png_alloc_size_t most = png_alloc_size_t{1} << 27;
    return bytes > most ? nullptr : std::malloc(bytes);
}
void bounded_free(png_structp, png_voidp memory) {
    std::free(memory);
}

/// Owns a reading libpng.
class Decoder {
  public:
    explicit Decoder(std::string_view bytes) {
        talk.in = bytes;
        talk.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &talk, on_error, on_warning, nullptr,
                                            bounded_malloc, bounded_free);
        if (talk.png != nullptr) talk.info = png_create_info_struct(talk.png);
    }
    ~Decoder() { png_destroy_read_struct(&talk.png, &talk.info, nullptr); }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;
    PngTalk talk;
};

/// Owns a writing libpng.
class Encoder {
  public:
    Encoder() {
        talk.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &talk, on_error, on_warning);
        if (talk.png != nullptr) talk.info = png_create_info_struct(talk.png);
    }
    ~Encoder() { png_destroy_write_struct(&talk.png, &talk.info); }
    Encoder(const Encoder&) = delete;
    Encoder& operator=(const Encoder&) = delete;
    PngTalk talk;
};

/// Reads the header and asks for eight bits each of red, green, blue and opacity, whatever is in the file.
bool read_header(PngTalk& talk) {
    return guarded(talk, [&talk] {
        png_set_read_fn(talk.png, &talk, on_read);
        png_set_user_limits(talk.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_read_info(talk.png, talk.info);
    });
}

bool ask_for_rgba(PngTalk& talk) {
    return guarded(talk, [&talk] {
        png_set_expand(talk.png);
        png_set_scale_16(talk.png);
        png_set_gray_to_rgb(talk.png);
        png_set_add_alpha(talk.png, 0xff, PNG_FILLER_AFTER);
        png_set_interlace_handling(talk.png);
        png_read_update_info(talk.png, talk.info);
    });
}

void note_reading(PngTalk& talk, RasterSink& sink) {
    png_textp texts = nullptr;
    const int count = png_get_text(talk.png, talk.info, &texts, nullptr);
    for (int k = 0; k < count; ++k) {
        if (std::strcmp(texts[k].key, reading_key) == 0 && std::strncmp(texts[k].text, "weave ", 6) == 0) {
            sink.reading = std::string(texts[k].text).substr(0, 200);
        }
    }
}

Status hand_over(const std::vector<png_byte>& rgba, std::size_t row, std::vector<Colour>& pixels,
                 RasterSink& sink) {
    for (std::size_t x = 0; x < pixels.size(); ++x) {
        const png_byte* pixel = rgba.data() + 4 * x;
        if (pixel[3] != 0xff) {
            return bad_input("the pixel in column " + std::to_string(x + 1) + " from the left and row " +
                             std::to_string(row + 1) + " from the top is transparent");
        }
        pixels[x] = {pixel[0], pixel[1], pixel[2]};
    }
    return sink.row(row, pixels);
}

Status read_interlaced(PngTalk& talk, std::size_t width, std::size_t height, RasterSink& sink) {
    if (width * height > most_pixels_at_once)
        return bad_input("is an interlaced picture that is too large to hold; save it without interlacing");
    std::vector<std::vector<png_byte>> rows(height, std::vector<png_byte>(width * 4));
    std::vector<png_bytep> pointers;
    for (auto& row : rows) pointers.push_back(row.data());
    png_bytepp all = pointers.data();
    if (!guarded(talk, [&talk, all] { png_read_image(talk.png, all); })) return damaged(talk);
    std::vector<Colour> pixels(width);
    for (std::size_t y = 0; y < height; ++y) WEAVE_CHECK_OK(hand_over(rows[y], y, pixels, sink));
    return {};
}

Status read_rows(PngTalk& talk, std::size_t width, std::size_t height, RasterSink& sink) {
    std::vector<png_byte> rgba(width * 4);
    std::vector<Colour> pixels(width);
    png_bytep to = rgba.data();
    for (std::size_t y = 0; y < height; ++y) {
        if (!guarded(talk, [&talk, to] { png_read_row(talk.png, to, nullptr); })) return damaged(talk);
        WEAVE_CHECK_OK(hand_over(rgba, y, pixels, sink));
    }
    return {};
}

/// Writes a whole PNG: `fill` gives the bytes of each row from the top.
template <class Fill>
Result<std::string> encode(std::size_t width, std::size_t height, int depth, int colour_type,
                           const std::string& reading, Fill fill) {
    if (width > PNG_UINT_31_MAX || height > PNG_UINT_31_MAX) return bad_input("is too large for a PNG");
    Encoder encoder;
    PngTalk& talk = encoder.talk;
    if (talk.info == nullptr) return system_fault("libpng does not start");
    std::string key = reading_key, value = reading;
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key.data(), text.text = value.data(), text.text_length = value.size();
    const auto begin = [&talk, &text, width, height, depth, colour_type] {
        png_set_write_fn(talk.png, &talk, on_write, nullptr);
        png_set_user_limits(talk.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
        png_set_IHDR(talk.png, talk.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
                     depth, colour_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                     PNG_FILTER_TYPE_DEFAULT);
        if (text.text_length > 0) png_set_text(talk.png, talk.info, &text, 1);
        png_write_info(talk.png, talk.info);
    };
    if (!guarded(talk, begin)) return system_fault("libpng: " + std::string(talk.error));
    std::vector<std::uint8_t> row(colour_type == PNG_COLOR_TYPE_RGB ? width * 3 : (width + 7) / 8);
    png_bytep from = row.data();
    for (std::size_t y = 0; y < height; ++y) {
        fill(y, std::span(row));
        if (!guarded(talk, [&talk, from] { png_write_row(talk.png, from); }))
            return system_fault("libpng: " + std::string(talk.error));
    }
    if (!guarded(talk, [&talk] { png_write_end(talk.png, nullptr); }))
        return system_fault("libpng: " + std::string(talk.error));
    return std::move(talk.out);
}

}  // namespace

Status decode_png(std::string_view bytes, RasterSink& sink) {
    Decoder decoder(bytes);
    PngTalk& talk = decoder.talk;
    if (talk.info == nullptr) return system_fault("libpng does not start");
    if (!read_header(talk)) return damaged(talk);
    const std::size_t width = png_get_image_width(talk.png, talk.info),
                      height = png_get_image_height(talk.png, talk.info);
    WEAVE_CHECK_OK(sink.start(width, height));
    const bool interlaced = png_get_interlace_type(talk.png, talk.info) != PNG_INTERLACE_NONE;
    note_reading(talk, sink);
    if (!ask_for_rgba(talk)) return damaged(talk);
    if (png_get_rowbytes(talk.png, talk.info) != width * 4) return bad_input("is a PNG of an unknown kind");
    return interlaced ? read_interlaced(talk, width, height, sink) : read_rows(talk, width, height, sink);
}

Result<std::string> encode_png(const BilevelRaster& raster) {
    return encode(raster.width, raster.height, 1, PNG_COLOR_TYPE_GRAY, raster.reading, raster.row);
}

Result<std::string> write_png(const ColourImage& image) {
    return encode(image.columns, image.rows, 8, PNG_COLOR_TYPE_RGB, "",
                  [&](std::size_t y, std::span<std::uint8_t> row) {
                      const Colour* pixels = image.pixels.data() + (image.rows - 1 - y) * image.columns;
                      for (std::size_t x = 0; x < image.columns; ++x) {
                          row[3 * x] = pixels[x].red, row[3 * x + 1] = pixels[x].green,
                                  row[3 * x + 2] = pixels[x].blue;
                      }
                  });
}

}  // namespace weave
