#pragma once

#include <weave/picture/look.hpp>
#include <weave/picture/weft_runs.hpp>

#include <cstddef>
#include <optional>
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

/// A turn of which a slice shows one pick or both.
struct SliceTurn {
    Turn turn;
    std::optional<std::size_t> from, to;  ///< paths; where there is none the yarn comes in, or leaves
    [[nodiscard]] bool caught() const { return turn.caught_by != CaughtBy::none; }
    [[nodiscard]] bool stays() const { return from && to; }
};

/// What a slice picture shows, apart from how it looks.
struct SliceMap {
    /// Pictures of slices show up to this many positions, from the one asked for, and levels, from the bottom;
    /// a note says so.
    static constexpr std::size_t most_positions = 60, most_levels = 48;
    System dots = System::weft;
    std::size_t begin = 0;                  ///< row or column of the first position shown
    std::size_t positions = 0, levels = 0;  ///< shown
    std::size_t all_positions = 0, all_levels = 0;
    std::vector<SliceDot> dot_list;
    std::vector<SlicePath> paths;  ///< yarns above the levels shown, and picks without weft, are left out
    std::vector<SliceTurn> turns;  ///< in wraparound, on sides that lie within the positions shown
};

/// How much of a slice is laid out.
struct SliceLimits {
    std::size_t positions = SliceMap::most_positions, levels = SliceMap::most_levels;
};

/// The slice that the request names. With `trim` loose dots are not listed; loose stretches of paths are left
/// to the drawer.
SliceMap slice_map(const Subject& subject, const YarnColours& colours, const WeftRuns& runs,
                   SliceLimits limits = {});

/// How far beyond the outermost position a path that reaches the edge is drawn, in positions.
inline constexpr double overhang = 0.62;

/// Whether a path runs on to the edge of the picture on a side, rather than to a turn.
bool reaches(const SliceMap& map, const SlicePath& path, Side side);

/// Behind which levels of a weft an arrow head shows the way of the shuttle: about every sixth, and none
/// where the line is so short that the head would hide it. Trimmed stretches count as not there with `trim`.
std::vector<std::size_t> arrow_places(const SliceMap& map, const SlicePath& path, bool trim);

/// Whether a path exchanges places with another one between its levels k and k+1, so that their lines cross.
bool swaps(const SliceMap& map, const SlicePath& path, std::size_t k);

/// Where a place of a slice lies in its picture.
Point slice_point(const SliceMap& map, double position, double level);

}  // namespace weave
