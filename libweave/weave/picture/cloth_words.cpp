#include <weave/picture/canvas.hpp>
#include <weave/picture/cloth_view.hpp>

#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

namespace weave {

namespace {

struct NamedSide {
    std::string_view name;
    double azimuth_deg, elevation_deg;
};

constexpr NamedSide sides[]{{"top", 0, 90},   {"bottom", 180, -90}, {"front", 0, 0},   {"back", 180, 0},
                            {"left", -90, 0}, {"right", 90, 0},     {"corner", 32, 38}};
constexpr std::string_view colours[]{"yarn", "strain", "contact", "moved", "height"};
constexpr std::size_t most_repeats = 100;
constexpr double farthest_mm = 1e9;

Error usage(const std::string& name, const std::string& given, const std::string& wish) {
    return {ErrorCode::usage, name + " '" + printable(given, 40) + "': " + wish, {}};
}

/// The numbers between separators, every one of them finite; nothing where a word is no number.
std::optional<std::vector<double>> numbers(std::string_view text, char separator) {
    std::vector<double> values;
    for (bool last = false; !last;) {
        const std::size_t end = text.find(separator);
        last = end == std::string_view::npos;
        const std::string_view word = text.substr(0, end);
        double value = 0;
        const auto [stop, code] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (code != std::errc{} || stop != word.data() + word.size() || !(std::abs(value) <= farthest_mm))
            return {};
        values.push_back(value);
        if (!last) text.remove_prefix(end + 1);
    }
    return values;
}

Status set_side(ClothView& view, const std::string& text) {
    for (const NamedSide& side : sides) {
        if (side.name != text) continue;
        view.azimuth_deg = side.azimuth_deg;
        view.elevation_deg = side.elevation_deg;
        return {};
    }
    const auto angles = numbers(text, ',');
    if (!angles || angles->size() != 2 || std::abs((*angles)[0]) > 360 || std::abs((*angles)[1]) > 90) {
        return usage(
            "side", text,
            "choose top, bottom, front, back, left, right, corner, or AZIMUTH,ELEVATION in degrees, from "
            "-360 to 360 and from -90 to 90");
    }
    view.azimuth_deg = (*angles)[0];
    view.elevation_deg = (*angles)[1];
    return {};
}

/// From the cloth to the viewer.
Vec3 to_viewer(const ClothView& view) {
    const double azimuth = view.azimuth_deg * std::numbers::pi / 180,
                 elevation = view.elevation_deg * std::numbers::pi / 180;
    return {-std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
            std::sin(elevation)};
}

Status set_cut(ClothView& view, const std::string& text) {
    const std::string wish =
        "write x=N, y=N or z=N in mm, or PX,PY,PZ:NX,NY,NZ, a point and a normal that is not 0";
    ClothCut cut;
    const std::size_t axis = std::string_view("xyz").find(text[0]);
    if (axis != std::string_view::npos && text.size() > 2 && text[1] == '=') {
        const auto at = numbers(std::string_view(text).substr(2), ',');
        if (!at || at->size() != 1) return usage("cut", text, wish);
        const auto index = static_cast<Eigen::Index>(axis);
        cut.point[index] = (*at)[0];
        cut.normal = Vec3::Unit(index) * (to_viewer(view)[index] < -1e-9 ? -1 : 1);
        cut.words = text.substr(0, 1) + " = " + text.substr(2) + " mm";
        view.cut = cut;
        return {};
    }
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return usage("cut", text, wish);
    const auto point = numbers(std::string_view(text).substr(0, colon), ',');
    const auto normal = numbers(std::string_view(text).substr(colon + 1), ',');
    if (!point || !normal || point->size() != 3 || normal->size() != 3) return usage("cut", text, wish);
    cut.point = {(*point)[0], (*point)[1], (*point)[2]};
    cut.normal = {(*normal)[0], (*normal)[1], (*normal)[2]};
    if (cut.normal.norm() < 1e-9) return usage("cut", text, wish);
    cut.words = "point " + text.substr(0, colon) + " mm, normal " + text.substr(colon + 1);
    view.cut = cut;
    return {};
}

Status set_colour(ClothView& view, const std::string& text) {
    for (std::size_t k = 0; k < std::size(colours); ++k) {
        if (colours[k] != text) continue;
        view.colour = static_cast<ClothColour>(k);
        return {};
    }
    return usage("colour", text, "choose yarn, strain, contact, moved or height");
}

/// Two whole numbers with an x between them, within limits.
Result<std::array<std::size_t, 2>> pair_of(const std::string& name, const std::string& text,
                                           std::array<double, 2> least, std::array<double, 2> most,
                                           const std::string& wish) {
    const auto values = numbers(text, 'x');
    if (!values || values->size() != 2) return usage(name, text, wish);
    for (std::size_t k = 0; k < 2; ++k) {
        const double value = (*values)[k];
        if (value != std::floor(value) || value < least[k] || value > most[k]) return usage(name, text, wish);
    }
    return std::array{static_cast<std::size_t>((*values)[0]), static_cast<std::size_t>((*values)[1])};
}

}  // namespace

Result<ClothView> parse_cloth_view(const ClothWords& words) {
    ClothView view;
    view.perspective = words.perspective;
    if (!words.side.empty()) WEAVE_CHECK_OK(set_side(view, words.side));
    if (!words.cut.empty()) WEAVE_CHECK_OK(set_cut(view, words.cut));  // after the side, which it looks at
    if (!words.colour.empty()) WEAVE_CHECK_OK(set_colour(view, words.colour));
    if (!words.repeat.empty()) {
        constexpr double most = most_repeats;
        WEAVE_TRY(view.repeat,
                  pair_of("repeat", words.repeat, {1, 1}, {most, most},
                          "write NxM, pieces along the ends and along the picks, 1 to 100 each"));
    }
    if (!words.size.empty()) {
        WEAVE_TRY(const auto size, pair_of("size", words.size, {400, 300}, {8000, 6000},
                                           "write WIDTHxHEIGHT in pixels, from 400x300 to 8000x6000"));
        view.width = size[0];
        view.height = size[1];
    }
    return view;
}

}  // namespace weave
