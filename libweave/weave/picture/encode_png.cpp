#include <weave/picture/encode_png.hpp>

#include <png.h>

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace weave {

namespace {

/// Up to 256 colours with quick look-up. Pictures have long runs of one colour, so the last answer is kept.
class Palette {
  public:
    /// The number of a colour; none when there would be more than 256.
    std::optional<std::uint8_t> number_of(std::uint32_t colour) {
        if (colour == m_last_colour) return m_last_number;
        std::size_t place = (colour * 2654435761U) >> 22;
        while (m_table[place].used && m_table[place].colour != colour) place = (place + 1) % m_table.size();
        if (!m_table[place].used) {
            if (m_colours.size() == 256) return std::nullopt;
            m_table[place] = {true, static_cast<std::uint8_t>(m_colours.size()), colour};
            m_colours.push_back(colour);
        }
        m_last_colour = colour;
        m_last_number = m_table[place].number;
        return m_last_number;
    }
    [[nodiscard]] const std::vector<std::uint32_t>& colours() const { return m_colours; }

  private:
    struct Entry {
        bool used = false;
        std::uint8_t number = 0;
        std::uint32_t colour = 0;
    };
    std::array<Entry, 1024> m_table{};
    std::vector<std::uint32_t> m_colours;
    std::uint32_t m_last_colour = std::numeric_limits<std::uint32_t>::max();
    std::uint8_t m_last_number = 0;
};

void append_rgb(std::vector<std::uint8_t>& bytes, std::uint32_t colour) {
    bytes.push_back(static_cast<std::uint8_t>(colour >> 16));
    bytes.push_back(static_cast<std::uint8_t>(colour >> 8));
    bytes.push_back(static_cast<std::uint8_t>(colour));
}

Result<std::string> write(png_image& image, const std::vector<std::uint8_t>& bytes,
                          const std::vector<std::uint8_t>& colour_map) {
    // Stored deflate blocks and chunk heads cost well under one byte in a hundred.
    png_alloc_size_t size = bytes.size() + bytes.size() / 100 + image.height + 16384;
    std::string file(size, '\0');
    const void* map = colour_map.empty() ? nullptr : colour_map.data();
    if (png_image_write_to_memory(&image, file.data(), &size, 0, bytes.data(), 0, map) == 0) {
        return system_fault(std::string("cannot write the picture as PNG: ") + image.message);
    }
    file.resize(size);
    return file;
}

}  // namespace

Result<std::string> encode_png(const std::uint32_t* pixels, std::size_t width, std::size_t height,
                               std::size_t row_stride) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.flags = PNG_IMAGE_FLAG_FAST;
    Palette palette;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(width * height);
    bool fits = true;
    for (std::size_t y = 0; y < height && fits; ++y) {
        const std::uint32_t* row = pixels + y * row_stride;
        for (std::size_t x = 0; x < width && fits; ++x) {
            const auto number = palette.number_of(row[x] & 0xffffff);
            fits = number.has_value();
            bytes.push_back(number.value_or(0));
        }
    }
    std::vector<std::uint8_t> colour_map;
    if (fits) {
        image.format = PNG_FORMAT_RGB_COLORMAP;
        image.colormap_entries = static_cast<png_uint_32>(palette.colours().size());
        for (const std::uint32_t colour : palette.colours()) append_rgb(colour_map, colour);
        return write(image, bytes, colour_map);
    }
    image.format = PNG_FORMAT_RGB;
    bytes.clear();
    bytes.reserve(width * height * 3);
    for (std::size_t y = 0; y < height; ++y) {
        for (std::size_t x = 0; x < width; ++x) append_rgb(bytes, pixels[y * row_stride + x]);
    }
    return write(image, bytes, colour_map);
}

}  // namespace weave
