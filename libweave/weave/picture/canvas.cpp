#include <weave/picture/canvas.hpp>

#include <weave/core/text.hpp>
#include <weave/picture/encode_png.hpp>

#include <cairo-svg.h>
#include <cairo.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace weave {

struct Canvas::State {
    PictureFormat format = PictureFormat::png;
    int scale = 1;  ///< of a PNG
    cairo_surface_t* surface = nullptr;
    cairo_t* cairo = nullptr;
    std::string svg;  ///< written by cairo while it draws
    std::vector<Mark>* marks = nullptr;
    Status trouble;  ///< the first failure that cairo itself does not know of
};

void Canvas::Close::operator()(State* state) const {
    if (state->cairo != nullptr) cairo_destroy(state->cairo);
    if (state->surface != nullptr) cairo_surface_destroy(state->surface);
    delete state;
}

namespace {

constexpr const char* font_family = "DejaVu Sans";

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int size) {
    static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), size);
    return CAIRO_STATUS_SUCCESS;
}

void set_colour(cairo_t* cairo, Colour colour, double alpha = 1) {
    cairo_set_source_rgba(cairo, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0, alpha);
}

void stroke_path(cairo_t* cairo, const Stroke& stroke) {
    set_colour(cairo, stroke.colour, stroke.alpha);
    cairo_set_line_width(cairo, stroke.width);
    cairo_set_line_cap(cairo, stroke.round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
    cairo_set_dash(cairo, stroke.dash.data(), static_cast<int>(stroke.dash.size()), 0);
    cairo_stroke(cairo);
}

void choose_font(cairo_t* cairo, double size, bool bold) {
    cairo_select_font_face(cairo, font_family, CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo, size);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
    cairo_set_font_options(cairo, options);
    cairo_font_options_destroy(options);
}

std::size_t digits_at(std::string_view text, std::size_t at) {
    std::size_t end = at;
    while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
    return end - at;
}

/// cairo counts `surface` and `image` names through the whole process; here they count from 1 in every file,
/// so that equal pictures are equal files. A name always follows a quote or '#', which picture data never
/// contain.
std::string with_own_numbers(const std::string& svg) {
    std::map<std::string, std::string, std::less<>> names;
    std::string out;
    out.reserve(svg.size());
    for (std::size_t at = 0; at < svg.size();) {
        const char mark = svg[at];
        out.push_back(svg[at++]);
        if (mark != '"' && mark != '#') continue;
        for (const std::string_view stem : {"surface", "image"}) {
            if (svg.compare(at, stem.size(), stem) != 0) continue;
            const std::size_t count = digits_at(svg, at + stem.size());
            if (count == 0) continue;
            const std::string old = svg.substr(at, stem.size() + count);
            const auto [name, is_new] = names.try_emplace(old);
            if (is_new) name->second = std::string(stem) + std::to_string(names.size());
            out += name->second;
            at += old.size();
            break;
        }
    }
    return out;
}

}  // namespace

Colour mix(Colour a, Colour b, double share) {
    const auto blend = [share](std::uint8_t from, std::uint8_t to) {
        return static_cast<std::uint8_t>(std::lround(from + (to - from) * std::clamp(share, 0.0, 1.0)));
    };
    return {blend(a.red, b.red), blend(a.green, b.green), blend(a.blue, b.blue)};
}

std::uint32_t pixel_of(Colour colour) {
    return std::uint32_t{colour.red} << 16 | std::uint32_t{colour.green} << 8 | colour.blue;
}

namespace {

/// Brightness as the eye sees it, 0 to 255.
double lightness(Colour colour) {
    return 0.299 * colour.red + 0.587 * colour.green + 0.114 * colour.blue;
}

}  // namespace

Colour ink_on(Colour ground) {
    return lightness(ground) > 140 ? Colour{0x20, 0x20, 0x20} : Colour{0xff, 0xff, 0xff};
}

Colour readable(Colour colour) {
    const double most = 95;  // a contrast of more than 5 to 1
    return mix(colour, {0, 0, 0}, std::max(0.35, 1 - most / std::max(lightness(colour), 1.0)));
}

std::string printable(std::string_view text, std::size_t most) {
    std::string out;
    std::size_t characters = 0;
    for (std::size_t at = 0; at < text.size(); ++characters) {
        if (characters == most) return out + "…";
        const std::size_t size = utf8_length(text.substr(at));
        const bool control = size == 1 && (static_cast<std::uint8_t>(text[at]) < 0x20 || text[at] == 0x7f);
        if (size == 0) {
            out.push_back('?');
        } else if (control) {
            out.push_back(' ');
        } else {
            out += text.substr(at, size);
        }
        at += std::max<std::size_t>(size, 1);
    }
    return out;
}

Result<Canvas> Canvas::make(PictureFormat format, double width, double height, int scale) {
    width = std::ceil(width);
    height = std::ceil(height);
    if (!(width >= 1 && height >= 1 && width <= longest_side && height <= longest_side &&
          width * height * scale * scale <= most_pixels)) {
        return invalid("a picture of this cloth would be too large to draw");
    }
    std::unique_ptr<State, Close> state(new State);
    state->format = format;
    if (format == PictureFormat::png) {
        state->scale = scale;
        state->surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(width) * scale,
                                                    static_cast<int>(height) * scale);
        cairo_surface_set_device_scale(state->surface, scale, scale);
    } else {
        state->surface = cairo_svg_surface_create_for_stream(append, &state->svg, width, height);
        cairo_svg_surface_set_document_unit(state->surface, CAIRO_SVG_UNIT_PX);
    }
    state->cairo = cairo_create(state->surface);
    if (const cairo_status_t status = cairo_status(state->cairo); status != CAIRO_STATUS_SUCCESS) {
        return system_fault(std::string("cannot draw: ") + cairo_status_to_string(status));
    }
    Canvas canvas(std::move(state));
    canvas.rectangle({0, 0, width, height}, {0xff, 0xff, 0xff});
    return canvas;
}

void Canvas::rectangle(const Rectangle& place, Colour fill, double alpha) {
    cairo_t* cairo = m_state->cairo;
    cairo_rectangle(cairo, place.x, place.y, place.width, place.height);
    set_colour(cairo, fill, alpha);
    cairo_fill(cairo);
}

void Canvas::rectangles(std::span<const Rectangle> places, Colour fill) {
    if (places.empty()) return;
    cairo_t* cairo = m_state->cairo;
    for (const Rectangle& place : places) cairo_rectangle(cairo, place.x, place.y, place.width, place.height);
    set_colour(cairo, fill);
    cairo_fill(cairo);
}

void Canvas::outline(const Rectangle& place, const Stroke& stroke) {
    cairo_rectangle(m_state->cairo, place.x, place.y, place.width, place.height);
    stroke_path(m_state->cairo, stroke);
}

void Canvas::list_marks(std::vector<Mark>* marks) {
    m_state->marks = marks;
}

void Canvas::list_line(std::span<const Point> points, const Stroke& stroke) {
    if (m_state->marks == nullptr) return;
    Mark mark{Mark::Kind::line, {points.begin(), points.end()}, stroke.colour, stroke.width};
    mark.dashed = !stroke.dash.empty();
    m_state->marks->push_back(std::move(mark));
}

void Canvas::polyline(std::span<const Point> points, const Stroke& stroke) {
    if (points.size() < 2) return;
    list_line(points, stroke);
    cairo_move_to(m_state->cairo, points[0].x, points[0].y);
    for (const Point point : points.subspan(1)) cairo_line_to(m_state->cairo, point.x, point.y);
    stroke_path(m_state->cairo, stroke);
}

void Canvas::lines(std::span<const Point> ends, const Stroke& stroke) {
    if (ends.size() < 2) return;
    for (std::size_t k = 0; k + 1 < ends.size(); k += 2) {
        cairo_move_to(m_state->cairo, ends[k].x, ends[k].y);
        cairo_line_to(m_state->cairo, ends[k + 1].x, ends[k + 1].y);
    }
    stroke_path(m_state->cairo, stroke);
}

void Canvas::curve(std::span<const Point> points, const Stroke& stroke) {
    if (points.size() < 4) return;
    list_line(points, stroke);
    cairo_move_to(m_state->cairo, points[0].x, points[0].y);
    for (std::size_t k = 1; k + 2 < points.size(); k += 3) {
        cairo_curve_to(m_state->cairo, points[k].x, points[k].y, points[k + 1].x, points[k + 1].y,
                       points[k + 2].x, points[k + 2].y);
    }
    stroke_path(m_state->cairo, stroke);
}

void Canvas::polygon(std::span<const Point> points, Colour fill) {
    if (points.size() < 3) return;
    cairo_move_to(m_state->cairo, points[0].x, points[0].y);
    for (const Point point : points.subspan(1)) cairo_line_to(m_state->cairo, point.x, point.y);
    cairo_close_path(m_state->cairo);
    set_colour(m_state->cairo, fill);
    cairo_fill(m_state->cairo);
}

void Canvas::circle(Point centre, double radius, Colour fill) {
    cairo_new_sub_path(m_state->cairo);
    cairo_arc(m_state->cairo, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
    set_colour(m_state->cairo, fill);
    cairo_fill(m_state->cairo);
}

void Canvas::ring(Point centre, double radius, const Stroke& stroke) {
    cairo_new_sub_path(m_state->cairo);
    cairo_arc(m_state->cairo, centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
    stroke_path(m_state->cairo, stroke);
}

void Canvas::yarn(const Rectangle& place, bool along_x, Colour colour) {
    cairo_t* cairo = m_state->cairo;
    const double radius = std::min(place.width, place.height) / 2, quarter = std::numbers::pi / 2;
    const double right = place.x + place.width, bottom = place.y + place.height;
    cairo_new_sub_path(cairo);
    cairo_arc(cairo, right - radius, place.y + radius, radius, -quarter, 0);
    cairo_arc(cairo, right - radius, bottom - radius, radius, 0, quarter);
    cairo_arc(cairo, place.x + radius, bottom - radius, radius, quarter, 2 * quarter);
    cairo_arc(cairo, place.x + radius, place.y + radius, radius, 2 * quarter, 3 * quarter);
    cairo_close_path(cairo);
    cairo_pattern_t* shade = along_x ? cairo_pattern_create_linear(0, place.y, 0, bottom)
                                     : cairo_pattern_create_linear(place.x, 0, right, 0);
    const auto stop = [&](double at, Colour tone) {
        cairo_pattern_add_color_stop_rgb(shade, at, tone.red / 255.0, tone.green / 255.0, tone.blue / 255.0);
    };
    stop(0, mix(colour, {0, 0, 0}, 0.38));
    stop(0.22, mix(colour, {0xff, 0xff, 0xff}, 0.12));
    stop(0.40, colour);  // the middle stays the yarn's own colour
    stop(0.60, colour);
    stop(1, mix(colour, {0, 0, 0}, 0.45));
    cairo_set_source(cairo, shade);
    cairo_fill(cairo);
    cairo_pattern_destroy(shade);
}

void Canvas::arrow_head(Point tip, Point direction, double length, Colour fill) {
    const double norm = std::hypot(direction.x, direction.y);
    if (norm == 0) return;
    if (m_state->marks != nullptr) {
        Mark mark{Mark::Kind::arrow, {tip}, fill, length};
        mark.direction = {direction.x / norm, direction.y / norm};
        m_state->marks->push_back(std::move(mark));
    }
    const double ux = direction.x / norm * length, uy = direction.y / norm * length;
    const Point corners[]{
        tip, {tip.x - ux - uy * 0.5, tip.y - uy + ux * 0.5}, {tip.x - ux + uy * 0.5, tip.y - uy - ux * 0.5}};
    polygon(corners, fill);
}

void Canvas::text(Point at, std::string_view text, const TextStyle& style) {
    cairo_t* cairo = m_state->cairo;
    const std::string clean = printable(text, 400);
    if (m_state->marks != nullptr) {
        Mark mark{Mark::Kind::text, {at}, style.colour, style.size};
        mark.text = clean;
        mark.anchor = style.anchor;
        mark.bold = style.bold;
        m_state->marks->push_back(std::move(mark));
    }
    choose_font(cairo, style.size, style.bold);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, clean.c_str(), &extents);
    const double share = style.anchor == Anchor::start ? 0 : style.anchor == Anchor::middle ? 0.5 : 1;
    cairo_save(cairo);
    cairo_translate(cairo, at.x, at.y);
    cairo_rotate(cairo, style.angle);
    cairo_move_to(cairo, -share * extents.x_advance, style.centred ? style.size * 0.36 : 0);
    set_colour(cairo, style.colour);
    cairo_show_text(cairo, clean.c_str());
    cairo_restore(cairo);
    cairo_new_path(cairo);
}

void Canvas::pixels(std::size_t x, std::size_t y, std::size_t width, std::size_t height,
                    const std::function<void(std::size_t, std::span<std::uint32_t>)>& fill) {
    if (m_state->format == PictureFormat::png) {
        cairo_surface_flush(m_state->surface);
        unsigned char* bytes = cairo_image_surface_get_data(m_state->surface);
        const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(m_state->surface));
        const auto scale = static_cast<std::size_t>(m_state->scale);
        std::vector<std::uint32_t> colours(width);
        for (std::size_t line = 0; line < height * scale; ++line) {
            if (line % scale == 0) fill(line / scale, colours);
            auto* to = reinterpret_cast<std::uint32_t*>(bytes + (y * scale + line) * stride) + x * scale;
            for (const std::uint32_t colour : colours) to = std::fill_n(to, scale, colour);
        }
        cairo_surface_mark_dirty(m_state->surface);
        return;
    }
    std::vector<std::uint32_t> colours(width * height);
    for (std::size_t row = 0; row < height; ++row) fill(row, std::span(colours).subspan(row * width, width));
    cairo_surface_t* image = cairo_image_surface_create_for_data(
        reinterpret_cast<unsigned char*>(colours.data()), CAIRO_FORMAT_RGB24, static_cast<int>(width),
        static_cast<int>(height), static_cast<int>(width * 4));
    if (auto png = encode_png(colours.data(), width, height, width)) {
        auto* kept = new std::string(std::move(png).value());  // cairo frees it with the surface
        cairo_surface_set_mime_data(
            image, CAIRO_MIME_TYPE_PNG, reinterpret_cast<const unsigned char*>(kept->data()), kept->size(),
            [](void* data) { delete static_cast<std::string*>(data); }, kept);
    } else if (m_state->trouble) {
        m_state->trouble = std::move(png).error();
    }
    cairo_set_source_surface(m_state->cairo, image, static_cast<double>(x), static_cast<double>(y));
    cairo_pattern_set_filter(cairo_get_source(m_state->cairo), CAIRO_FILTER_NEAREST);
    cairo_paint(m_state->cairo);
    cairo_set_source_rgb(m_state->cairo, 0, 0, 0);  // lets go of the image, whose pixels end here
    cairo_surface_flush(m_state->surface);
    cairo_surface_finish(image);
    cairo_surface_destroy(image);
}

void Canvas::clip(const Rectangle& place) {
    cairo_save(m_state->cairo);
    cairo_rectangle(m_state->cairo, place.x, place.y, place.width, place.height);
    cairo_clip(m_state->cairo);
}

void Canvas::unclip() {
    cairo_restore(m_state->cairo);
}

Result<std::string> Canvas::finish() && {
    if (!m_state->trouble) return std::move(m_state->trouble).error();
    cairo_status_t status = cairo_status(m_state->cairo);
    if (status == CAIRO_STATUS_SUCCESS && m_state->format == PictureFormat::svg)
        cairo_surface_finish(m_state->surface);
    cairo_surface_flush(m_state->surface);
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(m_state->surface);
    if (status != CAIRO_STATUS_SUCCESS) {
        return system_fault(std::string("cannot draw: ") + cairo_status_to_string(status));
    }
    if (m_state->format == PictureFormat::svg) return with_own_numbers(m_state->svg);
    const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(m_state->surface));
    return encode_png(reinterpret_cast<const std::uint32_t*>(cairo_image_surface_get_data(m_state->surface)),
                      static_cast<std::size_t>(cairo_image_surface_get_width(m_state->surface)),
                      static_cast<std::size_t>(cairo_image_surface_get_height(m_state->surface)), stride / 4);
}

double Canvas::text_width(std::string_view text, double size, bool bold) {
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
    cairo_t* cairo = cairo_create(surface);
    choose_font(cairo, size, bold);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo, printable(text, 400).c_str(), &extents);
    cairo_destroy(cairo);
    cairo_surface_destroy(surface);
    return extents.x_advance;
}

}  // namespace weave
