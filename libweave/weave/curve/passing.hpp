#pragma once

#include <cstddef>
#include <vector>

namespace weave {

/// A yarn in its line: a pick in its row, or an end in its column.
struct LineYarn {
    std::size_t first = 0;       ///< the stack of the line at which it begins
    std::vector<double> levels;  ///< in that stack and the following ones
};

/// What the yarns of a line have in common.
struct LineSpacing {
    bool is_periodic = false;  ///< after the last stack comes the first; all yarns then pass every stack
    double along_mm = 1;       ///< from stack to stack
    double level_mm = 1;       ///< from level to level
    double wish_aside_mm = 0;  ///< sideways from yarn to yarn where they pass one another
    double most_aside_mm = 0;  ///< and at most either side of the line, so that the next line is clear
};

/// The way of one yarn along its line: `keys` key points from stack to stack, evenly spread, the first in the
/// stack where the yarn begins.
struct Lead {
    std::size_t keys = 1;
    std::vector<double> level, aside_mm;  ///< per key point
};

/// How the yarns of a line are led past one another, in little memory: their ways follow from it.
struct LineWay {
    std::size_t keys = 1;               ///< from stack to stack, of a yarn that is led aside anywhere
    bool is_level_in_stacks = false;    ///< and climbs between them as half a cosine does
    std::vector<double> aside_mm;       ///< of each yarn
    std::vector<std::vector<bool>> led; ///< of each yarn and segment: led aside there
};

/// The furthest that find_way can start on.
inline constexpr std::size_t most_effort = 6;

/// Leads the yarns of a line past one another (paper, A.3). Where the curves of two of them come within a
/// quarter of a level from one stack to the next, both are led aside there, each by an amount of its own; in
/// the stacks themselves no yarn leaves its place, so that what it crosses there is as planned however steep
/// it runs. The heights of the interpolating splines are the same with and without the additional key points.
/// Where two key points a stack do not keep them well apart, a longer way aside and 4 and 8 key points are
/// tried; `effort`, to most_effort, leaves out so many of the six tries. Where none helps, as when two change
/// places right beside a stack, every yarn of the line runs level in the stacks and changes its level midway
/// between them, so that no two pass near a stack; with most_effort that is done even where none pass.
LineWay find_way(const std::vector<LineYarn>& yarns, const LineSpacing& spacing, std::size_t effort = 0);

/// The ways of all yarns of a line that are led so.
std::vector<Lead> leads_along(const std::vector<LineYarn>& yarns, const LineSpacing& spacing, const LineWay& way);

}  // namespace weave
