#pragma once

#include <weave/picture/cloth_view.hpp>
#include <weave/sim/yarns.hpp>

#include <cstddef>
#include <vector>

namespace weave {

/// A place of a yarn where two of its straight pieces meet.
struct YarnKnot {
    Vec3 place{0, 0, 0}, tangent{1, 0, 0};  ///< `tangent` has length 1
    double value = 0;                       ///< what colours the yarn there, in the unit of words_of()
    double along = 0;                       ///< the yarn from its start, mm
};

/// The yarn at these parameters of its spline (sim/sampled.hpp). Where a yarn stands still its tangent is
/// that of the knot before.
std::vector<YarnKnot> knots_of(const SimulatedYarn& yarn, const std::vector<double>& parameters,
                               ClothColour colour);

/// What colours a yarn at a parameter, in the unit of words_of(); 0 by ClothColour::yarn. `planned` is the
/// spline of its planned control points.
double value_of(const SimulatedYarn& yarn, const Spline& planned, ClothColour colour, double t);

/// Each yarn's colour. Where all yarns of a cloth have the colours of yarns that nobody chose, the paper's
/// tell warp from weft.
std::vector<Colour> own_colours(const Yarns& yarns);

/// The ends of a colour scale.
struct ValueRange {
    double low = 0, high = 1;
};
/// The scale for values between these two: none is the natural end of it, but for strain and height, which
/// have two sides; and never empty. Strain beyond that of what came to rest by itself is left out of the scale: where a
/// yarn is held as planned its strain says nothing, and would drown the rest.
ValueRange scale_of(const Yarns& yarns, ClothColour colour, double least, double most);

/// How colours are told to people: what they show, and with its unit, as over a colour bar.
struct ColourWords {
    const char* subtitle;
    const char* unit;
};
ColourWords words_of(ClothColour colour);

}  // namespace weave
