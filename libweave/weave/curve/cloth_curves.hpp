#pragma once

#include <weave/curve/vec3.hpp>
#include <weave/design/design.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace weave {

/// A stretch of rows and columns of the cloth, first to last inclusive, from 0.
struct Region {
    std::size_t first_row = 0, last_row = 0, first_column = 0, last_column = 0;
    friend bool operator==(const Region&, const Region&) = default;
};

/// A place that a yarn's curve passes, with what it stands for in the weave.
struct KeyPoint {
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    Vec3 place{0, 0, 0};  ///< mm
    /// The stack that it passes, in rows and columns of the whole cloth. Between two stacks a pick has no
    /// column and an end no row; a turn outside the cloth has neither.
    std::size_t row = none, column = none;
    std::size_t yarn = none;  ///< the pick that passes here (in a turn the earlier), or the end
    bool loose = false;       ///< lies here loose on purpose; between stacks: in both of them
};

/// The planned centreline of one yarn.
struct YarnCurve {
    System system = System::warp;
    std::size_t number = 0;  ///< the end, or the (first) pick, from 0, counted in the whole cloth
    std::uint32_t type = 0;  ///< index into the warp's or weft's yarns
    std::vector<KeyPoint> keys;
    /// The yarn goes on for ever: after the last key comes the first, moved by `shift`.
    bool is_periodic = false;
    Vec3 shift{0, 0, 0};  ///< mm
};

/// Where a weft and a warp pass one another, and which lies above: what the card image says.
struct Crossing {
    std::size_t weft = 0, weft_key = 0;  ///< index of the yarn in ClothCurves, and of its key point
    std::size_t warp = 0, warp_key = 0;
    std::size_t pick = 0, end = 0;  ///< in the whole cloth, from 0
    bool weft_over = false;
};

/// Every yarn of a cloth, or of a part of it, before it relaxes (paper, section 4.2 and A.3). A pick without
/// feeder has no yarn; one with two feeders has two, a quarter of a slot below and above its place.
struct ClothCurves {
    std::vector<YarnCurve> yarns;  ///< wefts by number, then warps by number
    std::vector<Crossing> crossings;
    double dx_mm = 0, dy_mm = 0, dz_mm = 0;  ///< spacing of rows, columns and levels
    /// Length of the piece in x and y, mm, whatever its boundary; its repeat where that boundary is periodic.
    std::array<double, 2> size_mm{};
    std::array<bool, 2> is_periodic{};
    Region region;  ///< the part of the cloth that this is
};

struct CurveOptions {
    std::optional<Region> region;       ///< only a part; then neither direction is periodic
    std::optional<WeftMode> weft_mode;  ///< instead of the scene's
};

/// Lays out the yarns of a cloth. Key points lie at (dx·row, dy·column, dz·level). Where the scene does not
/// tell them, dx and dy follow the densities (dy that of the ends, a column having so many on average) and dz
/// is the sum of the mean radii, so that a weft that lies on a warp touches it. Yarns of one system that
/// change places in their line are led past one another between the stacks, by at most a quarter of the
/// spacing (see passing.hpp), so that no two centrelines meet.
///
/// In periodic mode each pick is a yarn of its own from edge to edge. In wraparound a feeder's picks are one
/// yarn, numbered by its first pick, with a turn round what catches it (loom/weft_way.hpp); it is open where
/// the shuttle stands in the wrong box and at both ends, or a ring through the repeat where the boundary in x
/// is periodic and the last pick ends on the side where the first begins. Crossings are those of the parts
/// that stay in the cloth. Seen from above the side on which a turn passes picks of other rows is that of
/// weft_way.hpp wherever their order allows it; picks of its own rows it passes at the level at which it
/// lies. In a region yarns are cut at its rim.
///
/// Errors: a region outside the cloth, no yarn left, or (in wraparound, many wefts in one row) turns that
/// cannot be laid clear of one another.
Result<ClothCurves> cloth_curves(const Design& design, const Block& block, const CurveOptions& options = {});

/// Two centrelines that meet, or come nearer than was asked for.
struct Meeting {
    std::size_t yarn = 0, other = 0;  ///< indices into ClothCurves::yarns; equal where a yarn meets itself
    Vec3 place{0, 0, 0};              ///< mm, midway
    double distance_mm = 0;           ///< to within a ten-thousandth
};

/// The nearest pair of centrelines among those that come nearer to one another than `least_mm`, as the
/// interpolating splines through the key points run (spline.hpp), with every image of the cloth in its
/// periodic directions and every yarn with itself, but for segments that follow one another. Nothing is
/// sampled, so nothing is missed. Time is that of sorting the segments while `least_mm` is short against
/// them.
std::optional<Meeting> first_meeting(const ClothCurves& curves, double least_mm);

}  // namespace weave
