#pragma once

#include <weave/picture/picture.hpp>
#include <weave/sim/yarns.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace weave {

/// What colours the yarns in a picture of relaxed cloth.
enum class ClothColour : std::uint8_t {
    yarn,     ///< the yarn's own colour; the paper's grey and orange where all yarns have one colour
    strain,   ///< local lengthening, %
    contact,  ///< size of the contact force on a control point, N
    moved,    ///< distance from the planned centreline at the same parameter, mm
    height,   ///< of the centreline, from z = 0 of the plan up, mm: dents and ridges
};

/// A plane through the cloth. What lies on the side that the normal points to is cut away.
struct ClothCut {
    Vec3 point{0, 0, 0};   ///< mm
    Vec3 normal{0, 0, 1};  ///< any length but 0
    std::string words;     ///< as it is told in the picture, such as `x = 3.2 mm`
};

/// How relaxed cloth is looked at. Axes as in the cloth: x along the ends, y along the picks, z up.
struct ClothView {
    /// Where the viewer stands: 0 before the first pick, with the first end at the left; 90 at the last end.
    /// And how high: 90 right above, -90 right below. Degrees.
    double azimuth_deg = 32, elevation_deg = 38;
    bool perspective = false;  ///< a mild one; otherwise lengths in the picture compare
    std::optional<ClothCut> cut;
    ClothColour colour = ClothColour::yarn;
    std::array<std::size_t, 2> repeat{1, 1};  ///< periodic pieces side by side along x and y
    std::size_t width = 1600, height = 1200;  ///< of the picture, pixels
    PictureFormat format = PictureFormat::png;
};

/// How a person writes it; empty words mean the default.
struct ClothWords {
    /// `top`, `bottom`, `front`, `back`, `left`, `right`, `corner` (the default), or `AZIMUTH,ELEVATION` in
    /// degrees. `top` and `bottom` show the cloth as the pictures of face and back do.
    std::string side{};
    /// `x=N`, `y=N` or `z=N` in mm: what lies between the viewer and this plane is cut away. Or a point and a
    /// normal, `PX,PY,PZ:NX,NY,NZ`.
    std::string cut{};
    std::string colour{};  ///< `yarn`, `strain`, `contact`, `moved` or `height`
    std::string repeat{};  ///< `NxM`, pieces along x and along y, 1 to 100 each
    std::string size{};    ///< `WIDTHxHEIGHT` in pixels, 400x300 to 8000x6000
    bool perspective = false;
};

/// Errors (usage): a word that is none of these.
Result<ClothView> parse_cloth_view(const ClothWords& words);

/// A picture has at most so many straight pieces of yarn.
inline constexpr std::size_t most_tube_pieces = 2'000'000;

/// A shaded picture of relaxed cloth, as PNG; the same content gives the same bytes, whatever the number of
/// processors. Errors: no yarn, a cut that leaves nothing, a repeat where the piece is not periodic, more
/// pieces than most_tube_pieces, yarns far thicker than their pieces are long, SVG (there is none of this
/// view).
Result<std::string> draw_cloth(const Yarns& yarns, const ClothView& view);

}  // namespace weave
