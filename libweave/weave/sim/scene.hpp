#pragma once

#include <weave/curve/vec3.hpp>
#include <weave/design/scene.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace weave::sim {

/// A yarn as the solvers see it; lengths mm, forces N.
struct SimYarn {
    std::vector<Vec3> control;  ///< control points of its uniform cubic B-spline (curve/spline.hpp)
    /// Length by which contact samples are counted, so that they are the same whatever state a relaxation starts from;
    /// 0: that of the control points.
    double planned_mm = 0;
    bool is_periodic = false;
    Vec3 shift{0, 0, 0};        ///< of a periodic yarn from its end to its next beginning
    std::array<int, 2> turns{};  ///< how many periods in x and y `shift` is
    std::vector<std::uint8_t> frozen;  ///< per control point: it does not move; empty: all move
    double radius_mm = 0;
    double stretch_N = 0;         ///< EA
    double bending_N_mm2 = 0;     ///< EI
    double contact_N_mm2 = 0;     ///< k
    double gram_per_mm = 0;
    bool is_fed = false;          ///< at constant tension (warp); else a fixed length
    double strain = 1;            ///< target S of a fed yarn, at least 1
    double rest_mm = 0;           ///< unstretched length of a yarn of fixed length, whole

    // Only of a piece of a yarn, in a part of a cloth that is relaxed in parts (weave/ranks):
    /// Whether the yarn goes on before its first control point, and after its last: that one shapes the segments beside it,
    /// but no segment begins or ends there.
    std::array<bool, 2> is_cut{};
    std::vector<std::uint8_t> guests;  ///< per control point: it moves with another part; empty: none
    std::size_t whole_segments = 0;    ///< segments of the whole yarn, of which `planned_mm` and `rest_mm` are; 0: its own
};

/// A crossing whose two yarns are being led past one another (paper, 5.2 and A.4). Both `at` and `reach` count segments
/// along a yarn; those of a periodic one go on beyond its ends.
struct TransitionPair {
    std::array<std::size_t, 2> yarn{};  ///< of SimScene::yarns
    std::array<double, 2> at{};         ///< where each crosses the other, seen from above
    std::array<double, 2> reach{};      ///< half the stretch of each that does not touch the other's
    double height_mm = 0;               ///< how far the first is to lie above the second there; below 0: under it
    double spring_N_per_mm = 0;         ///< of the spring that leads to that height
    double contact = 0;                 ///< share of the contact of the two stretches, 0 to 1
};

/// A state that the yarns have come from.
struct SlipStart {
    std::vector<std::vector<Vec3>> control;  ///< of each yarn
    std::array<double, 2> period_mm{};
};

/// Everything that is simulated: yarns in one repeat, or in a piece with rims.
struct SimScene {
    std::vector<SimYarn> yarns;
    std::array<double, 2> period_mm{};
    std::array<bool, 2> is_periodic{};
    std::vector<ForceField> fields;
    std::optional<TransitionPair> transition;
    double gravity_mm_ms2 = 0;  ///< along -z
    double friction = 0;        ///< Coulomb coefficient μ between yarns
    /// Where slip against friction counts from; absent: from the control points above.
    std::optional<SlipStart> slip_from;
    /// Greatest distance of contact samples, as a share of the smallest sum of two radii (1/4: see the accuracy notes).
    double sample_spacing = 0.25;
    double least_radius_mm = 0;  ///< of all yarns of the cloth, where these are a part of it; 0: of these
};

}  // namespace weave::sim
