#pragma once

#include <weave/picture/canvas.hpp>
#include <weave/picture/picture.hpp>
#include <weave/picture/views.hpp>
#include <weave/samples/samples.hpp>

#include <catch2/catch.hpp>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace weave::testing {

/// A PNG as libpng reads it.
struct Pixels {
    std::size_t width = 0, height = 0;
    std::vector<std::uint8_t> rgb;
    [[nodiscard]] Colour at(Point point) const {
        const auto x = static_cast<std::size_t>(point.x), y = static_cast<std::size_t>(point.y);
        REQUIRE((x < width && y < height));
        const std::uint8_t* pixel = &rgb[(y * width + x) * 3];
        return {pixel[0], pixel[1], pixel[2]};
    }
};

inline Pixels read_pixels(const std::string& file) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&image, file.data(), file.size()) != 0);
    image.format = PNG_FORMAT_RGB;
    Pixels pixels{image.width, image.height,
                  std::vector<std::uint8_t>(std::size_t{3} * image.width * image.height)};
    REQUIRE(png_image_finish_read(&image, nullptr, pixels.rgb.data(), 0, nullptr) != 0);
    return pixels;
}

/// Whether every tag is closed in turn, every attribute quoted, and one element holds all.
inline bool is_well_formed(const std::string& xml) {
    std::vector<std::string> open;
    std::size_t roots = 0;
    for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at)) {
        const std::size_t end = xml.find('>', at);
        if (end == std::string::npos) return false;
        const std::string tag = xml.substr(at + 1, end - at - 1);
        at = end;
        if (tag.empty() || std::count(tag.begin(), tag.end(), '"') % 2 != 0) return false;
        if (tag.front() == '?' || tag.front() == '!') continue;
        const std::size_t name_at = tag.front() == '/' ? 1 : 0;
        const std::string name = tag.substr(name_at, tag.find_first_of(" \n/", name_at) - name_at);
        if (name_at == 1) {
            if (open.empty() || open.back() != name) return false;
            open.pop_back();
        } else if (tag.back() != '/') {
            if (open.empty()) ++roots;
            open.push_back(name);
        }
    }
    return open.empty() && roots == 1;
}

/// The sample of this name; it must be there.
inline Design sample_design(const std::string& name) {
    const Sample* sample = find_sample(name);
    REQUIRE(sample != nullptr);
    return sample->make();
}

inline Evaluation cloth_of(Block block) {
    return {std::make_shared<const Block>(std::move(block)), {}};
}

/// Design and cloth of a few yarns each with its own colour, so that a pixel tells which yarn it shows.
inline Design coloured_design() {
    Design design;
    design.title = "Test <cloth> & more";
    design.warp.yarns = {design.warp.yarns[0], design.warp.yarns[0]};
    design.warp.yarns[0].colour = {0x20, 0x40, 0x80};
    design.warp.yarns[1].colour = {0x70, 0x10, 0x30};
    design.warp.order.once = {0, 1};
    design.weft.yarns[0].colour = {0xe0, 0xd0, 0xb0};
    return design;
}

inline Block block_of(std::vector<std::uint32_t> t, std::vector<std::uint32_t> p,
                      const std::vector<std::string>& stacks) {
    const std::size_t columns = p.size();
    return make_block(
               std::move(t), std::move(p),
               [&](std::size_t i, std::size_t j) { return parse_stack(stacks[i * columns + j]).value(); })
        .value();
}

/// The words, arrows and lines of a picture, in the order in which they are drawn.
inline std::vector<Mark> marks_of(const Design& design, const Block& block, const PictureRequest& request) {
    std::vector<Mark> marks;
    const auto file = draw_view({design, block, request, PictureFormat::svg, &marks});
    if (!file) FAIL(file.error().text());
    return marks;
}

/// Every place where a picture says just this.
inline std::vector<Point> places_of(const std::vector<Mark>& marks, const std::string& text) {
    std::vector<Point> places;
    for (const Mark& mark : marks) {
        if (mark.kind == Mark::Kind::text && mark.text == text) places.push_back(mark.points[0]);
    }
    return places;
}

inline bool says(const std::vector<Mark>& marks, const std::string& piece) {
    return std::ranges::any_of(marks, [&](const Mark& mark) {
        return mark.kind == Mark::Kind::text && mark.text.find(piece) != std::string::npos;
    });
}

/// Two layers, a stack with a loose weft on top, unequal counts.
inline Block layered() {
    return block_of({3, 2}, {2, 1, 2},
                    {"T0 P0 T1 P1 T2~", "P0 T0 - T1 T2~", "P0 T0 T1 P1 T2~",  //
                     "P0 T0 P1 T1", "T1 P0 T0", "T0 P1 T1 P0"});
}

}  // namespace weave::testing
