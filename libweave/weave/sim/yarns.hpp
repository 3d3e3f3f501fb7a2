#pragma once

#include <weave/core/colour.hpp>
#include <weave/core/json.hpp>
#include <weave/curve/cloth_curves.hpp>
#include <weave/curve/spline.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace weave {

/// One yarn as the simulator leaves it.
struct SimulatedYarn {
    System system = System::warp;
    std::size_t number = 0;  ///< the end, or the (first) pick, from 0, in the whole cloth
    std::uint32_t beam = 0;  ///< of a warp yarn
    double radius_mm = 0;
    Colour colour;
    Spline spline;                        ///< relaxed centreline, mm
    std::vector<Vec3> planned;            ///< where each control point was at the start, mm
    std::vector<double> strain;           ///< per control point: local length over rest length, less 1
    std::vector<double> contact_N;        ///< per control point: size of the contact force on it
    double planned_length_mm = 0;         ///< straight extent of its repeat, or from end to end
    double length_mm = 0;                 ///< of the relaxed centreline
    double rest_length_mm = 0;            ///< what goes into the cloth without tension
};

/// A relaxed piece of cloth with what it says about itself: the content of a `.yarns` file.
struct Yarns {
    std::string title;
    std::string design_sha256, scene_sha256;
    std::vector<SimulatedYarn> yarns;
    std::vector<Crossing> crossings;  ///< `weft`, `warp` index `yarns`; keys count the planned key points
    std::array<double, 2> size_mm{};
    std::array<bool, 2> is_periodic{};
    Region region;
    std::size_t cloth_rows = 0, cloth_columns = 0;  ///< of the whole design
    Json report = Json::object();  ///< how it was simulated and how that ended: solver, fidelity, residual, plan …
};

}  // namespace weave
