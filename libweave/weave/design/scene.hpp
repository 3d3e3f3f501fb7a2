#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// No yarn has a larger number, from 0.
inline constexpr std::int64_t most_yarn_number = (std::int64_t{1} << 28) - 1;

/// How the rim of the simulated piece behaves in one direction.
enum class Boundary : std::uint8_t { periodic, frozen, free };

/// Whether each pick runs from edge to edge, or the picks of a feeder are one yarn that turns where an end
/// catches it.
enum class WeftMode : std::uint8_t { periodic, wraparound };

/// How the loom inserts the weft.
enum class Insertion : std::uint8_t { shuttle, rapier, air_jet };

/// Parameters of one yarn system that override its yarn types for the simulation; what is absent follows the
/// types.
struct SystemScene {
    std::optional<double> strain;           ///< target strain S >= 1 of the balanced yarns
    std::optional<double> stiffness_scale;  ///< factor on EA and EI
    std::optional<double> radius_scale;     ///< factor on the radii
    friend bool operator==(const SystemScene&, const SystemScene&) = default;
};

/// A yarn held at its planned place: pick or end, from 0.
struct Pin {
    bool is_pick = true;
    std::size_t number = 0;
    friend bool operator==(const Pin&, const Pin&) = default;
};

/// A spherical force field that pushes yarns outwards; lengths in mm. Strength: N on each mm of yarn at the centre,
/// falling evenly to none at the surface; below 0 it pulls inwards.
struct ForceField {
    std::array<double, 3> centre_mm{};
    double radius_mm = 1;
    double strength_N_per_mm = 1;
    friend bool operator==(const ForceField&, const ForceField&) = default;
};

/// What the simulator needs to know beyond the weave itself. Everything has a default that comes from the
/// yarns.
struct Scene {
    std::optional<double> dx_mm, dy_mm, dz_mm;  ///< spacing of rows, columns and levels
    Boundary boundary_x = Boundary::periodic, boundary_y = Boundary::periodic;
    WeftMode weft_mode = WeftMode::periodic;
    Insertion insertion = Insertion::shuttle;
    SystemScene warp, weft;
    std::vector<Pin> pins;
    std::vector<ForceField> fields;
    double friction = 0;  ///< Coulomb coefficient
    bool gravity = false;
    friend bool operator==(const Scene&, const Scene&) = default;
};

}  // namespace weave
