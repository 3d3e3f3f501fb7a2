#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/loom/weft_way.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace weave {

/// What one feeder's yarn leaves in the cloth of one pick.
struct WeftPart {
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::uint32_t feeder = 0;
    std::size_t pick = 0, row = 0;
    std::size_t first_end = 0, last_end = 0;        ///< between which it crosses the ends
    std::size_t first_column = 0, last_column = 0;  ///< between which it is drawn; wider where it is crossed
    bool is_leftwards = false;
    double offset = 0;  ///< slots: two wefts in one pick lie a quarter below and above its place
    std::array<std::size_t, 2> turn{none, none};  ///< at its left and right end: index into WeftParts::bends
};

/// A turn of a feeder's yarn, round the outside of a column.
struct WeftBend {
    Turn turn;                     ///< to_pick goes on counting into the next repeat where it closes the ring
    std::size_t from = 0, to = 0;  ///< parts
    bool closes = false;           ///< goes on to the first pick of the next repeat
    std::size_t column = 0;        ///< round which it turns
};

struct WeftParts {
    std::vector<WeftPart> parts;  ///< ordered by pick, then feeder
    std::vector<WeftBend> bends;
};

/// Every pick from edge to edge, without turns.
WeftParts straight_parts(const Block& block, const std::vector<Pick>& picks);

/// Every pick between its turns, as loom/weft_way.hpp finds them. A crossed pick runs from edge to edge, and
/// so do its neighbours on the side where it turns to them. In a cloth that repeats along the warp
/// (`repeats`) the way is that of the middle of three repeats, and a feeder whose last pick ends on the side
/// where its first begins turns into the next repeat, if it turns after all the others too.
WeftParts wrapped_parts(const Block& block, const std::vector<Pick>& picks, bool repeats);

/// The parts within a region; a yarn is cut where it leaves it.
WeftParts cut(const WeftParts& whole, const Region& region);

}  // namespace weave
