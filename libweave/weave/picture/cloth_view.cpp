#include <weave/picture/cloth_view.hpp>

#include <weave/core/text.hpp>
#include <weave/picture/colour_map.hpp>
#include <weave/picture/page.hpp>
#include <weave/picture/scale_marks.hpp>
#include <weave/picture/tube_render.hpp>
#include <weave/picture/yarn_knots.hpp>
#include <weave/sim/report_words.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>
#include <set>

namespace weave {

namespace {

constexpr double foot_height = 84;  ///< under the cloth, for axes and scale
constexpr double bar_room = 118;    ///< at the right, for the colour bar
constexpr double bar_width = 20;

std::string side_words(const ClothView& view) {
    struct Name {
        double azimuth, elevation;
        const char* words;
    };
    constexpr Name names[]{{0, 90, "from above"},           {180, -90, "from below"},
                           {0, 0, "from the front"},        {180, 0, "from the back"},
                           {-90, 0, "from the left"},       {90, 0, "from the right"},
                           {32, 38, "from the upper front"}};
    for (const Name& name : names) {
        if (name.azimuth == view.azimuth_deg && name.elevation == view.elevation_deg) return name.words;
    }
    return "from azimuth " + short_number(view.azimuth_deg) + "°, elevation " +
           short_number(view.elevation_deg) + "°";
}

std::string size_words(const Vec3& size) {
    return short_number(size.x()) + " × " + short_number(size.y()) + " × " + short_number(size.z()) + " mm";
}

/// How many picks, or ends, cross something: a weft that turns at the edges is one yarn and many picks. Of yarns that say nothing of
/// crossings each counts.
std::size_t count_of(const Yarns& yarns, System system) {
    if (yarns.crossings.empty()) return static_cast<std::size_t>(std::ranges::count(yarns.yarns, system, &SimulatedYarn::system));
    std::set<std::size_t> numbers;
    for (const Crossing& crossing : yarns.crossings) numbers.insert(system == System::weft ? crossing.pick : crossing.end);
    return numbers.size();
}

/// The text, cut with an ellipsis where it is wider than that.
std::string fitting(const std::string& text, double width, double size, bool bold) {
    for (std::size_t most = 80; most > 1; --most) {
        std::string cut = printable(text, most);
        if (Canvas::text_width(cut, size, bold) <= width) return cut;
    }
    return {};
}

/// Parts of a sentence set in lines of at most this width.
std::vector<std::string> in_lines(const std::vector<std::string>& parts, const char* between, double width) {
    std::vector<std::string> lines;
    for (const std::string& part : parts) {
        const std::string longer = lines.empty() ? part : lines.back() + between + part;
        if (lines.empty() || Canvas::text_width(longer, Page::small_size) > width) {
            lines.push_back(fitting(part, width, Page::small_size, false));
        } else {
            lines.back() = longer;
        }
    }
    return lines;
}

std::vector<std::string> notes_of(const Yarns& yarns, const ClothView& view, const TubeScene& scene) {
    std::vector<std::string> parts{"Shown: " + size_words(scene.size) + " (x × y × z)"};
    if (view.repeat[0] * view.repeat[1] > 1)
        parts.push_back("the piece " + std::to_string(view.repeat[0]) + " × " +
                        std::to_string(view.repeat[1]) + " times");
    const Region& region = yarns.region;
    if (region.last_row - region.first_row + 1 < yarns.cloth_rows)
        parts.push_back("rows " + std::to_string(region.first_row + 1) + " to " +
                        std::to_string(region.last_row + 1) + " of " + std::to_string(yarns.cloth_rows));
    if (region.last_column - region.first_column + 1 < yarns.cloth_columns)
        parts.push_back("columns " + std::to_string(region.first_column + 1) + " to " +
                        std::to_string(region.last_column + 1) + " of " +
                        std::to_string(yarns.cloth_columns));
    if (view.cut)
        parts.push_back(scene.is_cut_through ? "cut at " + view.cut->words + ", where flat discs are yarns cut through"
                                             : "nothing of it lies before the cut at " + view.cut->words);
    return parts;
}

/// A report that does not say how its run ended is that of yarns at rest.
std::string state_words(const Json& report) {
    if (sim::part_of(report, "converged") != false) return "relaxed yarns";
    return sim::part_of(report, "iterations") == 0 ? "planned yarns" : "yarns not at rest";
}

PageText words_of(const Yarns& yarns, const ClothView& view, const TubeScene& scene) {
    const double width = static_cast<double>(view.width) - 2 * Page::margin;
    PageText text;
    text.title = fitting(yarns.title.empty() ? "Relaxed cloth" : yarns.title, width, Page::title_size, true);
    std::vector<std::string> lines = in_lines({state_words(yarns.report) + ", seen " + side_words(view),
                                               counted(count_of(yarns, System::weft), "pick") + " × " +
                                                   counted(count_of(yarns, System::warp), "end"),
                                               std::string("coloured by ") + words_of(view.colour).subtitle},
                                              "  ·  ", width);
    text.subtitle = lines.front();
    text.notes.assign(lines.begin() + 1, lines.end());
    lines = in_lines(notes_of(yarns, view, scene), "; ", width);
    text.notes.insert(text.notes.end(), lines.begin(), lines.end());
    return text;
}

void draw_bar(Canvas& canvas, const Rectangle& body, const TubeScene& scene, const char* unit) {
    const double height = std::floor(std::min(420.0, body.height - 60));
    const Rectangle bar{body.x + body.width - bar_room + 26, std::floor(body.y + (body.height - height) / 2),
                        bar_width, height};
    for (double y = 0; y < height; ++y)
        canvas.rectangle({bar.x, bar.y + y, bar_width, 1}, map_colour(1 - (y + 0.5) / height));
    canvas.outline({bar.x - 0.5, bar.y - 0.5, bar.width + 1, bar.height + 1}, {.colour = faint_ink});
    canvas.text({bar.x - 6, bar.y - 16}, unit, {.size = 12.5, .bold = true});
    for (const double mark : scale_marks(scene.low, scene.high)) {
        const double y = bar.y + height * (1 - (mark - scene.low) / (scene.high - scene.low));
        const Point tick[]{{bar.x + bar_width, y}, {bar.x + bar_width + 5, y}};
        canvas.polyline(tick, {.colour = ink});
        canvas.text({bar.x + bar_width + 9, y}, short_number(mark), {.size = 12, .centred = true});
    }
}

/// The cloth's axes as they lie in the picture, in the corner.
void draw_axes(Canvas& canvas, const TubeCamera& camera, Point corner) {
    constexpr double length = 34;
    constexpr Colour colours[]{{0xc0, 0x39, 0x2b}, {0x2e, 0x8b, 0x57}, {0x2c, 0x5f, 0xb8}};
    constexpr const char* names[]{"x, warp", "y, weft", "z"};
    const Point origin{corner.x + 96, corner.y + foot_height / 2 + 4};
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 way = camera.turned(Vec3::Unit(axis));
        const Point tip{origin.x + length * way.x(), origin.y - length * way.y()};
        const double seen = std::hypot(way.x(), way.y());
        if (seen < 0.15) continue;  // it points at the viewer or away
        const Point shaft[]{origin, {tip.x - 4 * way.x(), tip.y + 4 * way.y()}};
        canvas.polyline(shaft, {.colour = colours[axis], .width = 2});
        canvas.arrow_head(tip, {tip.x - origin.x, tip.y - origin.y}, 9, colours[axis]);
        const Point name{tip.x + 9 * way.x() / seen, tip.y - 9 * way.y() / seen};
        const Anchor anchor = way.x() > 0.3 ? Anchor::start : way.x() < -0.3 ? Anchor::end : Anchor::middle;
        canvas.text(name, names[axis],
                    {.size = 11.5, .colour = colours[axis], .anchor = anchor, .bold = true, .centred = true});
    }
}

/// A bar of a round length; without it where perspective makes lengths depend on depth.
void draw_scale(Canvas& canvas, const TubeCamera& camera, Point right_end) {
    const double length = round_step(160 / camera.pixels_per_unit()),
                 width = length * camera.pixels_per_unit();
    const double x = right_end.x, y = right_end.y;
    const Point ends[]{{x - width, y},     {x, y},     {x - width, y - 5},
                       {x - width, y + 5}, {x, y - 5}, {x, y + 5}};
    canvas.lines(ends, {.colour = ink, .width = 2, .round = false});
    canvas.text({x - width / 2, y - 9}, short_number(length) + " mm", {.size = 12, .anchor = Anchor::middle});
}

/// Refuses pieces so thick that thousands lie over one another everywhere: no cloth, and hours of work.
Status check_cover(const TubeScene& scene, const TubeCamera& camera, double pixels) {
    constexpr double most_layers = 5000;
    double covered = 0;
    for (const TubePiece& piece : scene.pieces) {
        for (const Vec3& end : {piece.from, piece.to}) {
            const Rectangle box = camera.on_screen(camera.box_of(end, piece.radius));
            covered += box.width * box.height / 2;
        }
    }
    if (covered <= most_layers * pixels) return {};
    return invalid("the yarns are so thick, and lie so close, that they cannot be told apart in a picture");
}

Result<std::string> draw_page(const Yarns& yarns, const ClothView& view) {
    TubeCamera camera(view.azimuth_deg, view.elevation_deg);
    WEAVE_TRY(const TubeScene scene, make_scene(yarns, view, camera));
    const bool has_bar = view.colour != ClothColour::yarn;
    const PageText text = words_of(yarns, view, scene);
    const double words = 18 + 17 * static_cast<double>(text.notes.size());
    WEAVE_TRY(Page page,
              Page::open(view.format, text, static_cast<double>(view.width) - 2 * Page::margin,
                         static_cast<double>(view.height) - Page::body_top - words - Page::margin));
    const Rectangle body = page.body;
    const auto width = static_cast<std::size_t>(body.width - (has_bar ? bar_room : 0)),
               height = static_cast<std::size_t>(body.height - foot_height);
    const auto wide = static_cast<double>(width), high = static_cast<double>(height);
    const double rim = 0.02 * std::min(wide, high);
    camera.fit(box_of(scene, camera), {rim, rim, wide - 2 * rim, high - 2 * rim});
    WEAVE_CHECK_OK(check_cover(scene, camera, wide * high));
    const std::vector<std::uint32_t> pixels = render(scene, camera, width, height);
    page.canvas.pixels(static_cast<std::size_t>(body.x), static_cast<std::size_t>(body.y), width, height,
                       [&](std::size_t row, std::span<std::uint32_t> out) {
                           std::copy_n(&pixels[row * width], width, out.begin());
                       });
    draw_axes(page.canvas, camera, {body.x, body.y + high});
    if (!view.perspective)
        draw_scale(page.canvas, camera, {body.x + wide - 12, body.y + high + foot_height / 2});
    if (has_bar) draw_bar(page.canvas, body, scene, words_of(view.colour).unit);
    return std::move(page.canvas).finish();
}

}  // namespace

Result<std::string> draw_cloth(const Yarns& yarns, const ClothView& view) {
    if (view.format != PictureFormat::png) {
        return Error{
            ErrorCode::usage, "relaxed cloth is drawn as PNG only: choose a name that ends in .png", {}};
    }
    if (view.width < 400 || view.height < 300 || view.width > 8000 || view.height > 6000)
        return Error{
            ErrorCode::usage, "a picture of relaxed cloth is from 400x300 to 8000x6000 pixels large", {}};
    try {
        return draw_page(yarns, view);
    } catch (const std::bad_alloc&) {
        return system_fault("there is not enough memory to draw this cloth");
    }
}

}  // namespace weave
