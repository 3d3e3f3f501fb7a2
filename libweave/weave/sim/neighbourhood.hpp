#pragma once

#include <weave/sim/scene.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave::sim {

/// A piece of a scene around a place, for changes that reach no farther: what lies within `moving_mm` moves, what that may
/// touch is there and frozen, all else is left out. So a change in a large cloth costs what its neighbourhood costs.
struct Neighbourhood {
    /// Control points of a yarn that a yarn of `scene` stands for: `first` and the following ones. Those of a periodic yarn
    /// go on beyond its last.
    struct Piece {
        std::size_t yarn = 0, first = 0;
        Vec3 moved{0, 0, 0};  ///< the piece lies that much away: by whole periods
    };
    SimScene scene;
    std::vector<Piece> pieces;  ///< one a yarn of `scene`
};

/// The neighbourhood of a place. Yarns are cut, and nothing is periodic, where the scene is large enough; else they are whole.
/// Each keeps the density of its contact samples and its share of rest length. The transition and where slip counts from are
/// left out.
Neighbourhood neighbourhood(const SimScene& scene, const Vec3& place, double moving_mm);

/// Puts the control points of a neighbourhood back where they came from.
void put_back(const Neighbourhood& part, SimScene& scene);

}  // namespace weave::sim
