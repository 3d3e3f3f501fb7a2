#pragma once

#include <weave/curve/vec3.hpp>

#include <array>

namespace weave {

/// The Bézier points of a cubic piece of a curve.
using CubicPiece = std::array<Vec3, 4>;

/// Where two pieces are nearest.
struct Nearness {
    double distance = 0;
    Vec3 place{0, 0, 0};  ///< midway
};

/// Lowers `best` to the least distance of the two pieces if that is smaller, to within a ten-thousandth of
/// it, and says whether it was. Exact in that no piece is judged by samples: a part is left out only where
/// the distance of the chords less how far the curves stray from them exceeds the best so far.
bool bring_nearer(const CubicPiece& a, const CubicPiece& b, Nearness& best);

/// Whether a piece stays farther than `distance` from the origin in the yz-plane; exact as above.
bool stays_off_axis(const CubicPiece& piece, double distance);

/// The two halves of a piece.
std::array<CubicPiece, 2> halves(const CubicPiece& piece);

}  // namespace weave
