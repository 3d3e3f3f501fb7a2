#pragma once

#include <weave/curve/spline.hpp>

#include <cstddef>
#include <vector>

namespace weave {

/// Parameters from 0 to segments(), ends included, at which to cut a spline into straight pieces so that none
/// strays further than `error_mm` from the curve. A chord over a step h strays at most h² max|y''| / 8, and
/// y'' of a cubic is largest at an end of its segment; so every segment is cut evenly into as many pieces as
/// this asks for, from `least` to at most most_pieces, beyond which a curve is too wild to follow.
std::vector<double> sample_parameters(const Spline& spline, double error_mm, std::size_t least = 1);

/// Pieces of one segment at most.
inline constexpr std::size_t most_pieces = 64;

/// The value at parameter `t` of numbers given at the control points, between which it changes evenly.
/// `values` has one for each control point; beyond the last of a periodic spline comes the first.
double value_at(const Spline& spline, const std::vector<double>& values, double t);

}  // namespace weave
