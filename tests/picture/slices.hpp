#pragma once

#include <weave/picture/slice_map.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <picture/pictures.hpp>
#include <vector>

namespace weave::testing {

/// A slice as its parts and as the marks of its picture.
struct SlicePicture {
    SliceMap map;
    std::vector<Mark> marks;
    [[nodiscard]] Point at(double position, std::size_t level) const {
        return slice_point(map, position, static_cast<double>(level));
    }
};

inline SlicePicture slice_of(const Design& design, const Block& block, const PictureRequest& request) {
    const Subject subject{design, block, request};
    const YarnColours colours(subject);
    return {slice_map(subject, colours, WeftRuns(subject, colours)), marks_of(design, block, request)};
}

inline double distance(Point a, Point b) {
    return std::hypot(a.x - b.x, a.y - b.y);
}

/// Two picks in one row, woven there and back by one shuttle round the outermost ends.
inline Block there_and_back() {
    return block_of(
        {2}, {1, 1, 1, 1, 1, 1, 1, 1},
        {"T0 P0 T1", "T0 P0 T1", "T0 P0 T1", "T0 P0 T1", "T0 P0 T1", "T0 P0 T1", "T0 P0 T1", "T0 P0 T1"});
}

inline Design shuttle(WeftMode mode) {
    Design design;
    design.scene.weft_mode = mode;
    return design;
}

inline std::vector<Mark> arrows_of(const std::vector<Mark>& marks) {
    std::vector<Mark> arrows;
    std::ranges::copy_if(marks, std::back_inserter(arrows),
                         [](const Mark& mark) { return mark.kind == Mark::Kind::arrow; });
    return arrows;
}

}  // namespace weave::testing
