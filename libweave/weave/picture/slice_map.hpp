#pragma once

#include <weave/picture/look.hpp>
#include <weave/picture/weft_runs.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace weave {

/// A yarn that a slice cuts: it is seen end-on.
struct SliceDot {
    std::size_t position = 0, level = 0;  ///< positions count from the first one shown
    std::size_t number = 0;               ///< on the card, from 0
    Colour colour;
    bool loose = false;
};

/// A yarn that runs along a slice.
struct SlicePath {
    std::size_t number = 0;  ///< on the card, from 0
    Colour colour;
    std::size_t first = 0;  ///< position of the first level
    std::vector<std::size_t> levels;
    std::vector<bool> loose;  ///< for each level
    double shift = 0;         ///< -0.5 … 0.5: how yarns that swap levels step aside from one another
    bool leftwards = false;
    [[nodiscard]] std::size_t last() const { return first + levels.size() - 1; }
};

/// What a slice picture shows, apart from how it looks.
struct SliceMap {
    /// Slices are drawn up to this many positions, from the one asked for, and levels, from the bottom; a
    /// note says so.
    static constexpr std::size_t most_positions = 60, most_levels = 48;
    System dots = System::weft;
    std::size_t begin = 0;                  ///< row or column of the first position shown
    std::size_t positions = 0, levels = 0;  ///< shown
    std::size_t all_positions = 0, all_levels = 0;
    std::vector<SliceDot> dot_list;
    std::vector<SlicePath> paths;  ///< yarns above the levels shown, and picks without weft, are left out
};

/// The slice that the request names. With `trim` loose dots are not listed; loose stretches of paths are left
/// to the drawer.
SliceMap slice_map(const Subject& subject, const YarnColours& colours, const WeftRuns& runs);

/// Whether a path exchanges places with another one between its levels k and k+1, so that their lines cross.
bool swaps(const SliceMap& map, const SlicePath& path, std::size_t k);

/// Where a place of a slice lies in its picture.
Point slice_point(const SliceMap& map, double position, double level);

}  // namespace weave
