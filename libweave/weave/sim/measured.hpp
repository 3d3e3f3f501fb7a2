#pragma once

#include <weave/core/result.hpp>
#include <weave/curve/vec3.hpp>

#include <cstddef>
#include <string_view>
#include <vector>

namespace weave {

/// A centreline that somebody measured, say in a CT scan, as points along the yarn.
struct MeasuredYarn {
    std::vector<Vec3> places;  ///< two or more, in the file's unit and axes
    std::size_t line = 0;      ///< of the file where it begins, from 1
};

/// No file of measured yarns has more points.
inline constexpr std::size_t most_measured_points = std::size_t{1} << 24;

/// Reads measured centrelines from plain text: for each yarn a line with its number of points, then as many
/// lines `x y z`, separated by spaces or tabs. What follows a `#` is a comment; blank lines count for
/// nothing. Errors, each with its line: words that are not numbers, too many or too few of them, places
/// beyond 1e9, a yarn of fewer than two points, a file that ends within a yarn or holds none.
Result<std::vector<MeasuredYarn>> read_measured(std::string_view text);

}  // namespace weave
