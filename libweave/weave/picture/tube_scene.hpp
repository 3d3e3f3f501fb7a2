#pragma once

#include <weave/picture/cloth_view.hpp>
#include <weave/picture/tube_piece.hpp>

#include <optional>
#include <vector>

namespace weave {

/// What a picture of cloth shows, in the camera's axes, and how it is coloured.
struct TubeScene {
    std::vector<TubePiece> pieces;  ///< of one yarn after another, in their order along it
    std::vector<Plane> planes;      ///< where yarns end
    std::optional<Plane> cut;
    bool is_cut_through = false;  ///< whether the cut takes any of the cloth away
    std::vector<Colour> colours;  ///< of each yarn; empty where values colour the pieces
    double low = 0, high = 1;     ///< the values at both ends of the colour map
    Vec3 size{0, 0, 0};           ///< of what is shown, along the cloth's axes, mm
};

/// The yarns as straight pieces that stray less than a twentieth of the radius from them, what is cut away
/// left out, and the camera aimed at them. Errors: as draw_cloth().
Result<TubeScene> make_scene(const Yarns& yarns, const ClothView& view, TubeCamera& camera);

/// The box round the scene on the camera's picture plane.
Rectangle box_of(const TubeScene& scene, const TubeCamera& camera);

}  // namespace weave
