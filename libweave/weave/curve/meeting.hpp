#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/curve/spline.hpp>

#include <cstddef>
#include <vector>

namespace weave {

/// Two segments of centrelines that come nearer to one another than was asked for.
struct CloseSegments {
    Meeting meeting;
    std::size_t segment = 0, other_segment = 0;
};

/// Every pair of segments nearer than `least_mm`, as first_meeting looks at them. Segments of one yarn that
/// follow one another are left out.
std::vector<CloseSegments> close_segments(const ClothCurves& curves, double least_mm);

/// The spline of a yarn's curve.
Spline spline_of(const YarnCurve& curve);

}  // namespace weave
